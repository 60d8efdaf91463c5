//! 16-bit floats by their definition (IEEE 754): a number is a whole number of units in the last
//! place, and is rounded as such.

/// The number of a code.
pub(crate) fn decoded(code: u16) -> f64 {
    let sign = if code >> 15 == 1 { -1.0 } else { 1.0 };
    let exponent = i32::from(code >> 10 & 31);
    let fraction = f64::from(code & 1023);
    sign * match exponent {
        31 if fraction == 0.0 => f64::INFINITY,
        31 => f64::NAN,
        // Units of 2⁻²⁴.
        0 => fraction * 2.0_f64.powi(-24),
        _ => (1024.0 + fraction) * 2.0_f64.powi(exponent - 25),
    }
}

/// The code of the nearest 16-bit float, of ties that with an even code. 0x7E00 for NaN.
pub(crate) fn encoded(number: f64) -> u16 {
    let sign = if number.is_sign_negative() { 0x8000 } else { 0 };
    let size = number.abs();
    if size.is_nan() {
        return 0x7E00;
    }
    // Half a unit above the largest number, and more.
    if size >= 65520.0 {
        return sign | 0x7C00;
    }
    let mut exponent = -14;
    while size >= 2.0_f64.powi(exponent + 1) {
        exponent += 1;
    }
    let units = (size * 2.0_f64.powi(10 - exponent)).round_ties_even();
    // Up to 1023 units of the least exponent are denormal; 2048 are 1024 of the next exponent.
    let code = f64::from((exponent + 14) * 1024) + units;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a whole number below 31744"
    )]
    let code = code as u16;
    sign | code
}

/// A number rounded to 16 bits.
pub(crate) fn rounded(number: f64) -> f64 {
    decoded(encoded(number))
}

#[test]
fn codes_are_those_of_their_numbers() {
    for code in 0..=u16::MAX {
        let number = decoded(code);
        if !number.is_nan() {
            assert_eq!(encoded(number), code, "{number}");
        }
    }
    assert_eq!(encoded(65519.99), 0x7BFF);
    assert_eq!(encoded(-65520.0), 0xFC00);
    // Ties: half of the least denormal, and between 1 and the next number.
    assert_eq!(encoded(2.0_f64.powi(-25)), 0);
    assert_eq!(encoded(2.0_f64.powi(-25) * 1.000_001), 1);
    assert_eq!(encoded(1.0 + 2.0_f64.powi(-11)), 0x3C00);
    assert_eq!(encoded(1.0 + 3.0 * 2.0_f64.powi(-11)), 0x3C02);
}
