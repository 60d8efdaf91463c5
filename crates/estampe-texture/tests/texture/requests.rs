//! Requests of compiled shaders: together they give what each gives alone.

use super::{Random, noise};
use estampe_simd::{LANE_X, LANE_Y, LANES, Level, Packet};
use estampe_texture::{
    AddressMode, FilterMode, Limits, MipGeneration, PacketLod, PacketPlace, PacketRequest,
    SampledTexture, SamplerDescriptor, ShadowMap, TexelDescriptor, TexelView, TexelViewDescriptor,
    TextureDimension, TextureFormat, ViewDimension, compare_packets,
};

pub(super) type Colors = [Packet<f32>; 4];

pub(super) fn bits(colors: &[Packet<f32>]) -> Vec<[u32; LANES]> {
    let bits = colors.iter().map(|packet| packet.0.map(f32::to_bits));
    bits.collect()
}

/// Coordinates of neighbouring pixels from a place on.
pub(super) fn packets([u, v]: [f32; 2], step: f32) -> [Packet<f32>; 2] {
    let axis = |lanes: [u8; LANES], from: f32| Packet(lanes.map(|at| from + f32::from(at) * step));
    [axis(LANE_X, u), axis(LANE_Y, v)]
}

#[test]
fn textures_at_the_same_coordinates_are_sampled_as_alone() {
    let trilinear = SamplerDescriptor::trilinear_repeat();
    let clamped = SamplerDescriptor {
        address_mode_u: AddressMode::ClampToEdge,
        mag_filter: FilterMode::Nearest,
        ..trilinear
    };
    let from_level = |side: u32, base_mip_level, sampler| {
        let descriptor = TexelViewDescriptor {
            base_mip_level,
            ..TexelViewDescriptor::default()
        };
        let view = TexelView::new(noise(side, 32, TextureFormat::Rgba8Unorm), &descriptor);
        SampledTexture::new(view.unwrap(), sampler).unwrap()
    };
    let of = |side, sampler| from_level(side, 0, sampler);
    // Alike, of another size, with another sampler, of another kind.
    let textures = [
        of(64, trilinear),
        of(64, trilinear),
        of(32, trilinear),
        of(64, clamped),
        from_level(64, 1, trilinear),
    ];
    assert!(textures[0].common().is_some() && textures[4].common().is_none());
    let random = &mut Random::new(31);
    for level in Level::all_available() {
        let textures = textures.clone().map(|texture| texture.at_level(level));
        for _ in 0..60 {
            let step = random.unit() * random.unit() * 0.1;
            let uv = packets([random.unit() * 1.2 - 0.1, random.unit()], step);
            let request = PacketRequest {
                at: [&uv[0], &uv[1], PacketRequest::ZEROS.at[2]],
                ..PacketRequest::ZEROS
            };
            for count in 1..=textures.len() {
                let all: Vec<&SampledTexture> = textures[..count].iter().collect();
                let mut together = vec![Colors::default(); count];
                SampledTexture::sample_all_flat(&all, PacketPlace::Quads(&uv), &mut together);
                for (texture, together) in all.iter().zip(&together) {
                    let mut alone = Colors::default();
                    texture.sample_request(&request, &mut alone);
                    assert_eq!(bits(together), bits(&alone), "{level:?} {uv:?}");
                }
            }
        }
    }
}

