//! Every command of `docs/shapes.md` works, and draws the picture of the page, byte for byte.
//!
//! `UPDATE_PICTURES=1 cargo test -p estampe-cli --test shapes_page` writes the pictures anew: look
//! at each that changed.

#[path = "support/shell.rs"]
mod shell;
#[expect(dead_code, reason = "the commands of the page have quoted words")]
mod support;

use shell::run;
use std::collections::BTreeSet;
use std::path::Path;
use support::Folder;

/// The largest picture of the page, in bytes.
const MAX_PICTURE: usize = 40_000;

/// The lines of the page's `sh` blocks.
fn commands(page: &str) -> Vec<&str> {
    let mut is_inside = false;
    let mut commands = Vec::new();
    for line in page.lines() {
        if line.starts_with("```") {
            is_inside = line == "```sh";
        } else if is_inside {
            commands.push(line);
        }
    }
    commands
}

/// Rows: M3, M4, M5.
#[test]
fn the_commands_of_the_page_draw_its_pictures() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    let page = std::fs::read_to_string(docs.join("shapes.md")).expect("the page is there");
    let pictures = docs.join("images/shapes");
    let is_update = std::env::var_os("UPDATE_PICTURES").is_some();
    let folder = Folder::new();
    for line in commands(&page) {
        let done = run(line, &folder);
        assert_eq!(done.code, 0, "{line}: {}", done.err);
    }

    let mut drawn = BTreeSet::new();
    for name in folder
        .names()
        .into_iter()
        .filter(|name| name.ends_with(".png"))
    {
        let bytes = std::fs::read(folder.path(&name)).expect("written");
        assert!(
            bytes.len() <= MAX_PICTURE,
            "{name} has {} bytes",
            bytes.len()
        );
        let committed = pictures.join(&name);
        if is_update {
            std::fs::write(&committed, &bytes).expect("the folder of pictures is writable");
        }
        let expected = std::fs::read(&committed);
        assert!(
            expected.is_ok_and(|expected| expected == bytes),
            "{name} is not the page's picture; UPDATE_PICTURES=1 writes it anew"
        );
        assert!(
            page.contains(&format!("](images/shapes/{name})")),
            "{name} is not shown"
        );
        drawn.insert(name);
    }
    let committed = std::fs::read_dir(&pictures).expect("the folder of pictures");
    let committed: BTreeSet<String> = committed
        .map(|entry| {
            entry
                .expect("readable")
                .file_name()
                .to_string_lossy()
                .into_owned()
        })
        .collect();
    assert_eq!(
        drawn, committed,
        "each picture is drawn by a command of the page"
    );
    assert!(drawn.len() > 10, "{drawn:?}");
}
