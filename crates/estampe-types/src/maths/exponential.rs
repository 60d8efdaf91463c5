//! Exponential functions, logarithms and powers.

use super::rounding::ROUNDING;
use crate::{Int, Real};

/// 2ˣ, within 2 ulp for x in −126..128. Gives 0 below 2⁻¹²⁶, infinity above 2¹²⁸, and NaN for NaN.
///
/// x = i + f with i = floor(x + ½), |f| ≤ ½. 2^f is its Taylor series (terms up to f⁷, remainder
/// below 2⁻²⁷); 2^i is made of exponent bits, in two factors so that i = 128 does not wrap.
#[inline(always)]
pub(crate) fn exp2<R: Real>(x: R) -> R {
    // Below −126 the result is 0. A product there would be subnormal, and take a hundred times as
    // long on some processors.
    let clamped = x.clamp(-126.0, 129.0);
    let whole = (clamped + 0.5).floor();
    let f = clamped - whole;
    let mut sum = f * 1.525_273_4e-5 + 1.540_353e-4;
    sum = sum * f + 1.333_355_8e-3;
    sum = sum * f + 9.618_129e-3;
    sum = sum * f + 5.550_411e-2;
    sum = sum * f + 2.402_265e-1;
    sum = sum * f + 6.931_472e-1;
    sum = sum * f + 1.0;
    let i = whole.to_int();
    let half = i >> 1;
    let scaled = sum * power_of_two::<R>(half) * power_of_two::<R>(i - half);
    let small = R::select(x.lt(x.splat(-126.0)), x.splat(0.0), scaled);
    let large = R::select(x.ge(x.splat(128.0)), x.splat(f32::INFINITY), small);
    R::select(x.eq(x), large, x)
}

/// 2^i for i in −126..=127.
#[inline(always)]
fn power_of_two<R: Real>(i: R::Int) -> R {
    ((i + i.splat(127)) << 23).to_real_bits()
}

/// log₂ x, within 3.6·10⁻⁷ times max(|log₂ x|, 1) for positive normal x. Zero and subnormals give
/// −∞, negative numbers and NaN give NaN, infinity gives infinity.
///
/// x = 2^e·m with m in √½..√2; log₂ m = 2/ln 2 · artanh(s), s = (m − 1)/(m + 1), by its series in
/// s².
#[inline(always)]
pub(crate) fn log2<R: Real>(x: R) -> R {
    let (s, e) = split(x);
    let s2 = s * s;
    let mut sum = s2 * 0.320_598_9 + 0.412_198_6;
    sum = sum * s2 + 0.577_078_04;
    sum = sum * s2 + 0.961_796_7;
    sum = sum * s2 + 2.885_39;
    let normal = sum * s + e.to_real();
    with_special_logarithms(x, normal)
}

/// ln x, within 2 ulp for positive normal x. Other numbers are as in [`log2`].
///
/// x = 2^e·m as in [`log2`]; ln m = 2·artanh(s) = t + t·s²·p(s²) with t = 2s, where p is the
/// minimax polynomial of degree 2 (relative error of ln m 8·10⁻¹⁰). ln 2 is in two parts, the first
/// of which has so few bits that e times it is exact.
#[inline(always)]
pub(crate) fn log<R: Real>(x: R) -> R {
    let (s, e) = split(x);
    let e = e.to_real();
    let (s2, t) = (s * s, s + s);
    let series = ((s2 * 0.149_354_68 + 0.199_887_87) * s2 + 0.333_333_88) * s2;
    let normal = (e * LN_2_PARTS[0] + t) + (t * series + e * LN_2_PARTS[1]);
    with_special_logarithms(x, normal)
}

