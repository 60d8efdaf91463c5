#![forbid(unsafe_code)]
//! The oracle: the pipeline once more, scalar and plain, written to be read and to be right.
//!
//! It follows `docs/NUMERICS.md` operation for operation, shares no code with the fast path
//! (it may depend on `estampe-types` alone), and never optimises: a vertex is shaded whenever a
//! primitive names it, every sample of a triangle's box is tested against three edges in exact
//! integers, every fragment goes through every step. What the fast path stores must equal what
//! [`draw`] stores, bit for bit.
//!
//! ```text
//! fetch ─▶ shading ─▶ assembly ─▶ clip ─▶ viewport ─▶ cull ─▶ setup ─▶ raster ─▶ fragment ─▶ per_sample ─▶ target
//!                                                            (triangle, line, point)      │
//!                                                                                      texture
//! ```
//!
//! Each stage is a file and takes the type that the one before gives:
//!
//! | stage | takes | gives |
//! |---|---|---|
//! | [`fetch`] | buffers, vertex and instance index | attributes |
//! | [`shading`] | attributes | [`ClipVertex`]: clip space |
//! | [`assembly`] | how many vertices | [`Primitive`](assembly::Primitive)s |
//! | [`clip`] | clip vertices | clip vertices whose 1/w is finite |
//! | [`viewport`] | clip vertices | [`WindowVertex`]: window space, snapped |
//! | [`cull`] | snapped positions | facing |
//! | [`setup`] | window vertices | planes of depth, 1/w and varyings |
//! | [`raster`] | snapped positions | quads of covered samples |
//! | [`fragment`] | planes at a quad | colours, depth |
//! | [`per_sample`] with [`stencil`], [`blending`], [`logic`] | a fragment | the [`Target`] |
//!
//! Beside them: [`texture`] and [`depth_map`] (sampling), [`color`], [`channel`] and [`small_float`] (codes and
//! numbers), [`line`](mod@line), [`rectangle`] and [`point`] (the other primitives), [`depth_bias`], [`conservative`]
//! (triangles by touched pixels), [`bresenham`] (integer lines) and [`scan_conversion`] (triangles) as the classics
//! have them,
//! and [`exact`], the same formulas in f64 with bounds for the error of the f32 ones.

pub mod arithmetic;
pub mod assembly;
pub mod blending;
pub mod bresenham;
pub mod channel;
pub mod clip;
pub mod color;
pub mod conservative;
pub mod cull;
pub mod depth_bias;
pub mod depth_map;
pub mod exact;
pub mod fetch;
pub mod fragment;
pub mod line;
pub mod logic;
pub mod per_sample;
mod pipeline;
pub mod point;
pub mod raster;
pub mod rectangle;
pub mod scan_conversion;
pub mod setup;
pub mod shading;
pub mod small_float;
pub mod stencil;
mod target;
pub mod texture;
pub mod viewport;

pub use pipeline::{Counts, Draw, State, TargetState, draw};
pub use shading::ClipVertex;
pub use target::Target;
pub use texture::ReferenceTexture;
pub use viewport::WindowVertex;

#[cfg(test)]
mod tests;
