//! Sample results that can be computed by hand.

use super::*;
use estampe_texture::{AddressMode, FilterMode, create_texture_with_levels};

/// One row of grey texels.
fn row(codes: &[u8], sampler: SamplerDescriptor) -> Rgba8Texture {
    let rgba: Vec<u8> = codes.iter().flat_map(|&c| [c; 4]).collect();
    let limits = Limits::default();
    let width = u32::try_from(codes.len()).expect("short");
    let format = TextureFormat::Rgba8Unorm;
    let texture = create_texture(width, 1, format, &rgba, MipGeneration::None, &limits);
    sampled(texture.expect("valid"), sampler)
}

fn linear(mode: AddressMode) -> SamplerDescriptor {
    SamplerDescriptor {
        address_mode_u: mode,
        address_mode_v: mode,
        ..SamplerDescriptor::trilinear_repeat()
    }
}

/// The code at u, times 255.
fn code(sampled: &Rgba8Texture, u: f32) -> f32 {
    sampled.sample(Vec2::new(u, 0.5)).x * 255.0
}

fn assert_near(got: f32, expected: f32) {
    assert!((got - expected).abs() < 1e-4, "{got} is not {expected}");
}

#[test]
fn texel_centres_give_texels_and_the_middle_their_mean() {
    for mode in [
        AddressMode::ClampToEdge,
        AddressMode::Repeat,
        AddressMode::MirrorRepeat,
    ] {
        let sampled = row(&[0, 100, 40, 250], linear(mode));
        assert_near(code(&sampled, 0.125), 0.0);
        assert_near(code(&sampled, 0.375), 100.0);
        assert_near(code(&sampled, 0.5), 70.0);
        assert_near(code(&sampled, 0.4375), 85.0);
        assert_near(code(&sampled, 0.875), 250.0);
    }
}

#[test]
fn the_border_is_held_tiled_or_mirrored() {
    let codes = [0, 100, 40, 250];
    let clamp = row(&codes, linear(AddressMode::ClampToEdge));
    assert_near(code(&clamp, -7.0), 0.0);
    assert_near(code(&clamp, 0.01), 0.0);
    assert_near(code(&clamp, 1e30), 250.0);
    assert_near(code(&clamp, f32::NEG_INFINITY), 0.0);
    let repeat = row(&codes, linear(AddressMode::Repeat));
    assert_near(code(&repeat, 0.0), 125.0);
    assert_near(code(&repeat, 1.0), 125.0);
    assert_near(code(&repeat, -0.5), 70.0);
    assert_near(code(&repeat, 3.375), 100.0);
    let mirror = row(&codes, linear(AddressMode::MirrorRepeat));
    assert_near(code(&mirror, 1.0), 250.0);
    assert_near(code(&mirror, 1.125), 250.0);
    assert_near(code(&mirror, 1.5), 70.0);
    assert_near(code(&mirror, -0.375), 100.0);
    assert_near(code(&mirror, 2.5), 70.0);
}

#[test]
fn nearest_is_the_texel_that_contains_the_point() {
    let nearest = SamplerDescriptor {
        address_mode_u: AddressMode::Repeat,
        ..SamplerDescriptor::default()
    };
    let sampled = row(&[10, 20, 30, 40], nearest);
    for (u, expected) in [
        (0.0, 10.0),
        (0.249, 10.0),
        (0.25, 20.0),
        (0.999, 40.0),
        (1.0, 10.0),
        (-0.001, 40.0),
        (-1e-20, 10.0),
    ] {
        assert_near(code(&sampled, u), expected);
    }
}

#[test]
fn one_colour_stays_that_colour_exactly() {
    let limits = Limits::default();
    let rgba = [17, 99, 200, 254].repeat(21 * 21);
    let format = TextureFormat::Rgba8Unorm;
    let texture = create_texture(21, 21, format, &rgba, MipGeneration::Full, &limits);
    let sampled = sampled(texture.expect("valid"), linear(AddressMode::Repeat));
    let expected = [17.0, 99.0, 200.0, 254.0].map(|c: f32| c * (1.0 / 255.0));
    let mut random = Random::new(5);
    for _ in 0..500 {
        let uv = Vec2::new(random.unit() * 9.0 - 4.0, random.unit());
        assert_eq!(
            array(sampled.sample_level(uv, random.unit() * 5.0)),
            expected
        );
    }
}

