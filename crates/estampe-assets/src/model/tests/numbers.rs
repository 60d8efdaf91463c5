//! Numbers are rounded as by the standard library.

use crate::model::number::{parse_f32, parse_i64};
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
