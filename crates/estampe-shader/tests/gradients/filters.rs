//! Samples at uniform shifts from varyings are made before the shader runs, and give the same bits
//! as those that its code makes.

use super::running::{Textures, samplers};
use super::{fragment, program, program_of};
use estampe_shader::program::TextProgram;
use estampe_simd::{LANE_X, LANE_Y, LANES, Level, Packet};
use estampe_texture::{AddressMode, SamplerDescriptor};
use estampe_types::morton::compact;
use estampe_types::{Bindings, FragmentBatch, Program};

/// Statements that sample, with `AT` for the varying, and how many samples they are.
const FILTERS: [(usize, &str); 12] = [
    (
        5,
        "let step = vec2f(1.0, 0.0) / vec2f(textureDimensions(halves));
        sum += textureSampleLevel(halves, s, AT, 0.0);
        for (var tap = 1.0; tap < 3.0; tap += 1.0) {
            sum += textureSampleLevel(halves, s, AT + step * (tap * 1.3), 0.0);
            sum += textureSampleLevel(halves, s, AT - step * (tap * 1.3), 0.0);
        }",
    ),
    (
        9,
        "let step = 2.0 / vec2f(textureDimensions(halves));
        for (var x = -1.0; x < 2.0; x += 1.0) {
            for (var y = -1.0; y < 2.0; y += 1.0) {
                sum += textureSampleLevel(halves, s, AT + step * vec2f(x, y), 0.0);
            }
        }",
    ),
    // Without the last channel.
    (
        2,
        "let step = 0.7 / vec2f(textureDimensions(halves));
        sum += vec4f(textureSampleLevel(halves, s, AT + step, 0.0).rgb
            + textureSampleLevel(halves, s, AT - step, 0.0).rgb, 1.0);",
    ),
    // The last channel of one filter, and the others of another one, or of a sample.
    (
        4,
        "sum += vec4f(textureSampleLevel(halves, s, AT + 0.01, 0.0).rgb
            + textureSampleLevel(halves, s, AT - 0.01, 0.0).rgb,
            textureSampleLevel(map, s, AT + 0.25, 0.0).a
            + textureSampleLevel(map, s, AT - 0.25, 0.0).a);",
    ),
    (
        4,
        "sum += vec4f(textureSampleLevel(map, s, AT + 0.01, 0.0).rgb
            + textureSampleLevel(map, s, AT - 0.01, 0.0).rgb,
            textureSampleLevel(halves, s, AT + 0.25, 0.0).a
            + textureSampleLevel(halves, s, AT - 0.25, 0.0).a);",
    ),
    (
        3,
        "sum += vec4f(textureSampleLevel(map, s, AT, 0.0).rgb,
            textureSampleLevel(halves, s, AT + 0.01, 0.0).a
            + textureSampleLevel(halves, s, AT - 0.01, 0.0).a);",
    ),
    (
        3,
        "sum += vec4f(textureSampleLevel(map, s, AT + 0.01, 0.0).rgb
            + textureSampleLevel(map, s, AT - 0.01, 0.0).rgb,
            textureSampleLevel(halves, s, AT, 0.0).a);",
    ),
    // From a buffer, before the varying.
    (
        2,
        "sum += textureSampleLevel(halves, s, numbers.xy + AT, 0.0)
            + textureSampleLevel(halves, s, numbers.zw + AT, 0.0);",
    ),
    // Of one coordinate.
    (
        2,
        "sum += textureSampleLevel(halves, s, vec2f(AT.x, AT.y + 0.1), 0.0)
            + textureSampleLevel(halves, s, AT.yx - vec2f(numbers.z, 0.0), 0.0);",
    ),
    // Two textures, one of them bytes, and a sample without a shift beside them.
    (
        4,
        "sum += textureSampleLevel(map, s, AT + numbers.x, 0.0)
            + textureSampleLevel(map, s, AT, 0.0)
            + textureSampleLevel(other, s, AT, 0.0)
            + textureSampleLevel(halves, s, AT - 0.25, 0.0);",
    ),
    // With the level of detail of quads.
    (
        3,
        "sum += textureSample(map, s, AT + numbers.xy) + textureSample(map, s, AT - numbers.xy)
            + textureSample(halves, s, AT + 0.01);",
    ),
    // More than are made before stay in the code.
    (
        16,
        "for (var tap = 0.0; tap < 18.0; tap += 1.0) {
            sum += textureSampleLevel(halves, s, AT + tap * 0.01, 0.0);
        }",
    ),
];

