//! Every command of `docs/shapes.md` works, and draws the picture of the page, byte for byte.
//!
//! `UPDATE_PICTURES=1 cargo test -p estampe --test command shapes_page` writes the pictures
//! anew: look at each that changed.

use crate::support::page;

/// Rows: M3, M4, M5.
#[test]
fn the_commands_of_the_page_draw_its_pictures() {
    let drawn = page::check_page("shapes");
    assert_eq!(
        drawn,
        page::committed("shapes"),
        "each picture is drawn by a command of the page"
    );
    assert!(drawn.len() > 10, "{drawn:?}");
}
