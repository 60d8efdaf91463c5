#![forbid(unsafe_code)]
//! Codecs of texels and vertices: between stored bits and the numbers that shaders see.
//!
//! Every rounding here is defined in `docs/NUMERICS.md`, *Formats*. Each family of encodings has a
//! module, in which the form for one value (`encode`) and the form for sixteen lanes
//! (`encode_lanes`) stand beside each other; both give the same bits, at every SIMD level.
//!
//! | module | encodings |
//! |---|---|
//! | [`normalized`] | unorm and snorm of 2 to 16 bits |
//! | [`srgb`] | 8-bit sRGB, by tables |
//! | [`half`] | 16-bit floats |
//! | [`small_float`] | unsigned floats of 11 and 10 bits |
//! | [`shared_exponent`] | three mantissas of 9 bits with one exponent |
//! | [`float32`] | 32-bit floats |
//! | [`integer`] | unsigned and signed integers of 2 to 32 bits |
//! | [`depth`] | fixed-point depth of 16 and 24 bits |
//!
//! [`box_filter`] averages texels of four 8-bit channels, for mip levels.
//!
//! Three modules assemble them: [`texel`] reads and writes one texel of any format that is not
//! compressed; [`attachment`] reads and writes sixteen texels of a renderable format, as
//! attachments store them; [`vertex`] reads attributes of vertices.

pub mod attachment;
pub mod box_filter;
pub mod depth;
pub mod float32;
pub mod half;
pub mod integer;
pub mod normalized;
pub mod shared_exponent;
pub mod small_float;
pub mod srgb;
pub mod texel;
pub mod vertex;

mod layout;

mod five_bit_exponent;

pub use attachment::{AttachmentCodec, PacketCodec};
pub use texel::TexelCodec;

#[cfg(test)]
mod tests;
