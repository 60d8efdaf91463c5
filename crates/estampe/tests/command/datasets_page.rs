//! Every `estampe` command of `docs/datasets.md` works, and draws the picture of the page, byte for
//! byte.
//!
//! `UPDATE_PICTURES=1 cargo test -p estampe --test command datasets_page` writes the pictures anew:
//! look at each that changed.

use crate::support::page;

#[test]
fn the_commands_of_the_page_draw_its_pictures() {
    let drawn = page::check_page("datasets");
    let committed = page::committed("datasets");
    assert_eq!(drawn, committed, "each picture is drawn by a command");
    assert!(drawn.contains("left-depth.png"), "{drawn:?}");
}
