//! The functions keep the errors that they state, and their special values.

use super::every_size;
use crate::maths::*;
use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};

const INF: f32 = f32::INFINITY;

/// The distance between f32 at a number's magnitude.
fn ulp(number: f64) -> f64 {
    let least = f64::from(f32::MIN_POSITIVE);
    let exponent = (number.abs().max(least).to_bits() >> 52) as i32 - 1023;
    2f64.powi(exponent - 23)
}

/// Every 1009th f32 in a range, a million for each sign and 30 binades.
fn dense(low: f32, high: f32) -> impl Iterator<Item = f32> {
    (0..=u32::MAX)
        .step_by(1009)
        .map(f32::from_bits)
        .filter(move |x| (low..=high).contains(x))
}

/// Checks a function's greatest error in ulp of the exact result.
fn within(bound: f64, [low, high]: [f32; 2], f: fn(f32) -> f32, exact: fn(f64) -> f64) {
    let (mut worst, mut at) = (0.0, 0.0);
    for x in dense(low, high) {
        let exact = exact(f64::from(x));
        let error = (f64::from(f(x)) - exact).abs() / ulp(exact);
        // A NaN counts as an error.
        if error > worst || error.is_nan() {
            (worst, at) = (error, x);
        }
    }
    assert!(worst <= bound, "{worst} ulp at {at:e}, not {bound}");
    assert!(
        worst > bound * 0.4,
        "the bound {bound} is far above {worst} ulp"
    );
}

/// Checks results to the bit; all NaN are equal.
fn gives(f: fn(f32) -> f32, cases: &[(f32, f32)]) {
    for &(x, wanted) in cases {
        let got = f(x);
        let same = got.to_bits() == wanted.to_bits() || got.is_nan() && wanted.is_nan();
        assert!(same, "f({x:e}) = {got:e}, not {wanted:e}");
    }
    assert!(f(f32::NAN).is_nan());
}

#[test]
fn errors_are_within_the_stated_ulps() {
    within(9.0, [-PI, PI], tan, libm::tan);
    within(2.5, [-1.0, 1.0], asin, libm::asin);
    within(1.5, [-1.0, 1.0], acos, libm::acos);
    within(2.0, [f32::MIN, f32::MAX], atan, libm::atan);
    within(2.0, [-89.4, 89.4], sinh, libm::sinh);
    within(2.0, [-89.4, 89.4], cosh, libm::cosh);
    within(1.5, [f32::MIN, f32::MAX], tanh, libm::tanh);
    within(2.0, [f32::MIN_POSITIVE, f32::MAX], log, libm::log);
    within(3.0, [f32::MIN_POSITIVE, f32::MAX], log2, libm::log2);
    within(2.0, [-126.0, 127.99], exp2, libm::exp2);
    within(1.0, [-87.3, 88.7], exp, libm::exp);
    within(1.5, [f32::MIN_POSITIVE, f32::MAX], inverse_sqrt, |x| {
        1.0 / x.sqrt()
    });
    within(1.0, [-1e30, 1e30], radians, |x| {
        x * (std::f64::consts::PI / 180.0)
    });
    within(1.0, [-1e30, 1e30], degrees, |x| {
        x * (180.0 / std::f64::consts::PI)
    });
}

#[test]
fn cos_is_as_exact_as_it_says() {
    let steps = (-820_000..=820_000).map(|step| step as f32 * 0.0025);
    for x in steps
        .chain(dense(-2048.0, 2048.0))
        .filter(|x| x.abs() <= 2048.0)
    {
        let error = (f64::from(cos(x)) - libm::cos(f64::from(x))).abs();
        assert!(error < 1.5e-7, "cos({x}): error {error:e}");
    }
    for x in every_size() {
        let cosine = cos(x);
        if x.is_finite() {
            assert!((-1.0..=1.0).contains(&cosine), "cos({x}) = {cosine}");
        } else {
            assert!(cosine.is_nan(), "cos({x}) = {cosine}");
        }
    }
}

/// The sine exceeds 1 by one ulp next to some odd multiples of π/2, as documented.
#[test]
fn sin_exceeds_one_at_few_numbers() {
    let around = |x: f32| (x.to_bits() - 2000..x.to_bits() + 2000).map(f32::from_bits);
    let greatest = around(FRAC_PI_2).map(sin).fold(0.0, f32::max);
    assert_eq!(
        (greatest, sin(1.570_668_5)),
        (1.0 + f32::EPSILON, 1.0 + f32::EPSILON)
    );
    let cosines = (0x3700_0000..0x3B00_0000)
        .step_by(101)
        .map(f32::from_bits)
        .map(cos);
    assert_eq!(cosines.fold(0.0, f32::max), 1.0);
}

