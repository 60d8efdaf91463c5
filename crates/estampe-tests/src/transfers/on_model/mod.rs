//! A sequence on the oracle's plain textures.

mod operations;
mod passes;

pub use operations::{Model, Outcome};
pub use passes::case_of;
