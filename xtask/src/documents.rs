//! Documents: what they point at exists, and the README opens as people are promised.

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
    "LICENSE-MIT",
    "LICENSE-APACHE",
    "docs/README.md",
    "docs/NUMERICS.md",
];

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

/// Checks that required documents exist, that links, images and paths lead somewhere, and the
/// README's opening.
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
    if let Some(readme) = repository.file("README.md") {
        findings.extend(check_opening(readme));
    }
    findings
}

fn check_pointers(repository: &Repository, file: &TextFile) -> Vec<Finding> {
    let document = Document::parse(&file.text);
    let folder = file.path.parent().unwrap_or(Path::new(""));
    let mut findings = Vec::new();
    for (line, pointer) in &document.pointers {
        let objection = match pointer {
            Pointer::Link(target) | Pointer::Image(target) => {
                check_link(repository, &document, folder, target)
            }
            Pointer::Code(text) => check_code_span(repository, text),
        };
        findings.extend(objection.map(|message| Finding::error(&file.path, *line, message)));
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
