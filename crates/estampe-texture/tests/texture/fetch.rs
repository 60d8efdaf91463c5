//! Fetches by packets give the same bits as fetches one by one.

use super::Random;
use estampe_format::TexelCodec;
use estampe_simd::{LANE_X, LANE_Y, LANES, Level, Packet};
use estampe_texture::{
    Limits, MipGeneration, TexelDescriptor, TexelView, TexelViewDescriptor, TextureDimension,
    TextureFormat, ViewDimension,
};
use estampe_types::SampleType;

/// Every format, dimension and level; places inside and outside.
#[test]
fn packets_fetch_what_single_lanes_fetch() {
    use ViewDimension as V;
    let mut random = Random::new(31);
    let (mut by_packets, mut integers, mut one_by_one, mut outside) = (0, 0, 0, 0);
    for &format in TextureFormat::ALL {
        for dimension in [V::D1, V::D2, V::D2Array, V::Cube, V::CubeArray, V::D3] {
            let Some(view) = view_of(format, dimension, &mut random) else {
                continue;
            };
            for level in Level::all_available() {
                let mips = u32::try_from(view.level_count()).unwrap();
                let mip = (random.bits() % mips).cast_signed();
                let mut place = |side: u32| {
                    Packet([0; LANES].map(|_| (random.bits() % (side + 2)).cast_signed() - 1))
                };
                let places = [
                    place(8),
                    place(8),
                    place(13),
                    Packet([mip; LANES]),
                    Packet([0; LANES]),
                ];
                let mut texels = [Packet([7.0; LANES]); 4];
                let is_number = matches!(
                    TexelCodec::new(format).sample_type(),
                    SampleType::Float | SampleType::Depth
                );
                let done = view.fetch_packet(level, places.each_ref(), &mut texels);
                // All but stencil.
                let has_packets = (is_number || format.is_color()) && !level.is_scalar();
                assert_eq!(done, has_packets, "{format:?} at {}", level.name());
                if !done {
                    one_by_one += 1;
                    continue;
                }
                by_packets += 1;
                integers += u32::from(!is_number);
                for lane in 0..LANES {
                    let [x, y, z, mip, sample] = places.each_ref().map(|place| place.0[lane]);
                    let found = crate::array(view.fetch([x, y, z], mip, sample));
                    outside += u32::from(found == [0.0; 4]);
                    let expected = found.map(f32::to_bits);
                    let got = texels.each_ref().map(|channel| channel.0[lane].to_bits());
                    assert_eq!(
                        got,
                        expected,
                        "{format:?} {dimension:?} at {}",
                        level.name()
                    );
                }
            }
        }
    }
    assert!(by_packets > 100 && integers > 40 && one_by_one > 0 && outside > 1000);
}

/// Blocks of 4×4 texels, as a pass over a whole picture loads them, some across a border.
#[test]
fn blocks_of_texels_are_those_of_single_lanes() {
    let mut random = Random::new(33);
    for format in [TextureFormat::Rgba16Float, TextureFormat::Rgba32Float] {
        let view = view_of(format, ViewDimension::D2, &mut random).expect("a 2D format");
        for level in Level::all_available()
            .into_iter()
            .filter(|level| !level.is_scalar())
        {
            for [x, y] in [[0, 0], [4, 4], [3, 1], [5, 2], [-1, 0]] {
                let block =
                    |lanes: [u8; LANES], first: i32| Packet(lanes.map(|at| first + i32::from(at)));
                let none = Packet([0; LANES]);
                let places = [block(LANE_X, x), block(LANE_Y, y), none, none, none];
                let mut texels = <[Packet<f32>; 4]>::default();
                assert!(view.fetch_packet(level, places.each_ref(), &mut texels));
                for lane in 0..LANES {
                    let [x, y, z, mip, sample] = places.each_ref().map(|place| place.0[lane]);
                    let expected = crate::array(view.fetch([x, y, z], mip, sample));
                    let got = texels.each_ref().map(|channel| channel.0[lane].to_bits());
                    let name = level.name();
                    assert_eq!(
                        got,
                        expected.map(f32::to_bits),
                        "{format:?} at {name}, ({x}, {y})"
                    );
                }
            }
        }
    }
}

