//! Loads at the pixel itself, made before the shader runs: which they are, and that they give the
//! same bits as those that its code makes.

use super::entry_points;
use super::running::{Textures, samplers};
use estampe_shader::program::TextProgram;
use estampe_simd::{LANE_X, LANE_Y, LANES, Level, Packet};
use estampe_types::{Bindings, FragmentBatch, Program};

/// A program of these statements, of which `pixel` is the pixel as the expression gives it, and
/// `position` the position in the window.
fn program(pixel: &str, statements: &str) -> TextProgram {
    let text = format!(
        "@group(0) @binding(1) var map: texture_2d<f32>;
        @group(0) @binding(3) var small: texture_2d<f32>;
        @group(0) @binding(4) var layers: texture_2d_array<f32>;
        @group(0) @binding(8) var depths: texture_depth_2d;
        @group(0) @binding(10) var halves: texture_2d<f32>;
        @group(0) @binding(12) var stored: texture_storage_2d<rgba8unorm, write>;
        @fragment fn f(@builtin(position) position: vec4f) -> @location(0) vec4f {{
            let one = min(abs(position.z) + 1.0, 1.0);
            let pixel = {pixel};
            let offset = pixel / pixel;
            {statements}
        }}"
    );
    let vertex = "@vertex fn v() -> @builtin(position) vec4f { return vec4f(); }";
    let [vertex, fragment] = [vertex, &text].map(|text| entry_points(text).remove(0));
    let made = TextProgram::new(&vertex, Some(&fragment), 1 << 20);
    made.unwrap_or_else(|error| panic!("{error}"))
}

/// Statements, and how many of their loads are made before.
const LOADS: [(usize, &str); 5] = [
    (1, "return textureLoad(map, pixel, 0);"),
    (1, "return vec4f(textureLoad(depths, pixel, 0));"),
    (
        2,
        "return textureLoad(map, pixel, 0) + textureLoad(halves, pixel, 0);",
    ),
    // After an early return, but not in one arm.
    (
        3,
        "let depth = textureLoad(depths, pixel, 0);
        if depth >= 0.5 { return vec4f(depth); }
        var color = textureLoad(halves, pixel, 0);
        if depth >= 0.25 { color += textureLoad(small, pixel, 0); }
        return color + textureLoad(map, pixel, 0);",
    ),
    (
        3,
        "return textureLoad(map, pixel, 0) + textureLoad(map, pixel + offset, 0)
            + textureLoad(halves, pixel, 0) + textureLoad(small, pixel, 0);",
    ),
];

#[test]
fn loads_at_the_pixel_are_made_before() {
    for (expected, statements) in LOADS {
        for pixel in ["vec2i(position.xy)", "vec2u(position.xy)"] {
            let reads = program(pixel, statements).nondependent_reads();
            assert_eq!(reads, expected, "{pixel}: {statements}");
        }
    }
}

#[test]
fn other_loads_stay_in_the_code() {
    for (pixel, statements) in [
        ("vec2i(position.yx)", "return textureLoad(map, pixel, 0);"),
        (
            "vec2i(position.xy * 2.0)",
            "return textureLoad(map, pixel, 0);",
        ),
        ("vec2i(position.xy)", "return textureLoad(map, pixel, 1);"),
        (
            "vec2i(position.xy)",
            "return textureLoad(map, pixel, i32(position.z));",
        ),
        (
            "vec2i(position.xy)",
            "return textureLoad(layers, pixel, 1, 0);",
        ),
        (
            "vec2i(position.xy)",
            "var sum = vec4f();
            for (var i = 0; i < i32(position.z); i++) { sum += textureLoad(map, pixel, 0); }
            return sum;",
        ),
        (
            "vec2i(position.xy)",
            "let color = textureLoad(map, pixel, 0);
            textureStore(stored, pixel, color);
            return color;",
        ),
    ] {
        let reads = program(pixel, statements).nondependent_reads();
        assert_eq!(reads, 0, "{pixel}: {statements}");
    }
}

/// The bits of the colours of packets: blocks, of which some are across the edges of textures, and
/// pixels anywhere.
fn colors(program: &TextProgram, (level, bindings): (Level, &Bindings)) -> Vec<Packet<u32>> {
    const PACKETS: usize = 67;
    let random = &mut fastrand::Rng::with_seed(3);
    let mut positions = vec![Packet([0.0; LANES]); PACKETS * 4];
    for (at, position) in positions.chunks_mut(4).enumerate() {
        let first = [random.u8(0..36), random.u8(0..36)];
        for lane in 0..LANES {
            let of_block = [first[0] + LANE_X[lane], first[1] + LANE_Y[lane]];
            let anywhere = [random.u8(..), random.u8(0..40)];
            let pixel = if at % 5 == 4 { anywhere } else { of_block };
            for (to, at) in position.iter_mut().zip(pixel) {
                to.0[lane] = f32::from(at) + 0.5;
            }
            position[2].0[lane] = random.f32();
        }
    }
    let mut colors = vec![Packet::default(); PACKETS * 4];
    program.run_fragments(
        level,
        bindings,
        FragmentBatch {
            positions: &positions,
            coverage: &mut [0xFFFF; PACKETS],
            colors: &mut colors,
            ..FragmentBatch::default()
        },
    );
    let bits = colors.iter();
    bits.map(|packet| Packet(packet.0.map(f32::to_bits)))
        .collect()
}

#[test]
fn loads_have_the_same_bits_before_and_in_the_code() {
    let textures = Textures::new(samplers()[0]);
    let mut in_tiles_somewhere = false;
    for (count, statements) in LOADS {
        let before = program("vec2i(position.xy)", statements);
        let in_code = program("vec2i(position.xy * one)", statements);
        assert_eq!(before.nondependent_reads(), count, "{statements}");
        assert_eq!(in_code.nondependent_reads(), 0, "{statements}");
        let is_alone = statements.starts_with("return textureLoad(map, pixel, 0);");
        assert_eq!(before.passes_texels(), is_alone, "{statements}");
        for level in Level::all_available() {
            let bindings = textures.bindings(level);
            let context = (level, &bindings);
            let name = level.name();
            let expected = colors(&in_code, context);
            assert_eq!(colors(&before, context), expected, "{name} {statements}");
            // All of them in tiles, or one of several.
            let tiles: &[&[u32]] = match level.is_scalar() {
                true => &[],
                false => &[&[1, 8, 10, 3], &[10], &[8]],
            };
            for in_tiles in tiles {
                let at_pixel = |at: &&u32| {
                    let reads = before.texture_reads(0, **at);
                    reads.at_pixel && !reads.others
                };
                let in_tiles: Vec<u32> = in_tiles.iter().filter(at_pixel).copied().collect();
                in_tiles_somewhere |= !in_tiles.is_empty();
                let numbers = [0.03, -0.02, 1.5, 1e30];
                let bindings = textures.bindings_in_tiles(level, numbers, &in_tiles);
                let found = colors(&before, (level, &bindings));
                assert_eq!(found, expected, "{name} {statements} {in_tiles:?}");
            }
        }
    }
    assert!(in_tiles_somewhere || Level::best().is_scalar());
}

/// Where nothing is bound, loads give zeros.
#[test]
fn loads_from_nothing_give_zeros() {
    let program = program("vec2i(position.xy)", LOADS[2].1);
    for level in Level::all_available() {
        let found = colors(&program, (level, &Bindings::default()));
        assert!(found.iter().all(|packet| packet.0 == [0; LANES]));
    }
}
