//! Requests of blocks of pixels, whose samples stand in columns and rows or are neighbouring
//! texels: they give what their lanes give alone.

use super::Random;
use super::requests::{numbers, packets, textured};
use estampe_simd::{LANE_X, LANE_Y, LANES, Level, Packet};
use estampe_texture::{
    AddressMode, Limits, MipGeneration, PacketLod, PacketRequest, SampledTexture,
    SamplerDescriptor, TexelDescriptor, TexelView, TextureFormat,
};

/// Blocks of pixels whose samples stand in columns and rows, as many texels apart as a step says,
/// or nearly so; levels between, borders, and textures that are mirrored.
#[test]
fn blocks_of_pixels_are_sampled_as_their_lanes_alone() {
    let clamped = SamplerDescriptor {
        address_mode_u: AddressMode::ClampToEdge,
        address_mode_v: AddressMode::MirrorRepeat,
        ..SamplerDescriptor::trilinear_repeat()
    };
    let random = &mut Random::new(35);
    let formats = [
        TextureFormat::Rgba16Float,
        TextureFormat::Rgba8Unorm,
        TextureFormat::R8Unorm,
        TextureFormat::R16Unorm,
    ];
    for sampler in [SamplerDescriptor::trilinear_repeat(), clamped] {
        for format in formats {
            let texture = textured(format, sampler);
            for level in Level::all_available() {
                let texture = texture.clone().at_level(level);
                for round in 0..400 {
                    let texels = [1.0, 0.5, 2.0, 0.37, -1.0, 3.0][round % 6];
                    let place = [random.unit() * 1.2 - 0.1, random.unit() * 1.2 - 0.1];
                    // Sometimes at texels' centres, where rounding decides which one is first.
                    let place = match round % 3 {
                        0 => place.map(|at| (at * 64.0).floor() / 64.0 + 0.5 / 64.0),
                        _ => place,
                    };
                    let [mut u, v] = packets(place, texels / 64.0);
                    if round % 11 == 0 {
                        u.0[round % LANES] += 0.001;
                    }
                    let value = Packet([[0.0, 0.0, 1.0, 0.3][round % 4]; LANES]);
                    let request = PacketRequest {
                        at: [&u, &v, PacketRequest::ZEROS.at[2]],
                        lod: PacketLod::Level,
                        value: &value,
                        ..PacketRequest::ZEROS
                    };
                    // Every channel is stored, those too that the format does not have.
                    let mut block = [Packet([7.0; LANES]); 4];
                    texture.sample_request(&request, &mut block);
                    for lane in 0..LANES {
                        let only = |of: &Packet<f32>| Packet([of.0[lane]; LANES]);
                        let [u, v, value] = [only(&u), only(&v), only(&value)];
                        let request = PacketRequest {
                            count: 1,
                            at: [&u, &v, PacketRequest::ZEROS.at[2]],
                            value: &value,
                            ..request
                        };
                        let mut alone = [Packet([7.0; LANES]); 4];
                        texture.sample_request(&request, &mut alone);
                        let [block, alone] = [&block, &alone]
                            .map(|all| all.each_ref().map(|of| of.0.map(f32::to_bits)));
                        assert_eq!(
                            block.map(|of| of[lane]),
                            alone.map(|of| of[0]),
                            "{format:?} {level:?} {texels} {place:?} lane {lane}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn samples_in_columns_and_rows_are_blocks() {
    let clamped = SamplerDescriptor {
        address_mode_u: AddressMode::ClampToEdge,
        address_mode_v: AddressMode::ClampToEdge,
        ..SamplerDescriptor::trilinear_repeat()
    };
    let halves = textured(TextureFormat::Rgba16Float, clamped);
    let bytes = textured(TextureFormat::Rgba8Unorm, clamped);
    for level in Level::all_available() {
        let has_blocks = matches!(level.name(), "avx2" | "avx512");
        // The last steps are too far apart.
        for (step, is_near) in [
            (1.0, true),
            (0.5, true),
            (-1.0, true),
            (2.0, true),
            (3.0, false),
        ] {
            for is_tilted in [false, true] {
                let [mut u, v] = packets([0.3, 0.4], step / 64.0);
                u.0[9] += if is_tilted { 1e-4 } else { 0.0 };
                let request = PacketRequest {
                    at: [&u, &v, PacketRequest::ZEROS.at[2]],
                    lod: PacketLod::Level,
                    ..PacketRequest::ZEROS
                };
                let found = halves.clone().at_level(level).samples_a_block(&request);
                let expected = has_blocks && is_near && !is_tilted;
                assert_eq!(found, expected, "{level:?}, {step} texels, {is_tilted}");
                assert!(!bytes.clone().at_level(level).samples_a_block(&request));
            }
        }
    }
}

/// At a scale of one texel a pixel, texels are loaded as neighbours: any half floats, infinities
/// and NaNs too, up to the last texel of the texture.
#[test]
fn neighbouring_texels_are_sampled_as_lanes_alone() {
    let random = &mut Random::new(37);
    let [mut neighbours, mut others] = [0; 2];
    for address_mode in [AddressMode::ClampToEdge, AddressMode::Repeat] {
        let sampler = SamplerDescriptor {
            address_mode_u: address_mode,
            address_mode_v: address_mode,
            ..SamplerDescriptor::trilinear_repeat()
        };
        // A single level and layer, so that the image ends where the texture does.
        let descriptor = TexelDescriptor::new_2d(32, 16, TextureFormat::Rgba16Float);
        let created = descriptor.create(&[], MipGeneration::None, &Limits::default());
        let mut image = created.expect("a small texture");
        let words = image
            .texels
            .iter()
            .map(|_| (random.bits() << 8) ^ random.bits());
        image.texels = std::sync::Arc::new(words.collect::<Vec<u32>>().into());
        let texture = SampledTexture::new(TexelView::of(image).unwrap(), sampler).unwrap();
        for level in Level::all_available() {
            let texture = texture.clone().at_level(level);
            let has_blocks = matches!(level.name(), "avx2" | "avx512");
            for round in 0..600 {
                let (column, row) = (random.bits() % 34, random.bits() % 18);
                let shift = [0.5, random.unit()][round % 2];
                let at = |first: u32, pixel: u8| first as f32 - 2.0 + f32::from(pixel) + shift;
                let u = Packet(LANE_X.map(|pixel| at(column, pixel) / 32.0));
                let v = Packet(LANE_Y.map(|pixel| at(row, pixel) / 16.0));
                let request = PacketRequest {
                    at: [&u, &v, PacketRequest::ZEROS.at[2]],
                    lod: PacketLod::Level,
                    ..PacketRequest::ZEROS
                };
                let are_neighbours = texture.samples_neighbours(&request);
                // With another texel on each side, the four columns and rows are far from borders.
                if (4..28).contains(&column) && (4..12).contains(&row) {
                    assert_eq!(are_neighbours, has_blocks, "{level:?} {column} {row}");
                }
                neighbours += u32::from(are_neighbours);
                others += u32::from(!are_neighbours);
                let mut block = [Packet([7.0; LANES]); 4];
                texture.sample_each(
                    PacketLod::Level,
                    &[[u, v]],
                    std::slice::from_mut(&mut block),
                );
                for lane in 0..LANES {
                    let [u, v] = [&u, &v].map(|of: &Packet<f32>| Packet([of.0[lane]; LANES]));
                    let request = PacketRequest {
                        count: 1,
                        at: [&u, &v, PacketRequest::ZEROS.at[2]],
                        ..request
                    };
                    let mut alone = [Packet([7.0; LANES]); 4];
                    texture.sample_request(&request, &mut alone);
                    for (block, alone) in numbers(&block).iter().zip(numbers(&alone)) {
                        assert_eq!(
                            block[lane], alone[0],
                            "{level:?} {column} {row} lane {lane}"
                        );
                    }
                }
            }
        }
    }
    assert!(neighbours > 400 && others > 400, "{neighbours} {others}");
}
