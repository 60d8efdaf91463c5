//! The number that shaders compute with.

use std::fmt::Debug;
use std::ops::{
    Add, AddAssign, BitAnd, BitOr, BitXor, Div, DivAssign, Mul, MulAssign, Neg, Not, Shl, Shr, Sub,
    SubAssign,
};

/// A real number in f32 arithmetic: one (`f32`), four of a 2×2 quad ([`Quad`](crate::Quad)),
/// sixteen of a packet (`f32x16<S>`), or thirty-two of a pair of packets ([`Pair`](crate::Pair)).
///
/// Each operation acts on every lane alone and gives the same bits in all of them. Constants are made
/// from a value at hand, because sixteen lanes need their level's token: `x.splat(0.5)`, or simply
/// an `f32` on the right of an operator: `x * 0.5 + 1.0`.
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
    /// A yes or no for each lane.
    type Mask: Copy
        + Debug
        + BitAnd<Output = Self::Mask>
        + BitOr<Output = Self::Mask>
        + Not<Output = Self::Mask>;
    /// A 32-bit integer for each lane.
    type Int: Int<Real = Self, Mask = Self::Mask>;

    /// How many lanes there are: 1, 4, 16 or 32.
    const LANES: usize;
    /// Whether long code with many table look-ups had better be run lane by lane with `f32`: the lanes are
    /// plain scalars anyway.
    const NARROW: bool;

    /// `value` in every lane.
    #[must_use]
    fn splat(self, value: f32) -> Self;
    /// `value` in every lane, as integers.
    #[must_use]
    fn splat_int(self, value: i32) -> Self::Int;
    /// The same answer for every lane.
    #[must_use]
    fn splat_mask(self, value: bool) -> Self::Mask;

    /// Square root, correctly rounded.
    #[must_use]
    fn sqrt(self) -> Self;
    /// Absolute value.
    #[must_use]
    fn abs(self) -> Self;
    /// Greatest integer not above.
    #[must_use]
    fn floor(self) -> Self;
    /// `self < other ? self : other`: `other` where either is NaN.
    #[must_use]
    fn min(self, other: Self) -> Self;
    /// `self > other ? self : other`: `other` where either is NaN.
    #[must_use]
    fn max(self, other: Self) -> Self;

    /// Whether `self < other`.
    fn lt(self, other: Self) -> Self::Mask;
    /// Whether `self <= other`.
    fn le(self, other: Self) -> Self::Mask;
    /// Whether `self == other`.
    fn eq(self, other: Self) -> Self::Mask;
    /// Whether `self > other`.
    #[inline(always)]
    fn gt(self, other: Self) -> Self::Mask {
        other.lt(self)
    }
    /// Whether `self >= other`.
    #[inline(always)]
    fn ge(self, other: Self) -> Self::Mask {
        other.le(self)
    }

    /// `yes` in the lanes of the mask, `no` in the others.
    #[must_use]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// Whether any lane is in the mask.
    fn any(mask: Self::Mask) -> bool;
    /// The mask as bits: lane `i` is bit `i`.
    fn mask_bits(mask: Self::Mask) -> u32;

    /// Rounds towards zero to an integer; NaN gives 0, values beyond the range its ends.
    fn to_int(self) -> Self::Int;
    /// Rounds towards zero a number within ±2³⁰; of any other, the result is unspecified, and may be another
    /// at another level. It is one instruction where [`Real::to_int`] takes several.
    fn to_int_within_range(self) -> Self::Int;
    /// The bits of each lane as an integer.
    fn to_bits(self) -> Self::Int;

    /// Fine partial derivative in x: right minus left neighbour in the lane's row of its 2×2 quad.
    /// One lone fragment (`f32`) has no neighbours: 0.
    #[must_use]
    fn ddx(self) -> Self;
    /// Fine partial derivative in y: lower minus upper neighbour in the lane's column of its quad.
    /// One lone fragment (`f32`) has no neighbours: 0.
    #[must_use]
    fn ddy(self) -> Self;

    /// Coarse partial derivative in x: that of the first row, for the whole quad.
    /// One lone fragment (`f32`) has no neighbours: 0.
    #[must_use]
    fn ddx_coarse(self) -> Self;
    /// Coarse partial derivative in y: that of the first column, for the whole quad.
    /// One lone fragment (`f32`) has no neighbours: 0.
    #[must_use]
    fn ddy_coarse(self) -> Self;

    /// The value of one fragment of each 2×2 quad in all four: 0 left top, 1 right top, 2 left bottom, 3 right
    /// bottom. A lone fragment (`f32`) is all four.
    #[must_use]
    fn quad_lane(self, index: u8) -> Self;

    /// Calls `work` in a function of its own that is compiled for this kind of number. For long code
    /// that many shaders share: they call it instead of each containing it.
    fn outlined<T>(self, work: impl FnOnce() -> T) -> T {
        work()
    }

    /// One lane's value; `index` is below [`Real::LANES`].
    fn lane(self, index: usize) -> f32;
    /// The same kind of number with each lane's value from a function of its index.
    #[must_use]
    fn with_lanes(self, value: impl FnMut(usize) -> f32) -> Self;

    /// `self` confined to `low..=high`: `max(low)` then `min(high)`; NaN gives `low`.
    #[inline(always)]
    #[must_use]
    fn clamp(self, low: f32, high: f32) -> Self {
        let (low, high) = (self.splat(low), self.splat(high));
        self.max(low).min(high)
    }

    /// `self` confined to 0..=1; NaN gives 0.
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

/// A 32-bit integer in each lane. Arithmetic that overflows wraps in packets; code must not rely on it,
/// because a lone `i32` is checked in debug builds.
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
    /// A yes or no for each lane.
    type Mask: Copy;

    /// `value` in every lane.
    #[must_use]
    fn splat(self, value: i32) -> Self;
    /// The product modulo 2³², for hashes.
    #[must_use]
    fn wrapping_mul(self, other: Self) -> Self;
    /// Shifts zeros in from the left, as of unsigned numbers; `by` is below 32.
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
    /// Whether `self < other`, signed.
    fn lt(self, other: Self) -> Self::Mask;
    /// Whether `self == other`.
    fn eq(self, other: Self) -> Self::Mask;
    /// Whether `self` is not in `0..count`, where `count` is not negative.
    fn is_outside(self, count: i32) -> Self::Mask;
    /// `yes` in the lanes of the mask, `no` in the others.
    #[must_use]
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// `table[self]`, the index read as unsigned; beyond the end the last element, 0 from an empty
    /// table.
    #[must_use]
    fn gather(self, table: &[u32]) -> Self;
    /// `table[self]`, `table[self + 1]`, `table[self + stride]`, `table[self + stride + 1]`: two neighbours
    /// of one row and those below them. Of an index of which one of these is beyond the end, each may be
    /// any element of the table, or 0.
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
