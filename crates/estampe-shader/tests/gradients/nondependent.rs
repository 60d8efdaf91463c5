//! Samples that are made before the shader runs: which they are, and that they give the same bits
//! as those that its code makes.

use super::program;
use super::running::{Textures, samplers};
use estampe_shader::program::TextProgram;
use estampe_simd::{LANES, Level, Packet};
use estampe_types::{Bindings, FragmentBatch, Program};

fn reads(statements: &str) -> usize {
    program(statements).nondependent_reads()
}

#[test]
fn samples_at_varyings_are_made_before() {
    for (expected, statements) in [
        (1, "return textureSample(map, s, in.uv);"),
        (1, "return textureSampleLevel(map, s, in.on_screen, 0.0);"),
        (
            1,
            "return textureSample(layers, s, in.uv, in.layer, vec2i(1, -1));",
        ),
        (
            3,
            "return textureSample(map, s, in.uv) + textureSample(sky, s, in.direction)
                + textureSample(other, s, in.uv);",
        ),
        // With the level of detail of quads.
        (1, "return textureSample(map, s, in.uv) + dpdx(in.uv.x);"),
        // As many as all invocations make.
        (
            1,
            "var color = textureSample(map, s, in.uv);
            if in.uv.x > 0.5 { color += textureSample(other, s, in.uv); }
            return color;",
        ),
    ] {
        assert_eq!(reads(statements), expected, "{statements}");
    }
}

#[test]
fn other_samples_stay_in_the_code() {
    for statements in [
        "return textureSample(map, s, in.uv * 2.0);",
        "return textureSampleLevel(map, s, in.uv + in.on_screen, 0.0);",
        "return textureSampleLevel(map, s, numbers.xy - in.uv, 0.0);",
        "return textureSample(sky, s, in.direction + 0.5);",
        "return textureSample(layers, s, in.uv + 0.5, in.layer);",
        "return textureSampleLevel(map, s, in.uv, in.direction.x);",
        "return textureSampleBias(map, s, in.uv, 1.0);",
        "return vec4f(textureSampleCompare(depths, compared, in.uv, in.direction.z));",
        "return textureGather(0, map, s, in.uv);",
        "return textureSample(layers, s, in.uv, in.layer + 1);",
    ] {
        assert_eq!(reads(statements), 0, "{statements}");
    }
}

#[test]
fn shaders_that_return_a_sample_pass_its_texels() {
    for (expected, statements) in [
        (true, "return textureSample(map, s, in.uv);"),
        (
            true,
            "return textureSampleLevel(halves, s, in.uv + numbers.xy, 0.0);",
        ),
        (
            true,
            "let color = textureSample(layers, s, in.uv, in.layer);
            return vec4f(color.r, color.g, color.b, color.a);",
        ),
        (false, "return textureSample(map, s, in.uv).rgba.bgra;"),
        (
            false,
            "return vec4f(textureSample(map, s, in.uv).rgb, 1.0);",
        ),
        (false, "return textureSample(map, s, in.uv) * 2.0;"),
        (false, "return textureSample(map, s, in.uv * 2.0);"),
        (
            false,
            "if in.uv.x > 0.5 { discard; } return textureSampleLevel(map, s, in.uv, 0.0);",
        ),
        (
            false,
            "let color = textureSample(map, s, in.uv);
            return vec4f(color.rg, textureSample(other, s, in.uv).ba);",
        ),
        (false, "return in.uv.xyxy;"),
    ] {
        assert_eq!(
            program(statements).passes_texels(),
            expected,
            "{statements}"
        );
    }
}

/// The texels of a read are the colours, of one packet and of more than a batch.
#[test]
fn passed_texels_have_the_bits_of_those_that_the_code_returns() {
    for of in [
        "map, s, AT, 0.0",
        "halves, s, AT, 0.0",
        "layers, s, AT, in.layer, 0.0",
    ] {
        let shader = |at: &str| {
            let of = of.replace("AT", at);
            format!(
                "let one = min(abs(in.uv.x) + 1.0, 1.0);
                return textureSampleLevel({of});"
            )
        };
        let before = program(&shader("in.uv"));
        let in_code = program(&shader("(in.uv * one)"));
        assert!(before.passes_texels() && !in_code.passes_texels(), "{of}");
        for sampler in samplers() {
            let textures = Textures::new(sampler);
            for level in Level::all_available() {
                let bindings = textures.bindings(level);
                let context = (level, &bindings);
                assert!(
                    colors(&before, context) == colors(&in_code, context),
                    "{of}"
                );
            }
        }
    }
}

/// The colours of packets with random scalars.
fn colors(program: &TextProgram, (level, bindings): (Level, &Bindings)) -> Vec<Packet<f32>> {
    const PACKETS: usize = 19;
    let random = &mut fastrand::Rng::with_seed(5);
    let scalars = program.interface().fragment_scalars();
    let mut packets = vec![Packet([0.0; LANES]); PACKETS * scalars];
    for packet in &mut packets {
        // Neighbours are near each other, or not.
        let (first, step) = (random.f32() * 4.0 - 2.0, 0.5_f32.powi(random.i32(0..12)));
        for lane in &mut packet.0 {
            *lane = first + random.f32() * step;
        }
    }
    let mut colors = vec![Packet::default(); PACKETS * 4];
    program.run_fragments(
        level,
        bindings,
        FragmentBatch {
            varyings: &packets,
            coverage: &mut [0xFFFF; PACKETS],
            colors: &mut colors,
            ..FragmentBatch::default()
        },
    );
    colors
}

/// The level of detail of quads: the same coordinates, as varyings and computed.
#[test]
fn quads_have_the_same_bits_before_and_in_the_code() {
    let shader = |scale: &str| {
        format!(
            "let one = min(abs(in.direction.x) + 1.0, 1.0);
            let color = textureSample(map, s, in.uv * {scale})
                + textureSample(other, s, in.uv * {scale});
            return color + vec4f(0.0, 0.0, 0.0, dpdx(one));"
        )
    };
    let before = program(&shader("1.0"));
    let in_code = program(&shader("one"));
    assert_eq!(before.nondependent_reads(), 2);
    assert_eq!(in_code.nondependent_reads(), 0);
    for sampler in samplers() {
        let textures = Textures::new(sampler);
        for level in Level::all_available() {
            let bindings = textures.bindings(level);
            let context = (level, &bindings);
            assert_eq!(colors(&before, context), colors(&in_code, context));
        }
    }
}