#[test]
fn comparisons_with_one_depth_are_those_alone() {
    // A plane at ½ with a rough square in it.
    let random = &mut Random::new(8);
    let rows: Vec<f32> = (0..64 * 64)
        .map(|at| match [at % 64, at / 64] {
            [20..40, 20..40] => random.unit(),
            _ => 0.5,
        })
        .collect();
    let map = ShadowMap::from_rows(64, 64, &rows);
    let [mut lit, mut dark, mut mixed] = [0; 3];
    for level in Level::all_available() {
        for round in 0..400 {
            let place = [random.unit() * 1.4 - 0.2, random.unit() * 1.4 - 0.2];
            let step = [0.0, 1.0 / 64.0, 0.2][round % 3];
            let mut at: Vec<[Packet<f32>; 2]> = (0..9_u8)
                .map(|sample| {
                    let [column, row] = [sample % 3, sample / 3].map(|at| f32::from(at) / 64.0);
                    packets([place[0] + column, place[1] + row], step)
                })
                .collect();
            if round % 20 == 0 {
                at[round % 9][round % 2].0[5] = f32::NAN;
            }
            let reference = Packet([0.3 + random.unit() * 0.4; LANES]);
            let at: Vec<[&Packet<f32>; 2]> = at.iter().map(|[u, v]| [u, v]).collect();
            let mut together = vec![Packet([7.0; LANES]); 9];
            compare_packets(&map, level, (&at, &reference), &mut together);
            let mut alone = vec![Packet([7.0; LANES]); 9];
            for (at, share) in at.iter().zip(&mut alone) {
                let share = std::slice::from_mut(share);
                compare_packets(&map, level, (&[*at], &reference), share);
            }
            assert_eq!(bits(&together), bits(&alone), "{level:?} {at:?}");
            for share in together.iter().flat_map(|packet| packet.0) {
                match share {
                    1.0 => lit += 1,
                    0.0 => dark += 1,
                    _ => mixed += 1,
                }
            }
        }
    }
    assert!(
        lit > 1000 && dark > 1000 && mixed > 1000,
        "{lit} {dark} {mixed}"
    );
}

/// A texture of random texels, two layers of 64×32 with three mip levels; of half floats those
/// below 2. The view is its second layer.
pub(super) fn textured(format: TextureFormat, sampler: SamplerDescriptor) -> SampledTexture {
    let descriptor = TexelDescriptor {
        dimension: TextureDimension::D2,
        width: 64,
        height: 32,
        depth_or_layers: 2,
        mip_level_count: 3,
        sample_count: 1,
        format,
    };
    let created = descriptor.create(&[], MipGeneration::None, &Limits::default());
    let mut texture = created.expect("a small texture");
    let random = &mut Random::new(34);
    let of_format = match format {
        TextureFormat::Rgba16Float => 0x3FFF_3FFF,
        _ => u32::MAX,
    };
    let words = texture
        .texels
        .iter()
        .map(|_| ((random.bits() << 8) ^ random.bits()) & of_format);
    texture.texels = std::sync::Arc::new(words.collect::<Vec<u32>>().into());
    let view = TexelViewDescriptor {
        dimension: Some(ViewDimension::D2),
        base_array_layer: 1,
        ..TexelViewDescriptor::default()
    };
    SampledTexture::new(TexelView::new(texture, &view).unwrap(), sampler).unwrap()
}

#[test]
fn a_texture_at_several_places_is_sampled_as_at_each() {
    let random = &mut Random::new(36);
    for format in [TextureFormat::Rgba16Float, TextureFormat::Rgba8Unorm] {
        let texture = textured(format, SamplerDescriptor::trilinear_repeat());
        for level in Level::all_available() {
            let texture = texture.clone().at_level(level);
            for lod in [PacketLod::Level, PacketLod::Implicit] {
                let places: Vec<[Packet<f32>; 2]> = (0..9)
                    .map(|_| packets([random.unit(), random.unit()], 1.0 / 64.0))
                    .collect();
                let mut together = vec![Colors::default(); places.len()];
                texture.sample_each(lod, &places, &mut together);
                for ([u, v], together) in places.iter().zip(&together) {
                    let request = PacketRequest {
                        at: [u, v, PacketRequest::ZEROS.at[2]],
                        lod,
                        ..PacketRequest::ZEROS
                    };
                    let mut alone = Colors::default();
                    texture.sample_request(&request, &mut alone);
                    assert_eq!(bits(together), bits(&alone), "{format:?} {level:?} {lod:?}");
                }
            }
        }
    }
}

/// Whether a number is NaN counts, not its bits: the order of operands decides which NaN results.
pub(super) fn numbers(colors: &[Packet<f32>]) -> Vec<[u32; LANES]> {
    let number = |value: f32| match value.is_nan() {
        true => f32::NAN.to_bits(),
        false => value.to_bits(),
    };
    colors.iter().map(|packet| packet.0.map(number)).collect()
}
