//! Morton order (Z-order): the bits of x and y interleaved, so that squares of 2ⁿ×2ⁿ pixels lie
//! together in memory.
//!
//! Bit i of x is bit 2i of the index, bit i of y is bit 2i + 1: the index of (x, y) is `spread(x) |
//! spread(y) << 1`. Each step doubles the gaps between groups of bits (Warren, Hacker's Delight
//! 2012, §7-2).
//!
//! ```
//! use estampe_types::morton::{compact, spread, spread_lanes};
//!
//! let index = spread(5) | spread(3) << 1;
//! assert_eq!(index, 0b01_10_11);
//! assert_eq!((compact(index), compact(index >> 1)), (5, 3));
//! assert_eq!(spread_lanes(5), 0b01_00_01);
//! ```

use crate::Int;

/// Moves bit i to bit 2i, for the lowest six bits of `v`; the others are ignored.
#[inline(always)]
#[must_use]
pub const fn spread(v: u32) -> u32 {
    let v = v & 0x3F;
    let v = (v | (v << 4)) & 0x30F;
    let v = (v | (v << 2)) & 0x333;
    (v | (v << 1)) & 0x555
}

/// [`spread`] of every lane.
#[inline(always)]
#[must_use]
pub fn spread_lanes<I: Int>(v: I) -> I {
    let v = v & v.splat(0x3F);
    let v = (v | (v << 4)) & v.splat(0x30F);
    let v = (v | (v << 2)) & v.splat(0x333);
    (v | (v << 1)) & v.splat(0x555)
}

/// Moves bit 2i to bit i, for the lowest twelve bits of `v`; the others are ignored. The inverse of
/// [`spread`].
#[inline(always)]
#[must_use]
pub const fn compact(v: u32) -> u32 {
    let v = v & 0x555;
    let v = (v | (v >> 1)) & 0x333;
    let v = (v | (v >> 2)) & 0x30F;
    (v | (v >> 4)) & 0x3F
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_moved_to_even_places_and_back() {
        for v in 0..64 {
            let expected = (0..6).fold(0, |bits, i| bits | (v >> i & 1) << (2 * i));
            assert_eq!(spread(v), expected, "{v}");
            assert_eq!(spread(v | 0xFFFF_FFC0), expected, "{v}");
            assert_eq!(spread_lanes(v.cast_signed()), expected.cast_signed());
            assert_eq!(compact(expected), v);
            assert_eq!(compact(expected | 0xFFFF_FAAA), v);
        }
    }
}
