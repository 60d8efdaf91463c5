//! Every `estampe` command of `docs/shader.md` works, and draws the picture of the page, byte for
//! byte.
//!
//! `UPDATE_PICTURES=1 cargo test -p estampe --test command shader_page` writes the pictures
//! anew: look at each that changed.

use crate::support::page;

/// Rows: G1, G2, G5.
#[test]
fn the_commands_of_the_page_draw_its_pictures() {
    let drawn = page::check_page("shader");
    assert_eq!(drawn.len(), 5, "{drawn:?}");
    assert_eq!(drawn, page::committed("shader"));
}
