//! Every `estampe` command of `docs/depth.md` works, and draws the picture of the page, byte for
//! byte. The other pictures of the page are tested in estampe-visibility.
//!
//! `UPDATE_PICTURES=1 cargo test -p estampe-cli --test depth_page` writes the pictures anew: look
//! at each that changed.

#[path = "support/page.rs"]
mod page;
#[path = "support/shell.rs"]
mod shell;
#[expect(dead_code, reason = "the commands of the page are whole lines")]
mod support;

/// Rows: D2.
#[test]
fn the_commands_of_the_page_draw_its_plots() {
    let drawn = page::check_page("depth");
    assert_eq!(drawn.len(), 5, "{drawn:?}");
}
