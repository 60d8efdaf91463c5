//! 16-bit floats of WGSL against numbers of 64 bits that are rounded once.

mod buffers;
mod reference;
mod run;
mod spirv;
mod stages;

use reference::{decoded, encoded, rounded};
use run::{Contents, packed, run, unpacked};

/// Runs `body` for each invocation `i` of so many, which reads `data` and writes `out`.
fn computed(ty: &str, body: &str, data: Vec<u32>, out: usize, invocations: usize) -> Vec<u32> {
    let [from, to] = ty.split_once(" to ").map_or([ty, ty], |(a, b)| [a, b]);
    let source = format!(
        "@group(0) @binding(0) var<storage, read> data: array<{from}>;\n\
         @group(0) @binding(1) var<storage, read_write> out: array<{to}>;\n\
         @compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3u) {{\n\
         let i = id.x; {body} }}"
    );
    let buffers = [Contents::Read(data), Contents::Written(vec![0; out])];
    let groups = u32::try_from(invocations / 64).expect("few groups");
    run(&source, &buffers, groups).1.remove(0)
}

fn all_codes() -> Vec<u16> {
    (0..=u16::MAX).collect()
}

fn is_nan(code: u16) -> bool {
    code & 0x7FFF > 0x7C00
}

#[test]
fn every_code_is_loaded_converted_and_stored() {
    let data = packed(&all_codes());
    let copied = computed("f16", "out[i] = data[i];", data.clone(), 1 << 15, 1 << 16);
    for (code, got) in all_codes().into_iter().zip(unpacked(&copied)) {
        assert_eq!(got, if is_nan(code) { 0x7E00 } else { code });
    }
    let body = "let h = data[i]; out[i] = f32(h); out[i] = select(out[i], -f32(-h), h < 0);";
    let numbers = computed("f16 to f32", body, data.clone(), 1 << 16, 1 << 16);
    for (code, got) in all_codes().into_iter().zip(&numbers) {
        let (got, number) = (f64::from(f32::from_bits(*got)), decoded(code));
        assert!(got.to_bits() == number.to_bits() || got.is_nan() && number.is_nan());
    }
    let back = computed(
        "f32 to f16",
        "out[i] = f16(data[i]);",
        numbers,
        1 << 15,
        1 << 16,
    );
    assert_eq!(back, copied);
    // Pairs are words: load, convert, store.
    let pairs = computed("vec2h", "out[i] = -(-data[i]);", data, 1 << 15, 1 << 15);
    assert_eq!(pairs, copied);
}

#[test]
fn conversions_round_and_saturate() {
    let random = &mut fastrand::Rng::with_seed(11);
    let mut numbers = vec![
        f32::NAN,
        f32::INFINITY,
        -f32::INFINITY,
        65519.996,
        65520.0,
        -65536.0,
        1e30,
        1e-30,
        -0.0,
        6e-8,
        2.980_232_4e-8,
        2.980_232_7e-8,
    ];
    // Exponents around those of 16-bit floats.
    numbers.extend((numbers.len()..8192).map(|_| {
        let exponent = random.u32(95..150) << 23;
        f32::from_bits(random.u32(..) & 0x807F_FFFF | exponent)
    }));
    let data = numbers.iter().map(|number| number.to_bits()).collect();
    let found = computed("f32 to f16", "out[i] = f16(data[i]);", data, 4096, 8192);
    for (number, code) in numbers.iter().zip(unpacked(&found)) {
        assert_eq!(code, encoded(f64::from(*number)), "{number}");
    }
    // Integers, of which most are too large.
    let integers: Vec<i32> = (0..8192)
        .map(|_| random.i32(..) >> random.u32(0..32))
        .collect();
    let data = || integers.iter().map(|one| one.cast_unsigned()).collect();
    let signed = computed("i32 to f16", "out[i] = f16(data[i]);", data(), 4096, 8192);
    let unsigned = computed("u32 to f16", "out[i] = f16(data[i]);", data(), 4096, 8192);
    let found = unpacked(&signed).into_iter().zip(unpacked(&unsigned));
    for (integer, (signed, unsigned)) in integers.iter().zip(found) {
        assert_eq!(signed, encoded(f64::from(*integer)), "{integer}");
        assert_eq!(unsigned, encoded(f64::from(integer.cast_unsigned())));
    }
    // Infinity is the greatest float that is an integer of the type; booleans are not 0.
    let body = "let h = data[i]; out[i] = vec4i(i32(h), bitcast<i32>(u32(h)), i32(bool(h)), i32(h == f16(i32(h))));";
    let data = packed(&all_codes());
    let found = computed("f16 to vec4i", body, data, 1 << 18, 1 << 16);
    for (code, got) in all_codes().into_iter().zip(found.chunks(4)) {
        let number = decoded(code);
        #[expect(clippy::cast_possible_truncation, reason = "as WGSL does")]
        let signed = number.clamp(-2_147_483_648.0, 2_147_483_520.0) as i32;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "as WGSL does"
        )]
        let unsigned = number.clamp(0.0, 4_294_967_040.0) as u32;
        assert_eq!(got[0].cast_signed(), signed, "{number}");
        assert_eq!(got[1], unsigned, "{number}");
        assert_eq!(got[2] == 1, number != 0.0);
        let is_whole = number == rounded(f64::from(signed));
        assert_eq!(got[3] == 1, is_whole, "{number}");
    }
}

