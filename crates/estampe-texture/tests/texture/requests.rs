//! Requests of compiled shaders: together they give what each gives alone.

use super::{Random, noise};
use estampe_simd::{LANE_X, LANE_Y, LANES, Level, Packet};
use estampe_texture::{
    AddressMode, FilterMode, Limits, MipGeneration, PacketLod, PacketPlace, PacketPlaces,
    PacketRequest, SampledTexture, SamplerDescriptor, ShadowMap, TapShifts, TexelDescriptor,
    TexelView, TexelViewDescriptor, TextureDimension, TextureFormat, ViewDimension,
    compare_packets, shifted,
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

/// Whether a number is NaN counts, not its bits: the order of operands decides which NaN results.
fn numbers(colors: &[Packet<f32>]) -> Vec<[u32; LANES]> {
    let number = |value: f32| match value.is_nan() {
        true => f32::NAN.to_bits(),
        false => value.to_bits(),
    };
    colors.iter().map(|packet| packet.0.map(number)).collect()
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
