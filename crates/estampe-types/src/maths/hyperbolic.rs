//! Hyperbolic functions.

use super::exponential::{exp, half_exp};
use super::rounding::with_sign;
use crate::Real;

/// sinh x. With m = |x|: below 1, m + m·z·p(z), z = m², where p is the minimax polynomial of degree
/// 3 (relative error 5·10⁻⁹); else h − ¼ ÷ h with h = eᵐ ÷ 2. The sign is that of x.
#[inline(always)]
pub(crate) fn sinh<R: Real>(x: R) -> R {
    let m = x.abs();
    let z = m * m;
    let mut sum = z * 2.816_951_3e-6 + 1.983_616e-4;
    sum = sum * z + 8.333_35e-3;
    sum = sum * z + 1.666_666_7e-1;
    let small = sum * z * m + m;
    let h = half_exp(m);
    let large = h - 0.25 / h;
    with_sign(R::select(m.lt(1.0), small, large), x)
}

/// cosh x = h + ¼ ÷ h with h = e^|x| ÷ 2. cosh 0 = 1.
#[inline(always)]
pub(crate) fn cosh<R: Real>(x: R) -> R {
    let h = half_exp(x.abs());
    h + 0.25 / h
}

/// tanh x. With m = |x|: below 0.625, m + m·z·p(z), z = m², where p is the minimax polynomial of
/// degree 4 (relative error 9·10⁻⁹); else 1 − 2 ÷ (e²ᵐ + 1). The sign is that of x.
#[inline(always)]
pub(crate) fn tanh<R: Real>(x: R) -> R {
    let m = x.abs();
    let z = m * m;
    let mut sum = z * -5.704_984_5e-3 + 2.063_908_4e-2;
    sum = sum * z - 5.373_971_5e-2;
    sum = sum * z + 1.333_144_2e-1;
    sum = sum * z - 3.333_328e-1;
    let small = sum * z * m + m;
    let large = 1.0 - 2.0 / (exp(m + m) + 1.0);
    with_sign(R::select(m.lt(0.625), small, large), x)
}
