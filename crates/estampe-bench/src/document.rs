//! Generated sections of PERFORMANCE.md, each between two marks, which are kept.

use crate::BenchError;
use crate::provenance::repository;
use std::path::{Path, PathBuf};

/// The path of PERFORMANCE.md in the repository.
#[must_use]
pub fn default_document() -> PathBuf {
    repository().join("PERFORMANCE.md")
}

/// Replaces the text between the marks `<!-- NAME: begin -->` and `<!-- NAME: end -->` of a
/// document.
///
/// # Errors
/// If the file cannot be read or written, or has no such marks.
pub fn update(path: &Path, name: &str, section: &str) -> Result<(), BenchError> {
    let file_error = |source| BenchError::File {
        path: path.to_owned(),
        source,
    };
    let old = std::fs::read_to_string(path).map_err(file_error)?;
    let new = replaced(&old, name, section).ok_or_else(|| BenchError::Picture {
        path: path.to_owned(),
        reason: {
            let [begin, end] = marks(name);
            format!("lacks the lines {begin} and {end}")
        },
    })?;
    std::fs::write(path, new).map_err(file_error)
}

fn marks(name: &str) -> [String; 2] {
    ["begin", "end"].map(|place| format!("<!-- {name}: {place} -->"))
}

fn replaced(document: &str, name: &str, section: &str) -> Option<String> {
    let [begin, end] = &marks(name);
    let (before, rest) = document.split_once(begin)?;
    let (_, after) = rest.split_once(end)?;
    Some(format!("{before}{begin}\n\n{section}\n{end}{after}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_text_between_the_marks_changes() {
        let [begin, end] = marks("it");
        let [other_begin, other_end] = marks("other");
        let other = format!("{other_begin}\nother\n{other_end}");
        let document = format!("# Head\n\n{other}\n{begin}\nold\n{end}\n\ntail\n");
        let once = replaced(&document, "it", "new").unwrap();
        let expected = format!("# Head\n\n{other}\n{begin}\n\nnew\n{end}\n\ntail\n");
        assert_eq!(once, expected);
        assert_eq!(replaced(&once, "it", "new").unwrap(), once);
        assert_eq!(replaced("# Head\n", "it", "new"), None);
        assert_eq!(replaced(&format!("{end}{begin}"), "it", "new"), None);
    }
}
