//! Alpha tests: for which alphas of a texture a fragment is known to have no effect.

use super::program;
use super::running::Textures;
use estampe_simd::Level;
use estampe_texture::SamplerDescriptor;
use estampe_types::Program;
use estampe_types::shader::{AlphaTest, AlphaTestRequest};

/// The test of a fragment shader of these statements, whose uniform `numbers` is (0.03, −0.02, 1.5,
/// 10³⁰).
fn test_of(statements: &str, to_coverage: bool) -> Option<AlphaTest> {
    let textures = Textures::new(SamplerDescriptor::trilinear_repeat());
    let request = AlphaTestRequest {
        to_coverage,
        primitives: usize::MAX,
    };
    let program = program(statements);
    program.alpha_test(&textures.bindings(Level::best()), request)
}

/// The statements after a sample `color`.
fn failing(statements: &str, to_coverage: bool) -> Option<u8> {
    let statements = format!("let color = textureSample(map, s, in.uv); {statements}");
    test_of(&statements, to_coverage).map(|test| test.failing)
}

#[test]
fn discarded_alphas_are_those_below_the_threshold() {
    for (expected, statements) in [
        // 126/255 + 1/256 is below ½.
        (126, "if color.a < 0.5 { discard; } return color;"),
        (126, "if color.a >= 0.5 { } else { discard; } return color;"),
        (126, "if !(color.a > 0.49999) { discard; } return color;"),
        // Below ¾, by a uniform.
        (
            190,
            "if color.a < numbers.z * 0.5 { discard; } return color;",
        ),
        (
            84,
            "if color.a * numbers.z < 0.5 { discard; } return color;",
        ),
        (
            126,
            "if numbers.z > 1.0 { if color.a - 0.5 < 0.0 { discard; } } return color;",
        ),
        (
            126,
            "if select(color.a, 0.0, in.uv.x > 0.5) < 0.5 { discard; }
            return color * in.direction.x;",
        ),
        (
            126,
            "var alpha = color.a;
            if in.uv.x > 0.5 { alpha = alpha * alpha; }
            if min(alpha, 0.9) < 0.5 { discard; }
            return color;",
        ),
        // Derivatives of numbers in 0..=a are in −a..=a: 3a below ½.
        (
            41,
            "if color.a + fwidth(color.a) < 0.5 { discard; } return color;",
        ),
    ] {
        assert_eq!(failing(statements, false), Some(expected), "{statements}");
    }
}

#[test]
fn alphas_that_cover_nothing() {
    for (expected, statements) in [
        (29, "return color;"),
        // An edge of one pixel where alpha is ½: below 2/7.
        (
            71,
            "let slope = max(fwidth(color.a), 0.0001);
            let coverage = clamp((color.a - 0.5) / slope + 0.5, 0.0, 1.0);
            return vec4f(color.rgb, 0.225 * floor(4.0 * coverage + 0.5));",
        ),
        // Either of both.
        (126, "if color.a < 0.5 { discard; } return color;"),
        (29, "if color.a < 0.01 { discard; } return color;"),
    ] {
        assert_eq!(failing(statements, true), Some(expected), "{statements}");
    }
    assert_eq!(failing("return color;", false), None);
}

#[test]
fn of_other_shaders_nothing_is_known() {
    for statements in [
        "if color.a > 0.5 { discard; } return color;",
        "if color.r < 0.5 { discard; } return color;",
        "if color.a < 0.001 { discard; } return color;",
        "if color.a * in.direction.x < 0.5 { discard; } return color;",
        "if color.a < 0.5 && in.uv.x > 0.1 { discard; } return color;",
        "if numbers.z < 1.0 && color.a < 0.5 { discard; } return color;",
        // It overflows.
        "if color.a * numbers.w * numbers.w < 0.5 { discard; } return color;",
        // The alpha of two textures decides.
        "if color.a * textureSample(other, s, in.uv).a < 0.5 { discard; } return color;",
        "var alpha = color.a;
        for (var turn = 0; turn < i32(in.uv.x); turn += 1) { alpha *= alpha; }
        if alpha < 0.5 { discard; }
        return color;",
    ] {
        assert_eq!(failing(statements, false), None, "{statements}");
    }
}

/// What was found with some uniforms does not hold of others.
#[test]
fn thresholds_follow_the_uniforms() {
    let program = program(
        "let color = textureSample(map, s, in.uv);
        if numbers.x > 0.0 && color.a < numbers.y { discard; }
        return color;",
    );
    let textures = Textures::new(SamplerDescriptor::trilinear_repeat());
    let failing = |numbers: [f32; 4]| {
        let bindings = textures.bindings_with(Level::best(), numbers);
        let request = AlphaTestRequest {
            to_coverage: false,
            primitives: usize::MAX,
        };
        let test = program.alpha_test(&bindings, request);
        test.map(|test| test.failing)
    };
    for _ in 0..2 {
        for step in 0..20_u8 {
            // 1/256 above the code that is one less.
            let threshold = f32::from(step + 3) / 255.0;
            assert_eq!(
                failing([1.0, threshold, 0.0, 0.0]),
                Some(step + 2),
                "{step}"
            );
            assert_eq!(failing([0.0, threshold, 0.0, 0.0]), None);
        }
    }
}

/// Coordinates, layers and levels of detail must be varyings and their derivatives.
#[test]
fn places_are_varyings() {
    let of = |sample: &str| {
        let statements =
            format!("let color = {sample}; if color.a < 0.5 {{ discard; }} return color;");
        test_of(&statements, false)
    };
    let test = of("textureSample(layers, s, in.uv, in.layer)").expect("it is known");
    assert_eq!(
        (test.at, test.layer, test.of_quads),
        ([0, 1], Some(2), false)
    );
    assert_eq!((test.map.layers, test.map.size), (5, [16.0; 2]));
    let test = of("textureSample(map, s, in.uv) + dpdx(in.direction.x) * 0.0");
    assert_eq!(test, None, "of a sum nothing is known");
    for sample in [
        "textureSample(map, s, in.uv * 2.0)",
        "textureSampleLevel(map, s, in.uv, 0.0)",
        "textureSampleGrad(map, s, in.uv, in.on_screen, in.on_screen)",
        "textureSample(map, s, in.uv, vec2i(1, 0))",
        "textureSample(sky, s, in.direction)",
        "textureSample(halves, s, in.uv)",
    ] {
        assert_eq!(of(sample), None, "{sample}");
    }
}
