//! The book (`book/src`): its chapters, the check of what they show, and its pages in HTML.
//!
//! The folder has mdBook's form, so `mdbook build book` works where mdBook is installed. `cargo
//! xtask book` needs no other program: it checks the book and writes plain pages into
//! `target/book`.
//!
//! * [`chapters`]: the chapters in the order of the table of contents;
//! * [`check`]: the rules of a chapter, and the origin of each picture;
//! * [`pages`]: from Markdown to HTML.

mod chapters;
mod check;
mod pages;

pub use check::check_book;
pub use pages::{BookError, write_book};
