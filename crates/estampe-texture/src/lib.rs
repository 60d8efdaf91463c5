#![forbid(unsafe_code)]
//! Textures: creation, views, sampling and storage textures.
//!
//! * [`TexelDescriptor`] creates a [`TexelData`] of one, two or three dimensions, with layers, mip
//!   levels or samples, from the bytes of any [`TextureFormat`]; [`create_texture`] is the short
//!   form for four 8-bit channels. [`TextureError`] names the rule that was broken.
//! * [`TexelView`] is how a texture's dimension, mip levels and layers are reinterpreted; it
//!   gives their sizes and fetches texels.
//! * [`SampledTexture`] is a view with a sampler: it samples, gathers and compares at any
//!   [`Coordinates`] and [`Lod`].
//! * [`Rgba8Texture`] is a texture of the common kind with a sampler: 2D, four 8-bit channels,
//!   WebGPU's address modes.
//! * [`sample_compare_level`] and [`sample_compare_sum`] compare a depth attachment with a
//!   reference, without a copy; [`texture_from_depth`] copies it to a texture like others.
//! * [`TextureBindings`] finds the textures of a draw by group and binding number; a texture that
//!   is bound without a sampler is a [`BoundTexture`].
//! * [`StorageTexture`] is a texture that shaders load from and store to: [`storage_load`],
//!   [`storage_store`].
//!
//! Functions that read or write texels take one fragment (`f32`), a 2×2 quad
//! ([`Quad`](estampe_types::Quad)) or packets, and give the same bits for each.
//!
//! ```text
//!  bytes ─▶ upload (blocks) ─▶ generate ─▶ Texture          encode ◀─ StorageTexture
//!                                            │ decode
//!  coordinates ─▶ footprint ─▶ levels ─▶ axis, cube ─▶ texels ─▶ mixture     (view: everything)
//!  derivatives ─▶ lod ─▶ levels ─▶ wrap ─▶ filter ─▶ texel ─▶ mixture   (sampled: the common kind)
//! ```
//!
//! # Compiled once
//!
//! Shaders are generic over their numbers; the sampler is compiled once, in this crate.
//! `request.rs` is the boundary through which shaders call it: a shader stores its lanes as a
//! request and loads the answer, and both are packets of sixteen lanes, one cache line each.
//! Requests to views (`view/coordinates.rs`) have the same form. Only `compare.rs` and
//! [`Rgba8Texture::texel_fetch`] are generic, and compiled into each shader.
//!
//! A view that is not of the common kind has several implementations with the same bits:
//!
//! * `view/packet/inside.rs`, the common case of a packet: linear filtering, all lanes between the
//!   same two mip levels, all texels inside;
//! * `view/packet/bytes.rs` and `each_level.rs`, packets of formats of bytes with linear filtering,
//!   in any mip levels, layers and faces;
//! * `view/packet/general.rs`, the general packet code, which samples other packets;
//! * `view/sample.rs`, the scalar code, lane by lane, for everything else.
//!
//! # How a packet of the common kind is sampled
//!
//! Nearly always all sixteen lanes, 4×4 neighbouring pixels, need the same mip level. So a level is
//! sampled with its size and offset the same in every lane. Where a packet straddles levels, the
//! whole packet is sampled once for each of them, and each lane's result is selected. That is never
//! more than four times for a packet of quads, and spares sizes and offsets per lane. Only linear
//! filtering of repeated textures in two neighbouring levels selects a size per lane (`mixed.rs`).
//!
//! The level is guessed from the exponent of ρ² in the packet's first lane. The four texels of each
//! lane are then loaded ([`Int::gather_square`](estampe_types::Int::gather_square)) while λ is
//! still being computed; λ confirms or refutes the guess.
//!
//! At the scalar SIMD level ([`Real::EMULATED_LANES`](estampe_types::Real::EMULATED_LANES)), the
//! same code samples the lanes one after the other as `f32`: sixteen lanes at once took minutes to
//! compile.
//!
//! Unorm8 channels become floats without a conversion: a byte put into the mantissa of 2²³ is 2²³ +
//! c, and the difference of two of those is the exact c₁ − c₀ with which linear filtering begins.
//! The second and fourth byte stay in place, as 256·c, and the factor at the end, 1/255 divided by
//! 256, compensates for it. All of this is exact, so the bits are those of `docs/NUMERICS.md`.

mod alpha_map;
mod bindings;
mod blocks;
mod bound_texture;
mod byte_squares;
mod compare;
mod compare_shifted;
mod create;
mod descriptor;
mod error;
mod filter;
mod from_depth;
mod generate;
mod lod;
mod mips;
mod mixed;
pub mod region;
mod request;
mod request_batch;
mod rgba8_texture;
mod storage;
mod storage_packets;
mod texel;
mod unorm8;
mod upload;
mod view;
mod wrap;

pub use bindings::TextureBindings;
pub use blocks::{MAX_WORDS as MAX_BLOCK_WORDS, decode as decode_block};
pub use bound_texture::BoundTexture;
pub use compare::{compare_packets, sample_compare_level, sample_compare_sum};
pub use compare_shifted::compare_shifted;
pub use create::{MipGeneration, create_texture, create_texture_with_levels};
pub use descriptor::TexelDescriptor;
pub use error::TextureError;
pub use estampe_types::{
    AddressMode, BorderColor, FilterMode, Limits, MipLevel, SamplerDescriptor, ShadowMap,
    StorageTexture, TexelData, TexelViewDescriptor, TextureAspect, TextureDimension, TextureFormat,
    TextureShape, ViewDimension,
};
pub use from_depth::texture_from_depth;
pub use generate::{is_possible as can_generate, level as generate_level};
pub use request_batch::PacketPlaces;
pub use rgba8_texture::Rgba8Texture;
pub use storage::{
    create_storage_texture, is_storable, storage_bytes, storage_load, storage_store,
    storage_texture_to_texture,
};
pub use storage_packets::{load_packet, store_packet};
pub use unorm8::{store_unorm8, stored_unorm8_words};
pub use upload::LevelData;
pub use view::{
    Coordinates, Lod, PacketLod, PacketPlace, PacketRequest, SampledTexture, TapShifts, TexelView,
    TextureCoordinates, TiledTexels, TiledWords, shifted,
};
