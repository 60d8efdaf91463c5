//! The results as JSON and as a Markdown table.

use super::{Group, Operation};
use crate::provenance::Versions;
use serde::Serialize;
use std::fmt::Write as _;

/// The cost of an operation at a SIMD level.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// The operation's name.
    pub operation: &'static str,
    /// The SIMD level.
    pub level: &'static str,
    /// CPU time in nanoseconds of sixteen invocations.
    pub ns: f64,
}

/// The rows as a JSON list, one row a line.
#[must_use]
pub fn to_json(rows: &[Row]) -> String {
    let lines = rows
        .iter()
        .map(|row| serde_json::to_string(row).expect("strings and numbers always serialize"));
    let lines: Vec<String> = lines.collect();
    format!("[\n{}\n]\n", lines.join(",\n"))
}

/// The section of PERFORMANCE.md.
#[must_use]
pub fn section(
    operations: &[Operation],
    levels: &[&str],
    rows: &[Row],
    versions: &Versions,
) -> String {
    format!(
        "Measured on {} on {}: {} ({}).\n\n{}",
        versions.date,
        versions.processor,
        versions.estampe,
        versions.rustc,
        markdown(operations, levels, rows)
    )
}

/// The table: a line per operation, a column per SIMD level.
#[must_use]
pub fn markdown(operations: &[Operation], levels: &[&str], rows: &[Row]) -> String {
    let columns: Vec<String> = levels.iter().map(|level| format!(" {level} |")).collect();
    let mut text = format!(
        "| operation |{}\n|---|{}\n",
        columns.concat(),
        "--:|".repeat(levels.len())
    );
    let mut group: Option<Group> = None;
    for operation in operations {
        if group != Some(operation.group) {
            group = Some(operation.group);
            let empty = " |".repeat(levels.len());
            let _ = writeln!(text, "| **{}** |{empty}", operation.group.name());
        }
        let _ = write!(text, "| {} |", operation.name);
        for level in levels {
            let row = rows
                .iter()
                .find(|row| row.operation == operation.name && row.level == *level);
            let cell = row.map(|row| three_digits(row.ns)).unwrap_or_default();
            let _ = write!(text, " {cell} |");
        }
        text.push('\n');
    }
    text
}

/// A number with three significant digits, but at most two decimals.
fn three_digits(value: f64) -> String {
    match value {
        100.0.. => format!("{value:.0}"),
        10.0.. => format!("{value:.1}"),
        _ => format!("{value:.2}"),
    }
}
