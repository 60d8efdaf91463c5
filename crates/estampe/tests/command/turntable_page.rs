//! Every `estampe` command of `docs/turntable.md` works, and draws the animation of the page, byte
//! for byte.
//!
//! `UPDATE_PICTURES=1 cargo test -p estampe --test command turntable_page` writes the pictures
//! anew: look at each that changed.

use crate::support::page;

#[test]
fn the_commands_of_the_page_draw_its_animations() {
    let drawn = page::check_page("turntable");
    let committed = page::committed("turntable");
    assert_eq!(drawn, committed, "each picture is drawn by a command");
    assert!(drawn.contains("teapot.gif"), "{drawn:?}");
}
