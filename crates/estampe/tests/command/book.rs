//! Every command of the book (`book/src`) works, and draws the pictures of its chapter, byte for
//! byte.
//!
//! `UPDATE_PICTURES=1 cargo test -p estampe --test command book` writes the pictures anew: look
//! at each that changed.

use crate::support::Folder;
use crate::support::shell::run;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The largest picture of the book, in bytes.
const MAX_PICTURE: usize = 40_000;

fn sources() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../book/src")
}

/// The chapters: name and text.
fn chapters() -> Vec<(String, String)> {
    let entries = std::fs::read_dir(sources()).expect("the book is there");
    let names = entries.map(|entry| entry.expect("readable").file_name());
    let mut names: Vec<String> = names
        .map(|name| name.to_string_lossy().into_owned())
        .filter(|name| name.ends_with(".md"))
        .collect();
    names.sort();
    let read = |name: String| {
        let text = std::fs::read_to_string(sources().join(&name)).expect("readable");
        (name, text)
    };
    names.into_iter().map(read).collect()
}

/// The lines of a chapter's `sh` blocks, and the commands in its text: code spans that begin with
/// `estampe ` and say where the result goes.
fn commands(text: &str) -> Vec<&str> {
    let mut is_inside = false;
    let mut commands = Vec::new();
    for line in text.lines() {
        if line.starts_with("```") {
            is_inside = line == "```sh";
        } else if is_inside {
            commands.extend((!line.is_empty()).then_some(line));
        } else {
            let spans = line.split('`').skip(1).step_by(2);
            // Words in capitals are placeholders.
            let is_whole = |span: &&str| {
                span.starts_with("estampe ") && span.contains(" -o ") && !span.contains("NUMBER")
            };
            commands.extend(spans.filter(is_whole));
        }
    }
    commands
}

/// The names of the pictures that a chapter shows from the book's own folder.
fn shown(text: &str) -> BTreeSet<&str> {
    let after = text.split("](images/").skip(1);
    after.filter_map(|rest| rest.split(')').next()).collect()
}

#[test]
fn the_commands_of_the_book_draw_its_pictures() {
    let is_update = std::env::var_os("UPDATE_PICTURES").is_some();
    let pictures = sources().join("images");
    let mut kept = BTreeSet::new();
    let mut count = 0;
    for (chapter, text) in chapters() {
        let folder = Folder::new();
        for line in commands(&text) {
            let done = run(line, &folder);
            assert_eq!(done.code, 0, "{chapter}: {line}: {}", done.err);
            count += 1;
        }
        for name in shown(&text) {
            let bytes = std::fs::read(folder.path(name));
            let bytes = bytes.unwrap_or_else(|_| panic!("{chapter}: no command draws {name}"));
            let len = bytes.len();
            assert!(len <= MAX_PICTURE, "{chapter}: {name} has {len} bytes");
            let committed = pictures.join(name);
            if is_update {
                std::fs::write(&committed, &bytes).expect("the folder of pictures is writable");
            }
            let expected = std::fs::read(&committed);
            assert!(
                expected.is_ok_and(|expected| expected == bytes),
                "{chapter}: {name} is not the picture of the book; UPDATE_PICTURES=1 writes it anew"
            );
            assert!(kept.insert(name.to_owned()), "{name} is in two chapters");
        }
    }
    assert!(count > 20, "{count} commands");
    let committed = std::fs::read_dir(&pictures).expect("the folder of pictures");
    let committed = committed.map(|entry| entry.expect("readable").file_name());
    let committed: BTreeSet<String> = committed
        .map(|name| name.to_string_lossy().into_owned())
        .collect();
    assert_eq!(kept, committed, "each picture is shown by a chapter");
}

/// The chapter of options has every pair of pictures of `docs/render.md`, which has one for each
/// option.
#[test]
fn every_pair_of_the_page_of_options_is_in_the_book() {
    let page = sources().join("../../docs/render.md");
    let page = std::fs::read_to_string(page).expect("the page is there");
    let text = std::fs::read_to_string(sources().join("options.md")).expect("the chapter is there");
    let rows: Vec<&str> = page
        .lines()
        .filter(|line| line.starts_with("| `--"))
        .collect();
    assert!(rows.len() > 30, "{} rows", rows.len());
    for row in rows {
        let option = row.split('`').nth(1).expect("a code span");
        let line = text
            .lines()
            .find(|line| line.starts_with(&format!("| `{option}`")));
        let line = line.unwrap_or_else(|| panic!("options.md has no row for {option}"));
        for picture in row.split("](images/").skip(1) {
            let name = picture.split(')').next().unwrap_or_default();
            let link = format!("](../../docs/images/{name})");
            assert!(line.contains(&link), "{option}: {name} is not shown");
        }
    }
}
