//! Every command of `docs/render.md` works, and draws the picture of the page, byte for byte; every
//! option that changes a picture has a pair of them.
//!
//! `UPDATE_PICTURES=1 cargo test -p estampe --test command render_page` writes the pictures
//! anew: look at each that changed.

use crate::support::{Folder, Run};
use crate::support::{page, shell};
use std::path::Path;

/// Rows: D6, F3, I3.
#[test]
fn the_commands_of_the_page_draw_its_pictures() {
    let drawn = page::check_page("render");
    assert_eq!(
        drawn,
        page::committed("render"),
        "each picture is drawn by a command of the page"
    );
    assert!(drawn.len() > 40, "{drawn:?}");
}

/// Options that change no picture, or its file alone.
const WITHOUT_PICTURES: [&str; 22] = [
    "--cameras",
    "--preview",
    "--output",
    "--format",
    "--output-format",
    "--max-triangles",
    "--max-pixels",
    "--max-texture-size",
    "--max-bytes",
    "--max-memory",
    "--timeout",
    "--threads",
    "--simd",
    "--via",
    "--quiet",
    "--json",
    "--strict",
    "--preset",
    "--config",
    "--no-config",
    "--watch",
    "--help",
];

#[test]
fn every_option_is_on_the_page() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs");
    let page = std::fs::read_to_string(docs.join("render.md")).expect("the page is there");
    let help: Run = shell::run("estampe render --help", &Folder::new());
    let help = String::from_utf8(help.out).expect("UTF-8");
    let options = help.lines().filter_map(|line| {
        let words = line.trim_start().split([' ', ',', '[']);
        let mut long = words.filter(|word| word.starts_with("--"));
        line.trim_start().starts_with('-').then(|| long.next())?
    });
    let mut count = 0;
    for option in options {
        count += 1;
        let is_row = page.contains(&format!("| `{option}"));
        let is_shown = is_row || WITHOUT_PICTURES.contains(&option);
        assert!(is_shown, "{option} has no row with a pair of pictures");
    }
    assert!(count > 25, "{count} options: {help}");
}
