//! DirectDraw Surfaces, read: a mip level of a 2D texture (Microsoft, *Programming Guide
//! for DDS*).
//!
//! ```text
//!   byte  0  "DDS "                      byte 80  flags: 1 alpha, 4 a code, 0x40 colours,
//!        12  height, width                             0x20000 luminance
//!        28  number of mip levels, if
//!            byte 8 has flag 0x20000
//!       108  capabilities                    84  code: DXT1 …, or DX10: a second header follows
//!       112  cube map, volume                88  bits of a texel, masks of R, G, B, A
//! ```
//!
//! Numbers are little-endian. The header has 128 bytes, the second one 20: a DXGI format, the
//! dimension, flags, the number of layers.
//!
//! Textures of one channel (BC4) become grey, and those of two (BC5) become normal maps: the third
//! channel is the rest of a unit vector.

mod blocks;
mod decode;
mod header;

pub(super) use decode::{decode, decode_reduced, stated_size};

/// The first bytes of every file.
pub(super) const SIGNATURE: &[u8] = b"DDS ";

#[cfg(test)]
mod tests;
