//! Taps of filters, at shifts from each place or in the same columns: together they give what each
//! gives alone.

use super::Random;
use super::requests::{Colors, bits, numbers, packets, textured};
use estampe_simd::{LANES, Level, Packet};
use estampe_texture::{
    AddressMode, PacketLod, PacketPlaces, PacketRequest, SampledTexture, SamplerDescriptor,
    TapShifts, TextureFormat, shifted,
};

/// A packet's scalars: v, something else, u.
fn scalars_at(at: [f32; 2], scale: f32) -> [Packet<f32>; 3] {
    let [u, v] = packets(at, scale);
    [v, Packet([7.0; LANES]), u]
}

pub(super) fn places_of(packets: &[[Packet<f32>; 3]]) -> PacketPlaces<'_> {
    PacketPlaces {
        scalars: packets.as_flattened(),
        stride: 3,
        at: [2, 0],
        gradients: None,
    }
}

/// Samples each tap of each packet by itself.
pub(super) fn each_tap(
    texture: &SampledTexture,
    packets: &[[Packet<f32>; 3]],
    shifts: &[[f32; 2]],
) -> Vec<Colors> {
    let mut colors = Vec::new();
    for ([v, _, u], shift) in packets
        .iter()
        .flat_map(|packet| shifts.iter().map(move |shift| (packet, *shift)))
    {
        let [u, v] = shifted([u, v], shift);
        let request = PacketRequest {
            at: [&u, &v, PacketRequest::ZEROS.at[2]],
            lod: PacketLod::Level,
            ..PacketRequest::ZEROS
        };
        let mut alone = Colors::default();
        texture.sample_request(&request, &mut alone);
        colors.push(alone);
    }
    colors
}

/// Filters: taps at shifts that share columns, rows, both or neither, in each packet of a batch of
/// more packets than are sampled together, at each scale, in every address mode, inside and at
/// borders.
#[test]
fn shifted_samples_are_those_at_shifted_coordinates() {
    let random = &mut Random::new(52);
    let texel = 1.0 / 64.0;
    let square = |side: usize, step: f32| -> Vec<[f32; 2]> {
        let at = |tap: usize| [tap % side, tap / side].map(|at| at as f32 * step - texel);
        (0..side * side).map(at).collect()
    };
    let along = |axis: usize, count: usize| -> Vec<[f32; 2]> {
        let at = |tap: usize| {
            let mut at = [-0.0, 0.0];
            at[axis] = (tap as f32 - 2.0) * 1.3 * texel;
            at
        };
        (0..count).map(at).collect()
    };
    let filters = [
        vec![[-0.0; 2]],
        along(0, 5),
        along(1, 5),
        along(0, 16),
        along(1, 16),
        square(2, texel),
        square(3, 2.0 * texel),
        square(4, 9.0 * texel),
        vec![[f32::NAN, 0.0], [0.0, f32::INFINITY], [0.0, 0.0]],
    ];
    let modes = [
        AddressMode::ClampToEdge,
        AddressMode::Repeat,
        AddressMode::MirrorRepeat,
    ];
    let [mut filtered, mut all] = [0; 2];
    for address_mode in modes {
        let sampler = SamplerDescriptor {
            address_mode_u: address_mode,
            address_mode_v: address_mode,
            ..SamplerDescriptor::trilinear_repeat()
        };
        let texture = textured(TextureFormat::Rgba16Float, sampler);
        for level in Level::all_available() {
            let texture = texture.clone().at_level(level);
            let has_blocks = matches!(level.name(), "avx2" | "avx512");
            for (filter, scale) in filters
                .iter()
                .flat_map(|filter| [1.0, 2.0, 0.5, -1.0, 3.0].map(|scale| (filter, scale)))
            {
                let packets: Vec<_> = (0..21_usize)
                    .map(|packet| {
                        let at = [random.unit() * 1.2 - 0.1, random.unit() * 1.2 - 0.1];
                        let mut scalars = scalars_at(at, scale * texel);
                        // Some do not stand in columns, or not in rows.
                        scalars[packet % 8 / 4 * 2].0[9] += f32::from(packet % 4 == 3) * 0.01;
                        scalars
                    })
                    .collect();
                let places = places_of(&packets);
                let mut together = vec![Colors::default(); packets.len() * filter.len()];
                let (lod, shifts) = (PacketLod::Level, TapShifts::new(filter));
                assert!(texture.sample_shifted(lod, &places, (&shifts, true), &mut together));
                let alone = each_tap(&texture, &packets, filter);
                for (together, alone) in together.iter().zip(&alone) {
                    assert_eq!(numbers(together), numbers(alone), "{level:?} {scale}");
                }
                let found = texture.filtered_taps(&places, &shifts);
                assert!(has_blocks || found == 0, "{level:?}");
                if has_blocks {
                    filtered += found;
                    all += together.len();
                }
            }
        }
    }
    assert!(filtered > all / 4 && filtered < all, "{filtered} of {all}");
}

