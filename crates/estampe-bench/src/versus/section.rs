//! The tables as a section of PERFORMANCE.md.

use super::table::Table;
use crate::provenance::Versions;
use std::fmt::Write as _;

/// The section: the compared renderers, and the tables.
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

#[cfg(test)]
mod tests {
    use super::super::table::tests::line;
    use super::*;
    use crate::frame::FrameSize;

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
            vendor: "p".to_owned(),
            estampe: "estampe 0".to_owned(),
            rustc: "rustc 1".to_owned(),
        };
        let text = section(&[table], "Mesa 1", &versions);
        let head = "Measured on 2026-11-21 on P, 2 cores: estampe 0 (rustc 1) against Mesa 1.\n\n#### 64x48, 1 core\n";
        assert!(text.starts_with(head), "{text}");
    }
}
