//! The check must fail on documents that point nowhere, and only on those.

use super::*;

const OPENING: &str = "# estampe\n![teapot](docs/teapot.md)\n```sh\ncargo run a.obj\n```\n\
                       ```sh\ncargo test --workspace\n```\n";

/// The findings about `path` beside a few files that exist.
fn messages_of(path: &str, text: &str) -> Vec<String> {
    let files = [
        (path, text),
        ("docs/teapot.md", "# A teapot"),
        ("docs/README.md", ""),
        ("crates/x/src/lib.rs", ""),
    ];
    check_documents(&Repository::synthetic(&files))
        .iter()
        .map(ToString::to_string)
        .filter(|message| message.contains(path))
        .filter(|message| !message.contains("required") && !message.contains("links to it"))
        .collect()
}

#[test]
fn what_exists_passes() {
    let text = "[a](teapot.md) [b](../docs/teapot.md#a-teapot) [c](https://example.org/x) [d](#e)\n\
                # E\n`crates/x/src` `crates/*/src` `cargo run` ![f](teapot.md)";
    assert_eq!(messages_of("docs/a.md", text), [""; 0]);
    assert_eq!(messages_of("README.md", OPENING), [""; 0]);
}

#[test]
fn what_leads_nowhere_fails() {
    for text in [
        "[a](missing.md)",
        "![a](missing.png)",
        "<img src=\"missing.png\">",
        "[a](teapot.md#missing)",
        "[a](#missing)",
        "[a](../../outside.md)",
        "[a](/etc/passwd)",
        "`crates/x/src/missing.rs`",
        "[a][b]\n\n[b]: missing.md",
        "see MISSING.md, row 3",
    ] {
        assert_eq!(messages_of("docs/a.md", text).len(), 1, "{text}");
    }
}

#[test]
fn missing_documents_are_reported() {
    let found = check_documents(&Repository::synthetic(&[("README.md", OPENING)]));
    let missing = found
        .iter()
        .filter(|finding| finding.message.contains("required"));
    assert_eq!(missing.count(), REQUIRED.len() - 1);
}

#[test]
fn the_opening_of_the_readme_is_kept() {
    for (from, to) in [
        ("cargo run a.obj", "cargo run a.obj\ncargo run b.obj"),
        ("cargo run a.obj", ""),
        ("cargo test --workspace", "cargo test"),
        ("```sh\ncargo run", "```text\ncargo run"),
        ("![teapot](docs/teapot.md)", "teapot"),
    ] {
        let text = OPENING.replace(from, to);
        assert_eq!(messages_of("README.md", &text).len(), 1, "{from} -> {to}");
    }
    assert_eq!(messages_of("README.md", "![t](docs/teapot.md)").len(), 2);
}

#[test]
fn comments_name_documents_that_exist() {
    let comments = "//! See `docs/teapot.md`, teapot.md and [it](../../../docs/teapot.md).\n\
                    let text = \"MISSING.md\"; // no comment line\n";
    assert_eq!(messages_of("crates/x/src/a.rs", comments), [""; 0]);
    let found = messages_of("crates/x/src/a.rs", "\n/// Spec: MISSING.md row R2.");
    assert_eq!(
        found,
        ["error: crates/x/src/a.rs:2: there is no document `MISSING.md`"]
    );
}

#[test]
fn a_document_without_links_to_it_is_reported() {
    let readme = format!("{OPENING}[a](docs/a.md)");
    let reached = [
        ("docs/a.md", "[b](b.md#c)"),
        ("docs/b.md", "# C"),
        ("docs/teapot.md", ""),
    ];
    let files = [
        &[
            ("README.md", readme.as_str()),
            ("docs/alone.md", "[a](a.md)"),
        ],
        &reached[..],
    ];
    let found: Vec<PathBuf> = check_documents(&Repository::synthetic(&files.concat()))
        .into_iter()
        .filter(|finding| finding.message.contains("links to it"))
        .map(|finding| finding.path)
        .collect();
    assert_eq!(
        found,
        [
            PathBuf::from("docs/alone.md"),
            PathBuf::from("docs/teapot.md")
        ]
    );
}
