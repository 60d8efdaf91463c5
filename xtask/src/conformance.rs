//! The rows of the pipeline (`docs/PIPELINE.md`) and the tests that prove them
//! (`docs/CONFORMANCE.md`, made from the documentation of the tests).
//!
//! A test says which rows it is about in a line of its documentation, above its attributes:
//!
//! ```text
//! /// Rows: O3, O4.
//! #[test]
//! fn stencil_and_depth() {
//! ```
//!
//! An ignored test proves nothing; it is listed as such. The check fails where a proved row has no
//! test or only tests of the oracle, where a test names a row that is not proved, where a comment
//! names a row that does not exist, and where CONFORMANCE.md is not up to date.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use crate::markdown::Document;
use crate::repository::TextFile;
use crate::{Finding, Repository};

/// The document that defines the rows.
const PIPELINE: &str = "docs/PIPELINE.md";

/// The document that lists the rows and their tests.
pub(crate) const DOCUMENT: &str = "docs/CONFORMANCE.md";

/// The states of a row, which PIPELINE.md explains.
const STATES: &[&str] = &["proved", "begun", "open"];

/// The crate whose tests say nothing about the pipeline that people use.
const ORACLE: &str = "estampe-reference";

/// A row of the pipeline.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Row {
    /// A capital and a number, such as `O3`.
    id: String,
    /// The requirement, in a few words.
    summary: String,
    is_proved: bool,
}

/// A test that names rows.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Test {
    /// Crate and file, without what all paths have.
    place: String,
    name: String,
    rows: Vec<String>,
    is_ignored: bool,
    path: std::path::PathBuf,
    line: usize,
}

/// Checks the rows, their tests, the comments that name them, and that CONFORMANCE.md is current.
#[must_use]
pub fn check_conformance(repository: &Repository) -> Vec<Finding> {
    let mut findings = Vec::new();
    let rows = rows_of(repository, &mut findings);
    let tests = tests_of(repository, &mut findings);
    for test in &tests {
        for name in &test.rows {
            let message = match rows.iter().find(|row| row.id == *name) {
                Some(row) if row.is_proved => continue,
                Some(_) => format!("{PIPELINE} does not say that row {name} is proved"),
                None => format!("there is no row {name} in {PIPELINE}"),
            };
            findings.push(Finding::error(&test.path, test.line, message));
        }
    }
    for Row { id, summary, .. } in rows.iter().filter(|row| row.is_proved) {
        let proves = |test: &&Test| !test.is_ignored && test.rows.contains(id);
        let mut proofs = tests.iter().filter(proves).peekable();
        if proofs.peek().is_none() {
            let message = format!("row {id} ({summary}) has no test that says `/// Rows: {id}.`");
            findings.push(Finding::error(DOCUMENT, 0, message));
        } else if proofs.all(|test| test.place.starts_with(ORACLE)) {
            let message = format!("row {id} ({summary}) is only tested in the oracle");
            findings.push(Finding::error(DOCUMENT, 0, message));
        }
    }
    let files = repository.rust_files();
    findings.extend(files.flat_map(|file| check_comments(file, &rows)));
    let is_current = repository
        .file(DOCUMENT)
        .is_some_and(|file| file.text == document(&rows, &tests));
    if !is_current {
        let message = "not up to date: run `cargo xtask conformance`";
        findings.push(Finding::error(DOCUMENT, 0, message));
    }
    findings
}

/// The text of CONFORMANCE.md.
#[must_use]
pub fn conformance_document(repository: &Repository) -> String {
    let rows = rows_of(repository, &mut Vec::new());
    document(&rows, &tests_of(repository, &mut Vec::new()))
}

/// The rows of PIPELINE.md's tables, in order.
fn rows_of(repository: &Repository, findings: &mut Vec<Finding>) -> Vec<Row> {
    let Some(file) = repository.file(PIPELINE) else {
        findings.push(Finding::error(PIPELINE, 0, "the list of rows is missing"));
        return Vec::new();
    };
    let mut rows: Vec<Row> = Vec::new();
    for (line, cells) in Document::parse(&file.text).rows {
        let mut object = |message: String| findings.push(Finding::error(PIPELINE, line, message));
        let [id, summary, demands, state] = cells.as_slice() else {
            object(format!("a row has four cells, not {}", cells.len()));
            continue;
        };
        if !is_row_id(id) || summary.is_empty() || demands.is_empty() {
            object(format!("`{id}` is no id, or its row has empty cells"));
        } else if !STATES.contains(&state.as_str()) {
            object(format!(
                "`{state}` is none of the states {}",
                STATES.join(", ")
            ));
        } else if rows.iter().any(|row| row.id == *id) {
            object(format!("a second row {id}"));
        } else {
            rows.push(Row {
                id: id.clone(),
                summary: summary.clone(),
                is_proved: state == STATES[0],
            });
        }
    }
    rows
}

