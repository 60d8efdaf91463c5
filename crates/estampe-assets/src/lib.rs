#![forbid(unsafe_code)]
//! Bytes to scenes and pictures, and pictures to bytes.
//!
//! - [`model`]: OBJ with its material libraries, STL and PLY become an [`estampe_scene::Scene`].
//! - [`image`]: TGA, PNG and JPEG become an [`estampe_scene::Image`], and back.
//!
//! Every input is taken for hostile: a reader ends with a value or an [`AssetError`] that says what is
//! wrong, where and what to do; it takes no memory that the file's own size does not justify, and
//! [`Limits`] bound the rest. What can be tolerated is tolerated, with a located [`Warning`].

mod error;
mod file;
pub mod image;
mod limits;
pub mod model;
mod warning;

pub use error::{AssetError, Fault, Location};
pub use file::{read_bytes, read_stream};
pub use limits::Limits;
pub use model::{Loaded, ModelFormat, load_model, parse_model};
pub use warning::Warning;
