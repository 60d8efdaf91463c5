//! Minimum, maximum, clamping and rounding as NUMERICS.md defines them, where Rust's functions
//! differ.

/// `a < b ? a : b`: b where either is NaN. (`f32::min` would give the number.)
#[must_use]
pub fn min(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// `a > b ? a : b`: b where either is NaN. (`f32::max` would give the number.)
#[must_use]
pub fn max(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// `max(low)`, then `min(high)`; NaN gives `low`.
#[must_use]
pub fn clamp(value: f32, low: f32, high: f32) -> f32 {
    min(max(value, low), high)
}

/// The nearest integer, ties to even. It saturates at the ends of `i32`; NaN gives 0.
#[must_use]
#[expect(
    clippy::cast_possible_truncation,
    reason = "`as` saturates, as promised"
)]
pub fn round_half_even(value: f32) -> i32 {
    value.round_ties_even() as i32
}

/// ⌊a ÷ b⌋ of integers; b is not 0.
#[must_use]
pub fn floor_div(a: i128, b: i128) -> i128 {
    let (quotient, remainder) = (a / b, a % b);
    if remainder != 0 && (remainder < 0) != (b < 0) {
        quotient - 1
    } else {
        quotient
    }
}
