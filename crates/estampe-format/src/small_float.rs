//! Unsigned floats of 11 and 10 bits: five bits of exponent and `MANTISSA` bits of mantissa, 6 or
//! 5.
//!
//! *Spec* Vulkan, Unsigned 11-Bit and 10-Bit Floating-Point Numbers. To nearest, ties to even;
//! denormals are kept.

use crate::five_bit_exponent as magnitude;
use estampe_simd::{Bytes, Lanes, Select, SimdBase, f32x16, i32x16, outline, u32x16};

/// The code of every NaN: infinity's with the highest bit of the mantissa.
const fn nan(mantissa: u32) -> u32 {
    magnitude::infinity(mantissa) | 1 << (mantissa - 1)
}

/// The unsigned float nearest to a number: 0 of negative ones, the greatest finite one of all that
/// are too great, infinity of infinity alone.
#[inline(always)]
#[must_use]
pub fn encode<const MANTISSA: u32>(value: f32) -> u32 {
    let infinity = magnitude::infinity(MANTISSA);
    if value.is_nan() {
        nan(MANTISSA)
    } else if value <= 0.0 {
        0
    } else if value == f32::INFINITY {
        infinity
    } else {
        magnitude::encode::<MANTISSA>(value.to_bits()).min(infinity - 1)
    }
}

/// [`encode`] of sixteen lanes.
#[inline(always)]
pub fn encode_lanes<S: Lanes, const MANTISSA: u32>(s: S, value: f32x16<S>) -> u32x16<S> {
    outline!(s, {
        let splat = |value| <u32x16<S> as SimdBase<S>>::splat(s, value);
        // 0 of negative numbers, whose bits are negative as integers; of NaN anything.
        let bits: i32x16<S> = value.bitcast();
        let positive = bits.max(<i32x16<S> as SimdBase<S>>::splat(s, 0)).bitcast();
        let infinity = magnitude::infinity(MANTISSA);
        let finite = magnitude::encode_lanes::<S, MANTISSA>(s, positive).min(splat(infinity - 1));
        let infinite = <f32x16<S> as SimdBase<S>>::splat(s, f32::INFINITY);
        let number = value.simd_eq(infinite).select(splat(infinity), finite);
        value.simd_eq(value).select(number, splat(nan(MANTISSA)))
    })
}

/// An unsigned float's number, exactly; a NaN's mantissa moves up.
#[inline(always)]
#[must_use]
pub fn decode<const MANTISSA: u32>(code: u32) -> f32 {
    magnitude::decode::<MANTISSA>(code)
}

/// [`decode`] of sixteen lanes.
#[inline(always)]
pub fn decode_lanes<S: Lanes, const MANTISSA: u32>(s: S, code: u32x16<S>) -> f32x16<S> {
    magnitude::decode_lanes::<S, MANTISSA>(s, code)
}
