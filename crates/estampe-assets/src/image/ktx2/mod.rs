//! KTX 2.0 textures, read: a mip level of a 2D texture (Khronos Group, *KTX File Format
//! Specification, version 2.0*).
//!
//! ```text
//!   byte  0  "«KTX 20»\r\n\x1a\n"             byte 48  data format descriptor: offset, length
//!        12  vkFormat                             56  keys and values: offset, length
//!        20  width, height, depth                 64  global data of the supercompression
//!        32  layers, faces, levels                80  of each level, the largest first: offset,
//!        44  supercompression scheme                  length, length without supercompression
//! ```
//!
//! Numbers are little-endian, of 32 bits up to byte 64 and of 64 bits after it. Blocks are decoded
//! by estampe-texture, Zstandard by `ruzstd`, zlib by `flate2`.
//!
//! Textures of one channel become grey, and those of two become normal maps, as in DDS: the third
//! channel is the rest of a unit vector. Half floats (BC6H) are linear light, cut off at 1.

mod decode;
mod format;
mod header;
mod inflate;

pub(super) use decode::{decode, decode_reduced, stated_size};
pub(crate) use header::BasisUniversal;

/// The first bytes of every file.
pub(super) const SIGNATURE: &[u8] = b"\xabKTX 20\xbb\r\n\x1a\n";

#[cfg(test)]
#[expect(
    clippy::cast_possible_truncation,
    reason = "fixtures cut numbers to size"
)]
mod tests;
