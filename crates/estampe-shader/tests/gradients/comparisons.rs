//! Comparisons at uniform shifts from varyings are made before the shader runs, and give the same
//! bits as those that its code makes.

use super::program;
use super::running::Textures;
use estampe_shader::program::TextProgram;
use estampe_simd::{LANE_X, LANE_Y, LANES, Level, Packet};
use estampe_texture::{
    AddressMode, BoundTexture, SamplerDescriptor, ShadowMap, TexelView, texture_from_depth,
};
use estampe_types::bindings::{BoundGroup, BoundResource, BoundResources, OtherResource};
use estampe_types::shader::TextureReads;
use estampe_types::state::CompareFunction;
use estampe_types::{Bindings, BufferData, FragmentBatch, Program};
use std::sync::Arc;

/// Statements that compare, with `AT` for the varying, and how many comparisons they are.
const FILTERS: [(usize, &str); 4] = [
    (
        9,
        "for (var y = -1; y <= 1; y++) {
            for (var x = -1; x <= 1; x++) {
                let o = vec2f(f32(x), f32(y)) * (1.0 / 64.0);
                sum += textureSampleCompareLevel(depths, compared, AT + o, in.direction.z - 0.1);
            }
        }",
    ),
    (
        1,
        "sum += textureSampleCompareLevel(depths, compared, AT, in.direction.z);",
    ),
    // With two references, and a sample beside them.
    (
        5,
        "sum += textureSampleCompareLevel(depths, compared, AT + numbers.xy, in.direction.z)
            + textureSampleCompareLevel(depths, compared, AT - numbers.xy, in.direction.y)
            + textureSampleCompareLevel(depths, compared, AT - numbers.yx, in.direction.z)
            + textureSampleCompareLevel(depths, compared, AT, numbers.x + in.direction.z)
            + textureSampleLevel(halves, s, AT, 0.0).x;",
    ),
    // More than are made before stay in the code.
    (
        16,
        "for (var tap = 0.0; tap < 18.0; tap += 1.0) {
            sum += textureSampleCompareLevel(depths, compared, AT + tap * 0.01, in.direction.z);
        }",
    ),
];

/// The colours of packets whose references are near ½, and one whose coordinates are no numbers.
fn colors(program: &TextProgram, (level, bindings): (Level, &Bindings)) -> Vec<Packet<u32>> {
    const PACKETS: usize = 37;
    let random = &mut fastrand::Rng::with_seed(12);
    let scalars = program.interface().fragment_scalars();
    let mut packets = vec![Packet([0.0; LANES]); PACKETS * scalars];
    for (number, packet) in packets.chunks_mut(scalars).enumerate() {
        for scalar in &mut *packet {
            scalar.0 = [0.4 + random.f32() * 0.3; LANES];
        }
        let step = [1.0, 2.0, 0.5, 0.07][number % 4] / 64.0;
        for (axis, lanes) in [(0, LANE_X), (1, LANE_Y)] {
            let first = random.f32() * 1.2 - 0.1;
            packet[axis].0 = lanes.map(|at| first + f32::from(at) * step);
        }
    }
    packets[0].0[3] = f32::NAN;
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
    let bits = |packet: &Packet<f32>| Packet(packet.0.map(f32::to_bits));
    colors.iter().map(bits).collect()
}

/// A shadow map, which is compared by its windows, with what else the shaders read.
fn with_map(level: Level) -> Bindings {
    let random = &mut fastrand::Rng::with_seed(5);
    let rows: Vec<f32> = (0..64 * 64)
        .map(|at| match [at % 64, at / 64] {
            [20..40, 20..40] => random.f32(),
            _ => 0.5,
        })
        .collect();
    let map = ShadowMap::from_rows(64, 64, &rows);
    let texels = texture_from_depth(&map).expect("it is not empty");
    let depths = TexelView::of(Arc::new(texels)).expect("it has a level");
    let bound = |view, map| {
        let texture = Arc::new(BoundTexture::new(view, map, level));
        BoundResource::Other(OtherResource(texture))
    };
    let compared = SamplerDescriptor {
        compare: Some(CompareFunction::LessEqual),
        address_mode_u: AddressMode::ClampToEdge,
        address_mode_v: AddressMode::ClampToEdge,
        ..SamplerDescriptor::trilinear_repeat()
    };
    let numbers = BoundResource::Buffer {
        buffer: BufferData::from_words([0.03_f32, -0.02, 1.5, 1e30].map(f32::to_bits).to_vec()),
        offset: 0,
        size: 16,
        dynamic_offset: None,
    };
    let entries = vec![
        (
            0,
            BoundResource::Sampler(SamplerDescriptor::trilinear_repeat()),
        ),
        (8, bound(depths.clone(), Some(map))),
        (9, BoundResource::Sampler(compared)),
        (10, bound(depths, None)),
        (11, numbers),
    ];
    Bindings {
        groups: vec![BoundGroup {
            group: Arc::new(BoundResources { entries }),
            ..BoundGroup::default()
        }],
        ..Bindings::default()
    }
}

#[test]
fn comparisons_have_the_same_bits_before_and_in_the_code() {
    for (count, filter) in FILTERS {
        let shader = |at: &str| {
            format!(
                "let one = min(abs(in.direction.x) + 1.0, 1.0);
                var sum = 0.0;
                {}
                return vec4f(sum, 0.0, 0.0, one);",
                filter.replace("AT", at)
            )
        };
        let before = program(&shader("in.uv"));
        let in_code = program(&shader("(in.uv * one)"));
        assert_eq!(before.nondependent_reads(), count, "{filter}");
        assert_eq!(in_code.nondependent_reads(), 0, "{filter}");
        // Comparisons of their own kind, and those of any texture.
        let textures = Textures::new(SamplerDescriptor::trilinear_repeat());
        for level in Level::all_available() {
            for bindings in [with_map(level), textures.bindings(level)] {
                let context = (level, &bindings);
                let (before, in_code) = (colors(&before, context), colors(&in_code, context));
                assert_eq!(before, in_code, "{} {filter}", level.name());
            }
        }
    }
}

#[test]
fn depths_that_are_only_compared_before_are_not_read() {
    let shader = "return vec4f(textureSampleCompareLevel(depths, compared, in.uv, 0.5));";
    let compares = TextureReads {
        compares: true,
        ..TextureReads::default()
    };
    assert_eq!(program(shader).texture_reads(0, 8), compares, "in the code");
    let shader =
        "return vec4f(textureSampleCompareLevel(depths, compared, in.uv, in.direction.z));";
    assert_eq!(program(shader).nondependent_reads(), 1);
    assert_eq!(program(shader).texture_reads(0, 8), compares);
    assert_eq!(program(shader).texture_reads(0, 1), TextureReads::default());
}
