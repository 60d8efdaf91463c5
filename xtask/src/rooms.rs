//! Rooms: file names that say what is inside, files that one can take in, unsafe code in its place.

use std::path::Path;

use crate::repository::TextFile;
use crate::rust_source::{code_only, tokens, without_test_items};
use crate::{Finding, Repository};

/// File and folder names that attract whatever has no home.
const ATTICS: &[&str] = &[
    "util", "utils", "common", "helper", "helpers", "misc", "manager", "data", "info",
];

/// Beyond this many lines without tests, look for the second idea in a file.
const LONG_LINES: usize = 600;

/// Beyond this many, the file must be split.
const TOO_LONG_LINES: usize = 1000;

/// A crate's root is its documentation, its modules and its re-exports.
const LONG_ROOT_LINES: usize = 150;

/// The crates that hold unsafe code: they `deny` it, and these modules alone expect it.
const UNSAFE_CRATES: &[(&str, &[&str])] = &[(
    "crates/estampe-simd",
    &["crates/estampe-simd/src/gather.rs"],
)];

/// Tests that need unsafe code: an allocator that counts cannot be written without.
const UNSAFE_TESTS: &[&str] = &["crates/estampe/tests/no_allocation.rs"];

/// Checks names and lengths of files, and that unsafe code stays where it is allowed.
#[must_use]
pub fn check_rooms(repository: &Repository) -> Vec<Finding> {
    repository
        .rust_files()
        .flat_map(|file| {
            let code = code_only(&file.text);
            let mut findings = Vec::from_iter(check_name(&file.path));
            findings.extend(check_length(file, &code));
            findings.extend(check_unsafe(file, &code));
            findings
        })
        .collect()
}

fn check_name(path: &Path) -> Option<Finding> {
    let stemmed = path.with_extension("");
    let attic = stemmed
        .iter()
        .find(|part| ATTICS.iter().any(|attic| part == attic))?;
    let message = format!("`{}` says nothing: name the thing", attic.to_string_lossy());
    Some(Finding::error(path, 0, message))
}

fn check_length(file: &TextFile, code: &str) -> Option<Finding> {
    if file.is_test() {
        return None;
    }
    let lines = file.text.lines().count() - lines_of_inline_tests(code);
    if lines > TOO_LONG_LINES {
        let message = format!("{lines} lines without tests, over {TOO_LONG_LINES}: split it");
        Some(Finding::error(&file.path, 0, message))
    } else if lines > LONG_LINES {
        let message = format!("{lines} lines without tests: is there a second idea in it?");
        Some(Finding::note(&file.path, 0, message))
    } else if file.path.ends_with("src/lib.rs") && lines > LONG_ROOT_LINES {
        let message = format!("{lines} lines in a crate's root, which is a contents page");
        Some(Finding::note(&file.path, 0, message))
    } else {
        None
    }
}