/// Textures of one size are read together where the texels are a block inside their level.
#[test]
fn blocks_of_several_textures_are_those_of_each() {
    let mut random = Random::new(35);
    let mut of = |format| view_of(format, ViewDimension::D2, &mut random).expect("a 2D format");
    let halves = [(); 3].map(|()| of(TextureFormat::Rgba16Float));
    let several = [
        TextureFormat::Rgba8UnormSrgb,
        TextureFormat::Rgba16Float,
        TextureFormat::Depth32Float,
    ];
    let several = several.map(&mut of);
    let words = [
        TextureFormat::R32Float,
        TextureFormat::Bgra8Unorm,
        TextureFormat::Rgba8Unorm,
    ];
    let words = words.map(&mut of);
    let other = of(TextureFormat::Rgb10a2Unorm);
    for level in Level::all_available() {
        let has_halves = matches!(level.name(), "avx2" | "avx512");
        // Level 0 has 8×8 texels.
        for (x, y, mip, is_inside) in [
            (0, 0, 0, true),
            (4, 4, 0, true),
            (3, 1, 0, true),
            (5, 2, 0, false),
            (-1, 0, 0, false),
            (0, 5, 0, false),
            (0, i32::MIN, 0, false),
            (0, 0, 1, true),
            (1, 0, 1, false),
            (0, 0, 2, false),
            (0, 0, -1, false),
        ] {
            let block = |lanes: [u8; LANES], first: i32| {
                Packet(lanes.map(|at| first.wrapping_add(i32::from(at))))
            };
            let places = [block(LANE_X, x), block(LANE_Y, y), Packet([mip; LANES])];
            for views in [&halves, &several, &words] {
                let mut texels = [[Packet([7.0; LANES]); 4]; 3];
                let mut fetch = |views: [&TexelView; 3], places: [&Packet<i32>; 3]| {
                    TexelView::fetch_blocks(&views.map(Some), level, places, &mut texels)
                };
                let mut tilted = places;
                tilted[1].0[9] ^= 1;
                assert!(!fetch(views.each_ref(), tilted.each_ref()));
                assert!(!fetch([&views[0], &other, &views[2]], places.each_ref()));
                let done = fetch(views.each_ref(), places.each_ref());
                assert_eq!(done, has_halves && is_inside, "{level:?} {x} {y} {mip}");
                for (view, texels) in views.iter().zip(&texels).filter(|_| done) {
                    for lane in 0..LANES {
                        let [x, y, mip] = places.each_ref().map(|place| place.0[lane]);
                        let expected = crate::array(view.fetch([x, y, 0], mip, 0));
                        let got = texels.each_ref().map(|channel| channel.0[lane].to_bits());
                        assert_eq!(got, expected.map(f32::to_bits), "{level:?} ({x}, {y})");
                    }
                }
            }
        }
    }
}

