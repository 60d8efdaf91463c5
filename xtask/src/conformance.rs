//! Which tests prove which row of the pipeline: `docs/CONFORMANCE.md`, made from the tests' own words.
//!
//! A test says which rows it is about in a line of its documentation, above its attributes:
//!
//! ```text
//! /// Rows: O3, O4.
//! #[test]
//! fn stencil_and_depth() {
//! ```
//!
//! A test that is ignored proves nothing; it is listed as such. The check fails where a row has no test, or none but the
//! oracle's own, where a test
//! names a row that there is not, and where the document is not what the tests say: `cargo xtask conformance` writes it.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use crate::repository::TextFile;
use crate::{Finding, Repository};

/// Where the document is.
pub(crate) const DOCUMENT: &str = "docs/CONFORMANCE.md";

/// The rows, in the order of the pipeline: what each asks for. A row that this project adds is added here.
const ROWS: &[(&str, &str)] = &[
    (
        "V1",
        "vertex shader: attributes, uniforms, varyings, point size, clip distances",
    ),
    (
        "V2",
        "indexed and plain draws, base vertex, instances, restart, indirect, vertex formats",
    ),
    ("A1", "primitive assembly, adjacency"),
    ("A2", "facing and face culling"),
    (
        "A3",
        "clipping, user clip and cull distances, depth clamp, guard band",
    ),
    ("A4", "perspective division, viewport"),
    ("A5", "polygon mode, depth bias, provoking vertex"),
    ("R1", "triangles: exact coverage, top-left rule"),
    (
        "R2",
        "the classic scan conversions, equal to the production coverage",
    ),
    (
        "R3",
        "lines: integer and pipeline rule, wide, anti-aliased, stippled",
    ),
    ("R4", "points, rectangles"),
    (
        "R5",
        "interpolation: affine depth, perspective-correct varyings",
    ),
    (
        "R6",
        "1, 2, 4, 8, 16 samples: coverage, shading by sample, masks, alpha to coverage, resolve",
    ),
    ("R7", "derivatives over quads, helper lanes"),
    ("R8", "conservative rasterization"),
    (
        "F1",
        "fragment shader: inputs, discard, depth output, several targets, dual source",
    ),
    (
        "F2",
        "textures: dimensions, formats, filters, comparison, gather, fetch, storage, mips",
    ),
    ("O1", "pixel ownership"),
    ("O2", "scissor"),
    ("O3", "stencil"),
    ("O4", "depth test and depth bounds"),
    ("O5", "blending"),
    ("O6", "logic operations"),
    ("O7", "write masks"),
    ("O8", "sRGB, float, integer and other targets"),
    ("O9", "early tests, where they cannot be seen"),
    ("O10", "occlusion and statistics queries"),
    (
        "D1",
        "depth formats, reversed depth, infinite far plane, logarithmic depth",
    ),
    ("L", "limits: size of targets, layers, attributes, varyings"),
    ("U3", "the same bits at every level and number of threads"),
];

/// The crate whose tests say nothing of the pipeline that people use.
const ORACLE: &str = "estampe-reference";

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

/// Checks the rows' tests, and that the document is up to date.
#[must_use]
pub fn check_conformance(repository: &Repository) -> Vec<Finding> {
    let mut findings = Vec::new();
    let tests = tests_of(repository, &mut findings);
    for test in &tests {
        for row in &test.rows {
            if !ROWS.iter().any(|(id, _)| id == row) {
                let message = format!("there is no row `{row}`: see xtask/src/conformance.rs");
                findings.push(Finding::error(&test.path, test.line, message));
            }
        }
    }
    for (id, what) in ROWS {
        let proves = |test: &&Test| !test.is_ignored && test.rows.iter().any(|row| row == id);
        let mut proofs = tests.iter().filter(proves).peekable();
        if proofs.peek().is_none() {
            let message = format!("row {id} ({what}) has no test that says `/// Rows: {id}.`");
            findings.push(Finding::error(DOCUMENT, 0, message));
        } else if proofs.all(|test| test.place.starts_with(ORACLE)) {
            let message = format!("row {id} ({what}) is only tested in the oracle");
            findings.push(Finding::error(DOCUMENT, 0, message));
        }
    }
    let is_current = repository
        .file(DOCUMENT)
        .is_some_and(|file| file.text == document(&tests));
    if !is_current {
        let message = "not what the tests say: run `cargo xtask conformance`";
        findings.push(Finding::error(DOCUMENT, 0, message));
    }
    findings
}

