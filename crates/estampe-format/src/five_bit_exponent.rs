//! Magnitudes of floats with five bits of exponent (bias 15) and a mantissa of `MANTISSA` bits:
//! what halves and the unsigned floats of 11 and 10 bits share.
//!
//! ```text
//!     code    0 ……………… 2^MANTISSA ……………………… 31·2^MANTISSA ……
//!             denormal    normal                infinity, then NaNs
//!     number  m·2^(−14 − MANTISSA)    (1 + m/2^MANTISSA)·2^(e − 15)
//! ```

use estampe_simd::{Bytes, Lanes, Select, SimdBase, SimdCvtFloat, f32x16, i32x16, outline, u32x16};

/// The code of infinity.
pub(crate) const fn infinity(mantissa: u32) -> u32 {
    31 << mantissa
}

/// The bits that all quiet NaNs have.
const QUIET_NAN: u32 = 0x7FC0_0000;

/// 2^(−14 − mantissa), of which denormal codes are multiples, as an f32's bits.
const fn least_bits(mantissa: u32) -> u32 {
    (127 - 14 - mantissa) << 23
}

/// The nearest code, ties to even, of a magnitude's bits (sign 0, not NaN); anything above the
/// greatest finite code where the magnitude is too great.
#[inline(always)]
pub(crate) fn encode<const MANTISSA: u32>(bits: u32) -> u32 {
    let dropped = 23 - MANTISSA;
    // The least normal number is 2⁻¹⁴; the code's exponent field is the float's less 112.
    if bits >= 113 << 23 {
        let rebased = bits - (112 << 23);
        let half = (1 << (dropped - 1)) - 1;
        // A carry out of the mantissa belongs in the exponent.
        return (rebased + half + (rebased >> dropped & 1)) >> dropped;
    }
    // Below it the code is a multiple of the least number: the mantissa is shifted right.
    let shift = dropped + 113 - (bits >> 23);
    if shift > 25 {
        return 0;
    }
    let mantissa = bits & 0x007F_FFFF | 0x0080_0000;
    let half = (1 << (shift - 1)) - 1;
    (mantissa + half + (mantissa >> shift & 1)) >> shift
}

/// [`encode`] of sixteen lanes.
///
/// A magnitude below 2⁻¹⁴ is rounded by an addition: the sum with 2^(9 − MANTISSA), whose last
/// mantissa bit is worth 2^(−14 − MANTISSA), is below twice that, so its last bit is worth the
/// same, and the addition rounds to it as the code asks: to nearest, ties to even. The code is then
/// the sum's bits less those of 2^(9 − MANTISSA).
#[inline(always)]
pub(crate) fn encode_lanes<S: Lanes, const MANTISSA: u32>(s: S, bits: u32x16<S>) -> u32x16<S> {
    let dropped = 23 - MANTISSA;
    let splat = |value| <u32x16<S> as SimdBase<S>>::splat(s, value);
    let half = (1 << (dropped - 1)) - 1;
    let rebased = bits - splat(112 << 23);
    let odd = (rebased >> dropped) & splat(1);
    let normal = (rebased + splat(half) + odd) >> dropped;

    let aligned = (127 + 9 - MANTISSA) << 23;
    let number: f32x16<S> = bits.bitcast();
    let sum: u32x16<S> = (number + f32::from_bits(aligned)).bitcast();
    let denormal = sum - splat(aligned);

    // As signed numbers, which every level compares at once: magnitudes have no sign.
    let signed: i32x16<S> = bits.bitcast();
    let is_denormal = signed.simd_lt(<i32x16<S> as SimdBase<S>>::splat(s, 113 << 23));
    is_denormal.select(denormal, normal)
}

/// A code's number, exactly; a NaN's mantissa moves up, and it becomes quiet.
#[inline(always)]
pub(crate) fn decode<const MANTISSA: u32>(code: u32) -> f32 {
    let moved = code << (23 - MANTISSA);
    if code > infinity(MANTISSA) {
        f32::from_bits(moved | QUIET_NAN)
    } else if code == infinity(MANTISSA) {
        f32::INFINITY
    } else if code < 1 << MANTISSA {
        code as f32 * f32::from_bits(least_bits(MANTISSA))
    } else {
        f32::from_bits(moved + (112 << 23))
    }
}

/// [`decode`] of sixteen lanes.
#[inline(always)]
pub(crate) fn decode_lanes<S: Lanes, const MANTISSA: u32>(s: S, code: u32x16<S>) -> f32x16<S> {
    outline!(s, {
        let splat = |value| <u32x16<S> as SimdBase<S>>::splat(s, value);
        let moved = code << (23 - MANTISSA);
        let signed: i32x16<S> = code.bitcast();
        let bound = |value: u32| <i32x16<S> as SimdBase<S>>::splat(s, value.cast_signed());
        // Denormal codes are converted, not multiplied as bits: processors are slow with denormal
        // f32.
        let least = f32::from_bits(least_bits(MANTISSA));
        let denormal: u32x16<S> = (f32x16::float_from(signed) * least).bitcast();
        let normal = moved + splat(112 << 23);
        let finite = signed
            .simd_lt(bound(1 << MANTISSA))
            .select(denormal, normal);
        let not_finite = signed
            .simd_gt(bound(infinity(MANTISSA)))
            .select(moved | splat(QUIET_NAN), splat(0x7F80_0000));
        signed
            .simd_lt(bound(infinity(MANTISSA)))
            .select(finite, not_finite)
            .bitcast()
    })
}
