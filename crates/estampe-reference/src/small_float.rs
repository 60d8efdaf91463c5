//! Encoding and decoding of floats of 16, 11 and 10 bits: 5 bits of exponent, 10, 6 or 5 of
//! mantissa.
//!
//! In · Out: f32 numbers · codes. Precision: to nearest, ties to even; decoding is exact. Spec:
//! NUMERICS.md, *Formats*; IEEE 754 binary16; Khronos Data Format Specification 1.3, chapter 11
//! (the unsigned ones).
//! IEEE 754 binary16; Khronos Data Format Specification 1.3, chapter 11 (the unsigned ones).
//!
//! ```text
//!   exponent field 0       mantissa · 2^(−14 − bits)                      denormals
//!   exponent field e       (2^bits + mantissa) · 2^(e − 15 − bits)
//!   exponent field 31      infinity (mantissa 0) or NaN
//! ```

/// The least exponent of a normal number; denormals are multiples of the same unit.
const LEAST_EXPONENT: i32 = -14;

/// The exponent field of infinity and NaN.
const NOT_FINITE: u32 = 31;

/// Encodes a half float.
#[must_use]
pub fn half_code(value: f32) -> u32 {
    if value.is_nan() {
        return 0x7E00;
    }
    let sign = u32::from(value.is_sign_negative()) << 15;
    let infinite = NOT_FINITE << 10;
    let magnitude = if value.is_infinite() {
        infinite
    } else {
        rounded(value.abs(), 10).min(infinite)
    };
    sign | magnitude
}

/// Decodes a half float.
#[must_use]
pub fn half_value(code: u32) -> f32 {
    let magnitude = value_of(code & 0x7FFF, 10);
    if code >> 15 & 1 == 1 {
        -magnitude
    } else {
        magnitude
    }
}

/// Encodes an unsigned float with 6 or 5 bits of mantissa.
#[must_use]
pub fn unsigned_code(value: f32, mantissa_bits: u32) -> u32 {
    let infinite = NOT_FINITE << mantissa_bits;
    if value.is_nan() {
        infinite | 1 << (mantissa_bits - 1)
    } else if value <= 0.0 {
        0
    } else if value.is_infinite() {
        infinite
    } else {
        rounded(value, mantissa_bits).min(infinite - 1)
    }
}

/// Decodes an unsigned float with 6 or 5 bits of mantissa.
#[must_use]
pub fn unsigned_value(code: u32, mantissa_bits: u32) -> f32 {
    value_of(code, mantissa_bits)
}

/// The code of a finite number ≥ 0, as if the exponent field were unlimited.
///
/// With the number's exponent e, but at least the least one, the number is q units of 2^(e − bits).
/// q has one bit more than the mantissa; adding it to the exponent field makes that bit part of the
/// exponent, so a q that was rounded up to 2^(bits + 1) carries into it correctly.
fn rounded(value: f32, mantissa_bits: u32) -> u32 {
    let bits = i32::try_from(mantissa_bits).expect("at most 10");
    let exponent = exponent_of(value).max(LEAST_EXPONENT);
    let units = f64::from(value) / power_of_two(exponent - bits);
    let steps = u32::try_from(exponent - LEAST_EXPONENT).expect("not below the least");
    (steps << mantissa_bits) + whole(units.round_ties_even())
}

fn value_of(code: u32, mantissa_bits: u32) -> f32 {
    let bits = i32::try_from(mantissa_bits).expect("at most 10");
    let (field, mantissa) = (code >> mantissa_bits, code & ((1 << mantissa_bits) - 1));
    let scaled = |units: u32, exponent: i32| {
        // At most 2¹¹ units of 2⁻²⁴ to 2⁵: exact in f32.
        narrow(f64::from(units) * power_of_two(exponent - bits))
    };
    match field {
        0 => scaled(mantissa, LEAST_EXPONENT),
        NOT_FINITE if mantissa == 0 => f32::INFINITY,
        NOT_FINITE => f32::NAN,
        _ => {
            let exponent = i32::try_from(field).expect("5 bits") - 15;
            scaled(mantissa + (1 << mantissa_bits), exponent)
        }
    }
}

/// ⌊log₂ value⌋ of a normal number; −127 for denormals and 0.
fn exponent_of(value: f32) -> i32 {
    i32::try_from(value.to_bits() >> 23 & 0xFF).expect("8 bits") - 127
}

fn power_of_two(exponent: i32) -> f64 {
    if exponent < 0 {
        1.0 / power_of_two(-exponent)
    } else {
        (0..exponent).fold(1.0, |power, _| power * 2.0)
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a whole number of at most 12 bits"
)]
fn whole(value: f64) -> u32 {
    value as u32
}

#[expect(clippy::cast_possible_truncation, reason = "exact")]
fn narrow(value: f64) -> f32 {
    value as f32
}
