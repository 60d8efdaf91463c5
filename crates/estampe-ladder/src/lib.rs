#![forbid(unsafe_code)]
//! The ladder: programs that build the graphics pipeline rung by rung, after a university course.
//!
//! Each rung is one file in `examples`, with a function `draw` that returns its picture. The
//! examples and this library compile the same files, so `cargo run --example ladder_02_lines`,
//! `estampe ladder 2` and the tests draw the same picture.
//!
//! | item | contents |
//! |---|---|
//! | [`Course`] | the device, the model, the light and the camera that rungs share |
//! | [`Model`] | positions, normals, texture coordinates, faces, a texture |
//! | [`Picture`] | pixels; magnified, side by side, as a file |
//! | [`Screen`], [`Faces`], [`Corner`] | the attachments, the model's buffer, and its vertices in shaders |
//! | [`Lit`] | a shader for rungs whose subject is not shading |
//! | [`Polygon`] | a convex polygon that is filled and split, without the pipeline |
//! | [`RUNGS`], [`rung`] | the rungs, in order |
//! | [`Sheet`] | all pictures on one page |
//! | [`mistakes`] | pictures of the formulas in which the course is mistaken |
//! | [`run`] | the `main` of an example |
//!
//! The pictures of the rungs are in `docs/ladder.md`. Row L1 of `docs/PIPELINE.md` lists them.

// The rungs name this crate as the examples do.
extern crate self as estampe_ladder;

mod arguments;
mod course;
mod error;
mod lit;
pub mod mistakes;
mod model;
mod picture;
mod polygon;
mod program;
pub mod rungs;
mod screen;
mod sheet;

/// The README's snippet, compiled and run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

pub use course::Course;
pub use error::LadderError;
pub use lit::Lit;
pub use model::Model;
pub use picture::{Color, Picture};
pub use polygon::Polygon;
pub use program::run;
pub use rungs::{RUNGS, Rung, rung};
pub use screen::{Corner, Faces, Screen};
pub use sheet::Sheet;
