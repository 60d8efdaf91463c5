#![forbid(unsafe_code)]
//! Readers and writers of models and images.
//!
//! - [`model`]: glTF, OBJ with its material libraries, STL, PLY, OFF and 3MF become an
//!   [`estampe_scene::Scene`]; OBJ, STL and PLY are also written.
//! - [`image`]: TGA, PNG, JPEG and WebP become an [`estampe_scene::Image`], and back; BMP, DDS and
//!   KTX2 are read; animations are written as GIF, APNG, WebP and Y4M.
//!
//! Every input is treated as hostile: a reader ends with a value or an [`AssetError`] with the
//! problem, its location and advice. It allocates no memory that the file's own size does not
//! justify, and [`Limits`] bound the rest. Tolerable errors are tolerated, with a located
//! [`Warning`].

mod error;
mod file;
pub mod image;
mod limits;
pub mod model;
mod warning;
mod zeros;

/// The README's snippet, compiled and run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

pub use error::{AssetError, Fault, Location};
pub use file::{read_bytes, read_stream};
pub use limits::Limits;
pub use model::{Loaded, ModelFormat, ModelInput, ModelOptions};
pub use model::{encode_model, load_model, load_model_with, parse_model, parse_model_with};
pub use warning::Warning;
