//! Integers, which shaders give and get as the bits of numbers. A channel of n bits saturates.

use estampe_simd::{Lanes, SimdBase, i32x16, u32x16};

/// An unsigned integer confined to n bits, 1..=32.
#[inline(always)]
#[must_use]
pub fn encode_uint(value: u32, bits: u32) -> u32 {
    value.min(u32::MAX >> (32 - bits))
}

/// [`encode_uint`] of sixteen lanes.
#[inline(always)]
pub fn encode_uint_lanes<S: Lanes>(s: S, value: u32x16<S>, bits: u32) -> u32x16<S> {
    value.min(<u32x16<S> as SimdBase<S>>::splat(
        s,
        u32::MAX >> (32 - bits),
    ))
}

/// A signed integer confined to n bits, 1..=32.
#[inline(always)]
#[must_use]
pub fn encode_sint(value: i32, bits: u32) -> i32 {
    value.clamp(i32::MIN >> (32 - bits), i32::MAX >> (32 - bits))
}

/// [`encode_sint`] of sixteen lanes.
#[inline(always)]
pub fn encode_sint_lanes<S: Lanes>(s: S, value: i32x16<S>, bits: u32) -> i32x16<S> {
    let splat = |value| <i32x16<S> as SimdBase<S>>::splat(s, value);
    value
        .max(splat(i32::MIN >> (32 - bits)))
        .min(splat(i32::MAX >> (32 - bits)))
}

/// The number of the lowest n bits, 1..=32, in two's complement.
#[inline(always)]
#[must_use]
pub fn sign_extended(code: u32, bits: u32) -> i32 {
    (code << (32 - bits)).cast_signed() >> (32 - bits)
}
