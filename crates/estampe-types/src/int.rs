//! The integers that belong to the numbers of shaders.

use crate::Real;
use crate::operand::{Implied, LeftOfReal};
use std::fmt::Debug;
use std::ops::{Add, BitAnd, BitOr, BitXor, Mul, Shl, Shr, Sub};

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
    + Implied<f32, Is = f32>
    + Implied<f32, Is: LeftOfReal<<Self as Int>::Real>>
{
    /// The real number with the same lanes.
    type Real: Real<Int = Self, SelectMask = Self::SelectMask>;
    /// A boolean in each lane.
    type SelectMask: Copy;

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
    fn lt(self, other: Self) -> Self::SelectMask;
    /// True in the lanes where `self == other`.
    fn eq(self, other: Self) -> Self::SelectMask;
    /// True in the lanes where `self` is outside `0..count`; `count` is not negative.
    fn is_outside(self, count: i32) -> Self::SelectMask;
    /// `yes` in the lanes of the mask, `no` in the others.
    #[must_use]
    fn select(mask: Self::SelectMask, yes: Self, no: Self) -> Self;
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
    /// [`Int::lane`] for a sampler that stores all lanes; see [`Real::lane_to_store`].
    #[doc(hidden)]
    #[inline(always)]
    fn lane_to_store(self, index: usize) -> i32 {
        self.lane(index)
    }
}
