//! Documents: links and named files exist, every document can be reached from the README, and the
//! README opens with a picture and two commands.

use std::collections::BTreeSet;
use std::path::{Component, Path, PathBuf};

use crate::markdown::{Document, Pointer};
use crate::repository::TextFile;
use crate::{Finding, Repository};

/// Documents without which the repository is not complete.
const REQUIRED: &[&str] = &[
    "README.md",
    "ARCHITECTURE.md",
    "STYLE.md",
    "GLOSSARY.md",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "SECURITY.md",
    "LICENSE-MIT",
    "LICENSE-APACHE",
    "docs/README.md",
    "docs/NUMERICS.md",
    "docs/PIPELINE.md",
];

/// Folders in which a document that is named without its folder may be.
const DOCUMENT_FOLDERS: &[&str] = &["", "docs"];

/// Names of documents that programs write.
const WRITTEN_BY_PROGRAMS: &[&str] = &["DIR/GROWTH.md", "folder/GROWTH.md"];

/// A code span that starts with one of these folders is a path of the repository.
const FOLDERS: &[&str] = &[
    "crates/",
    "docs/",
    "xtask/",
    "goldens/",
    "examples/",
    "fuzz/",
    ".ci/",
    ".cargo/",
];

/// The command that the README's second block starts with, and that CI runs.
const TEST_COMMAND: &str = "cargo test --workspace";

/// Checks that required documents exist, that links, images, paths and names of documents lead
/// somewhere, in the comments of sources too, and the README's opening.
#[must_use]
pub fn check_documents(repository: &Repository) -> Vec<Finding> {
    let mut findings: Vec<Finding> = REQUIRED
        .iter()
        .filter(|path| !repository.exists(Path::new(path)))
        .map(|path| Finding::error(*path, 0, "a required document is missing"))
        .collect();
    for file in repository.files().filter(|file| file.has_ending("md")) {
        findings.extend(check_pointers(repository, file));
    }
    for file in repository.rust_files() {
        findings.extend(check_comments(repository, file));
    }
    if let Some(readme) = repository.file("README.md") {
        findings.extend(check_opening(readme));
        findings.extend(check_reach(repository, readme));
    }
    findings
}

/// Checks that every document can be reached by links from the README.
fn check_reach(repository: &Repository, readme: &TextFile) -> Vec<Finding> {
    let mut reached = BTreeSet::from([readme.path.clone()]);
    let mut to_read = vec![readme];
    while let Some(file) = to_read.pop() {
        let folder = file.path.parent().unwrap_or(Path::new(""));
        for (_, pointer) in Document::parse(&file.text).pointers {
            let Pointer::Link(target) = pointer else {
                continue;
            };
            let path = target.split('#').next().unwrap_or_default();
            let linked = normalised(&folder.join(path)).and_then(|path| repository.file(path));
            let linked = linked.filter(|linked| linked.has_ending("md"));
            to_read.extend(linked.filter(|linked| reached.insert(linked.path.clone())));
        }
    }
    let documents = repository.files().filter(|file| file.has_ending("md"));
    documents
        .filter(|file| !reached.contains(&file.path))
        .map(|file| {
            Finding::error(
                &file.path,
                0,
                "no document that the README reaches links to it",
            )
        })
        .collect()
}

/// Checks the names of documents in the comments of a source.
fn check_comments(repository: &Repository, file: &TextFile) -> Vec<Finding> {
    let comments = file
        .text
        .lines()
        .enumerate()
        .filter(|(_, line)| line.trim_start().starts_with("//"));
    let folder = file.path.parent().unwrap_or(Path::new(""));
    comments
        .flat_map(|(index, line)| {
            check_names(repository, folder, line)
                .into_iter()
                .map(move |message| Finding::error(&file.path, index + 1, message))
        })
        .collect()
}

/// Returns a message for each document that a text names (as `NUMERICS.md`) and that does not
/// exist.
fn check_names(repository: &Repository, folder: &Path, text: &str) -> Vec<String> {
    let is_part_of_name = |c: char| c.is_alphanumeric() || matches!(c, '.' | '/' | '-' | '_');
    text.split(|c| !is_part_of_name(c))
        .filter(|word| word.ends_with(".md") && !WRITTEN_BY_PROGRAMS.contains(word))
        .filter(|word| {
            let beside = normalised(&folder.join(word));
            let elsewhere = DOCUMENT_FOLDERS
                .iter()
                .map(|folder| Path::new(folder).join(word));
            !beside
                .into_iter()
                .chain(elsewhere)
                .any(|path| repository.exists(&path))
        })
        .map(|word| format!("there is no document `{word}`"))
        .collect()
}

