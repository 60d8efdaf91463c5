//! Every command of `docs/shapes.md` works, and draws the picture of the page, byte for byte.
//!
//! `UPDATE_PICTURES=1 cargo test -p estampe-cli --test shapes_page` writes the pictures anew: look
//! at each that changed.

#[path = "support/page.rs"]
mod page;
#[path = "support/shell.rs"]
mod shell;
#[expect(dead_code, reason = "the commands of the page have quoted words")]
mod support;

use page::check_page;

/// Rows: M3, M4, M5.
#[test]
fn the_commands_of_the_page_draw_its_pictures() {
    assert!(check_page("shapes") > 10);
}
