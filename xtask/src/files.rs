//! Files: names that say what is inside, lengths, folders of modules, comment widths, unsafe code.

use std::path::Path;

use crate::repository::TextFile;
use crate::rust_source::RustSource;
use crate::{Finding, Repository};

/// File and folder names that say nothing about their contents.
const VAGUE_NAMES: &[&str] = &[
    "util", "utils", "common", "helper", "helpers", "misc", "manager", "data", "info",
];

/// Beyond this many lines without tests, look for the second idea in a file.
const LONG_LINES: usize = 600;

/// Beyond this many, the file must be split.
const TOO_LONG_LINES: usize = 1000;

/// A crate's root is its documentation, its modules and its re-exports.
const LONG_ROOT_LINES: usize = 150;

/// Comments are as wide as rustfmt's code, except table rows and lines with a link.
const COMMENT_COLUMNS: usize = 100;

/// The crates with unsafe code: they `deny` it, and only these modules of theirs expect it.
const UNSAFE_CRATES: &[(&str, &[&str])] = &[
    (
        "crates/estampe-simd",
        &[
            "crates/estampe-simd/src/gather/fours.rs",
            "crates/estampe-simd/src/gather/lines.rs",
            "crates/estampe-simd/src/gather/mod.rs",
            "crates/estampe-simd/src/gather/pairs.rs",
            "crates/estampe-simd/src/gather/single.rs",
            "crates/estampe-simd/src/gather/squares.rs",
            // The system is asked for huge pages.
            "crates/estampe-simd/src/huge_pages.rs",
            // Stores past the caches have no safe form.
            "crates/estampe-simd/src/streaming.rs",
        ],
    ),
    // Machine code: the pages that hold it, and the calls into it and out of it.
    (
        "crates/estampe-x86",
        &[
            "crates/estampe-x86/src/enter.rs",
            "crates/estampe-x86/src/executable.rs",
        ],
    ),
];

/// Tests with unsafe code: an allocator that counts cannot be written without.
const UNSAFE_TESTS: &[&str] = &[
    "crates/estampe-gpu/tests/no_allocation.rs",
    "crates/estampe-assets/tests/readers/hostile/allocator.rs",
];

/// Checks names and lengths of files, widths of comments, and that unsafe code is where it may be.
#[must_use]
pub fn check_files(repository: &Repository) -> Vec<Finding> {
    let mut findings: Vec<Finding> = repository.rust_files().flat_map(check_file).collect();
    findings.extend(check_comment_widths(repository));
    findings
}

fn check_file(file: &TextFile) -> Vec<Finding> {
    let mut findings = Vec::from_iter(check_name(&file.path));
    match RustSource::parse(&file.text) {
        Ok(source) => {
            findings.extend(check_length(file, &source));
            findings.extend(check_unsafe(file, &source));
        }
        Err(cause) => {
            let line = cause.span().start().line;
            findings.push(Finding::error(&file.path, line, "this is not Rust"));
        }
    }
    findings
}

fn check_name(path: &Path) -> Option<Finding> {
    let stemmed = path.with_extension("");
    let name = stemmed
        .iter()
        .find(|part| VAGUE_NAMES.iter().any(|vague| part == vague))?;
    let message = format!("`{}` says nothing: name the thing", name.to_string_lossy());
    Some(Finding::error(path, 0, message))
}

fn check_length(file: &TextFile, source: &RustSource) -> Option<Finding> {
    if file.is_test() {
        return None;
    }
    // Inline tests are at the end of a file.
    let test_lines = source.last_line() - source.without_test_items().last_line();
    let lines = file.text.lines().count() - test_lines;
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

fn check_comment_widths(repository: &Repository) -> Vec<Finding> {
    let mut findings = Vec::new();
    for file in repository.rust_files() {
        for (index, line) in file.text.lines().enumerate() {
            if is_wide_comment(line) {
                let message = format!("a comment wider than {COMMENT_COLUMNS} columns");
                findings.push(Finding::error(&file.path, index + 1, message));
            }
        }
    }
    findings
}

fn is_wide_comment(line: &str) -> bool {
    let Some(comment) = line.trim_start().strip_prefix("//") else {
        return false;
    };
    let text = comment.trim_start_matches(['/', '!']).trim_start();
    let is_table = text.starts_with('|');
    let has_link = text.contains("](") || text.contains("]: ") || text.contains("://");
    line.chars().count() > COMMENT_COLUMNS && !is_table && !has_link
}

fn check_unsafe(file: &TextFile, source: &RustSource) -> Vec<Finding> {
    let exception = UNSAFE_CRATES
        .iter()
        .find(|(folder, _)| file.path.starts_with(folder));
    let mut findings = Vec::new();

    let level = if exception.is_some() {
        "deny"
    } else {
        "forbid"
    };
    if is_crate_root(&file.path) && !source.has_inner_attribute(level, "unsafe_code") {
        let message = format!("a crate's root must say `#![{level}(unsafe_code)]`");
        findings.push(Finding::error(&file.path, 1, message));
    }

    let is_this = |path: &&str| file.path == Path::new(path);
    let may_be_unsafe = exception.is_some_and(|(_, modules)| modules.iter().any(is_this))
        || UNSAFE_TESTS.iter().any(is_this);
    if !may_be_unsafe {
        let identifiers = source.identifiers();
        let found = identifiers.iter().filter(|found| found.name == "unsafe");
        findings.extend(found.map(|found| {
            let message =
                "unsafe code is only allowed in the modules that xtask/src/files.rs lists";
            Finding::error(&file.path, found.line, message)
        }));
    }
    findings
}

/// Returns true if the file is the root of a library or a program.
fn is_crate_root(path: &Path) -> bool {
    let is_program = path
        .parent()
        .is_some_and(|folder| folder.ends_with("src/bin"));
    path.ends_with("src/lib.rs") || path.ends_with("src/main.rs") || is_program
}

#[cfg(test)]
mod tests {
    use super::*;

    fn messages_of(path: &str, text: &str) -> Vec<String> {
        let findings = check_files(&Repository::synthetic(&[(path, text)]));
        let about_file = findings
            .iter()
            .filter(|finding| finding.path == Path::new(path));
        about_file.map(ToString::to_string).collect()
    }

    #[test]
    fn vague_names_are_refused() {
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
    fn unsafe_code_stays_in_its_modules() {
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
            messages_of("crates/estampe-simd/src/gather/mod.rs", source),
            [""; 0]
        );
        let harmless = "// unsafe\nfn f() { \"unsafe\"; unsafe_code }";
        assert_eq!(
            messages_of("crates/estampe-core/src/tiles.rs", harmless),
            [""; 0]
        );
    }

    #[test]
    fn what_is_not_rust_is_reported() {
        let found = messages_of("crates/x/src/a.rs", "fn f() {\n\"");
        assert!(found[0].contains("not Rust"), "{found:?}");
    }

    #[test]
    fn wide_comments_are_found() {
        let wide = "word ".repeat(20);
        for text in [
            format!("/// {wide}"),
            format!("    // {wide}"),
            format!("//! {wide}"),
        ] {
            assert!(is_wide_comment(&text), "{text}");
        }
        for text in [
            format!("/// | {wide} |"),
            format!("/// {wide} [a](b)"),
            format!("// {wide} https://example.org"),
            format!("let a = \"{wide}\";"),
            "/// short".to_owned(),
        ] {
            assert!(!is_wide_comment(&text), "{text}");
        }
        assert_eq!(
            messages_of("new/src/a.rs", &format!("fn f() {{}}\n// {wide}")).len(),
            1
        );
    }
}
