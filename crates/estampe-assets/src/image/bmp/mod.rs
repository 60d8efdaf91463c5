//! Windows and OS/2 bitmaps, read (Microsoft, *Windows GDI: Bitmap Storage*; IBM, *OS/2
//! Presentation Manager: bitmap file formats*).
//!
//! ```text
//!   byte  0  "BM"                            byte 14  length of the second header: 12, 16 to 124
//!         2  length of the file (not used)        18  width, height (16 bits each if it is 12)
//!        10  offset of the texels                 28  bits of a texel: 1, 4, 8, 16, 24, 32
//!                                                 30  compression    46  number of colours
//! ```
//!
//! Numbers are little-endian; texels are B, G, R. After the second header come the bit masks of
//! the channels, if compression is 3 or 6 and the header is too short for them, and the palette.
//! Rows end at multiples of four bytes, and run from the bottom to the top unless the height is
//! negative. Alpha exists only with a mask of its own: the fourth byte of other texels of 32 bits
//! is not used.

mod decode;
mod header;
mod runs;

pub(super) use decode::{decode, decode_reduced, stated_size};

/// The first bytes of every bitmap file.
pub(super) const SIGNATURE: &[u8] = b"BM";

#[cfg(test)]
mod tests;
