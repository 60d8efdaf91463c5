//! Arc sine, arc cosine and arc tangents.

use super::rounding::with_sign;
use crate::{Int, Real};
use std::f32::consts::{FRAC_PI_2, PI};

/// asin x for |x| ≤ 1, else NaN.
///
/// With [`half_angle`]'s a: asin |x| = a for |x| ≤ ½, else π/2 − 2a.
#[inline(always)]
pub(crate) fn asin<R: Real>(x: R) -> R {
    let (a, is_small) = half_angle(x.abs());
    with_sign(R::select(is_small, a, FRAC_PI_2 - (a + a)), x)
}

/// acos x for |x| ≤ 1, else NaN.
///
/// With [`half_angle`]'s a: π/2 ∓ a for |x| ≤ ½, else 2a for positive x and π − 2a for negative x.
#[inline(always)]
pub(crate) fn acos<R: Real>(x: R) -> R {
    let (a, is_small) = half_angle(x.abs());
    let twice = a + a;
    let small = FRAC_PI_2 - with_sign(a, x);
    R::select(is_small, small, R::select(x.lt(0.0), PI - twice, twice))
}

/// asin m and true for m ≤ ½; else asin √((1 − m)/2), which is half of acos m, and false. NaN for m
/// above 1.
///
/// asin s = s + s·z·p(z), z = s² ≤ ¼, where p is the minimax polynomial of degree 4 (relative error
/// 6·10⁻⁹).
#[inline(always)]
fn half_angle<R: Real>(m: R) -> (R, R::SelectMask) {
    let is_small = m.le(0.5);
    let z = R::select(is_small, m * m, (1.0 - m) * 0.5);
    let s = R::select(is_small, m, z.sqrt());
    let mut sum = z * 4.216_629e-2 + 2.417_953_1e-2;
    sum = sum * z + 4.547_037e-2;
    sum = sum * z + 7.495_297_5e-2;
    sum = sum * z + 1.666_675_2e-1;
    (sum * z * s + s, is_small)
}

/// atan x: atan |x| for |x| ≤ 1, else π/2 − atan(1 ÷ |x|), with the sign of x.
#[inline(always)]
pub(crate) fn atan<R: Real>(x: R) -> R {
    let m = x.abs();
    let is_large = m.gt(1.0);
    let a = atan_to_one(R::select(is_large, 1.0 / m, m));
    with_sign(R::select(is_large, FRAC_PI_2 - a, a), x)
}

/// The angle of the point (x, y).
///
/// With n and d the smaller and the greater of |x| and |y|: a = atan(n ÷ d), where 0 ÷ 0 counts as
/// 0 and ∞ ÷ ∞ as 1. The angle to the x axis is a, or π/2 − a if |y| > |x|; that to the positive x
/// axis is π minus it if x has the sign bit. The sign is that of y.
#[inline(always)]
pub(crate) fn atan2<R: Real>(y: R, x: R) -> R {
    let (x_size, y_size) = (x.abs(), y.abs());
    let is_steep = y_size.gt(x_size);
    let n = R::select(is_steep, x_size, y_size);
    let d = R::select(is_steep, y_size, x_size);
    let equal = R::select(d.eq(0.0), d, d.splat(1.0));
    let a = atan_to_one(R::select(n.eq(d), equal, n / d));
    let to_axis = R::select(is_steep, FRAC_PI_2 - a, a);
    let is_left = x.to_bits().lt(x.splat_int(0));
    with_sign(R::select(is_left, PI - to_axis, to_axis), y)
}

/// atan t for t in 0..=1: t + t·z·p(z), z = t², where p is the minimax polynomial of degree 8
/// (relative error 9·10⁻⁹). NaN stays NaN.
///
/// (A second reduction at tan(π/8) needs four coefficients less, and a division more.)
#[inline(always)]
fn atan_to_one<R: Real>(t: R) -> R {
    let z = t * t;
    let mut sum = z * -1.793_627_2e-3 + 1.091_463_3e-2;
    sum = sum * z - 3.117_790_3e-2;
    sum = sum * z + 5.795_765_7e-2;
    sum = sum * z - 8.403_455e-2;
    sum = sum * z + 1.095_218_7e-1;
    sum = sum * z - 1.426_424_2e-1;
    sum = sum * z + 1.999_854_9e-1;
    sum = sum * z - 3.333_33e-1;
    sum * z * t + t
}
