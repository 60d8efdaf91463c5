//! Views: any texture as shaders see it, and what can be read without a sampler.
//!
//! Everything here is the general path: every dimension, format and function, scalar, lane by lane, compiled once
//! for all shaders. Where a view and its sampler are of the common kind ([`Sampled`](crate::Sampled)'s: 2D, four
//! 8-bit channels), [`SampledView`] hands over to it.
//!
//! ```text
//!  coordinates ─▶ footprint ─▶ probes ─▶ levels ─▶ axis / cube ─▶ decode ─▶ mixture
//! ```

mod axis;
mod compare;
mod coordinates;
mod cube;
mod fetch;
mod footprint;
mod gather;
mod packet;
mod packet_texel;
mod plane;
mod sample;
mod sampled_view;

pub(crate) use coordinates::{Answers, answer, by_sixteen, load, packed, packet, packet_of_ints};
pub use coordinates::{Coordinates, Lod};
pub use plane::TextureView;
#[cfg(test)]
pub(crate) use sample::border_unit;
pub use sampled_view::SampledView;
