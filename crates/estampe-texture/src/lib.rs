#![forbid(unsafe_code)]
#![allow(
    clippy::self_named_module_files,
    reason = "folders that are being rewritten get their `mod.rs` then"
)]
//! Textures: making them, reading them at coordinates, storing to them.
//!
//! * [`TextureDescriptor`]: bytes of any [`TextureFormat`] become a [`Texture`] of one, two or three dimensions, with
//!   layers, levels or samples; [`create_texture`] is the short way for four 8-bit channels. [`TextureError`] names
//!   the rule that was broken;
//! * [`TextureView`]: as what and how much of it is read; its sizes, and fetching texels;
//! * [`SampledView`]: a view with a sampler: sampling, gathering, comparing, at any [`Coordinates`] and [`Lod`];
//! * [`Sampled`]: the common kind by itself: 2D, four 8-bit channels, WebGPU's address modes;
//! * [`sample_compare_level`], [`sample_compare_sum`]: a depth attachment, as it lies, compared with a reference
//!   ([`texture_from_depth`] makes it a texture like others);
//! * [`StorageTexture`], which shaders store to: [`storage_load`], [`storage_store`].
//!
//! All of it is one text for one fragment (`f32`), a 2×2 quad ([`Quad`](estampe_types::Quad)) and packets, with the
//! same bits.
//!
//! ```text
//!  bytes ─▶ upload (blocks) ─▶ generate ─▶ Texture          encode ◀─ StorageTexture
//!                                            │ decode
//!  coordinates ─▶ footprint ─▶ levels ─▶ axis, cube ─▶ texels ─▶ mixture        (view: everything)
//!  derivatives ─▶ lod ─▶ levels and their mixture ─▶ wrap ─▶ filter ─▶ texel    (sampled: the common kind)
//! ```
//!
//! # How a packet of the common kind is sampled
//!
//! Nearly always all sixteen lanes want the same mip level: 4×4 neighbouring pixels. So a level is
//! sampled with its size and place the same in every lane, and where a packet does straddle levels,
//! the whole is done once for each of them and the lanes are picked together. That is never more
//! than four times for a packet of quads, and spares sizes and offsets per lane.
//!
//! The level is guessed from the exponent of ρ² in the packet's first lane, so the four texels of each lane
//! are on their way ([`Int::gather_square`](estampe_types::Int::gather_square)) while λ is still being
//! computed; λ then says whether the guess was right.
//!
//! At the scalar level ([`Real::EMULATED_LANES`](estampe_types::Real::EMULATED_LANES)), the lanes are sampled one after the
//! other by the same text on `f32`: sixteen lanes at once took minutes to compile.
//!
//! Unorm8 channels become numbers without a conversion: a byte put into the mantissa of 2²³ is
//! 2²³ + c, and the difference of two of those is the exact c₁ − c₀ that linear filtering begins
//! with. The second and fourth byte stay where they are, as 256·c, and the factor 1/255 at the end
//! makes up for it. All of this is exact, so the bits are those of `docs/NUMERICS.md`.

mod blocks;
mod compare;
mod create;
mod descriptor;
mod error;
mod filter;
mod from_depth;
mod generate;
mod lod;
mod mips;
mod mixed;
mod request;
mod sampled;
mod storage;
mod texel;
mod upload;
mod view;
mod wrap;

pub use compare::{sample_compare_level, sample_compare_sum};
pub use create::{MipGeneration, create_texture, create_texture_with_levels};
pub use descriptor::TextureDescriptor;
pub use error::TextureError;
pub use estampe_types::{
    AddressMode, BorderColor, DepthTexture, FilterMode, Limits, MipLevel, SamplerDescriptor,
    StorageTexture, Texture, TextureAspect, TextureDimension, TextureFormat, TextureShape,
    TextureViewDescriptor, ViewDimension,
};
pub use from_depth::texture_from_depth;
pub use sampled::Sampled;
pub use storage::{
    create_storage_texture, storage_bytes, storage_load, storage_store, storage_texture_to_texture,
};
pub use upload::LevelData;
pub use view::{Coordinates, Lod, SampledView, TextureView};

#[cfg(test)]
mod tests;
