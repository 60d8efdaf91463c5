//! The numbers that shaders compute with.

use estampe_simd::Level;
use std::fmt::Debug;
use std::ops::{
    Add, AddAssign, BitAnd, BitOr, BitXor, Div, DivAssign, Mul, MulAssign, Neg, Not, Shl, Shr, Sub,
    SubAssign,
};

/// Real numbers in f32 arithmetic: one (`f32`), the four of a 2×2 quad ([`Quad`](crate::Quad)), the
/// sixteen of a packet (`f32x16<S>`), or the thirty-two of a packet pair ([`Pair`](crate::Pair)).
///
/// Each operation acts on every lane alone and gives the same bits for every implementation.
/// Constants are made from an existing number, because sixteen lanes need the token of their SIMD
/// level: `x.splat(0.5)`, or an `f32` on the right of an operator: `x * 0.5 + 1.0`.
pub trait Real:
    Copy
    + Debug
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f32, Output = Self>
    + Sub<f32, Output = Self>
    + Mul<f32, Output = Self>
    + Div<f32, Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + DivAssign
{
    /// A boolean in each lane.
    type Mask: Copy
        + Debug
        + BitAnd<Output = Self::Mask>
        + BitOr<Output = Self::Mask>
        + Not<Output = Self::Mask>;
    /// A 32-bit integer for each lane.
    type Int: Int<Real = Self, Mask = Self::Mask>;

    /// The number of lanes: 1, 4, 16 or 32.
    const LANES: usize;
    /// True if several lanes are emulated by scalar instructions. Long code with many table
    /// look-ups should then loop over the lanes with `f32` numbers.
    const EMULATED_LANES: bool;

    /// `value` in every lane.
    #[must_use]
    fn splat(self, value: f32) -> Self;
    /// `value` in every lane, as integers.
    #[must_use]
    fn splat_int(self, value: i32) -> Self::Int;
    /// `value` in every lane of a mask.
    #[must_use]
    fn splat_mask(self, value: bool) -> Self::Mask;

    /// Square root, correctly rounded.
    #[must_use]
    fn sqrt(self) -> Self;
    /// Absolute value.
    #[must_use]
    fn abs(self) -> Self;
    /// The greatest integer that is not above `self`.
    #[must_use]
    fn floor(self) -> Self;
    /// `self < other ? self : other`: `other` where either is NaN.
    #[must_use]
    fn min(self, other: Self) -> Self;
    /// `self > other ? self : other`: `other` where either is NaN.
    #[must_use]
    fn max(self, other: Self) -> Self;

    /// True in the lanes where `self < other`.
    fn lt(self, other: Self) -> Self::Mask;
    /// True in the lanes where `self <= other`.
    fn le(self, other: Self) -> Self::Mask;
    /// True in the lanes where `self == other`.
    fn eq(self, other: Self) -> Self::Mask;
    /// True in the lanes where `self > other`.
    #[inline(always)]
    fn gt(self, other: Self) -> Self::Mask {
        other.lt(self)
    }
    /// True in the lanes where `self >= other`.
    #[inline(always)]
    fn ge(self, other: Self) -> Self::Mask {
        other.le(self)
    }

    /// `yes` in the lanes of the mask, `no` in the others.
    #[must_use]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// True if the mask is true in any lane.
    fn any(mask: Self::Mask) -> bool;
    /// The mask as bits: lane `i` is bit `i`.
    fn mask_bits(mask: Self::Mask) -> u32;

    /// Rounds towards zero. NaN gives 0; values out of range give the least or the greatest
    /// integer.
    fn to_int(self) -> Self::Int;
    /// Rounds numbers within ±2³⁰ towards zero. The result for any other number is unspecified and
    /// may differ between SIMD levels. This is one instruction where [`Real::to_int`] takes
    /// several.
    fn to_int_within_range(self) -> Self::Int;
    /// The bits of each lane as an integer.
    fn to_bits(self) -> Self::Int;

    /// Fine partial derivative in x: right minus left neighbour in the lane's row of its 2×2 quad.
    /// 0 for a single fragment (`f32`), which has no neighbours.
    #[must_use]
    fn ddx(self) -> Self;
    /// Fine partial derivative in y: lower minus upper neighbour in the lane's column of its quad.
    /// 0 for a single fragment (`f32`), which has no neighbours.
    #[must_use]
    fn ddy(self) -> Self;

    /// Coarse partial derivative in x: that of the quad's first row, in all four lanes. 0 for a
    /// single fragment (`f32`), which has no neighbours.
    #[must_use]
    fn ddx_coarse(self) -> Self;
    /// Coarse partial derivative in y: that of the quad's first column, in all four lanes. 0 for a
    /// single fragment (`f32`), which has no neighbours.
    #[must_use]
    fn ddy_coarse(self) -> Self;

    /// Broadcasts one fragment of each 2×2 quad to all four lanes: 0 is top left, 1 top right, 2
    /// bottom left, 3 bottom right. A single fragment (`f32`) is returned unchanged.
    #[must_use]
    fn quad_lane(self, index: u8) -> Self;

    /// Calls `work` in a separate function that is compiled for this kind of number. For long code
    /// that many shaders share: they call it and do not each contain it.
    fn out_of_line<T>(self, work: impl FnOnce() -> T) -> T {
        work()
    }

    /// The SIMD level of packets, at which code that is compiled once for all shaders is entered;
    /// `None` for a single fragment and for a quad.
    #[inline(always)]
    fn level(self) -> Option<Level> {
        None
    }

    /// One lane's value; `index` is below [`Real::LANES`].
    fn lane(self, index: usize) -> f32;
    /// A number of the same kind, whose lanes are computed from their index.
    #[must_use]
    fn with_lanes(self, value: impl FnMut(usize) -> f32) -> Self;

    /// `self` clamped to `low..=high`: `max(low)` then `min(high)`; NaN gives `low`.
    #[inline(always)]
    #[must_use]
    fn clamp(self, low: f32, high: f32) -> Self {
        let (low, high) = (self.splat(low), self.splat(high));
        self.max(low).min(high)
    }

    /// `self` clamped to 0..=1; NaN gives 0.
    #[inline(always)]
    #[must_use]
    fn saturate(self) -> Self {
        self.clamp(0.0, 1.0)
    }

    /// `self − floor(self)`.
    #[inline(always)]
    #[must_use]
    fn fract(self) -> Self {
        self - self.floor()
    }
}