/// The document's text.
#[must_use]
pub fn conformance_document(repository: &Repository) -> String {
    document(&tests_of(repository, &mut Vec::new()))
}

fn document(tests: &[Test]) -> String {
    let mut text = String::from(
        "# Rows and their tests\n\n\
         Which tests prove which row of the pipeline. Made from the tests' documentation by `cargo xtask conformance`;\n\
         `cargo xtask check` and the ordinary tests fail when it is stale, or when a row has no test.\n\n\
         | row | asks for | tests |\n|---|---|---|\n",
    );
    for (id, what) in ROWS {
        let mut by_place: BTreeMap<&str, Vec<String>> = BTreeMap::new();
        for test in tests
            .iter()
            .filter(|test| test.rows.iter().any(|row| row == id))
        {
            let mark = if test.is_ignored { " (ignored)" } else { "" };
            let name = format!("`{}`{mark}", test.name);
            by_place.entry(&test.place).or_default().push(name);
        }
        let places: Vec<String> = by_place
            .into_iter()
            .map(|(place, names)| format!("{place}: {}", names.join(", ")))
            .collect();
        // Writing to a string cannot fail.
        let _ = writeln!(text, "| {id} | {what} | {} |", places.join("; "));
    }
    text
}

/// Every test that names rows, by path and line.
fn tests_of(repository: &Repository, findings: &mut Vec<Finding>) -> Vec<Test> {
    let mut tests = Vec::new();
    for file in repository
        .rust_files()
        .filter(|file| file.path.starts_with("crates"))
    {
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
            let message = "`Rows:` stands above tests alone";
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

    fn errors(files: &[(&str, &str)]) -> Vec<String> {
        let findings = check_conformance(&Repository::synthetic(files));
        findings
            .into_iter()
            .map(|finding| finding.message)
            .collect()
    }

    #[test]
    fn a_row_without_a_test_and_a_stale_document_are_found() {
        let source = "/// Rows: O3, O4.\n#[test]\nfn both() {}\n";
        let found = errors(&[(PATH, source), (DOCUMENT, "old")]);
        assert!(found.iter().any(|message| message.starts_with("row O5 ")));
        assert!(!found.iter().any(|message| message.starts_with("row O3 ")));
        assert!(
            found
                .iter()
                .any(|message| message.contains("cargo xtask conformance"))
        );

        let repository = Repository::synthetic(&[(PATH, source)]);
        let document = conformance_document(&repository);
        assert!(document.contains("| O4 | depth test and depth bounds | a b: `both` |"));
        let found = errors(&[(PATH, source), (DOCUMENT, &document)]);
        assert!(
            !found
                .iter()
                .any(|message| message.contains("cargo xtask conformance"))
        );
    }

    #[test]
    fn ignored_tests_prove_nothing_and_are_marked() {
        let source = "/// Rows: O6.\n#[test]\n#[ignore = \"not yet\"]\nfn later() {}\n";
        let found = errors(&[(PATH, source)]);
        assert!(found.iter().any(|message| message.starts_with("row O6 ")));
        let document = conformance_document(&Repository::synthetic(&[(PATH, source)]));
        assert!(document.contains("`later` (ignored)"));
    }

    #[test]
    fn unknown_rows_and_marks_that_are_not_above_tests_are_found() {
        let found = errors(&[(PATH, "/// Rows: O11.\n#[test]\nfn no() {}\n")]);
        assert!(found.iter().any(|message| message.contains("no row `O11`")));
        let found = errors(&[(PATH, "/// Rows: O1.\nfn not_a_test() {}\n")]);
        assert!(
            found
                .iter()
                .any(|message| message.contains("above tests alone"))
        );
    }
}