/// Returns true if a word is a capital and a number of one or two digits.
fn is_row_id(word: &str) -> bool {
    let mut letters = word.chars();
    letters
        .next()
        .is_some_and(|first| first.is_ascii_uppercase())
        && (1..=2).contains(&letters.clone().count())
        && letters.all(|digit| digit.is_ascii_digit())
}

/// Checks that the rows exist which the comments of a source name: `row X3`, `(O4)`, `(F1, R5)`.
fn check_comments(file: &TextFile, rows: &[Row]) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (index, line) in file.text.lines().enumerate() {
        let Some(comment) = line.trim_start().strip_prefix("//") else {
            continue;
        };
        for id in named_rows(comment) {
            if !rows.iter().any(|row| row.id == id) {
                let message = format!("there is no row {id} in {PIPELINE}");
                findings.push(Finding::error(&file.path, index + 1, message));
            }
        }
    }
    findings
}

/// The ids in a comment that follow `row` or `rows`, or fill a pair of parentheses.
fn named_rows(comment: &str) -> Vec<&str> {
    // The parenthesis of a call follows a name.
    let in_parentheses = comment.match_indices(" (").filter_map(|(at, opening)| {
        let (inside, _) = comment[at + opening.len()..].split_once(')')?;
        let ids: Vec<&str> = inside.split(", ").collect();
        ids.iter().all(|id| is_row_id(id)).then_some(ids)
    });
    let after_row = comment
        .split_whitespace()
        .zip(comment.split_whitespace().skip(1));
    let after_row = after_row
        .filter(|(word, _)| matches!(word.trim_start_matches('('), "row" | "rows"))
        .map(|(_, id)| id.trim_end_matches(|c: char| !c.is_ascii_digit()))
        .filter(|id| is_row_id(id));
    in_parentheses.flatten().chain(after_row).collect()
}

fn document(rows: &[Row], tests: &[Test]) -> String {
    let mut text = String::from(
        "# Rows and their tests\n\n\
         The tests that prove each row of [PIPELINE.md](PIPELINE.md). `cargo xtask conformance` writes this document\n\
         from the documentation of the tests; `cargo xtask check` fails when it is not up to date.\n\n\
         | row | demands | tests |\n|---|---|---|\n",
    );
    for Row { id, summary, .. } in rows.iter().filter(|row| row.is_proved) {
        let mut by_place: BTreeMap<&str, Vec<String>> = BTreeMap::new();
        for test in tests.iter().filter(|test| test.rows.contains(id)) {
            let mark = if test.is_ignored { " (ignored)" } else { "" };
            let name = format!("`{}`{mark}", test.name);
            by_place.entry(&test.place).or_default().push(name);
        }
        let places: Vec<String> = by_place
            .into_iter()
            .map(|(place, names)| format!("{place}: {}", names.join(", ")))
            .collect();
        // Writing to a string cannot fail.
        let _ = writeln!(text, "| {id} | {summary} | {} |", places.join("; "));
    }
    text
}

/// Every test that names rows, by path and line.
fn tests_of(repository: &Repository, findings: &mut Vec<Finding>) -> Vec<Test> {
    let mut tests = Vec::new();
    // Sources of the checks hold examples of such lines; their tests of the repository are tests.
    let with_tests = ["crates", "xtask/tests"];
    for file in repository.rust_files().filter(|file| {
        with_tests
            .iter()
            .any(|folder| file.path.starts_with(folder))
    }) {
        tests.extend(tests_in(file, findings));
    }
    tests
}

fn tests_in(file: &TextFile, findings: &mut Vec<Finding>) -> Vec<Test> {
    let lines: Vec<&str> = file.text.lines().map(str::trim).collect();
    let mut tests = Vec::new();
    for (at, line) in lines.iter().enumerate() {
        let Some(rows) = line.strip_prefix("/// Rows:") else {
            continue;
        };
        let rows = rows.trim().trim_end_matches('.').split(',');
        let after = &lines[at + 1..];
        let is_heading = |line: &&&str| line.starts_with("///") || line.starts_with("#[");
        let headings: Vec<&&str> = after.iter().take_while(is_heading).collect();
        let name = after
            .get(headings.len())
            .and_then(|line| line.strip_prefix("fn "))
            .and_then(|line| line.split_once('('))
            .map(|(name, _)| name.to_owned());
        let (Some(name), true) = (name, headings.iter().any(|line| **line == "#[test]")) else {
            let message = "only a test can have a line `Rows:`";
            findings.push(Finding::error(&file.path, at + 1, message));
            continue;
        };
        tests.push(Test {
            place: place(file),
            name,
            rows: rows.map(|row| row.trim().to_owned()).collect(),
            is_ignored: headings.iter().any(|line| line.starts_with("#[ignore")),
            path: file.path.clone(),
            line: at + 1,
        });
    }
    tests
}