/// A 32-bit integer in each lane. Overflow wraps in packets, but a single `i32` panics in debug
/// builds, so code must not overflow.
pub trait Int:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + BitAnd<Output = Self>
    + BitOr<Output = Self>
    + BitXor<Output = Self>
    + Shl<u32, Output = Self>
    + Shr<u32, Output = Self>
{
    /// The real number with the same lanes.
    type Real: Real<Int = Self, Mask = Self::Mask>;
    /// A boolean in each lane.
    type Mask: Copy;

    /// `value` in every lane.
    #[must_use]
    fn splat(self, value: i32) -> Self;
    /// The product modulo 2³², for hashes.
    #[must_use]
    fn wrapping_mul(self, other: Self) -> Self;
    /// Shifts right and fills with zeros, as for unsigned numbers; `by` is below 32.
    #[must_use]
    fn shr_unsigned(self, by: u32) -> Self;
    /// The nearest real number, ties to even.
    fn to_real(self) -> Self::Real;
    /// The real number that has these bits.
    fn to_real_bits(self) -> Self::Real;
    /// The smaller one, signed.
    #[must_use]
    fn min(self, other: Self) -> Self;
    /// The greater one, signed.
    #[must_use]
    fn max(self, other: Self) -> Self;
    /// True in the lanes where `self < other`, signed.
    fn lt(self, other: Self) -> Self::Mask;
    /// True in the lanes where `self == other`.
    fn eq(self, other: Self) -> Self::Mask;
    /// True in the lanes where `self` is outside `0..count`; `count` is not negative.
    fn is_outside(self, count: i32) -> Self::Mask;
    /// `yes` in the lanes of the mask, `no` in the others.
    #[must_use]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// `table[self]`, the index read as unsigned. An index beyond the end gives the last element;
    /// an empty table gives 0.
    #[must_use]
    fn gather(self, table: &[u32]) -> Self;
    /// `table[self]`, `table[self + 1]`, `table[self + stride]` and `table[self + stride + 1]`: two
    /// neighbours in one row and the two below them. If any of the four is beyond the end, each of
    /// the four may be any element of the table, or 0.
    #[inline(always)]
    #[must_use]
    fn gather_square(self, table: &[u32], stride: i32) -> [Self; 4] {
        let (one, below) = (self.splat(1), self + self.splat(stride));
        [
            self.gather(table),
            (self + one).gather(table),
            below.gather(table),
            (below + one).gather(table),
        ]
    }
    /// One lane's value; `index` is below the number of lanes.
    fn lane(self, index: usize) -> i32;
}
