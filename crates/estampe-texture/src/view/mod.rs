//! Texture views: how a texture's dimension, mip levels and layers are reinterpreted, and how views
//! are sampled, gathered, compared and fetched.
//!
//! This code serves every dimension, format and function, and is compiled once for all shaders. If
//! a view and its sampler are of the common kind (2D, four 8-bit channels), [`SampledTexture`]
//! hands `sample` over to [`Rgba8Texture`](crate::Rgba8Texture).
//!
//! ```text
//!  coordinates ─▶ footprint ─▶ probes ─▶ levels ─▶ axis / cube ─▶ decode ─▶ mixture
//! ```
//!
//! A shader stores its lanes as a request of packets (`coordinates.rs`). Several implementations
//! sample it, each with the same arithmetic in the same order, so that the bits are the same:
//!
//! * `packet/inside.rs` is the common case of a packet: linear filtering, all lanes in the same mip
//!   level or between the same two, all texels inside. It needs no selection per lane.
//! * `packet/bytes.rs` samples packets of formats of bytes with linear filtering: the common case,
//!   and with `packet/each_level.rs` a mip level, a layer and four texels for each lane.
//! * `packet/filter.rs`, `packet/taps.rs` and `packet/block.rs` sample half floats for packets that
//!   are blocks of pixels, by rows of texels: filters whose taps stand at known shifts, taps at any
//!   coordinates, and one place.
//! * `packet/general.rs` is the general packet code, for other packets: every format except
//!   integers and stencil, every dimension, filter and comparison. It samples once for every mip
//!   level among the lanes.
//! * `sample.rs` is the scalar code, lane by lane: integers and stencil, fewer than sixteen lanes,
//!   the scalar SIMD level, and the lanes that the packet code leaves out (texels across a border
//!   or a cube's edge).
//!
//! Gathers have packet code for 2D views (`packet/gather.rs`), and fetches for most requests
//! (`packet_fetch.rs`, and `blocks.rs` for rows of neighbours); the others are lane by lane
//! (`gather.rs`, `fetch.rs`). What a pass reads of
//! another one at its own pixels alone, it loads where it is stored (`tiled_texels.rs`).

mod axis;
mod blocks;
mod compare;
mod coordinates;
mod cube;
mod fetch;
mod footprint;
mod gather;
mod packet;
mod packet_fetch;
mod packet_request;
pub(crate) mod packet_texel;
mod plane;
mod request_functions;
mod sample;
mod sampled_texture;
mod shader_functions;
mod tiled_texels;

pub(crate) use coordinates::{Answers, answer, by_sixteen, load, packed, packet, packet_of_ints};
pub use coordinates::{Coordinates, Lod, TextureCoordinates};
pub use packet::TapShifts;
pub use packet_request::{PacketLod, PacketPlace, PacketRequest, shifted};
pub use plane::TexelView;
pub use sampled_texture::SampledTexture;
pub use tiled_texels::{TiledTexels, TiledWords};
