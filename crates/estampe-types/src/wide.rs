//! [`Real`] and [`Int`] for a packet of sixteen lanes.

use crate::operand::join_number;
use crate::{Int, Operand, Real};
use estampe_simd::{
    Bytes, LANES, Lanes, Level, Select, SimdBase, SimdCvtFloat, SimdCvtTruncate, SimdFloat,
    SimdMask, f32x16, i32x16, mask32x16, u32x16,
};

join_number! { [S: Lanes] f32x16<S> }

impl<S: Lanes> Real for f32x16<S> {
    type SelectMask = mask32x16<S>;
    type Int = i32x16<S>;
    const LANES: usize = LANES;
    const EMULATED_LANES: bool = S::IS_SCALAR;

    #[inline(always)]
    fn splat(self, value: f32) -> Self {
        <Self as SimdBase<S>>::splat(token(self), value)
    }
    #[inline(always)]
    fn splat_int(self, value: i32) -> i32x16<S> {
        <i32x16<S> as SimdBase<S>>::splat(token(self), value)
    }
    #[inline(always)]
    fn splat_mask(self, value: bool) -> mask32x16<S> {
        <mask32x16<S> as SimdMask<S>>::splat(token(self), value)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        SimdFloat::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        SimdBase::abs(self)
    }
    #[inline(always)]
    fn floor(self) -> Self {
        token(self).floor_f32(self)
    }
    #[inline(always)]
    fn min(self, other: impl Operand<Self>) -> Self {
        token(self).min_f32(self, other.operand(self))
    }
    #[inline(always)]
    fn max(self, other: impl Operand<Self>) -> Self {
        token(self).max_f32(self, other.operand(self))
    }
    #[inline(always)]
    fn lt(self, other: impl Operand<Self>) -> mask32x16<S> {
        self.simd_lt(other.operand(self))
    }
    #[inline(always)]
    fn le(self, other: impl Operand<Self>) -> mask32x16<S> {
        self.simd_le(other.operand(self))
    }
    #[inline(always)]
    fn eq(self, other: impl Operand<Self>) -> mask32x16<S> {
        self.simd_eq(other.operand(self))
    }
    #[inline(always)]
    fn select(mask: mask32x16<S>, yes: Self, no: Self) -> Self {
        Select::select(mask, yes, no)
    }
    #[inline(always)]
    fn any(mask: mask32x16<S>) -> bool {
        mask.any_true()
    }
    #[inline(always)]
    fn mask_bits(mask: mask32x16<S>) -> u64 {
        mask.to_bitmask()
    }
    #[inline(always)]
    fn to_int(self) -> i32x16<S> {
        self.to_int_precise()
    }
    #[inline(always)]
    fn to_int_within_range(self) -> i32x16<S> {
        i32x16::truncate_from(self)
    }
    #[inline(always)]
    fn to_bits(self) -> i32x16<S> {
        Bytes::bitcast(self)
    }
    #[inline(always)]
    fn ddx(self) -> Self {
        self.takes_derivatives();
        // Lanes 0 1 2 3 of each quad: (1 − 0) in both lanes of the upper row, (3 − 2) in the lower.
        let left = self.swizzle_dyn_within_blocks(quad_bytes(token(self), [0, 0, 2, 2]));
        let right = self.swizzle_dyn_within_blocks(quad_bytes(token(self), [1, 1, 3, 3]));
        right - left
    }
    #[inline(always)]
    fn ddy(self) -> Self {
        self.takes_derivatives();
        let upper = self.swizzle_dyn_within_blocks(quad_bytes(token(self), [0, 1, 0, 1]));
        let lower = self.swizzle_dyn_within_blocks(quad_bytes(token(self), [2, 3, 2, 3]));
        lower - upper
    }
    #[inline(always)]
    fn ddx_coarse(self) -> Self {
        self.takes_derivatives();
        self.quad_lane(1) - self.quad_lane(0)
    }
    #[inline(always)]
    fn ddy_coarse(self) -> Self {
        self.takes_derivatives();
        self.quad_lane(2) - self.quad_lane(0)
    }
    #[inline(always)]
    fn quad_lane(self, index: u8) -> Self {
        self.takes_derivatives();
        self.swizzle_dyn_within_blocks(quad_bytes(token(self), [index & 3; 4]))
    }
    #[inline(never)]
    fn out_of_line<T>(self, work: impl FnOnce() -> T) -> T {
        token(self).vectorize(work)
    }
    #[inline(always)]
    fn level(self) -> Option<Level> {
        Some(token(self).as_level())
    }
    #[inline(always)]
    fn lane(self, index: usize) -> f32 {
        self.as_slice()[index]
    }
    #[inline(always)]
    fn with_lanes(self, mut value: impl FnMut(usize) -> f32) -> Self {
        let mut lanes = [0.0; LANES];
        for (index, lane) in lanes.iter_mut().enumerate() {
            *lane = value(index);
        }
        SimdBase::load_array(token(self), lanes)
    }
}