/// How many lines from `#[cfg(test)]` at the file's end on are inline tests.
fn lines_of_inline_tests(code: &str) -> usize {
    let all = tokens(code);
    let kept = without_test_items(&all);
    let last = |tokens: &[crate::rust_source::Token<'_>]| tokens.last().map_or(0, |t| t.line);
    last(&all) - last(&kept)
}

fn check_unsafe(file: &TextFile, code: &str) -> Vec<Finding> {
    let exception = UNSAFE_CRATES
        .iter()
        .find(|(folder, _)| file.path.starts_with(folder));
    let mut findings = Vec::new();

    let wanted = if exception.is_some() {
        "deny"
    } else {
        "forbid"
    };
    if is_crate_root(&file.path) && !has_inner_attribute(code, wanted) {
        let message = format!("a crate's root must say `#![{wanted}(unsafe_code)]`");
        findings.push(Finding::error(&file.path, 1, message));
    }

    let is_at = |home: &&str| file.path == Path::new(home);
    let is_home = exception.is_some_and(|(_, homes)| homes.iter().any(is_at))
        || UNSAFE_TESTS.iter().any(is_at);
    if !is_home {
        let found = tokens(code);
        findings.extend(
            found
                .iter()
                .filter(|token| token.text == "unsafe")
                .map(|token| {
                    Finding::error(
                        &file.path,
                        token.line,
                        "unsafe code has its homes: not here",
                    )
                }),
        );
    }
    findings
}

/// Whether the file is the root of a library or a program.
fn is_crate_root(path: &Path) -> bool {
    let is_program = path
        .parent()
        .is_some_and(|folder| folder.ends_with("src/bin"));
    path.ends_with("src/lib.rs") || path.ends_with("src/main.rs") || is_program
}

fn has_inner_attribute(code: &str, lint_level: &str) -> bool {
    let wanted = ["#", "!", "[", lint_level, "(", "unsafe_code", ")", "]"];
    let found = tokens(code);
    found
        .windows(wanted.len())
        .any(|window| window.iter().map(|t| t.text).eq(wanted))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn messages_of(path: &str, text: &str) -> Vec<String> {
        let findings = check_rooms(&Repository::synthetic(&[(path, text)]));
        findings.iter().map(ToString::to_string).collect()
    }

    #[test]
    fn attics_are_refused() {
        for path in [
            "crates/x/src/util.rs",
            "crates/x/tests/common/mod.rs",
            "crates/x/src/info.rs",
        ] {
            assert_eq!(messages_of(path, "").len(), 1, "{path}");
        }
        assert_eq!(messages_of("crates/x/src/database.rs", ""), [""; 0]);
    }

    #[test]
    fn long_files_are_reported_and_very_long_ones_refused() {
        let lines = |count: usize| "fn f() {}\n".repeat(count);
        assert_eq!(messages_of("crates/x/src/a.rs", &lines(600)), [""; 0]);
        assert!(messages_of("crates/x/src/a.rs", &lines(601))[0].starts_with("note"));
        assert!(messages_of("crates/x/src/a.rs", &lines(1001))[0].starts_with("error"));
        assert_eq!(
            messages_of("crates/x/src/a/tests.rs", &lines(2000)),
            [""; 0]
        );
        assert_eq!(messages_of("crates/x/tests/a.rs", &lines(2000)), [""; 0]);
    }

    #[test]
    fn inline_tests_do_not_count() {
        let tests = format!(
            "#[cfg(test)]\nmod tests {{\n{}}}\n",
            "fn f() {}\n".repeat(900)
        );
        let source = format!("{}{tests}", "fn f() {}\n".repeat(590));
        assert_eq!(messages_of("crates/x/src/a.rs", &source), [""; 0]);
    }

    #[test]
    fn every_root_forbids_unsafe_code() {
        for path in [
            "crates/x/src/lib.rs",
            "crates/x/src/main.rs",
            "crates/x/src/bin/y.rs",
        ] {
            assert_eq!(
                messages_of(path, "// #![forbid(unsafe_code)]").len(),
                1,
                "{path}"
            );
            assert_eq!(
                messages_of(path, "#![forbid(unsafe_code)]"),
                [""; 0],
                "{path}"
            );
        }
        assert_eq!(
            messages_of("crates/estampe-simd/src/lib.rs", "#![deny(unsafe_code)]"),
            [""; 0]
        );
        assert_eq!(messages_of("crates/estampe-simd/src/lib.rs", "").len(), 1);
    }

    #[test]
    fn unsafe_code_stays_at_home() {
        let source = "fn f() { unsafe { g() } }";
        assert_eq!(
            messages_of("crates/estampe-core/src/tiles.rs", source).len(),
            1
        );
        assert_eq!(
            messages_of("crates/estampe-core/tests/a.rs", source).len(),
            1
        );
        assert_eq!(
            messages_of("crates/estampe-simd/src/lanes.rs", source).len(),
            1
        );
        assert_eq!(
            messages_of("crates/estampe-simd/src/gather.rs", source),
            [""; 0]
        );
        let harmless = "// unsafe\nfn f() { \"unsafe\"; unsafe_code }";
        assert_eq!(
            messages_of("crates/estampe-core/src/tiles.rs", harmless),
            [""; 0]
        );
    }
}
