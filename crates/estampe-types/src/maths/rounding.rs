//! Rounding to integers, remainders, and the sign.

use crate::{Int, Real};

/// 1.5·2²³: adding it to a number within ±2²² rounds the number to the nearest integer, ties to
/// even, in the low bits of the sum.
pub(super) const ROUNDING: f32 = 12_582_912.0;

/// 2²³, from which on all f32 are integers.
const ALL_INTEGERS: f32 = 8_388_608.0;

/// `magnitude`, which is not negative, with the sign of `sign`.
#[inline(always)]
pub(super) fn with_sign<R: Real>(magnitude: R, sign: R) -> R {
    let sign_bit = sign.to_bits() & sign.splat_int(i32::MIN);
    (magnitude.to_bits() | sign_bit).to_real_bits()
}

/// 1 for positive numbers, −1 for negative ones; zeros and NaN are returned unchanged.
#[inline(always)]
pub(crate) fn sign<R: Real>(x: R) -> R {
    let negative = R::select(x.lt(0.0), x.splat(-1.0), x);
    R::select(x.gt(0.0), x.splat(1.0), negative)
}

/// −floor(−x).
#[inline(always)]
pub(crate) fn ceil<R: Real>(x: R) -> R {
    -(-x).floor()
}

/// floor(|x|) with the sign of x.
#[inline(always)]
pub(crate) fn trunc<R: Real>(x: R) -> R {
    with_sign(x.abs().floor(), x)
}

/// The nearest integer, ties to even, with the sign of x: (|x| + 2²³) − 2²³ for |x| < 2²³.
#[inline(always)]
pub(crate) fn round<R: Real>(x: R) -> R {
    let magnitude = x.abs();
    let whole = (magnitude + ALL_INTEGERS) - ALL_INTEGERS;
    R::select(magnitude.lt(ALL_INTEGERS), with_sign(whole, x), x)
}

/// 1 ÷ √x: two roundings.
#[inline(always)]
pub(crate) fn inverse_sqrt<R: Real>(x: R) -> R {
    1.0 / x.sqrt()
}

/// x − y·trunc(x ÷ y).
#[inline(always)]
pub(crate) fn remainder<R: Real>(x: R, y: R) -> R {
    x - y * trunc(x / y)
}

/// x − y·floor(x ÷ y).
#[inline(always)]
pub(crate) fn modulo<R: Real>(x: R, y: R) -> R {
    x - y * (x / y).floor()
}