/// `crates/estampe-tests/tests/colors.rs` is "estampe-tests colors".
fn place(file: &TextFile) -> String {
    let parts = file.path.iter().map(|part| part.to_string_lossy());
    let parts: Vec<String> = parts
        .filter(|part| !matches!(&**part, "crates" | "src" | "tests"))
        .map(|part| part.trim_end_matches(".rs").to_owned())
        .collect();
    parts.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    const PATH: &str = "crates/a/tests/b.rs";

    const ROWS: &str = "| row | in short | demands | state |\n|---|---|---|---|\n\
                        | O3 | stencil | all. | proved |\n| O4 | depth test | all. | proved |\n\
                        | O5 | blending | all. | proved |\n| V3 | tessellation | all. | open |\n";

    fn repository(files: &[(&str, &str)]) -> Repository {
        Repository::synthetic(&[&[(PIPELINE, ROWS)], files].concat())
    }

    fn errors(files: &[(&str, &str)]) -> Vec<String> {
        let findings = check_conformance(&repository(files));
        let about_other_files = findings.into_iter().filter(|finding| finding.line > 0);
        about_other_files.map(|finding| finding.message).collect()
    }

    #[test]
    fn a_row_without_a_test_and_a_stale_document_are_found() {
        let source = "/// Rows: O3, O4.\n#[test]\nfn both() {}\n";
        let files = [(PATH, source), (DOCUMENT, "old")];
        let messages = |files: &[(&str, &str)]| -> Vec<String> {
            let findings = check_conformance(&repository(files));
            findings
                .into_iter()
                .map(|finding| finding.message)
                .collect()
        };
        let found = messages(&files);
        assert_eq!(found.len(), 2, "{found:?}");
        assert!(found[0].starts_with("row O5 (blending) has no test"));
        assert!(found[1].contains("cargo xtask conformance"));

        let document = conformance_document(&repository(&files[..1]));
        assert!(document.contains("| O4 | depth test | a b: `both` |"));
        assert!(!document.contains("V3"));
        assert_eq!(messages(&[(PATH, source), (DOCUMENT, &document)]).len(), 1);
    }

    #[test]
    fn ignored_tests_prove_nothing_and_are_marked() {
        let source = "/// Rows: O5.\n#[test]\n#[ignore = \"not yet\"]\nfn later() {}\n";
        let found = check_conformance(&repository(&[(PATH, source)]));
        assert!(
            found
                .iter()
                .any(|finding| finding.message.starts_with("row O5 "))
        );
        let document = conformance_document(&repository(&[(PATH, source)]));
        assert!(document.contains("`later` (ignored)"));
    }

    #[test]
    fn tests_can_only_name_proved_rows() {
        let found = errors(&[(PATH, "/// Rows: O11.\n#[test]\nfn no() {}\n")]);
        assert!(found[0].contains("no row O11"), "{found:?}");
        let found = errors(&[(PATH, "/// Rows: V3.\n#[test]\nfn no() {}\n")]);
        assert!(
            found[0].contains("does not say that row V3 is proved"),
            "{found:?}"
        );
        let found = errors(&[(PATH, "/// Rows: O4.\nfn not_a_test() {}\n")]);
        assert!(found[0].contains("only a test"), "{found:?}");
    }

    #[test]
    fn comments_can_only_name_rows_that_exist() {
        let comments =
            "//! Stencil (O3), depth (O4, O5), a call f(X9) and row V3.\nf(O9); // (O9)\n";
        assert_eq!(errors(&[(PATH, comments)]), [""; 0]);
        for comment in [
            "/// Limits (O9).",
            "// (O3, O9)",
            "//! row O9, that is",
            "// (rows O9 to O10)",
        ] {
            let found = errors(&[(PATH, comment)]);
            assert_eq!(
                found,
                ["there is no row O9 in docs/PIPELINE.md"],
                "{comment}"
            );
        }
    }

    #[test]
    fn malformed_rows_are_found() {
        for row in [
            "| O6 | a | b |",
            "| Oh | a | b | open |",
            "| O6 | | b | open |",
            "| O6 | a | b | done |",
            "| O3 | a | b | open |",
        ] {
            let text = format!("{ROWS}{row}\n");
            let mut findings = Vec::new();
            let rows = rows_of(&Repository::synthetic(&[(PIPELINE, &text)]), &mut findings);
            assert_eq!((rows.len(), findings.len()), (4, 1), "{row}");
        }
    }
}