#[test]
fn atan2_is_as_exact_as_it_says() {
    let mut random = fastrand::Rng::with_seed(7);
    let mut worst = 0.0f64;
    for _ in 0..2_000_000 {
        let y = f32::from_bits(random.u32(..));
        // Half of the points are near a diagonal; others have any direction.
        let scale = f32::from_bits(random.u32(0x3E00_0000..0x4100_0000));
        let x = if random.bool() {
            y * scale
        } else {
            f32::from_bits(random.u32(..))
        };
        if x.is_finite() && y.is_finite() {
            let exact = libm::atan2(f64::from(y), f64::from(x));
            let error = (f64::from(atan2(y, x)) - exact).abs() / ulp(exact);
            assert!(error < 2.0, "atan2({y:e}, {x:e}): {error} ulp");
            worst = worst.max(error);
        }
    }
    assert!(worst > 1.0, "{worst}");
}

#[test]
fn special_values_of_angles() {
    gives(
        sin,
        &[
            (0.0, 0.0),
            (-0.0, 0.0),
            (FRAC_PI_2, 1.0),
            (1e-40, 1e-40),
            (-INF, f32::NAN),
        ],
    );
    gives(
        cos,
        &[
            (0.0, 1.0),
            (-0.0, 1.0),
            (PI, -1.0),
            (1e-40, 1.0),
            (INF, f32::NAN),
        ],
    );
    gives(
        tan,
        &[(0.0, 0.0), (-0.0, 0.0), (1e-40, 1e-40), (INF, f32::NAN)],
    );
    gives(
        asin,
        &[
            (0.0, 0.0),
            (-0.0, -0.0),
            (1.0, FRAC_PI_2),
            (-1.0, -FRAC_PI_2),
            (1e-40, 1e-40),
        ],
    );
    gives(
        asin,
        &[(1.000_000_1, f32::NAN), (-2.0, f32::NAN), (INF, f32::NAN)],
    );
    gives(
        acos,
        &[(1.0, 0.0), (-1.0, PI), (0.0, FRAC_PI_2), (-0.0, FRAC_PI_2)],
    );
    gives(
        acos,
        &[(-1.000_000_1, f32::NAN), (2.0, f32::NAN), (-INF, f32::NAN)],
    );
    gives(
        atan,
        &[
            (0.0, 0.0),
            (-0.0, -0.0),
            (1e-40, 1e-40),
            (INF, FRAC_PI_2),
            (-INF, -FRAC_PI_2),
        ],
    );
    assert!((atan(1.0f32) - FRAC_PI_4).abs() < 1e-7);
}

#[test]
fn special_values_of_atan2_are_those_of_ieee_754() {
    let quarter = atan(1.0f32);
    for (y, x, wanted) in [
        (0.0, 0.0, 0.0),
        (-0.0, 0.0, -0.0),
        (0.0, -0.0, PI),
        (-0.0, -0.0, -PI),
        (0.0, 2.0, 0.0),
        (-0.0, -2.0, -PI),
        (3.0, 0.0, FRAC_PI_2),
        (-3.0, -0.0, -FRAC_PI_2),
        (INF, 1.0, FRAC_PI_2),
        (1.0, INF, 0.0),
        (-1.0, INF, -0.0),
        (1.0, -INF, PI),
        (INF, INF, quarter),
        (-INF, INF, -quarter),
        (INF, -INF, PI - quarter),
        (1e-40, 1e-40, quarter),
    ] {
        let got: f32 = atan2(y, x);
        assert_eq!(
            got.to_bits(),
            f32::to_bits(wanted),
            "atan2({y}, {x}) = {got}, not {wanted}"
        );
    }
    assert!(atan2(f32::NAN, 1.0).is_nan() && atan2(1.0, f32::NAN).is_nan());
}

#[test]
fn special_values_of_exponentials() {
    gives(
        exp,
        &[
            (0.0, 1.0),
            (-0.0, 1.0),
            (INF, INF),
            (-INF, 0.0),
            (89.0, INF),
            (-110.0, 0.0),
        ],
    );
    gives(
        exp2,
        &[
            (0.0, 1.0),
            (-0.0, 1.0),
            (INF, INF),
            (-INF, 0.0),
            (128.0, INF),
            (-127.0, 0.0),
        ],
    );
    gives(
        log,
        &[
            (1.0, 0.0),
            (INF, INF),
            (0.0, -INF),
            (-0.0, -INF),
            (1e-40, -INF),
        ],
    );
    gives(log, &[(-1.0, f32::NAN), (-INF, f32::NAN)]);
    gives(
        log2,
        &[
            (1.0, 0.0),
            (8.0, 3.0),
            (INF, INF),
            (0.0, -INF),
            (-0.0, -INF),
            (1e-40, -INF),
        ],
    );
    gives(log2, &[(-1.0, f32::NAN), (-INF, f32::NAN)]);
    gives(
        sinh,
        &[
            (0.0, 0.0),
            (-0.0, -0.0),
            (1e-40, 1e-40),
            (INF, INF),
            (-INF, -INF),
            (90.0, INF),
        ],
    );
    gives(
        cosh,
        &[
            (0.0, 1.0),
            (-0.0, 1.0),
            (INF, INF),
            (-INF, INF),
            (-90.0, INF),
        ],
    );
    gives(
        tanh,
        &[
            (0.0, 0.0),
            (-0.0, -0.0),
            (1e-40, 1e-40),
            (INF, 1.0),
            (-INF, -1.0),
            (20.0, 1.0),
        ],
    );
    for (x, y, wanted) in [
        (0.0, 2.0, 0.0),
        (0.0, 0.0, 1.0),
        (3.0, 0.0, 1.0),
        (0.0, -1.0, INF),
        (INF, 2.0, INF),
        (2.0, -INF, 0.0),
    ] {
        assert_eq!(pow(x, y), wanted, "pow({x}, {y})");
    }
    assert!(pow(-8.0f32, 3.0).is_nan() && pow(1.0f32, INF).is_nan());
}