/// Pairs of codes: random ones, and those with exponents that are near to each other.
fn pairs(count: usize, seed: u64) -> Vec<[u16; 2]> {
    let random = &mut fastrand::Rng::with_seed(seed);
    let special = [0, 1, 0x3FF, 0x400, 0x3C00, 0x7BFF, 0x7C00, 0x7E00, 0x7D01];
    let one = |random: &mut fastrand::Rng| match random.u32(0..8) {
        0 => special[random.usize(0..special.len())] | random.u16(0..2) << 15,
        1 => random.u16(..) & 0x83FF,
        _ => random.u16(..),
    };
    let pair = |_| {
        let (a, b) = (one(random), one(random));
        let near = a & 0x7C00 | b & 0x83FF;
        [a, if random.bool() { near } else { b }]
    };
    (0..count).map(pair).collect()
}

/// A function of a pair, in WGSL and on numbers of 64 bits.
type Case = (&'static str, fn(f64, f64) -> f64);

#[test]
fn arithmetic_is_rounded_once() {
    // In 64 bits sums and products of 16-bit floats are exact, and quotients and roots have more
    // than twice as many bits.
    let cases: [Case; 12] = [
        ("a + b", |a, b| a + b),
        ("a - b", |a, b| a - b),
        ("a * b", |a, b| a * b),
        ("a / b", |a, b| a / b),
        ("sqrt(a) + b * 0", |a, b| rounded(a.sqrt()) + b * 0.0),
        ("sqrt(a)", |a, _| a.sqrt()),
        // Each operation is rounded.
        ("a * b + a", |a, b| rounded(a * b) + a),
        ("a * 0.1h - b", |a, b| rounded(a * rounded(0.1)) - b),
        ("floor(a) - ceil(b)", |a, b| a.floor() - b.ceil()),
        ("round(a) + trunc(b)", |a, b| {
            a.round_ties_even() + b.trunc()
        }),
        ("select(a, b, a < b)", |a, b| if a < b { b } else { a }),
        ("abs(-a) * sign(b)", |a, b| {
            a.abs()
                * if b > 0.0 {
                    1.0
                } else if b < 0.0 {
                    -1.0
                } else {
                    b
                }
        }),
    ];
    for (seed, (text, wanted)) in (0..).zip(cases) {
        let pairs = pairs(1 << 16, seed);
        let data = pairs.iter().flat_map(|pair| packed(pair)).collect();
        let body = format!("let a = data[i].x; let b = data[i].y; out[i] = {text};");
        let found = computed("vec2h to f16", &body, data, 1 << 15, 1 << 16);
        for ([a, b], got) in pairs.into_iter().zip(unpacked(&found)) {
            let wanted = encoded(wanted(decoded(a), decoded(b)));
            let is_same = got == wanted || is_nan(got) && is_nan(wanted);
            assert!(
                is_same,
                "{text}: {a:04x} {b:04x}: {got:04x}, not {wanted:04x}"
            );
        }
    }
}

/// The units in the last place, of the wanted number, between it and a code.
fn error_in_units(code: u16, wanted: f64) -> f64 {
    let near = decoded(encoded(wanted) & 0x7FFF);
    let unit = if near >= 2.0_f64.powi(-13) {
        2.0_f64.powi(i32::from((encoded(wanted) & 0x7FFF) >> 10) - 25)
    } else {
        2.0_f64.powi(-24)
    };
    (decoded(code) - wanted).abs() / unit
}

#[test]
#[expect(
    clippy::disallowed_methods,
    reason = "results are compared with a tolerance"
)]
fn functions_are_computed_in_32_bits_and_rounded() {
    let cases: [Case; 16] = [
        ("sin(a)", |a, _| a.sin()),
        ("exp2(a)", |a, _| a.exp2()),
        ("log2(abs(a))", |a, _| a.abs().log2()),
        ("atan2(a, b)", f64::atan2),
        ("tanh(a)", |a, _| a.tanh()),
        ("inverseSqrt(abs(a))", |a, _| 1.0 / a.abs().sqrt()),
        ("fma(a, b, a)", |a, b| a * b + a),
        ("mix(a, b, 0.25h)", |a, b| a + (b - a) * 0.25),
        ("length(vec2h(a, b))", f64::hypot),
        ("distance(a, b)", |a, b| (a - b).abs()),
        ("dot(vec2h(a, 3), vec2h(b, 4))", |a, b| a * b + 12.0),
        ("fract(a)", |a, _| a - a.floor()),
        ("modf(a).fract", |a, _| a - a.trunc()),
        ("modf(a).whole", |a, _| a.trunc()),
        ("ldexp(a, 3)", |a, _| a * 8.0),
        ("clamp(a, -1.5h, 2) + saturate(b)", |a, b| {
            a.clamp(-1.5, 2.0) + b.clamp(0.0, 1.0)
        }),
    ];
    for (seed, (text, wanted)) in (100..).zip(cases) {
        let pairs = pairs(1 << 12, seed);
        let data = pairs.iter().flat_map(|pair| packed(pair)).collect();
        let body = format!("let a = data[i].x; let b = data[i].y; out[i] = {text};");
        let found = computed("vec2h to f16", &body, data, 1 << 11, 1 << 12);
        for ([a, b], got) in pairs.into_iter().zip(unpacked(&found)) {
            let (a, b) = (decoded(a), decoded(b));
            let wanted = wanted(a, b);
            // Infinite arguments and NaN are the business of the functions of 32 bits.
            if !(a.is_finite() && b.is_finite() && wanted.is_finite()) {
                continue;
            }
            let is_right = if wanted.abs() >= 65519.0 {
                got & 0x7FFF >= 0x7BFF
            } else {
                error_in_units(got, wanted) <= 0.51
            };
            assert!(is_right, "{text}: {a} {b}: {}, not {wanted}", decoded(got));
        }
    }
}
