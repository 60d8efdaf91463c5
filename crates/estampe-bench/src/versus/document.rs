//! The tables in their document: between two marks, which stay.

use super::table::Table;
use crate::BenchError;
use std::fmt::Write as _;
use std::path::Path;

/// The lines around what this command writes.
const MARKS: [&str; 2] = ["<!-- compare: begin -->", "<!-- compare: end -->"];

/// What was compared, on what.
#[derive(Debug, Clone, Default)]
pub struct Versions {
    /// The day, as 2026-11-21.
    pub date: String,
    /// The processor's name and how many cores there are.
    pub processor: String,
    /// Our version and commit.
    pub estampe: String,
    /// The compiler's.
    pub rustc: String,
}

/// The section: what was compared, and the tables.
#[must_use]
pub fn section(tables: &[Table], driver: &str, versions: &Versions) -> String {
    let mut text = format!(
        "Measured on {} on {}: {} ({}) against {driver}.\n",
        versions.date, versions.processor, versions.estampe, versions.rustc
    );
    for table in tables {
        let _ = write!(text, "\n{}", table.markdown());
    }
    text
}

/// Puts the section between the marks of a document.
///
/// # Errors
/// When the file cannot be read or written, or has no marks.
pub fn update(path: &Path, section: &str) -> Result<(), BenchError> {
    let file_error = |source| BenchError::File {
        path: path.to_owned(),
        source,
    };
    let old = std::fs::read_to_string(path).map_err(file_error)?;
    let new = replaced(&old, section).ok_or_else(|| BenchError::Picture {
        path: path.to_owned(),
        reason: format!("lacks the lines {} and {}", MARKS[0], MARKS[1]),
    })?;
    std::fs::write(path, new).map_err(file_error)
}

fn replaced(document: &str, section: &str) -> Option<String> {
    let (before, rest) = document.split_once(MARKS[0])?;
    let (_, after) = rest.split_once(MARKS[1])?;
    Some(format!(
        "{before}{}\n\n{section}\n{}{after}",
        MARKS[0], MARKS[1]
    ))
}

#[cfg(test)]
mod tests {
    use super::super::table::tests::line;
    use super::*;
    use crate::frame::FrameSize;

    #[test]
    fn only_what_is_between_the_marks_changes() {
        let [begin, end] = MARKS;
        let document = format!("# Head\n\n{begin}\nold\n{end}\n\ntail\n");
        let once = replaced(&document, "new").unwrap();
        assert_eq!(once, format!("# Head\n\n{begin}\n\nnew\n{end}\n\ntail\n"));
        assert_eq!(replaced(&once, "new").unwrap(), once);
        assert_eq!(replaced("# Head\n", "new"), None);
        assert_eq!(replaced(&format!("{end}{begin}"), "new"), None);
    }

    #[test]
    fn a_section_names_both_renderers() {
        let mut table = Table::new(
            FrameSize {
                width: 64,
                height: 48,
            },
            1,
        );
        table.lines.push(line("fill", 2.0, 1.0));
        let versions = Versions {
            date: "2026-11-21".to_owned(),
            processor: "P, 2 cores".to_owned(),
            estampe: "estampe 0".to_owned(),
            rustc: "rustc 1".to_owned(),
        };
        let text = section(&[table], "Mesa 1", &versions);
        let head = "Measured on 2026-11-21 on P, 2 cores: estampe 0 (rustc 1) against Mesa 1.\n\n### 64x48, 1 core\n";
        assert!(text.starts_with(head), "{text}");
    }
}