/// (s, e) with x = 2^e·m, m in √½..√2, and s = (m − 1) ÷ (m + 1); of 1 where x is not positive and
/// normal.
#[inline(always)]
fn split<R: Real>(x: R) -> (R, R::Int) {
    // The series holds for positive normal numbers only; all others are replaced at the end.
    let regular = x.ge(x.splat(f32::MIN_POSITIVE)) & x.le(x.splat(f32::MAX));
    let bits = R::select(regular, x, x.splat(1.0)).to_bits();
    // The exponent of x/√½: adding the distance from √½ to 1 carries where m ≥ √2.
    let e = ((bits + bits.splat(0x3F80_0000 - 0x3F35_04F3)) >> 23) - bits.splat(127);
    let m = (bits - (e << 23)).to_real_bits();
    let s = (m - 1.0) / (m + 1.0);
    (s, e)
}

/// A logarithm of x: `normal` if x is positive and normal.
#[inline(always)]
fn with_special_logarithms<R: Real>(x: R, normal: R) -> R {
    let infinite = R::select(x.eq(x.splat(f32::INFINITY)), x, normal);
    let tiny = R::select(
        x.lt(x.splat(f32::MIN_POSITIVE)),
        x.splat(f32::NEG_INFINITY),
        infinite,
    );
    R::select(x.ge(x.splat(0.0)), tiny, x.splat(f32::NAN))
}

/// x^y = 2^(y·log₂ x) for x ≥ 0, with the relative error of log₂ times y; 0^y = 0 for y > 0 and
/// x^0 = 1. Negative x gives NaN.
#[inline(always)]
pub(crate) fn pow<R: Real>(x: R, y: R) -> R {
    let zero = x.splat(0.0);
    R::select(y.eq(zero), x.splat(1.0), exp2(y * log2(x)))
}

/// xⁿ by repeated squaring, from the lowest bit of n on.
#[inline(always)]
pub(crate) fn powi<R: Real>(x: R, n: u32) -> R {
    let (mut result, mut base, mut left) = (x.splat(1.0), x, n);
    while left != 0 {
        if left & 1 == 1 {
            result *= base;
        }
        base = base * base;
        left >>= 1;
    }
    result
}

/// ln 2 in two parts.
const LN_2_PARTS: [f32; 2] = [0.693_359_4, -2.121_944_4e-4];

/// eˣ, with a relative error of at most 1.5·10⁻⁷ where it is a normal number. Gives 0 below 2⁻¹⁵⁰,
/// infinity beyond f32's range, and NaN for NaN.
///
/// x = k·ln 2 + r with k the nearest integer to x/ln 2, |r| ≤ ½·ln 2. ln 2 is subtracted in two
/// parts, the first of which has so few bits that k times it is exact. eʳ = 1 + r + r²·p(r), where
/// p is the minimax polynomial of degree 4 (error 3·10⁻⁹); 2^k is made of exponent bits, in two
/// factors.
#[inline(always)]
pub(crate) fn exp<R: Real>(x: R) -> R {
    // In this order of operands NaN stays NaN.
    let x = x.splat(-104.0).max(x.splat(89.0).min(x));
    exp_times_power(x, 0)
}

/// eˣ ÷ 2, which is finite for x up to 89.4.
#[inline(always)]
pub(crate) fn half_exp<R: Real>(x: R) -> R {
    let x = x.splat(-104.0).max(x.splat(90.0).min(x));
    exp_times_power(x, -1)
}

/// eˣ·2^shift for x in −104..=90, as [`exp`] explains.
#[inline(always)]
fn exp_times_power<R: Real>(x: R, shift: i32) -> R {
    let rounded = x * std::f32::consts::LOG2_E + ROUNDING;
    let k = rounded - ROUNDING;
    let r = x - k * LN_2_PARTS[0] - k * LN_2_PARTS[1];
    let mut sum = r * 1.381_446_7e-3 + 8.368_781e-3;
    sum = sum * r + 4.166_839_3e-2;
    sum = sum * r + 1.666_652e-1;
    sum = sum * r + 4.999_999_4e-1;
    let power = sum * (r * r) + r + 1.0;
    let k = rounded.to_bits() - rounded.splat_int(0x4B40_0000 - shift);
    let half = k >> 1;
    power * power_of_two::<R>(half) * power_of_two::<R>(k - half)
}
