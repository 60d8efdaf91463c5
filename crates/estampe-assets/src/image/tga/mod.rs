//! Truevision TGA, read and written (Truevision, *TGA File Format Specification, Version 2.0*,
//! 1991).
//!
//! A file is a header of 18 bytes, an image ID, a colour map and the texels; a TGA 2 file ends in a
//! footer that may point to an extension area:
//!
//! ```text
//!   byte  0  length of the image ID          byte 8, 10  origin on the screen (not used)
//!         1  colour map: 0 none, 1 present        12, 14  width, height
//!         2  type (+8: run-length encoded)            16  bits of a texel
//!         3  first colour map entry                   17  descriptor:
//!         5  number of entries                              7 6 | 5 | 4 | 3 2 1 0
//!         7  bits of an entry                               row    |   |  alpha bits
//!                                                           order  |  columns run right to left
//!                                                              rows run top to bottom
//! ```
//!
//! Numbers are little-endian; texels are B, G, R, A. Types: 1 mapped, 2 true colour, 3 grey; 9, 10
//! and 11 are these three, run-length encoded. `AlphaUse` is the one place that decides about
//! alpha.

mod decode;
mod encode;
mod footer;
mod header;
mod packets;
mod texel;

pub use decode::decode;
pub(super) use decode::{decode_reduced, looks_like_tga, stated_size};
pub use encode::{TgaOptions, encode};

#[cfg(test)]
#[expect(
    clippy::cast_possible_truncation,
    reason = "fixtures cut numbers to size"
)]
mod tests;
