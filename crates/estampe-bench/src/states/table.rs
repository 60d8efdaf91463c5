//! The results as JSON and as a Markdown table.

use super::state::{Group, State};
use super::{Load, SIZE};
use crate::provenance::Versions;
use serde::Serialize;
use std::fmt::Write as _;

/// The cost per fragment of a load in a state.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// The state's name.
    pub state: String,
    /// The load.
    pub load: Load,
    /// CPU time in nanoseconds per fragment of the load's primitives, hidden ones included.
    pub ns: f64,
    /// That time divided by the baseline's.
    pub ratio: f64,
    /// CPU time in nanoseconds per triangle, line or point; only for the load `tris8`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ns_per_triangle: Option<f64>,
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
pub fn section(states: &[State], rows: &[Row], level: &str, versions: &Versions) -> String {
    format!(
        "Measured on {} on {}: {} ({}), {level}, {SIZE}.\n\n{}",
        versions.date,
        versions.processor,
        versions.estampe,
        versions.rustc,
        markdown(states, rows)
    )
}

/// The table: a line per state, a column per load.
#[must_use]
pub fn markdown(states: &[State], rows: &[Row]) -> String {
    let mut text = "| state |".to_owned();
    for load in Load::ALL {
        let _ = write!(text, " {} |", load.name());
    }
    let _ = write!(text, "\n|---|{}\n", "--:|".repeat(Load::ALL.len()));
    let mut group: Option<Group> = None;
    for state in states {
        if group != Some(state.group) {
            group = Some(state.group);
            let empty = " |".repeat(Load::ALL.len());
            let _ = writeln!(text, "| **{}** |{empty}", state.group.name());
        }
        let _ = write!(text, "| {} |", state.name);
        for load in Load::ALL {
            let _ = write!(text, " {} |", cell(state, load, rows));
        }
        text.push('\n');
    }
    text
}

/// The cell of a state that does not apply to a load.
const LEFT_OUT: &str = "–";

fn cell(state: &State, load: Load, rows: &[Row]) -> String {
    if !state.applies_to(load) {
        return LEFT_OUT.to_owned();
    }
    let row = rows
        .iter()
        .find(|row| row.state == state.name && row.load == load);
    row.map(|row| format!("{} ({:.2}×)", three_digits(row.ns), row.ratio))
        .unwrap_or_default()
}

/// A number with three significant digits, but at most two decimals.
fn three_digits(value: f64) -> String {
    match value {
        100.0.. => format!("{value:.0}"),
        10.0.. => format!("{value:.1}"),
        _ => format!("{value:.2}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(state: &str, load: Load, ns: f64) -> Row {
        Row {
            state: state.to_owned(),
            load,
            ns,
            ratio: ns / 2.0,
            ns_per_triangle: (load == Load::Tris8).then_some(ns * 8.0),
        }
    }

    #[test]
    fn the_json_is_a_list_of_rows() {
        let rows = [
            row("bgra8unorm", Load::Text, 48.25),
            row("scissor", Load::Tris8, 9.0),
        ];
        let text = to_json(&rows);
        let value: serde_json::Value = serde_json::from_str(&text).unwrap();
        let expected = serde_json::json!([
            {"state": "bgra8unorm", "load": "text", "ns": 48.25, "ratio": 24.125},
            {"state": "scissor", "load": "tris8", "ns": 9.0, "ratio": 4.5, "ns_per_triangle": 72.0},
        ]);
        assert_eq!(value, expected);
        assert_eq!(
            text.lines()
                .filter(|line| line.starts_with("{\"state\""))
                .count(),
            2
        );
    }

    #[test]
    fn the_table_marks_states_that_do_not_apply() {
        let states = State::all();
        let named = |name: &str| {
            states
                .iter()
                .find(|state| state.name == name)
                .unwrap()
                .clone()
        };
        let states = [named("bgra8unorm"), named("r8uint"), named("points")];
        let rows = [
            row("bgra8unorm", Load::Text, 48.25),
            row("bgra8unorm", Load::Fill, 123.4),
            row("r8uint", Load::Fill, 3.456),
            row("points", Load::Tris8, 9.0),
        ];
        let expected = "\
| state | fill | blend | tris8 | textured | text |
|---|--:|--:|--:|--:|--:|
| **color-format** | | | | | |
| bgra8unorm | 123 (61.70×) |  |  |  | 48.2 (24.12×) |
| r8uint | 3.46 (1.73×) | – |  | – | – |
| **primitives** | | | | | |
| points | – | – | 9.00 (4.50×) | – | – |
";
        assert_eq!(markdown(&states, &rows), expected);
        let text = section(&states, &rows, "avx2", &Versions::default());
        assert!(
            text.ends_with(&format!(", avx2, 640x360.\n\n{expected}")),
            "{text}"
        );
    }
}
