//! Fixed-point depth: stored as the f32 nearest to code ÷ (2ⁿ − 1), so that comparing numbers is
//! comparing codes.

use estampe_simd::{
    Bytes, Lanes, Select, SimdBase, SimdCvtTruncate, SimdFloat, f32x16, i32x16, outline, u32x16,
};
use estampe_types::{TexelEncoding, TextureFormat};

/// A depth format of 16 or 24 bits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FixedDepth {
    /// The greatest code: 65535 or 16777215.
    most: f32,
}

impl FixedDepth {
    /// The format's codec; `None` of float depth and of formats without depth.
    #[must_use]
    pub const fn new(format: TextureFormat) -> Option<Self> {
        match format.encoding() {
            TexelEncoding::Depth16 => Some(Self { most: 65_535.0 }),
            TexelEncoding::Depth24 => Some(Self { most: 16_777_215.0 }),
            _ => None,
        }
    }

    /// The number that stands for a depth in 0..=1: round_ties_even(depth·most) ÷ most.
    #[inline(always)]
    #[must_use]
    pub fn stored(self, depth: f32) -> f32 {
        (depth * self.most).round_ties_even() / self.most
    }

    /// [`stored`](Self::stored) of sixteen depths in 0..=1.
    #[inline(always)]
    #[must_use]
    pub fn stored_lanes<S: Lanes>(self, s: S, depth: f32x16<S>) -> f32x16<S> {
        outline!(s, self.rounded_lanes(s, depth) / self.most)
    }

    /// The [`code`](Self::code)s of sixteen depths in 0..=1.
    #[inline(always)]
    #[must_use]
    pub fn code_lanes<S: Lanes>(self, s: S, depth: f32x16<S>) -> u32x16<S> {
        outline!(s, {
            let code = i32x16::truncate_from(self.rounded_lanes(s, depth));
            code.bitcast()
        })
    }

    /// The codes of sixteen depths in 0..=1 as numbers: round_ties_even(depth·most). Of a stored
    /// depth this is its code.
    ///
    /// The product p is at most 2²⁴. Below 2²³ the sum p + 2²³ is between 2²³ and 2²⁴, where
    /// numbers are the integers: the addition rounds p to nearest, ties to even, and taking 2²³
    /// away is exact. From 2²³ on p is an integer as it is; the sum would be above 2²⁴, where odd
    /// integers are no numbers. −0 keeps its sign.
    #[inline(always)]
    #[must_use]
    pub fn rounded_lanes<S: Lanes>(self, s: S, depth: f32x16<S>) -> f32x16<S> {
        const INTEGERS: f32 = 8_388_608.0;
        let product = depth * self.most;
        let rounded = ((product + INTEGERS) - INTEGERS).copysign(product);
        let integers = <f32x16<S> as SimdBase<S>>::splat(s, INTEGERS);
        product.simd_lt(integers).select(rounded, product)
    }

    /// The greatest code: 65535 or 16777215.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "an integer of 24 bits")]
    pub const fn greatest_code(self) -> u32 {
        self.most as u32
    }

    /// The code of a depth in 0..=1.
    #[inline(always)]
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "an integer of 24 bits")]
    pub fn code(self, depth: f32) -> u32 {
        (depth * self.most).round_ties_even() as u32
    }

    /// The number of a code.
    #[inline(always)]
    #[must_use]
    pub fn decode(self, code: u32) -> f32 {
        code as f32 / self.most
    }
}