fn check_pointers(repository: &Repository, file: &TextFile) -> Vec<Finding> {
    let document = Document::parse(&file.text);
    let folder = file.path.parent().unwrap_or(Path::new(""));
    let mut findings = Vec::new();
    for (line, pointer) in &document.pointers {
        let objections = match pointer {
            Pointer::Link(target) | Pointer::Image(target) => {
                Vec::from_iter(check_link(repository, &document, folder, target))
            }
            Pointer::Code(text) => Vec::from_iter(check_code_span(repository, text)),
            Pointer::Text(text) => check_names(repository, folder, text),
        };
        let found = objections.into_iter();
        findings.extend(found.map(|message| Finding::error(&file.path, *line, message)));
    }
    findings
}

fn check_link(
    repository: &Repository,
    document: &Document,
    folder: &Path,
    target: &str,
) -> Option<String> {
    if target.contains("://") || target.starts_with("mailto:") {
        return None;
    }
    let (path, anchor) = target.split_once('#').unwrap_or((target, ""));
    if path.is_empty() {
        let is_known = document.anchors.iter().any(|known| known == anchor);
        return (!is_known).then(|| format!("no heading makes the anchor `#{anchor}`"));
    }
    let Some(path) = normalised(&folder.join(path)) else {
        return Some(format!("`{path}` leads out of the repository"));
    };
    if !repository.exists(&path) {
        return Some(format!("`{}` does not exist", path.display()));
    }
    let other = repository.file(&path).filter(|_| !anchor.is_empty())?;
    let anchors = Document::parse(&other.text).anchors;
    let is_known = anchors.iter().any(|known| known == anchor);
    (!is_known).then(|| format!("no heading of `{}` makes `#{anchor}`", path.display()))
}

/// A code span that looks like a path of the repository must be one.
fn check_code_span(repository: &Repository, text: &str) -> Option<String> {
    let is_path = FOLDERS.iter().any(|folder| text.starts_with(folder))
        && text
            .chars()
            .all(|c| c.is_alphanumeric() || "/._-".contains(c));
    let is_missing = is_path && !repository.exists(Path::new(text));
    is_missing.then(|| format!("`{text}` does not exist"))
}

/// Takes `.` and `..` out of a path; `None` when it leaves the root.
fn normalised(path: &Path) -> Option<PathBuf> {
    let mut clean = PathBuf::new();
    for part in path.components() {
        match part {
            Component::CurDir => {}
            Component::ParentDir => {
                if !clean.pop() {
                    return None;
                }
            }
            Component::Normal(name) => clean.push(name),
            Component::RootDir | Component::Prefix(_) => return None,
        }
    }
    Some(clean)
}

/// A picture made by the tool, then two commands, each alone in a block that can be copied whole:
/// the first makes a picture, the second runs the tests.
fn check_opening(readme: &TextFile) -> Vec<Finding> {
    let document = Document::parse(&readme.text);
    let mut findings = Vec::new();
    let mut object = |line: usize, message: String| {
        findings.push(Finding::error(&readme.path, line, message));
    };
    for (index, what) in ["makes a picture", "runs the tests"]
        .into_iter()
        .enumerate()
    {
        let Some(fence) = document.fences.get(index) else {
            object(
                0,
                format!(
                    "block {} of the README, which {what}, is missing",
                    index + 1
                ),
            );
            continue;
        };
        if fence.language != "sh" {
            object(fence.line, format!("the block that {what} must be `sh`"));
        }
        let commands: Vec<_> = fence
            .lines
            .iter()
            .filter(|line| !line.trim().is_empty())
            .collect();
        if commands.len() != 1 {
            object(
                fence.line,
                format!("the block that {what} must hold one command"),
            );
        }
        if index == 1
            && !commands
                .iter()
                .all(|command| command.starts_with(TEST_COMMAND))
        {
            object(
                fence.line,
                format!("the block that {what} must start with `{TEST_COMMAND}`"),
            );
        }
    }
    let first_block = document
        .fences
        .first()
        .map_or(usize::MAX, |fence| fence.line);
    let has_picture = document
        .pointers
        .iter()
        .any(|(line, pointer)| *line < first_block && matches!(pointer, Pointer::Image(_)));
    if !has_picture {
        object(
            0,
            "a picture must stand before the first command".to_owned(),
        );
    }
    findings
}

#[cfg(test)]
mod tests;
