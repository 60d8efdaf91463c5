//! 16-bit floats (IEEE 754 binary16): to nearest, ties to even; denormals are kept.

use crate::five_bit_exponent as magnitude;
use estampe_simd::{Bytes, Lanes, Select, SimdBase, f32x16, outline, u32x16};

/// The half float of every NaN.
const NAN: u32 = 0x7E00;

/// The half float nearest to a number: infinite from 65520 on; −0 stays.
#[inline(always)]
#[must_use]
pub fn encode(value: f32) -> u32 {
    if value.is_nan() {
        return NAN;
    }
    let bits = value.to_bits();
    let nearest = magnitude::encode::<10>(bits & 0x7FFF_FFFF);
    bits >> 16 & 0x8000 | nearest.min(magnitude::infinity(10))
}

/// [`encode`] of sixteen lanes, in the low 16 bits of each.
#[inline(always)]
pub fn encode_lanes<S: Lanes>(s: S, value: f32x16<S>) -> u32x16<S> {
    outline!(s, {
        let splat = |value| <u32x16<S> as SimdBase<S>>::splat(s, value);
        let number = match s.encode_half(value) {
            Some(codes) => codes,
            None => {
                let bits: u32x16<S> = value.bitcast();
                let nearest = magnitude::encode_lanes::<S, 10>(s, bits & splat(0x7FFF_FFFF));
                let infinity = splat(magnitude::infinity(10));
                nearest.min(infinity) | ((bits >> 16) & splat(0x8000))
            }
        };
        value.simd_eq(value).select(number, splat(NAN))
    })
}

/// [`encode_lanes`] of two numbers, in the low and the high 16 bits of each lane.
#[inline(always)]
pub fn encode_pair<S: Lanes>(s: S, [low, high]: [f32x16<S>; 2]) -> u32x16<S> {
    match s.encode_half_pair([low, high]) {
        Some(codes) => codes,
        None => encode_lanes(s, low) | (encode_lanes(s, high) << 16),
    }
}

/// A half float's number, exactly. A NaN keeps its sign, its mantissa moves up, and it becomes
/// quiet, as processors' instructions do it.
#[inline(always)]
#[must_use]
pub fn decode(half: u32) -> f32 {
    let magnitude = magnitude::decode::<10>(half & 0x7FFF);
    f32::from_bits(magnitude.to_bits() | (half & 0x8000) << 16)
}

/// [`decode`] of sixteen lanes, the low 16 bits of each.
#[inline(always)]
pub fn decode_lanes<S: Lanes>(s: S, half: u32x16<S>) -> f32x16<S> {
    outline!(s, {
        let splat = |value| <u32x16<S> as SimdBase<S>>::splat(s, value);
        if let Some(numbers) = s.decode_half(half) {
            return numbers;
        }
        let magnitude = magnitude::decode_lanes::<S, 10>(s, half & splat(0x7FFF));
        let bits: u32x16<S> = magnitude.bitcast();
        (bits | ((half & splat(0x8000)) << 16)).bitcast()
    })
}

/// [`decode_lanes`] of the low and the high 16 bits of each lane.
#[inline(always)]
pub fn decode_pair<S: Lanes>(s: S, words: u32x16<S>) -> [f32x16<S>; 2] {
    match s.decode_half_pair(words) {
        Some(numbers) => numbers,
        None => [decode_lanes(s, words), decode_lanes(s, words >> 16)],
    }
}
