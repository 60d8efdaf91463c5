//! All kinds of [`Real`] agree to the bit, and the functions keep their documented accuracy.

#![expect(clippy::cast_possible_truncation, reason = "tests know their numbers")]

use super::*;
use estampe_simd::{LANES, Lanes, Level, SimdBase, dispatch, f32x16};

fn samples() -> Vec<f32> {
    let mut random = fastrand::Rng::with_seed(1);
    let mut values = vec![
        0.0,
        -0.0,
        1.0,
        -1.0,
        0.5,
        2.0,
        1e-30,
        1e30,
        f32::INFINITY,
        f32::NAN,
        f32::NEG_INFINITY,
        f32::MAX,
        f32::MIN_POSITIVE,
        1e-40,
        -1e-45,
        1.5,
        -2.5,
        8_388_607.5,
        -89.3,
        88.8,
    ];
    while values.len() < 4096 {
        values.push(f32::from_bits((random.u32(..) & 0x87FF_FFFF) | 0x3800_0000));
    }
    values
}

mod pairs;

type Unary = (&'static str, fn(f32) -> f32, fn(Quad) -> Quad);

/// Runs one generic function with all kinds of numbers. `no emulated lanes` leaves out packets at
/// the scalar level, where shaders run on quads: a packet of a long function takes a minute to
/// compile.
macro_rules! agrees {
    ($name:literal, $x:ident => $body:expr) => {
        agrees! { $name, true, $x => $body }
    };
    (no emulated lanes $name:literal, $x:ident => $body:expr) => {
        agrees! { $name, false, $x => $body }
    };
    ($name:literal, $emulated:literal, $x:ident => $body:expr) => {{
        #[inline(always)]
        fn generic<R: Real>($x: R) -> R {
            $body
        }
        #[inline(always)]
        fn wide<S: Lanes>(s: S, mut chunk: [f32; LANES]) -> [f32; LANES] {
            if S::IS_SCALAR && !$emulated {
                for x in &mut chunk {
                    *x = generic(*x);
                }
                return chunk;
            }
            generic(f32x16::load_array(s, chunk)).to_array()
        }
        let pair = |a, b| generic(Pair(Quad([a; 4]), Quad([b; 4])));
        let scalar: Unary = ($name, generic::<f32>, generic::<Quad>);
        for chunk in samples().chunks_exact(LANES) {
            let chunk: [f32; LANES] = chunk.try_into().expect("whole chunks");
            for level in Level::all_available() {
                let wide = dispatch!(level, s => wide(s, chunk));
                for (lane, &x) in chunk.iter().enumerate() {
                    let one = scalar.1(x);
                    let four = scalar.2(Quad([x; 4])).0[lane % 4];
                    for (kind, value) in [
                        ("packet", wide[lane]),
                        ("first of a pair", pair(x, 0.5).0.0[lane % 4]),
                        ("second of a pair", pair(0.5, x).1.0[lane % 4]),
                        ("quad", four),
                    ] {
                        let same = value.to_bits() == one.to_bits() || value.is_nan() && one.is_nan();
                        assert!(same, "{}({x:e}) {kind} {level:?}: {value:e} is not {one:e}", scalar.0);
                    }
                }
            }
        }
    }};
}

mod bits;
mod functions;
mod items;
mod kinds;
mod matrices;
mod structs;
mod vectors;

#[test]
fn all_kinds_agree() {
    agrees!("arithmetic", x => (x * 3.0 + x * x) / (x - 0.25) - x.floor());
    agrees!("clamp", x => x.clamp(-0.5, 0.75));
    agrees!("sqrt", x => x.abs().sqrt());
    agrees!("to_int", x => x.to_int().to_real());
    agrees!("ints", x => ((x.clamp(-1e6, 1e6).to_int() + x.splat_int(7)) >> 1).to_real());
    agrees!("exp2", x => maths::exp2(x));
    agrees!("log2", x => maths::log2(x));
    agrees!("pow", x => maths::pow(x, x.splat(5.5)));
    agrees!("sin", x => maths::sin(x));
    agrees!("exp", x => maths::exp(x));
    agrees!("hashes", x => {
        let bits = x.to_bits().wrapping_mul(x.splat_int(0x7FEB_352D));
        (bits ^ bits.shr_unsigned(15)).shr_unsigned(8).to_real()
    });
    agrees!("powi", x => maths::powi(x, 33));
    agrees!("select", x => R::select(x.lt(x * x), x.fract(), -x));
}

#[test]
fn derivatives_are_those_of_the_quad() {
    #[inline(always)]
    fn wide<S: Lanes>(s: S, values: [f32; LANES]) -> [[f32; LANES]; 2] {
        let x = f32x16::load_array(s, values);
        [Real::ddx(x).to_array(), Real::ddy(x).to_array()]
    }
    let values: [f32; LANES] = std::array::from_fn(|i| (i * i) as f32 * 0.37);
    for level in Level::all_available() {
        let [dx, dy] = dispatch!(level, s => wide(s, values));
        for (quad, chunk) in values.chunks_exact(4).enumerate() {
            let quad_values = Quad([chunk[0], chunk[1], chunk[2], chunk[3]]);
            assert_eq!(dx[quad * 4..][..4], quad_values.ddx().0, "{level:?}");
            assert_eq!(dy[quad * 4..][..4], quad_values.ddy().0, "{level:?}");
        }
    }
}

#[test]
fn exp2_and_log2_are_as_exact_as_they_say() {
    for i in -5000..5000 {
        let x = i as f32 * 0.0251;
        let exact = libm_exp2(f64::from(x));
        let error = (f64::from(maths::exp2(x)) - exact).abs() / exact;
        assert!(error < 2.5e-7, "exp2({x}): relative error {error:e}");
        let y = maths::exp2(x);
        if y.is_normal() {
            let back = f64::from(maths::log2(y));
            let exact = libm_log2(f64::from(y));
            let bound = 3.6e-7 * exact.abs().max(1.0);
            assert!(
                (back - exact).abs() < bound,
                "log2({y:e}): {back} is not {exact}"
            );
        }
    }
    assert_eq!(maths::exp2(0.0), 1.0);
    assert_eq!(maths::exp2(10.0), 1024.0);
    assert_eq!(maths::log2(8.0), 3.0);
    assert_eq!(maths::pow(0.0, 2.0), 0.0);
    assert!(maths::log2(-1.0).is_nan());
}

/// Numbers of every magnitude and sign.
fn every_size() -> impl Iterator<Item = f32> {
    (0..=u32::MAX).step_by(65_521).map(f32::from_bits)
}

#[test]
fn sin_is_as_exact_as_it_says() {
    let error = |x: f32| (f64::from(maths::sin(x)) - libm::sin(f64::from(x))).abs();
    let dense = (-820_000..=820_000).map(|step| step as f32 * 0.0025);
    let small = every_size().filter(|x| x.abs() <= 2048.0);
    for x in dense.chain(small).filter(|x| x.abs() <= 2048.0) {
        assert!(error(x) < 1.5e-7, "sin({x}): error {:e}", error(x));
    }
    for x in every_size() {
        let sine = maths::sin(x);
        if x.is_finite() {
            assert!((-1.0..=1.0).contains(&sine), "sin({x}) = {sine}");
        } else {
            assert!(sine.is_nan(), "sin({x}) = {sine}");
        }
    }
    assert_eq!(maths::sin(0.0), 0.0);
    assert!(maths::sin(f32::INFINITY).is_nan() && maths::sin(f32::NEG_INFINITY).is_nan());
}

#[test]
fn exp_is_as_exact_as_it_says() {
    for step in -110_000..=95_000 {
        let x = step as f32 * 0.001;
        let (got, exact) = (f64::from(maths::exp(x)), libm::exp(f64::from(x)));
        let least = f64::from(f32::MIN_POSITIVE);
        if exact >= f64::from(f32::MAX) {
            assert_eq!(got, f64::INFINITY, "exp({x})");
        } else if exact >= least {
            assert!((got - exact).abs() < 1.5e-7 * exact, "exp({x}): {got:e}");
        } else {
            // The distance between subnormal numbers.
            assert!((got - exact).abs() < 1.5e-45, "exp({x}): {got:e}");
        }
    }
    for x in every_size() {
        let power = maths::exp(x);
        assert!(power >= 0.0 || x.is_nan() && power.is_nan(), "exp({x})");
    }
    assert_eq!(maths::exp(0.0), 1.0);
    assert_eq!(maths::exp(f32::INFINITY), f32::INFINITY);
    assert_eq!(maths::exp(f32::NEG_INFINITY), 0.0);
}

/// 2^x in f64, independent of the system: halving of the exponent and a long series.
fn libm_exp2(x: f64) -> f64 {
    let whole = x.round();
    let t = (x - whole) * std::f64::consts::LN_2;
    let (mut sum, mut term) = (1.0, 1.0);
    for k in 1..25 {
        term *= t / f64::from(k);
        sum += term;
    }
    sum * 2f64.powi(whole as i32)
}

fn libm_log2(x: f64) -> f64 {
    let bits = x.to_bits();
    let e = (bits >> 52) as i64 - 1023;
    let m = f64::from_bits(bits & ((1 << 52) - 1) | (1023 << 52));
    let s = (m - 1.0) / (m + 1.0);
    let (mut sum, mut power) = (0.0, s);
    for k in 0..60 {
        sum += power / f64::from(2 * k + 1);
        power *= s * s;
    }
    e as f64 + 2.0 * sum / std::f64::consts::LN_2
}

#[test]
fn bindings_read_zeros_where_nothing_is() {
    let bindings = Bindings::default();
    assert_eq!(bindings.f32s::<4>(0, 0, 0), [0.0; 4]);
    let group = BoundResources {
        entries: vec![(
            3,
            BoundResource::Buffer {
                buffer: BufferData::from_f32s(&[1.0, 2.0, 3.0]),
                offset: 4,
                size: u32::MAX,
                dynamic_offset: Some(0),
            },
        )],
    };
    let bindings = Bindings {
        groups: vec![crate::BoundGroup {
            group: std::sync::Arc::new(group),
            dynamic_offsets: [4; crate::MAX_DYNAMIC_OFFSETS],
        }],
        ..Bindings::default()
    };
    assert_eq!(bindings.f32s::<1>(0, 3, 0), [3.0]);
    assert_eq!(bindings.f32s::<2>(0, 3, 0), [3.0, 0.0]);
    // The upper half of 3.0 = 0x4040_0000, between words.
    assert_eq!(bindings.f32s::<1>(0, 3, 2), [f32::from_bits(0x4040)]);
}