/// At the pixels of fragments, packet by packet: those that are blocks.
#[test]
fn texels_at_pixels_are_those_of_blocks() {
    let mut random = Random::new(36);
    let mut of = |format| view_of(format, ViewDimension::D2, &mut random).expect("a 2D format");
    let views = [TextureFormat::Rgba16Float, TextureFormat::Depth32Float].map(&mut of);
    let views = views.each_ref();
    let all = views.map(Some);
    let other = of(TextureFormat::Rgb10a2Unorm);
    // Level 0 has 8×8 texels.
    let pixels: Vec<[f32; 2]> = (0..19_u8)
        .map(|at| [at * 3 % 11, at * 5 % 7].map(f32::from))
        .collect();
    let positions: Vec<[Packet<f32>; 4]> = (pixels.iter().enumerate())
        .map(|(at, [x, y])| {
            let axis = |first: f32, lanes: [u8; LANES]| {
                Packet(lanes.map(|lane| first + f32::from(lane) + 0.5))
            };
            let mut position = [axis(*x, LANE_X), axis(*y, LANE_Y), Packet::default()];
            if at == 7 {
                position[0].0[5] += 1.0;
            }
            let [x, y, z] = position;
            [x, y, z, z]
        })
        .collect();
    for level in Level::all_available() {
        let mut texels = vec![[Packet([7.0; LANES]); 4]; 2 * positions.len()];
        let others = TexelView::fetch_at_pixels(&all, level, &positions, &mut texels);
        let has_halves = matches!(level.name(), "avx2" | "avx512");
        for (at, ([x, y], texels)) in pixels.iter().zip(texels.chunks(2)).enumerate() {
            let is_block = *x <= 4.0 && *y <= 4.0 && at != 7;
            assert_eq!(
                others >> at & 1 == 0,
                has_halves && is_block,
                "{level:?} {at}"
            );
            for (view, texels) in views.iter().zip(texels).filter(|_| others >> at & 1 == 0) {
                for lane in 0..LANES {
                    let places = [positions[at][0], positions[at][1]];
                    #[expect(clippy::cast_possible_truncation, reason = "small positions")]
                    let [x, y] = places.map(|place| place.0[lane] as i32);
                    let expected = crate::array(view.fetch([x, y, 0], 0, 0));
                    let got = texels.each_ref().map(|channel| channel.0[lane].to_bits());
                    assert_eq!(got, expected.map(f32::to_bits), "{level:?} ({x}, {y})");
                }
            }
        }
        let views = [Some(views[0]), Some(&other)];
        let others = TexelView::fetch_at_pixels(&views, level, &positions, &mut texels);
        assert_eq!(others, (1 << positions.len()) - 1);
        assert_eq!(TexelView::fetch_at_pixels(&views, level, &[], &mut []), 0);
    }
}

#[test]
fn packets_with_different_levels_are_fetched_one_by_one() {
    let mut random = Random::new(32);
    let view = view_of(TextureFormat::Rgba8Unorm, ViewDimension::D2, &mut random);
    let view = view.expect("8-bit colours are 2D");
    let none = Packet([0; LANES]);
    for (mips, samples) in [
        ([1, 0], [0, 0]),
        ([0, 0], [0, 1]),
        ([9, 9], [0, 0]),
        ([-1, -1], [0, 0]),
    ] {
        let alternating = |[even, odd]: [i32; 2]| {
            Packet(std::array::from_fn(
                |lane| if lane % 2 == 0 { even } else { odd },
            ))
        };
        let places = [none, none, none, alternating(mips), alternating(samples)];
        let mut texels = <[Packet<f32>; 4]>::default();
        assert!(!view.fetch_packet(Level::best(), places.each_ref(), &mut texels));
    }
}

/// A view of two levels of random bytes, all of the texture but its first layer; `None` if the
/// format does not have the dimension.
fn view_of(
    format: TextureFormat,
    dimension: ViewDimension,
    random: &mut Random,
) -> Option<TexelView> {
    use ViewDimension as V;
    let (of_texture, height, layers) = match dimension {
        V::D1 => (TextureDimension::D1, 1, 1),
        V::D3 => (TextureDimension::D3, 8, 8),
        V::D2 => (TextureDimension::D2, 8, 2),
        V::D2Array | V::Cube | V::CubeArray => (TextureDimension::D2, 8, 13),
    };
    let descriptor = TexelDescriptor {
        dimension: of_texture,
        width: 8,
        height,
        depth_or_layers: layers,
        mip_level_count: if dimension == V::D1 { 1 } else { 2 },
        sample_count: 1,
        format,
    };
    let created = descriptor.create(&[], MipGeneration::None, &Limits::default());
    let mut texture = created.ok()?;
    let words = texture
        .texels
        .iter()
        .map(|_| (random.bits() << 8) ^ random.bits());
    texture.texels = std::sync::Arc::new(words.collect::<Vec<u32>>().into());
    let base_array_layer = u32::from(matches!(
        dimension,
        V::D2 | V::D2Array | V::Cube | V::CubeArray
    ));
    let descriptor = TexelViewDescriptor {
        dimension: Some(dimension),
        base_array_layer,
        ..TexelViewDescriptor::default()
    };
    TexelView::new(texture, &descriptor).ok()
}