/// The colours of packets that stand in columns and rows, first of a square of them, and of some
/// that do not.
fn colors(program: &TextProgram, (level, bindings): (Level, &Bindings)) -> Vec<Packet<u32>> {
    const PACKETS: usize = 37;
    let random = &mut fastrand::Rng::with_seed(11);
    let scalars = program.interface().fragment_scalars();
    let mut packets = vec![Packet([0.0; LANES]); PACKETS * scalars];
    for (number, packet) in packets.chunks_mut(scalars).enumerate() {
        for scalar in &mut *packet {
            scalar.0 = [random.f32(); LANES];
        }
        let square = u32::try_from(number).ok().filter(|number| *number < 16);
        let step = square.map_or([1.0, 2.0, 0.5, 0.07][number % 4], |_| 1.0) / 64.0;
        for (axis, lanes) in [(0, LANE_X), (1, LANE_Y)] {
            let random = random.f32() * 1.2 - 0.1;
            let first = square.map_or(random, |number| {
                0.3 + (4 * compact(number >> axis)) as f32 * step
            });
            packet[axis].0 = lanes.map(|at| first + f32::from(at) * step);
        }
        if square.is_some() {
            continue;
        }
        packet[number % 2].0[9] += f32::from(u8::from(number % 5 == 4)) * 0.01;
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
        .iter()
        .map(|packet| Packet(packet.0.map(f32::to_bits)))
        .collect()
}

/// A shader that samples at `at`.
fn shader(filter: &str, at: &str) -> String {
    format!(
        "let one = min(abs(in.direction.x) + 1.0, 1.0);
        var sum = vec4f();
        {}
        return sum + vec4f(0.0, 0.0, 0.0, dpdx(one));",
        filter.replace("AT", at)
    )
}

/// Shifts that are products stay what they are where products are rounded together with sums.
#[test]
fn filters_of_contracted_shaders_are_made_before() {
    for (count, filter) in FILTERS {
        let mut source = fragment(&shader(filter, "in.uv"));
        source.contract();
        let program = program_of(&source);
        assert_eq!(program.nondependent_reads(), count, "{filter}");
    }
}

#[test]
fn filters_have_the_same_bits_before_and_in_the_code() {
    let mut all = samplers().to_vec();
    all.push(SamplerDescriptor {
        address_mode_u: AddressMode::ClampToEdge,
        address_mode_v: AddressMode::ClampToEdge,
        ..SamplerDescriptor::trilinear_repeat()
    });
    for (count, filter) in FILTERS {
        let before = program(&shader(filter, "in.uv"));
        let in_code = program(&shader(filter, "(in.uv * one)"));
        assert_eq!(before.nondependent_reads(), count, "{filter}");
        assert_eq!(in_code.nondependent_reads(), 0, "{filter}");
        for &sampler in &all {
            let textures = Textures::new(sampler);
            for level in Level::all_available() {
                let bindings = textures.bindings(level);
                let context = (level, &bindings);
                let name = level.name();
                assert_eq!(
                    anew(filter, "in.uv", context),
                    anew(filter, "(in.uv * one)", context),
                    "{name} {filter}"
                );
            }
        }
    }
}

/// The colours of a program whose memory holds no texels of another level or sampler, which might
/// be those that it should find.
fn anew(filter: &str, at: &str, context: (Level, &Bindings)) -> Vec<Packet<u32>> {
    std::thread::scope(|scope| {
        let run = || colors(&program(&shader(filter, at)), context);
        scope.spawn(run).join().expect("it does not panic")
    })
}