#[test]
fn special_values_of_roundings() {
    let odd = 8_388_607.0;
    gives(
        round,
        &[
            (0.5, 0.0),
            (1.5, 2.0),
            (2.5, 2.0),
            (-0.5, -0.0),
            (-1.5, -2.0),
            (-0.0, -0.0),
        ],
    );
    gives(
        round,
        &[
            (odd - 0.5, odd - 1.0),
            (1e30, 1e30),
            (INF, INF),
            (-INF, -INF),
            (1e-40, 0.0),
        ],
    );
    gives(
        trunc,
        &[
            (1.9, 1.0),
            (-1.9, -1.0),
            (-0.5, -0.0),
            (0.0, 0.0),
            (INF, INF),
            (-INF, -INF),
        ],
    );
    gives(
        ceil,
        &[
            (1.1, 2.0),
            (-1.1, -1.0),
            (-0.5, -0.0),
            (0.0, 0.0),
            (1e-40, 1.0),
            (INF, INF),
        ],
    );
    gives(
        floor,
        &[
            (1.1, 1.0),
            (-1.1, -2.0),
            (-0.0, -0.0),
            (-1e-40, -1.0),
            (-INF, -INF),
        ],
    );
    gives(
        sign,
        &[
            (3.0, 1.0),
            (-3.0, -1.0),
            (0.0, 0.0),
            (-0.0, -0.0),
            (1e-40, 1.0),
            (-INF, -1.0),
        ],
    );
    gives(
        fract,
        &[(1.25, 0.25), (-1.25, 0.75), (0.0, 0.0), (INF, f32::NAN)],
    );
    gives(
        inverse_sqrt,
        &[
            (4.0, 0.5),
            (0.0, INF),
            (-0.0, -INF),
            (INF, 0.0),
            (-1.0, f32::NAN),
        ],
    );
    for x in dense(f32::MIN, f32::MAX) {
        assert_eq!(
            round(x).to_bits(),
            x.round_ties_even().to_bits(),
            "round({x:e})"
        );
        assert_eq!(trunc(x).to_bits(), f32::trunc(x).to_bits(), "trunc({x:e})");
        assert_eq!(ceil(x).to_bits(), f32::ceil(x).to_bits(), "ceil({x:e})");
    }
}

#[test]
fn remainders_have_the_signs_of_wgsl_and_glsl() {
    for (x, y, trunc, floor) in [
        (5.5, 3.0, 2.5, 2.5),
        (-5.5, 3.0, -2.5, 0.5),
        (5.5, -3.0, 2.5, -0.5),
        (-5.5, -3.0, -2.5, -2.5),
    ] {
        assert_eq!(remainder(x, y), trunc, "{x} % {y}");
        assert_eq!(modulo(x, y), floor, "mod({x}, {y})");
    }
    assert!(remainder(1.0f32, 0.0).is_nan() && modulo(INF, 2.0).is_nan());
}

#[test]
fn functions_of_ranges_are_those_of_wgsl() {
    assert_eq!(
        (step(0.5f32, 0.5), step(0.5f32, 0.4), step(0.5f32, f32::NAN)),
        (1.0, 0.0, 0.0)
    );
    for (x, wanted) in [
        (-1.0, 0.0),
        (0.0, 0.0),
        (0.5, 0.15625),
        (1.0, 0.5),
        (2.0, 1.0),
        (9.0, 1.0),
    ] {
        assert_eq!(smoothstep(0.0, 2.0, x), wanted, "smoothstep of {x}");
    }
    assert_eq!(smoothstep(2.0, 0.0, 2.5f32), 0.0, "a falling edge");
    assert_eq!(smoothstep(1.0, 1.0, 1.0f32), 0.0, "an edge without width");
    assert_eq!(
        (
            mix(2.0, 4.0, 0.0),
            mix(2.0, 4.0, 0.25f32),
            mix(2.0, 4.0, 1.0)
        ),
        (2.0, 2.5, 4.0)
    );
    assert_eq!(clamp(f32::NAN, 1.0, 2.0), 1.0);
    assert_eq!(
        (saturate(f32::NAN), saturate(-1.0f32), saturate(INF)),
        (0.0, 0.0, 1.0)
    );
    assert_eq!(
        (min(f32::NAN, 1.0), max(1.0, f32::NAN).is_nan()),
        (1.0, true)
    );
    assert_eq!(
        (select(1.0, 2.0, true), select(1.0f32, 2.0, false)),
        (2.0, 1.0)
    );
    assert_eq!((radians(180.0f32), degrees(PI)), (PI, 180.0));
}
