//! Normalised integers: unorm codes stand for 0..=1, snorm codes for −1..=1.
//!
//! `most` is the greatest code: 2ⁿ − 1 of a unorm channel with n bits, 2ⁿ⁻¹ − 1 of a snorm channel.
//! A unorm code is ⌊x·most + ½⌋, two operations in f32; a snorm code is the integer nearest to
//! x·most, ties to even, because the floor of negative numbers takes four instructions and nearest
//! takes two. n is at most 16, so both are below 2¹⁷ in magnitude: they fit an i32, and conversions
//! between the two are exact.

use estampe_simd::{
    Lanes, Select, SimdBase, SimdCvtFloat, SimdCvtTruncate, f32x16, i32x16, outline,
};

/// Confines a number to 0..=1; NaN gives 0.
#[inline(always)]
#[must_use]
pub fn saturate(value: f32) -> f32 {
    let positive = if value > 0.0 { value } else { 0.0 };
    if positive < 1.0 { positive } else { 1.0 }
}

/// [`saturate`] of sixteen lanes.
#[inline(always)]
pub fn saturate_lanes<S: Lanes>(s: S, value: f32x16<S>) -> f32x16<S> {
    let zero = <f32x16<S> as SimdBase<S>>::splat(s, 0.0);
    let one = <f32x16<S> as SimdBase<S>>::splat(s, 1.0);
    s.min_f32(s.max_f32(value, zero), one)
}

/// The unorm code of a number, 0..=most.
#[inline(always)]
#[must_use]
pub fn encode_unorm(value: f32, most: f32) -> i32 {
    floor_to_int(saturate(value) * most + 0.5)
}

/// [`encode_unorm`] of sixteen lanes.
#[inline(always)]
pub fn encode_unorm_lanes<S: Lanes>(s: S, value: f32x16<S>, most: f32) -> i32x16<S> {
    outline!(s, { code_of_positive(saturate_lanes(s, value) * most) })
}

/// The nearest codes of numbers in code units, at least 0 and less than 2³¹: ⌊x + ½⌋.
///
/// Truncation is the floor of what is not negative.
#[inline(always)]
pub fn code_of_positive<S: Lanes>(value: f32x16<S>) -> i32x16<S> {
    i32x16::truncate_from(value + 0.5)
}

/// The snorm code of a number, −most..=most; NaN gives 0.
#[inline(always)]
#[must_use]
#[expect(
    clippy::cast_possible_truncation,
    reason = "codes have at most 16 bits"
)]
pub fn encode_snorm(value: f32, most: f32) -> i32 {
    let value = if value.is_nan() { 0.0 } else { value };
    let above = if value > -1.0 { value } else { -1.0 };
    let confined = if above < 1.0 { above } else { 1.0 };
    (confined * most).round_ties_even() as i32
}

/// [`encode_snorm`] of sixteen lanes.
#[inline(always)]
pub fn encode_snorm_lanes<S: Lanes>(s: S, value: f32x16<S>, most: f32) -> i32x16<S> {
    outline!(s, {
        let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
        let number = value.simd_eq(value).select(value, splat(0.0));
        let confined = s.min_f32(s.max_f32(number, splat(-1.0)), splat(1.0));
        s.round_to_i32(confined * most)
    })
}

/// The number of a unorm code: `code·unit`, `unit` being 1/most rounded to f32.
#[inline(always)]
#[must_use]
pub fn decode_unorm(code: i32, unit: f32) -> f32 {
    code as f32 * unit
}

/// [`decode_unorm`] of sixteen lanes.
#[inline(always)]
pub fn decode_unorm_lanes<S: Lanes>(code: i32x16<S>, unit: f32) -> f32x16<S> {
    f32x16::float_from(code) * unit
}

/// The number of a snorm code: `max(code·unit, −1)`, `unit` being 1/most rounded to f32.
#[inline(always)]
#[must_use]
pub fn decode_snorm(code: i32, unit: f32) -> f32 {
    let value = code as f32 * unit;
    if value > -1.0 { value } else { -1.0 }
}

/// [`decode_snorm`] of sixteen lanes.
#[inline(always)]
pub fn decode_snorm_lanes<S: Lanes>(s: S, code: i32x16<S>, unit: f32) -> f32x16<S> {
    let least = <f32x16<S> as SimdBase<S>>::splat(s, -1.0);
    s.max_f32(f32x16::float_from(code) * unit, least)
}

/// ⌊x⌋ of a number that fits an i32.
#[expect(
    clippy::cast_possible_truncation,
    reason = "codes have at most 16 bits"
)]
#[inline(always)]
fn floor_to_int(value: f32) -> i32 {
    value.floor() as i32
}