#[test]
fn shifted_samples_of_other_textures_are_left_to_requests() {
    let sampler = SamplerDescriptor::trilinear_repeat();
    let halves = textured(TextureFormat::Rgba16Float, sampler);
    let bytes = textured(TextureFormat::Rgba8Unorm, sampler);
    let packets = [scalars_at([0.5; 2], 1.0 / 64.0)];
    let places = places_of(&packets);
    let mut colors = vec![Colors::default(); 16];
    let mut sample = |texture: &SampledTexture, lod, taps| {
        let shifts = TapShifts::new(&[[0.5, 0.0]; 17][..taps]);
        texture.sample_shifted(lod, &places, (&shifts, true), &mut colors[..taps.min(16)])
    };
    assert!(!sample(&bytes, PacketLod::Level, 1));
    assert!(!sample(&halves, PacketLod::Implicit, 1));
    assert!(!sample(&halves, PacketLod::Level, 0));
    assert!(sample(&halves, PacketLod::Level, 16));
    // Only the first sixteen shifts count.
    assert!(sample(&halves, PacketLod::Level, 17));
}

/// Filters whose taps stand in columns: at each scale, in every address mode, inside and at
/// borders.
#[test]
fn taps_of_the_same_columns_are_sampled_as_each_alone() {
    let random = &mut Random::new(39);
    let [mut sharing, mut all] = [0; 2];
    let modes = [
        AddressMode::ClampToEdge,
        AddressMode::Repeat,
        AddressMode::MirrorRepeat,
    ];
    for address_mode in modes {
        let sampler = SamplerDescriptor {
            address_mode_u: address_mode,
            address_mode_v: address_mode,
            ..SamplerDescriptor::trilinear_repeat()
        };
        let texture = textured(TextureFormat::Rgba16Float, sampler);
        for level in Level::all_available() {
            let texture = texture.clone().at_level(level);
            let has_blocks = matches!(level.name(), "avx2" | "avx512");
            for (scale, round) in (0..400).map(|at| ([2.0, 0.5, 1.0, -1.0, 3.0][at % 5], at / 5)) {
                let scale = scale / 64.0;
                let [u, v] = [random.unit() * 1.2 - 0.1, random.unit() * 1.2 - 0.1];
                // The third column differs in a lane that is not in the first row.
                let places: Vec<[Packet<f32>; 2]> = (0..13)
                    .map(|tap| {
                        let [column, row] = [tap % 3, tap / 3].map(|at| at as f32 / 64.0);
                        let mut place = packets([u + column * 1.3, v + row * 0.9], scale);
                        place[0].0[9] += if tap % 3 == 2 && tap > 6 { 0.01 } else { 0.0 };
                        place
                    })
                    .collect();
                let found = texture.sharing_taps(&places);
                assert!(has_blocks || found == 0, "{level:?}");
                sharing += found;
                all += 13;
                let mut together = vec![Colors::default(); places.len()];
                texture.sample_each(PacketLod::Level, &places, &mut together);
                for ([u, v], together) in places.iter().zip(&together) {
                    let request = PacketRequest {
                        at: [u, v, PacketRequest::ZEROS.at[2]],
                        lod: PacketLod::Level,
                        ..PacketRequest::ZEROS
                    };
                    let mut alone = Colors::default();
                    texture.sample_request(&request, &mut alone);
                    assert_eq!(bits(together), bits(&alone), "{level:?} {scale} {round}");
                }
            }
        }
    }
    assert!(sharing > 1000 && sharing < all, "{sharing} of {all}");
}
