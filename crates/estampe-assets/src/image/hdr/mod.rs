//! Radiance HDR (`.hdr`, `.pic`): linear colours with a shared exponent (G. Ward, "Real Pixels",
//! Graphics Gems II, 1991; Radiance's `ra_xyze` and `color.c` describe the file).
//!
//! ```text
//!   #?RADIANCE ⏎ NAME=VALUE ⏎ … ⏎ ⏎ -Y height +X width ⏎ rows
//!
//!   row     2 2 width(16 bits)  then red, green, blue, exponent, each in runs      since 1991
//!           or texels, where 1 1 1 n repeats the one before n times                before
//!   texel   colour = mantissa · 2^(exponent − 136)
//! ```

mod decode;
mod encode;
mod header;

#[cfg(test)]
mod tests;

pub use decode::decode_hdr;
pub use encode::encode_hdr;

/// True if the bytes begin as such a file.
#[must_use]
pub fn is_hdr(bytes: &[u8]) -> bool {
    bytes.starts_with(b"#?")
}

/// The difference of an exponent's code and the exponent of the mantissa's last bit.
const BIAS: i32 = 136;

/// The widths whose rows may be in runs by component.
const RUN_WIDTHS: std::ops::RangeInclusive<u32> = 8..=0x7fff;
