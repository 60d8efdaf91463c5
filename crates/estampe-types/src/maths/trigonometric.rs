//! Sine, cosine and tangent, and the units of angles.

use super::rounding::ROUNDING;
use crate::{Int, Real};

/// π in two parts, the first of which has 8 bits.
const PI_PARTS: [f32; 2] = [3.140_625, 9.676_536e-4];

/// sin x of an angle in radians, within 1.5·10⁻⁷ for |x| ≤ 2048. Beyond, the error grows with the
/// distance between neighbouring f32. Infinity and NaN give NaN; ±0 give 0.
///
/// Finite x give numbers in −1..=1, except for 29 f32 and their negatives, which are next to odd
/// multiples of π/2 and give ±(1 + 2⁻²³). The first is 1.5706685. ([`cos`] clamps its result; a
/// clamp here would change pictures.)
///
/// x = k·π + r with k the nearest integer to x/π, |r| ≤ π/2; sin x = (−1)^k·sin r. π is subtracted
/// in two parts (Cody and Waite 1980), the first of which has so few bits that k times it is exact.
/// sin r = r + r³·p(r²), where p is the minimax polynomial of degree 3 (error 5·10⁻⁹). Its upper
/// and lower half are evaluated side by side, because the latency of sines limits programs more
/// than their throughput.
#[inline(always)]
pub(crate) fn sin<R: Real>(x: R) -> R {
    let rounded = x * std::f32::consts::FRAC_1_PI + ROUNDING;
    let k = rounded - ROUNDING;
    let r = x - k * PI_PARTS[0] - k * PI_PARTS[1];
    let sine = sin_near_zero(r);
    // The lowest bit of k flips the sign.
    (sine.to_bits() ^ (rounded.to_bits() << 31)).to_real_bits()
}

/// cos x of an angle in radians, within 1.5·10⁻⁷ for |x| ≤ 2048; beyond as [`sin`]. cos 0 = 1.
///
/// x = (k + ½)·π + r with k the integer nearest to x/π − ½, |r| ≤ π/2; cos x = −(−1)^k·sin r, with
/// the same parts of π and the same polynomial as [`sin`], clamped to −1..=1. (A polynomial of cos
/// r about multiples of π was rejected: its relative error is unbounded where the cosine is 0.)
#[inline(always)]
pub(crate) fn cos<R: Real>(x: R) -> R {
    let rounded = (x * std::f32::consts::FRAC_1_PI - 0.5) + ROUNDING;
    let k = (rounded - ROUNDING) + 0.5;
    let r = x - k * PI_PARTS[0] - k * PI_PARTS[1];
    let sine = sin_near_zero(-r);
    // In this order of operands NaN stays NaN.
    let sine = r.splat(-1.0).max(r.splat(1.0).min(sine));
    (sine.to_bits() ^ (rounded.to_bits() << 31)).to_real_bits()
}

/// sin r for |r| ≤ π/2. Larger r is clamped to −2..=2; NaN stays NaN.
#[inline(always)]
fn sin_near_zero<R: Real>(r: R) -> R {
    // If x is too large for a remainder, r is clamped. In this order of operands NaN stays NaN.
    let r = r.splat(-2.0).max(r.splat(2.0).min(r));
    let r2 = r * r;
    let upper = r2 * 2.599_903_4e-6 - 1.980_654_8e-4;
    let lower = r2 * 8.333_016e-3 - 1.666_665_7e-1;
    (upper * (r2 * r2) + lower) * (r2 * r) + r
}

/// tan x = sin x ÷ cos x, as WGSL defines its accuracy.
#[inline(always)]
pub(crate) fn tan<R: Real>(x: R) -> R {
    sin(x) / cos(x)
}

/// Degrees to radians.
#[inline(always)]
pub(crate) fn radians<R: Real>(x: R) -> R {
    x * 0.017_453_292
}

/// Radians to degrees.
#[inline(always)]
pub(crate) fn degrees<R: Real>(x: R) -> R {
    x * 57.295_78
}
