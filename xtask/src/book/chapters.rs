//! The chapters of the book, in the order in which the table of contents links to them.

use std::path::{Path, PathBuf};

use crate::markdown::{Document, Pointer};
use crate::repository::TextFile;
use crate::{Finding, Repository};

/// The folder of the book's sources.
pub(super) const SOURCES: &str = "book/src";

/// The table of contents, relative to the sources.
pub(super) const SUMMARY: &str = "SUMMARY.md";

/// What stands before the French title of a chapter, in the first paragraph.
const FRENCH: &str = "*En français : ";

/// One chapter.
#[derive(Debug, Clone)]
pub(super) struct Chapter<'a> {
    pub(super) file: &'a TextFile,
    /// The first heading.
    pub(super) title: &'a str,
    /// The title in French.
    pub(super) title_fr: &'a str,
}

impl<'a> Chapter<'a> {
    /// The name of the source, such as `03_spaces` with its ending.
    pub(super) fn name(&self) -> &'a str {
        let name = self.file.path.file_name().and_then(|name| name.to_str());
        name.expect("a text file of the repository has a name in UTF-8")
    }

    /// Returns true if the chapter explains a stage: its name starts with its number.
    pub(super) fn is_stage(&self) -> bool {
        self.name()
            .starts_with(|first: char| first.is_ascii_digit())
    }

    fn read(file: &'a TextFile) -> Self {
        let mut lines = file.text.lines().filter(|line| !line.trim().is_empty());
        let title = lines.next().and_then(|line| line.strip_prefix("# "));
        let title_fr = lines.next().and_then(|line| line.strip_prefix(FRENCH));
        Self {
            file,
            title: title.unwrap_or_default(),
            title_fr: title_fr
                .and_then(|rest| rest.strip_suffix('*'))
                .unwrap_or_default(),
        }
    }
}

/// The chapters in the order of the table of contents, with a finding for each that is missing
/// here or there, and for each without its two titles.
pub(super) fn chapters<'a>(
    repository: &'a Repository,
    findings: &mut Vec<Finding>,
) -> Vec<Chapter<'a>> {
    let summary_path = Path::new(SOURCES).join(SUMMARY);
    let Some(summary) = repository.file(&summary_path) else {
        findings.push(Finding::error(
            summary_path,
            0,
            "the book has no table of contents",
        ));
        return Vec::new();
    };
    let mut found: Vec<Chapter<'a>> = Vec::new();
    for (line, pointer) in Document::parse(&summary.text).pointers {
        let Pointer::Link(target) = pointer else {
            continue;
        };
        let path: PathBuf = Path::new(SOURCES).join(&target);
        let mut object =
            |message: String| findings.push(Finding::error(&summary_path, line, message));
        match repository.file(&path) {
            None => object(format!("there is no chapter `{target}`")),
            Some(file) if found.iter().any(|chapter| chapter.file.path == file.path) => {
                object(format!("`{target}` is listed twice"));
            }
            Some(file) => found.push(Chapter::read(file)),
        }
    }
    for chapter in &found {
        let mut object = |line, message: &str| {
            findings.push(Finding::error(&chapter.file.path, line, message));
        };
        if chapter.title.is_empty() {
            object(1, "a chapter starts with its title, `# …`");
        }
        if chapter.title_fr.is_empty() {
            object(3, "a chapter's second paragraph is `*En français : …*`");
        }
    }
    let files = repository
        .files()
        .filter(|file| file.path.starts_with(SOURCES));
    for file in files.filter(|file| file.has_ending("md") && file.path != summary_path) {
        if !found.iter().any(|chapter| chapter.file.path == file.path) {
            let message = "the table of contents does not list this chapter";
            findings.push(Finding::error(&file.path, 0, message));
        }
    }
    found
}
