//! Every `estampe` command of `docs/depth.md` works, and draws the picture of the page, byte for
//! byte. The other pictures of the page are tested in estampe-visibility.
//!
//! `UPDATE_PICTURES=1 cargo test -p estampe --test command depth_page` writes the pictures
//! anew: look at each that changed.

use crate::support::page;

/// Rows: D2.
#[test]
fn the_commands_of_the_page_draw_its_plots() {
    let drawn = page::check_page("depth");
    assert_eq!(drawn.len(), 5, "{drawn:?}");
}
