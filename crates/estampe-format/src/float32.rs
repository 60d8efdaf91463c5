//! 32-bit floats: stored as they are, but for NaN, of which there is one.

use estampe_simd::{Bytes, Lanes, Select, SimdBase, f32x16, u32x16};

/// The bits of every NaN.
const NAN: u32 = 0x7FC0_0000;

/// A number's bits.
#[inline(always)]
#[must_use]
pub fn encode(value: f32) -> u32 {
    if value.is_nan() { NAN } else { value.to_bits() }
}

/// [`encode`] of sixteen lanes.
#[inline(always)]
pub fn encode_lanes<S: Lanes>(s: S, value: f32x16<S>) -> u32x16<S> {
    let nan = <u32x16<S> as SimdBase<S>>::splat(s, NAN);
    value.simd_eq(value).select(value.bitcast(), nan)
}
