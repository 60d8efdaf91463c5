//! The sRGB transfer function (IEC 61966-2-1), by tables of the oracle's own.
//!
//! In · Out: 8-bit codes · linear values. Precision: NUMERICS.md, *Formats*.
//!
//! An encoded value e above 0.04045 decodes to s^2.4 with s = (e + 0.055) ÷ 1.055. No power is
//! computed: x = s^2.4 exactly where x⁵ = s¹², and both sides are products of f64. The tables are
//! found by bisection over the f32 numbers. The relative error of the products is below 20 · 2⁻⁵³;
//! neighbouring f32 differ by 2⁻²⁴, so their fifth powers differ by at least 5 · 2⁻²⁴: a wrong
//! decision needs a boundary within a hundred-millionth of an f32.

use std::sync::LazyLock;

/// The function is linear up to this encoded value.
const LINE_ENDS: f64 = 0.040_45;

/// The linear value of each code, as the nearest f32.
static LINEAR: LazyLock<[f32; 256]> =
    LazyLock::new(|| std::array::from_fn(|code| nearest(code as f64 / 255.0)));

/// Threshold k is the least f32 that encodes to k + 1: the first f32 at or above the linear value
/// of the code boundary (k + ½) ÷ 255.
pub static THRESHOLDS: LazyLock<[f32; 255]> =
    LazyLock::new(|| std::array::from_fn(|code| first_at_or_above((code as f64 + 0.5) / 255.0)));

/// The linear value of a code; only its low 8 bits are used.
#[must_use]
pub fn linear(code: u32) -> f32 {
    LINEAR[code as usize & 0xFF]
}

/// The code of a linear value: the number of thresholds at or below it. NaN gives 0.
#[must_use]
pub fn code(linear: f32) -> u8 {
    let below = THRESHOLDS.partition_point(|&threshold| threshold <= linear);
    u8::try_from(below).expect("there are 255 thresholds")
}

/// The f32 nearest to the linear value of `encoded`.
fn nearest(encoded: f64) -> f32 {
    let above = first_at_or_above(encoded);
    if above == 0.0 {
        return above;
    }
    let below = above.next_down();
    // The midpoint of two neighbouring f32 is exact in f64.
    let middle = f64::midpoint(below.into(), above.into());
    if is_at_or_above(middle, encoded) {
        below
    } else {
        above
    }
}

/// The least f32 in 0..=1 that is at or above the linear value of `encoded`, which is in 0..=1.
fn first_at_or_above(encoded: f64) -> f32 {
    // Non-negative f32 are ordered as their bits are.
    let (mut first, mut last) = (0.0_f32.to_bits(), 1.0_f32.to_bits());
    while first < last {
        let middle = first.midpoint(last);
        if is_at_or_above(f32::from_bits(middle).into(), encoded) {
            last = middle;
        } else {
            first = middle + 1;
        }
    }
    f32::from_bits(first)
}

/// Returns true if `linear` is at or above the linear value of `encoded`.
fn is_at_or_above(linear: f64, encoded: f64) -> bool {
    if encoded <= LINE_ENDS {
        return linear * 12.92 >= encoded;
    }
    let s = (encoded + 0.055) / 1.055;
    let fifth_power = (linear * linear) * (linear * linear) * linear;
    let fourth = (s * s) * (s * s);
    fifth_power >= fourth * fourth * fourth
}