impl<S: Lanes> Int for i32x16<S> {
    type Real = f32x16<S>;
    type SelectMask = mask32x16<S>;

    #[inline(always)]
    fn splat(self, value: i32) -> Self {
        <Self as SimdBase<S>>::splat(estampe_simd::ExtractToken::token(&self), value)
    }
    #[inline(always)]
    fn wrapping_mul(self, other: Self) -> Self {
        self * other
    }
    #[inline(always)]
    fn shr_unsigned(self, by: u32) -> Self {
        let bits: u32x16<S> = Bytes::bitcast(self);
        Bytes::bitcast(bits >> by)
    }
    #[inline(always)]
    fn to_real(self) -> f32x16<S> {
        f32x16::float_from(self)
    }
    #[inline(always)]
    fn to_real_bits(self) -> f32x16<S> {
        Bytes::bitcast(self)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        SimdBase::min(self, other)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        SimdBase::max(self, other)
    }
    #[inline(always)]
    fn lt(self, other: Self) -> mask32x16<S> {
        self.simd_lt(other)
    }
    #[inline(always)]
    fn eq(self, other: Self) -> mask32x16<S> {
        self.simd_eq(other)
    }
    #[inline(always)]
    fn is_outside(self, count: i32) -> mask32x16<S> {
        // Read as unsigned, a negative number is greater than all others.
        let (unsigned, count): (u32x16<S>, u32x16<S>) = (
            Bytes::bitcast(self),
            Bytes::bitcast(Int::splat(self, count)),
        );
        unsigned.simd_ge(count)
    }
    #[inline(always)]
    fn select(mask: mask32x16<S>, yes: Self, no: Self) -> Self {
        Select::select(mask, yes, no)
    }
    #[inline(always)]
    fn gather(self, table: &[u32]) -> Self {
        let index: u32x16<S> = Bytes::bitcast(self);
        Bytes::bitcast(estampe_simd::ExtractToken::token(&self).gather(table, index))
    }
    #[inline(always)]
    fn gather_square(self, table: &[u32], stride: i32) -> [Self; 4] {
        let index: u32x16<S> = Bytes::bitcast(self);
        let stride = stride.cast_unsigned();
        let simd = estampe_simd::ExtractToken::token(&self);
        let [a, b, c, d] = simd.gather_square(table, index, stride);
        [
            Bytes::bitcast(a),
            Bytes::bitcast(b),
            Bytes::bitcast(c),
            Bytes::bitcast(d),
        ]
    }
    #[inline(always)]
    fn lane(self, index: usize) -> i32 {
        self.as_slice()[index]
    }
}

#[inline(always)]
fn token<S: Lanes>(value: f32x16<S>) -> S {
    estampe_simd::ExtractToken::token(&value)
}

/// Byte indices that select one 32-bit lane of each 128-bit block for each lane.
#[inline(always)]
fn quad_bytes<S: Lanes>(simd: S, pick: [u8; 4]) -> <f32x16<S> as Bytes>::Bytes {
    let mut bytes = [0u8; 64];
    for (lane, bytes) in bytes.chunks_exact_mut(4).enumerate() {
        let first = pick[lane % 4] * 4;
        bytes.copy_from_slice(&[first, first + 1, first + 2, first + 3]);
    }
    SimdBase::from_slice(simd, &bytes)
}
