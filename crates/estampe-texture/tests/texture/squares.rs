//! Filters of half floats in squares of sixteen packets, as full-screen passes ask for them.

use super::Random;
use super::requests::{Colors, packets, textured};
use super::taps::{each_tap, places_of};
use estampe_simd::{LANES, Level, Packet};
use estampe_texture::{
    AddressMode, PacketLod, SampledTexture, SamplerDescriptor, TapShifts, TextureFormat,
};
use estampe_types::morton::compact;
use std::collections::BTreeMap;

const TEXEL: f32 = 1.0 / 64.0;

/// The scalars of sixteen packets of a square from a place on, so far from pixel to pixel.
fn square([u, v]: [f32; 2], step: f32) -> Vec<[Packet<f32>; 3]> {
    let packet = |number: u32| {
        let [x, y] = [compact(number), compact(number >> 1)].map(|at| (4 * at) as f32 * step);
        let [u, v] = packets([u + x, v + y], step);
        [v, Packet([7.0; LANES]), u]
    };
    (0..16).map(packet).collect()
}

fn numbers(colors: &[Packet<f32>]) -> Vec<[u32; LANES]> {
    let bits = colors.iter().map(|packet| packet.0.map(f32::to_bits));
    bits.collect()
}

fn texture(address_mode: AddressMode) -> SampledTexture {
    let sampler = SamplerDescriptor {
        address_mode_u: address_mode,
        address_mode_v: address_mode,
        ..SamplerDescriptor::trilinear_repeat()
    };
    textured(TextureFormat::Rgba16Float, sampler)
}

fn filters() -> Vec<Vec<[f32; 2]>> {
    let along = |axis: usize, count: usize, step: f32| -> Vec<[f32; 2]> {
        let at = |tap: usize| {
            let mut at = [-0.0, 0.0];
            at[axis] = (tap as f32 - 2.0) * step * TEXEL;
            at
        };
        (0..count).map(at).collect()
    };
    let down = [
        [0, 0],
        [-2, -2],
        [2, -2],
        [-2, 2],
        [2, 2],
        [0, -2],
        [-2, 0],
        [2, 0],
        [0, 2],
        [-1, -1],
        [1, -1],
        [-1, 1],
        [1, 1],
    ];
    vec![
        vec![[-0.0; 2]],
        along(0, 5, 1.3),
        along(1, 5, 1.3),
        along(1, 16, 9.0),
        down.map(|at| at.map(|at: i8| f32::from(at) * TEXEL))
            .to_vec(),
        vec![[f32::NAN, 0.0], [0.0, f32::INFINITY], [0.0, 0.0]],
    ]
}

/// At each scale, in every address mode, inside and at borders, squares are sampled as each tap
/// alone; so are packets that are nearly a square.
#[test]
fn squares_are_sampled_as_each_tap_alone() {
    let random = &mut Random::new(53);
    // The squares of each level that filters blocks, and those of them that are filtered channel by
    // channel.
    let mut squares = BTreeMap::new();
    let mut planes = 0;
    let mut cases = 0;
    let modes = [
        AddressMode::ClampToEdge,
        AddressMode::Repeat,
        AddressMode::MirrorRepeat,
    ];
    for (mode, level) in modes.into_iter().flat_map(|mode| {
        Level::all_available()
            .into_iter()
            .map(move |level| (mode, level))
    }) {
        let texture = texture(mode).at_level(level);
        let has_blocks = matches!(level.name(), "avx2" | "avx512");
        let steps = [1.0, 2.0, 0.5, -1.0, 0.07, 5.0].map(|scale| scale * TEXEL);
        for (filter, step) in filters()
            .iter()
            .flat_map(|filter| steps.map(|step| (filter, step)))
        {
            let at = [random.unit() * 1.2 - 0.1, random.unit() * 1.2 - 0.1];
            let mut packets = square(at, step);
            let is_square = random.unit() < 0.8;
            if !is_square {
                // One packet stands elsewhere, or has a row apart.
                let number = [1, 3, 5, 10, 15][cases % 5];
                let moved = &mut packets[number][if random.unit() < 0.5 { 0 } else { 2 }];
                let lanes = if random.unit() < 0.5 { LANES } else { 2 };
                moved.0[..lanes]
                    .iter_mut()
                    .for_each(|at| *at += 0.5 * TEXEL);
            }
            let places = places_of(&packets);
            let shifts = TapShifts::new(filter);
            let mut together = vec![Colors::default(); 16 * filter.len()];
            assert!(texture.sample_shifted(
                PacketLod::Level,
                &places,
                (&shifts, true),
                &mut together
            ));
            let alone = each_tap(&texture, &packets, filter);
            for (together, alone) in together.iter().zip(&alone) {
                assert_eq!(
                    numbers(together),
                    numbers(alone),
                    "{level:?} {mode:?} {step}"
                );
            }
            let mut colors = vec![[Packet([-7.0; LANES]); 4]; 16 * filter.len()];
            let of = (&shifts, false);
            assert!(texture.sample_shifted(PacketLod::Level, &places, of, &mut colors));
            for (colors, alone) in colors.iter().zip(&alone) {
                assert_eq!(numbers(&colors[..3]), numbers(&alone[..3]), "{level:?}");
            }
            planes += u32::from(
                colors
                    .iter()
                    .all(|[_, _, _, alpha]| alpha.0 == [-7.0; LANES]),
            );
            let found = texture.filters_a_square(&places, &shifts);
            // The texture has fewer rows than a square may read.
            assert_eq!(found, has_blocks && is_square, "{level:?}");
            if has_blocks {
                *squares.entry(level.name()).or_insert(0) += u32::from(found);
            }
            cases += 1;
        }
    }
    let by_planes = squares.contains_key("avx2");
    assert_eq!(planes > 10, by_planes, "{planes} squares");
    for (level, count) in squares {
        assert!(count > 50, "{count} squares at {level}");
    }
}
