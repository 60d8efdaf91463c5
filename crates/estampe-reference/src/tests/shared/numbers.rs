//! The arithmetic of shaders, for `f32` and `Quad`, and the functions of `maths` whose bounds
//! `estampe-types` does not test.

use super::super::*;
use estampe_types::maths;

/// A quad whose four values reveal every wrong neighbour: left top, right top, left bottom, right
/// bottom.
const CORNERS: Quad = Quad([1.0, 3.0, 7.0, 20.0]);

/// Rows: R7.
#[test]
fn derivatives_of_a_quad_by_hand() {
    // 3 − 1 and 20 − 7 along x; 7 − 1 and 20 − 3 along y.
    assert_eq!(CORNERS.ddx().0, [2.0, 2.0, 13.0, 13.0]);
    assert_eq!(CORNERS.ddy().0, [6.0, 17.0, 6.0, 17.0]);
    assert_eq!(CORNERS.ddx_coarse().0, [2.0; 4]);
    assert_eq!(CORNERS.ddy_coarse().0, [6.0; 4]);
    let lanes = [0, 1, 2, 3].map(|lane: u8| CORNERS.quad_lane(lane).0);
    assert_eq!(lanes, [[1.0; 4], [3.0; 4], [7.0; 4], [20.0; 4]]);
    // A single number has no neighbours.
    assert_eq!([5.0_f32.ddx(), 5.0_f32.ddy()], [0.0; 2]);
    assert_eq!([5.0_f32.ddx_coarse(), 5.0_f32.ddy_coarse()], [0.0; 2]);
    assert_eq!(5.0_f32.quad_lane(3), 5.0);
}

const ODD: [f32; 16] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    -2.5,
    2.5,
    1e-40,
    -1e-40,
    3.999_999_8,
    -3.999_999_8,
    16_777_216.0,
    3e9,
    -3e9,
    f32::INFINITY,
    f32::NAN,
];

fn same(got: f32, wanted: f32) {
    assert!(
        got.to_bits() == wanted.to_bits() || got.is_nan() && wanted.is_nan(),
        "{got:e} is not {wanted:e}"
    );
}

/// Checks an operation on two numbers, alone and in each lane of a quad.
fn check(a: f32, b: f32, lone: f32, quads: impl Fn(Quad, Quad) -> Quad, wanted: f32) {
    same(lone, wanted);
    for lane in 0..4 {
        let (mut left, mut right) = (CORNERS, CORNERS);
        (left.0[lane], right.0[lane]) = (a, b);
        same(quads(left, right).0[lane], wanted);
    }
}

/// Rows: F1.
#[test]
fn operations_on_numbers_are_ieee_754s() {
    let less = |a: f32, b: f32| a.partial_cmp(&b) == Some(std::cmp::Ordering::Less);
    for a in ODD {
        for b in ODD {
            check(
                a,
                b,
                Real::min(a, b),
                |a, b| a.min(b),
                if less(a, b) { a } else { b },
            );
            check(
                a,
                b,
                Real::max(a, b),
                |a, b| a.max(b),
                if less(b, a) { a } else { b },
            );
            check(a, b, a + b, |a, b| a + b, a + b);
            check(a, b, a - b, |a, b| a - b, a - b);
            check(a, b, a * b, |a, b| a * b, a * b);
            check(a, b, a / b, |a, b| a / b, a / b);
            let quads = [Quad([a; 4]), Quad([b; 4])];
            let equal = !(less(a, b) || less(b, a) || a.is_nan() || b.is_nan());
            for (got, of_quads, wanted) in [
                (Real::lt(a, b), quads[0].lt(quads[1]), less(a, b)),
                (Real::gt(a, b), quads[0].gt(quads[1]), less(b, a)),
                (Real::eq(a, b), Real::eq(quads[0], quads[1]), equal),
                (Real::le(a, b), quads[0].le(quads[1]), less(a, b) || equal),
                (Real::ge(a, b), quads[0].ge(quads[1]), less(b, a) || equal),
            ] {
                assert_eq!((got, of_quads.0), (wanted, [wanted; 4]), "{a} {b}");
            }
        }
    }
}

