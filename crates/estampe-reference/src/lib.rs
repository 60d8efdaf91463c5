#![forbid(unsafe_code)]
//! The oracle: a second implementation of the pipeline, scalar and unoptimised, against which the
//! core is tested.
//!
//! It follows `docs/NUMERICS.md` operation for operation, has its own code for every stage (its
//! only dependency is `estampe-types`: see *What the core and the oracle share*), and never
//! optimises: a vertex is shaded whenever a primitive names it, every sample of a triangle's box is
//! tested against three edges in exact integers, every fragment goes through every step. The core's
//! attachments must equal those of [`draw`], bit for bit.
//!
//! ```text
//! fetch ─▶ shading ─▶ assembly ─▶ clip ─▶ viewport ─▶ cull ─▶ setup ─▶ raster
//!                                                                 (triangle, line, point)
//!    raster ─▶ fragment ─▶ per_sample ─▶ target
//!                │
//!             texture
//! ```
//!
//! Each stage is a file and takes the type that the previous stage returns:
//!
//! | stage | takes | gives |
//! |---|---|---|
//! | [`fetch`] | buffers, vertex and instance index | attributes |
//! | [`shading`] | attributes | [`ClipVertex`]: clip space |
//! | [`assembly`] | a number of vertices | [`Primitive`](assembly::Primitive)s |
//! | [`clip`] | clip vertices | clip vertices whose 1/w is finite |
//! | [`viewport`] | clip vertices | [`WindowVertex`]: window space, snapped |
//! | [`cull`] | snapped positions | facing |
//! | [`setup`] | window vertices | planes of depth, 1/w and varyings |
//! | [`raster`] | snapped positions | quads of covered samples |
//! | [`fragment`] | planes at a quad | colours, depth |
//! | [`per_sample`] with [`stencil`], [`blending`], [`logic`] | a fragment | the [`Target`] |
//!
//! Beside them: [`texture`] and [`depth_map`] (sampling), [`color`], [`channel`], [`srgb`],
//! [`small_float`] and [`shared_exponent`] (encoding and decoding), [`compare`] (comparison
//! functions), [`tessellation`] and [`geometry_shader`] (the vertices that [`draw_vertices`]
//! draws; [`amplification`] joins the two), [`line`](mod@line), [`rectangle`] and [`point`] (the other primitives),
//! [`depth_bias`], [`conservative`] (conservative rasterization), [`bresenham`] (integer lines) and
//! [`scan_conversion`] (triangles) in the textbook forms, and [`exact`], the formulas in f64 with
//! bounds for the error of the f32 ones. [`transfer`] has what happens to images outside of draws:
//! copies, clears, mip levels and blits. [`illumination`] is the light on surfaces in f64, with
//! which the shaders of `estampe-renderer` are compared. [`program`] runs shaders, and [`observer`]
//! is told what happens to a primitive: `Device::inspect` of `estampe` stands on them.
//!
//! # What the core and the oracle share
//!
//! Both read states, formats and shaders through `estampe-types`. Its plain data (descriptors,
//! states and their enums) computes nothing. It also has the functions below; a fault in one of
//! them is the same on both sides, so comparing the core with the oracle cannot find it. A test
//! with numbers of the specifications, or with results in f64, guards each.
//!
//! | shared | guarded by |
//! |---|---|
//! | properties of texture formats: `encoding`, `components`, `block_bytes`, `block_size`, `is_srgb`, `is_bgra`, `is_renderable`, `is_blendable`, `sample_type`, `has_depth`, `has_stencil`, `is_compressed` | `tests/shared/formats.rs`: a table of every format |
//! | properties of vertex and index formats: `components`, `size_bytes`, `encoding`, `missing`, `restart` | `tests/shared/formats.rs`: a table of every format |
//! | the arithmetic of shaders: `Real` and `Int` of `f32` and `Quad`, derivatives included | `tests/shared/numbers.rs`, by hand; `all_kinds_agree` of `estampe-types` for the other lanes |
//! | `maths`: `exp2`, `log2`, `sin`, `exp`, `pow`, `powi` | `estampe-types/src/tests/mod.rs` and `tests/shared/numbers.rs`: error bounds against f64 |
//! | `Vec2`, `Vec3`, `Vec4`, `Mat4` | `tests/shared/vectors.rs`, by hand, the order of sums included |
//! | how attributes and varyings are split into scalars and assembled; `FragmentOut`, `VertexOut` | `tests/shared/layouts.rs`; `tests/drawing.rs` |
//! | the points that a tessellation or geometry shader reads: `Points`, `ShadedPoint` | `tests/shared/points.rs`, by hand |
//! | the interface of a shader: `interface_of` | `estampe-types/src/shader/dry_run/tests.rs` |
//! | `BufferData::words`, and how bytes become words; `Bindings` | `tests/shared/layouts.rs`, by hand |
//! | the layout of textures: `stored_format`, `words_per_texel`, `slices`; `StorageTexture::index` | `tests/shared/layouts.rs`, by hand |
//!
//! The oracle has its own comparison functions, stencil operations, sRGB tables, and decoding of
//! indices and attributes. The tests of both sides also share the decoded texels that
//! `estampe-texture` makes of an image (decoded blocks, mip levels); its own tests have the
//! specifications' numbers for those.

pub mod amplification;
pub mod arithmetic;
pub mod assembly;
pub mod blending;
pub mod bresenham;
pub mod channel;
pub mod clip;
pub mod color;
pub mod compare;
pub mod conservative;
pub mod cull;
pub mod depth_bias;
pub mod depth_map;
pub mod exact;
pub mod fetch;
pub mod fragment;
pub mod geometry_shader;
pub mod illumination;
pub mod line;
pub mod logic;
pub mod observer;
pub mod pbr;
pub mod per_sample;
mod pipeline;
pub mod point;
pub mod program;
pub mod raster;
pub mod rectangle;
pub mod scan_conversion;
pub mod setup;
pub mod shading;
pub mod shared_exponent;
pub mod small_float;
pub mod srgb;
pub mod stencil;
mod target;
pub mod tessellation;
pub mod texture;
pub mod transfer;
pub mod viewport;

pub use pipeline::{
    Counts, Draw, State, TargetState, draw, draw_observed, draw_vertices, draw_vertices_observed,
};
pub use shading::ClipVertex;
pub use target::{StoredSample, Target};
pub use texture::ReferenceTexture;
pub use viewport::{PixelBounds, WindowVertex};

#[cfg(test)]
mod tests;
