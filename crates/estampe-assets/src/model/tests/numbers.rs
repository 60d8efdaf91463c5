//! Numbers are rounded as by the standard library.

use crate::model::number::{leading_digits, parse_f32, parse_i64, parse_usual_f32};
use crate::model::srgb::{linear_from_srgb, linear_from_srgb8};
use fastrand::Rng;

fn assert_as_standard(text: &str) {
    let expected: f32 = text.parse().unwrap();
    let (value, length) = parse_f32(text.as_bytes()).unwrap_or_else(|| panic!("{text}"));
    assert_eq!(length, text.len(), "{text}");
    assert_eq!(
        value.to_bits(),
        expected.to_bits(),
        "{text}: {value:e}, not {expected:e}"
    );
    // What follows the number makes no difference.
    for rest in [" 12345678", "\n", "/3456789012345", "x1234567"] {
        let longer = format!("{text}{rest}");
        assert_eq!(
            parse_f32(longer.as_bytes()).map(|(value, length)| (value.to_bits(), length)),
            Some((value.to_bits(), length)),
            "{longer}"
        );
        if let Some((usual, at)) = parse_usual_f32(longer.as_bytes())
            && at == length
        {
            assert_eq!(usual.to_bits(), expected.to_bits(), "{longer}");
        }
    }
}

#[test]
fn usual_numbers_are_read_at_once() {
    for (text, value, length) in [
        ("1.500000 0.1", 1.5, 8),
        ("-0.25\n0123456", -0.25, 5),
        ("0 000000000", 0.0, 1),
        ("-0.000000 9999", -0.0, 9),
        ("9999999.9999999 12", 9_999_999.9999999, 15),
        ("12. 345678901", 12.0, 3),
    ] {
        let (found, at) = parse_usual_f32(text.as_bytes()).unwrap_or_else(|| panic!("{text}"));
        assert_eq!(
            (found.to_bits(), at),
            (f32::to_bits(value), length),
            "{text}"
        );
    }
    for text in [
        "",
        "-",
        ".5 1234567",
        "12345678 123456789",
        "1.12345678 1234567",
        "1",
        "+1 23456789",
    ] {
        assert_eq!(parse_usual_f32(text.as_bytes()), None, "{text}");
    }
}

#[test]
fn leading_digits_end_at_any_other_byte() {
    for other in (0..=255).filter(|byte: &u8| !byte.is_ascii_digit()) {
        for count in 0..8 {
            let mut text = *b"98765432";
            text[count..].fill(other);
            let value = (0..count).fold(0, |value, at| value * 10 + u64::from(text[at] - b'0'));
            assert_eq!(leading_digits(&text), Some((value, count)), "{text:?}");
            // Digits after it are not read.
            if count < 7 {
                text[count + 1..].fill(b'7');
                assert_eq!(leading_digits(&text), Some((value, count)), "{text:?}");
            }
        }
    }
    assert_eq!(leading_digits(b"00120034x"), Some((120_034, 8)));
    assert_eq!(leading_digits(b"1234567"), None);
}

#[test]
fn decimals_are_rounded_as_by_the_standard_library() {
    let cases = [
        "0",
        "-0",
        "1",
        "-1",
        "+1.5",
        ".5",
        "-.7e+2",
        ".8e-1",
        "5.",
        "1e-06",
        "0.08156099999999999",
        "16777217",
        "16777216.9999999999",
        "33554433",
        "1.00000005960464477539062500",
        "3.4028235e38",
        "3.4028236e38",
        "1e39",
        "-1e400",
        "1e-45",
        "7e-46",
        "1.17549435e-38",
        "1.1754942e-38",
        "0.000000000000000000000000000000000000000000001",
        "1e-400",
        "123456789012345678901234567890",
        "9999999999999999999",
        "18446744073709551616",
        "0e999999999999999999",
        "8388608.5",
        "8388609.5",
        "1e22",
        "1e23",
        "00000000000000000000001.5",
    ];
    for text in cases {
        assert_as_standard(text);
    }
}

#[test]
fn random_decimals_are_rounded_as_by_the_standard_library() {
    let mut random = Rng::with_seed(1);
    for _ in 0..200_000 {
        let bits = random.u32(..);
        let value = f32::from_bits(bits);
        if value.is_finite() {
            assert_as_standard(&format!("{value}"));
            assert_as_standard(&format!("{value:e}"));
            assert_as_standard(&format!("{value:.6}"));
        }
        let whole = random.u64(..) >> random.u32(..64);
        let exponent = random.i64(-50..40);
        assert_as_standard(&format!("{whole}e{exponent}"));
        assert_as_standard(&format!(
            "{}.{}",
            whole % 100_000,
            random.u32(..1_000_000_000)
        ));
    }
}

/// Points midway between two floats, and their neighbours in the last of 20 digits.
#[test]
fn midpoints_are_rounded_as_by_the_standard_library() {
    let mut random = Rng::with_seed(2);
    for _ in 0..20_000 {
        let bits = 0x3f80_0000 + random.u32(..0x0100_0000);
        let [low, high] = [bits, bits + 1].map(|bits| f64::from(f32::from_bits(bits)));
        let middle = format!("{:.30}", f64::midpoint(low, high));
        assert_as_standard(&middle);
        assert_as_standard(&format!("{middle}1"));
        assert_as_standard(&middle[..18]);
    }
}

#[test]
fn named_values_are_numbers() {
    for text in [
        "nan",
        "NaN",
        "-nan",
        "-nan(ind)",
        "1.#QNAN",
        "-1.#IND",
        "1.#IND00",
    ] {
        let (value, length) = parse_f32(text.as_bytes()).unwrap();
        assert!(value.is_nan(), "{text}");
        assert_eq!(length, text.len(), "{text}");
    }
    assert_eq!(parse_f32(b"inf 1"), Some((f32::INFINITY, 3)));
    assert_eq!(parse_f32(b"-Infinity"), Some((f32::NEG_INFINITY, 9)));
    assert_eq!(parse_f32(b"-1.#INF"), Some((f32::NEG_INFINITY, 7)));
    for text in ["", "-", "+", ".", "e5", "abc", "#", "--1", "-#"] {
        assert_eq!(parse_f32(text.as_bytes()), None, "{text}");
    }
    assert_eq!(parse_f32(b"1e"), Some((1.0, 1)), "an exponent needs digits");
}

#[test]
fn integers_saturate() {
    assert_eq!(parse_i64(b"-12/3"), Some((-12, 3)));
    assert_eq!(parse_i64(b"99999999999999999999"), Some((i64::MAX, 20)));
    assert_eq!(parse_i64(b"-99999999999999999999"), Some((-i64::MAX, 21)));
    assert_eq!(parse_i64(b"-"), None);
    assert_eq!(parse_i64(b"x"), None);
}

#[test]
fn srgb_has_its_fixed_points_and_its_middle() {
    assert_eq!(linear_from_srgb(0.0), 0.0);
    assert!((linear_from_srgb(1.0) - 1.0).abs() < 1e-6);
    assert!((linear_from_srgb(0.5) - 0.214_041_14).abs() < 1e-6);
    assert_eq!(linear_from_srgb(-3.0), 0.0);
    assert_eq!(linear_from_srgb(f32::NAN), 0.0);
    assert_eq!(linear_from_srgb8(188), linear_from_srgb(188.0 / 255.0));
}