/// Rows: F1.
#[test]
fn operations_on_one_number_by_hand() {
    type Row = (f32, f32, i32, f32, f32);
    // The number, its floor, its truncation, clamped to −0.5..=0.75, |x|.
    let rows: [Row; 10] = [
        (-2.5, -3.0, -2, -0.5, 2.5),
        (2.5, 2.0, 2, 0.75, 2.5),
        (-0.25, -1.0, 0, -0.25, 0.25),
        (0.25, 0.0, 0, 0.25, 0.25),
        (-0.0, -0.0, 0, -0.0, 0.0),
        (8_388_607.5, 8_388_607.0, 8_388_607, 0.75, 8_388_607.5),
        (3e9, 3e9, i32::MAX, 0.75, 3e9),
        (-3e9, -3e9, i32::MIN, -0.5, 3e9),
        (f32::INFINITY, f32::INFINITY, i32::MAX, 0.75, f32::INFINITY),
        (f32::NAN, f32::NAN, 0, -0.5, f32::NAN),
    ];
    for (x, floor, int, clamped, abs) in rows {
        check(x, 0.0, Real::floor(x), |x, _| x.floor(), floor);
        check(
            x,
            0.0,
            Real::clamp(x, -0.5, 0.75),
            |x, _| x.clamp(-0.5, 0.75),
            clamped,
        );
        check(x, 0.0, Real::abs(x), |x, _| x.abs(), abs);
        assert_eq!((Real::to_int(x), Quad([x; 4]).to_int().0), (int, [int; 4]));
        let bits = x.to_bits().cast_signed();
        assert_eq!(
            (Real::to_bits(x), Quad([x; 4]).to_bits().0),
            (bits, [bits; 4])
        );
    }
    same(Real::fract(-2.25), 0.75);
    same(Real::saturate(f32::NAN), 0.0);
    same(Real::sqrt(2.0), std::f32::consts::SQRT_2);
    // Masks: lane k is bit k; a selection takes each lane from the chosen side.
    let mask = CORNERS.lt(Quad([2.0, 2.0, 8.0, 8.0]));
    assert_eq!(mask.0, [true, false, true, false]);
    assert_eq!(Quad::mask_bits(mask), 0b0101);
    assert_eq!(
        <Quad as Real>::select(mask, CORNERS, -CORNERS).0,
        [1.0, -3.0, 7.0, -20.0]
    );
    assert!(Quad::any(mask) && !Quad::any(CORNERS.lt(Quad([0.0; 4]))));
}

/// Rows: F1.
#[test]
fn integers_wrap_and_shift_as_two_s_complement() {
    let [small, large] = [-7, 0x7FFF_FFFF];
    let quad = Quad([small, large, 5, -1]);
    let one = quad.splat(1);
    assert_eq!((quad + one).0, [-6, i32::MIN, 6, 0]);
    assert_eq!((quad * quad.splat(3)).0, [-21, 0x7FFF_FFFD, 15, -3]);
    assert_eq!((quad >> 1).0, [-4, 0x3FFF_FFFF, 2, -1]);
    assert_eq!((quad << 4).0, [-112, -16, 80, -16]);
    assert_eq!(quad.shr_unsigned(28).0, [15, 7, 0, 15]);
    assert_eq!((quad & quad.splat(0xFF)).0, [0xF9, 0xFF, 5, 0xFF]);
    assert_eq!((quad | one).0, [-7, large, 5, -1]);
    assert_eq!((quad ^ one).0, [-8, large - 1, 4, -2]);
    assert_eq!(Int::min(quad, one).0, [-7, 1, 1, -1]);
    assert_eq!(Int::max(quad, one).0, [1, large, 5, 1]);
    assert_eq!(Int::lt(quad, one).0, [true, false, false, true]);
    assert_eq!(quad.is_outside(6).0, [true, true, false, true]);
    // 2³¹ − 1 rounds to 2³¹.
    assert_eq!(quad.to_real().0, [-7.0, 2_147_483_648.0, 5.0, -1.0]);
    assert_eq!(Int::wrapping_mul(large, 3), 0x7FFF_FFFD);
    let table = [10, 20, 30];
    let found = Quad([0, 2, 3, -1]).gather(&table);
    assert_eq!(found.0, [10, 30, 30, 30]);
    assert_eq!(Int::gather(1, &table), 20);
    assert_eq!(Int::gather(1, &[]), 0);
}

/// Rows: F1.
#[test]
fn powers_lie_within_their_bounds() {
    for step in 1..2000 {
        let x = step as f32 * 0.013;
        for y in [-3.5_f32, -1.0, 0.0, 0.25, 1.0, 2.2, 5.0, 12.0] {
            let exact = libm::pow(f64::from(x), f64::from(y));
            let got = f64::from(maths::pow(x, y));
            // The error of log₂ in the product, times ln 2, and that of exp2.
            let logarithm = libm::log2(f64::from(x)).abs().max(1.0);
            let bound = 4e-7 * logarithm * f64::from(y).abs() + 3e-7;
            assert!((got - exact).abs() <= bound * exact, "{x}^{y} is not {got}");
        }
        for n in [0_u32, 1, 2, 3, 7, 16] {
            let exact = libm::pow(f64::from(x), f64::from(n));
            let got = f64::from(maths::powi(x, n));
            // At most one rounding for each product and one for each square.
            assert!(
                (got - exact).abs() <= f64::from(n) * 6e-8 * exact,
                "{x}^{n}"
            );
        }
    }
    same(maths::pow(0.0, 0.0), 1.0);
    same(maths::pow(0.0, 2.0), 0.0);
    assert!(maths::pow(-1.0, 2.0).is_nan());
}
