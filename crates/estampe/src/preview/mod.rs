//! `--preview`: the picture in the terminal.
//!
//! ```text
//! arguments -> terminal (environment, size: which kind of pictures it shows)
//!           -> scale (fewer pixels) -> blocks or sixel; kitty has the picture as PNG
//! ```
//!
//! The terminal is not asked: answers of a terminal that has none would be waited for, and would
//! end up in the input of a shell. The environment says what is known.

mod arguments;
mod base64;
mod blocks;
mod kitty;
mod scale;
mod sixel;
mod terminal;

pub(crate) use arguments::PreviewArgs;
