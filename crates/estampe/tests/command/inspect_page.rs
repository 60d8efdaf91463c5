//! Every `estampe` command of `docs/inspect.md` works, and draws the picture of the page, byte for
//! byte.
//!
//! `UPDATE_PICTURES=1 cargo test -p estampe --test command inspect_page` writes the pictures
//! anew: look at each that changed.

use crate::support::page;

/// Rows: U2.
#[test]
fn the_commands_of_the_page_draw_every_stage() {
    let drawn = page::check_page("inspect");
    assert_eq!(drawn.len(), 8, "{drawn:?}");
    assert_eq!(drawn, page::committed("inspect"));
}