#[test]
fn a_pixel_of_two_texels_reads_level_one() {
    // Each level has its own grey: 0, 50, 100, 150.
    let levels: Vec<Vec<u8>> = (0..4).map(|l| vec![50 * l; 4 << (6 - 2 * l)]).collect();
    let levels: Vec<&[u8]> = levels.iter().map(Vec::as_slice).collect();
    let format = TextureFormat::Rgba8Unorm;
    let texture = create_texture_with_levels((8, 8), format, &levels, &Limits::default());
    let sampled = sampled(texture.expect("valid"), linear(AddressMode::Repeat));
    // (texels of the base level per pixel, expected code)
    for (texels, expected, tolerance) in [
        (0.0, 0.0, 0.0),
        (0.3, 0.0, 0.0),
        (1.0, 0.0, 0.0),
        (2.0, 50.0, 1e-4),
        (4.0, 100.0, 1e-4),
        (8.0, 150.0, 1e-4),
        (800.0, 150.0, 1e-4),
        (std::f32::consts::SQRT_2, 25.0, 0.01),
        (2.0 * std::f32::consts::SQRT_2, 75.0, 0.01),
    ] {
        let step = texels / 8.0;
        let uv = [
            estampe_simd::LANE_X.map(|x| 0.3 + f32::from(x) * step),
            estampe_simd::LANE_Y.map(|y| 0.7 - f32::from(y) * step),
        ];
        for level in Level::all_available() {
            for color in sample_packet(level, &sampled, uv, Lod::FromQuad) {
                let error = (color[0] * 255.0 - expected).abs();
                assert!(error <= tolerance + 5e-4, "{texels} texels: {color:?}");
            }
        }
        let d = Vec2::new(0.0, step);
        let by_hand = sampled.sample_grad(Vec2::new(0.3, 0.7), Vec2::new(0.0, 0.0), d);
        assert!((by_hand.x * 255.0 - expected).abs() <= tolerance + 5e-4);
    }
}

#[test]
fn magnification_has_its_own_filter() {
    let sampler = SamplerDescriptor {
        mag_filter: FilterMode::Nearest,
        ..linear(AddressMode::ClampToEdge)
    };
    let sampled = row(&[0, 200], sampler);
    let at = |lod| sampled.sample_level(Vec2::new(0.45, 0.5), lod).x * 255.0;
    assert_near(at(0.0), 0.0);
    assert_near(at(-3.0), 0.0);
    assert_near(at(0.1), 80.0);
}

#[test]
fn fetching_reads_the_texel_and_stays_inside() {
    let texture = noise(5, 3, TextureFormat::Rgba8UnormSrgb);
    let sampled = sampled(texture, SamplerDescriptor::default());
    for (x, y, level) in [(0, 0, 0), (4, 2, 0), (2, 1, 0), (1, 0, 1), (0, 0, 2)] {
        let place = sampled.texture().levels[level];
        let at = place.offset + y * place.width + x;
        let [r, g, b, a] = sampled.texture().texels[at as usize].to_le_bytes();
        let linear = |c: u8| estampe_format::srgb::LINEAR_FROM_SRGB[usize::from(c)];
        let (x, y) = (x.cast_signed(), y.cast_signed());
        let got = array(sampled.texel_fetch::<f32>(x, y, level));
        let expected = [
            linear(r),
            linear(g),
            linear(b),
            f32::from(a) * (1.0 / 255.0),
        ];
        assert_eq!(got, expected);
    }
    let corner = array(sampled.texel_fetch::<f32>(4, 2, 0));
    assert_eq!(array(sampled.texel_fetch::<f32>(i32::MAX, 99, 0)), corner);
    let first = array(sampled.texel_fetch::<f32>(0, 0, 0));
    assert_eq!(array(sampled.texel_fetch::<f32>(i32::MIN, -1, 0)), first);
}
