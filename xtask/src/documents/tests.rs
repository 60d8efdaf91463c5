//! The check must fail on documents that point nowhere, and only on those.

use super::*;

const OPENING: &str = "# estampe\n![teapot](docs/teapot.md)\n```sh\ncargo run a.obj\n```\n\
                       ```sh\ncargo test --workspace\n```\n";

/// The findings about `path` beside a few files that exist.
fn messages_of(path: &str, text: &str) -> Vec<String> {
    let files = [
        (path, text),
        ("docs/teapot.md", "# A teapot"),
        ("crates/x/src/lib.rs", ""),
    ];
    check_documents(&Repository::synthetic(&files))
        .iter()
        .map(ToString::to_string)
        .filter(|message| message.contains(path) && !message.contains("required"))
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
