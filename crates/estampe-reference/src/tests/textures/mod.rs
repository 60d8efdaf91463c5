//! Sampling of 2D textures: addressing, filters, level of detail.

mod views;

use super::*;
use estampe_types::shader::Sample2d;
use std::sync::Arc;

/// A texture with these red codes in each mip level; green is 255 minus red, blue 0, alpha 51.
fn texture(
    format: TextureFormat,
    sizes: &[[u32; 2]],
    reds: &[u8],
    sampler: SamplerDescriptor,
) -> ReferenceTexture {
    let mut offset = 0;
    let levels = sizes.iter().map(|&[width, height]| {
        let level = MipLevel {
            width,
            height,
            offset,
        };
        offset += width * height;
        level
    });
    let words = reds
        .iter()
        .map(|&red| u32::from_le_bytes([red, 255 - red, 0, 51]));
    let texture = TexelData {
        format,
        levels: levels.collect(),
        texels: Arc::new(words.collect::<Vec<u32>>().into()),
        is_opaque: false,
        alpha_maps: Arc::default(),
        squares: Arc::default(),
        shape: estampe_types::TextureShape::default(),
    };
    ReferenceTexture::new(Arc::new(texture), sampler)
}

fn sampler(mode: AddressMode, filter: FilterMode) -> SamplerDescriptor {
    SamplerDescriptor {
        address_mode_u: mode,
        address_mode_v: mode,
        mag_filter: filter,
        min_filter: filter,
        ..SamplerDescriptor::default()
    }
}

/// The sampled red, as a code, of a row of four texels 0, 100, 200, 250.
fn red(mode: AddressMode, filter: FilterMode, u: f32) -> f32 {
    let row = texture(
        TextureFormat::Rgba8Unorm,
        &[[4, 1]],
        &[0, 100, 200, 250],
        sampler(mode, filter),
    );
    row.sample(Vec2::new(u, 0.5)).x * 255.0
}

/// Rows: F2.
#[test]
fn addresses_wrap_as_they_say() {
    use AddressMode::{ClampToEdge, MirrorRepeat, Repeat};
    let row = [0.0, 100.0, 200.0, 250.0];
    for texel in -9_i32..9 {
        let u = (texel as f32 + 0.5) / 4.0;
        let near = |mode, index: i32| {
            let found = red(mode, FilterMode::Nearest, u);
            let expected = row[usize::try_from(index).expect("a texel")];
            assert!(
                (found - expected).abs() < 1e-3,
                "{mode:?} {u}: {found}, not {expected}"
            );
        };
        near(ClampToEdge, texel.clamp(0, 3));
        near(Repeat, texel.rem_euclid(4));
        let twice = texel.rem_euclid(8);
        near(MirrorRepeat, Ord::min(twice, 7 - twice));
    }
    // The ends, and coordinates that are huge, infinite or NaN.
    assert_eq!(red(Repeat, FilterMode::Nearest, 1.0), 0.0);
    assert_eq!(red(Repeat, FilterMode::Nearest, -1e-10), 0.0);
    for u in [f32::NAN, f32::INFINITY, -f32::INFINITY, 3e38] {
        for filter in [FilterMode::Nearest, FilterMode::Linear] {
            assert_eq!(
                red(Repeat, filter, u).round(),
                if filter == FilterMode::Linear {
                    125.0
                } else {
                    0.0
                }
            );
            assert!(red(MirrorRepeat, filter, u) < 1e-3, "{u}");
            let clamped = if u > 0.0 { 250.0 } else { 0.0 };
            assert_eq!(red(ClampToEdge, filter, u).round(), clamped, "{u}");
        }
    }
}

/// Rows: F2.
#[test]
fn bilinear_weights_lie_between_centres() {
    use AddressMode::{ClampToEdge, MirrorRepeat, Repeat};
    let close = |mode, u: f32, expected: f32| {
        let found = red(mode, FilterMode::Linear, u);
        assert!(
            (found - expected).abs() < 1e-3,
            "{mode:?} {u}: {found}, not {expected}"
        );
    };
    for mode in [ClampToEdge, Repeat, MirrorRepeat] {
        close(mode, 1.5 / 4.0, 100.0); // a centre
        close(mode, 2.0 / 4.0, 150.0); // between two
        close(mode, 1.75 / 4.0, 125.0); // a quarter of the way
    }
    close(ClampToEdge, 0.0, 0.0);
    close(MirrorRepeat, 1.0, 250.0);
    close(Repeat, 0.0, 125.0); // between the last and the first
    close(Repeat, 1.0, 125.0);

    // In two directions.
    let square = texture(
        TextureFormat::Rgba8Unorm,
        &[[2, 2]],
        &[0, 40, 80, 200],
        sampler(ClampToEdge, FilterMode::Linear),
    );
    assert_eq!(square.sample(Vec2::new(0.5, 0.5)).x, 80.0 * (1.0 / 255.0));
    assert_eq!(square.sample(Vec2::new(0.5, 0.5)).w, 51.0 * (1.0 / 255.0));
}

/// Rows: F2.
#[test]
fn srgb_is_decoded_before_it_is_filtered() {
    let pair = |format| {
        let linear = sampler(AddressMode::ClampToEdge, FilterMode::Linear);
        texture(format, &[[2, 1]], &[0, 255], linear).sample(Vec2::new(0.5, 0.5))
    };
    let decoded = pair(TextureFormat::Rgba8UnormSrgb);
    assert_eq!((decoded.x, decoded.y), (0.5, 0.5));
    assert_eq!(decoded.w, 51.0 * (1.0 / 255.0));
    assert_eq!(pair(TextureFormat::Rgba8Unorm).x, 127.5 * (1.0 / 255.0));
}

/// Rows: F2, R7.
#[test]
fn the_level_follows_the_derivatives_of_the_quads_first_lane() {
    let sizes = [[4, 4], [2, 2], [1, 1]];
    let reds: Vec<u8> = [[10; 16].as_slice(), &[50; 4], &[90]].concat();
    let with = |mipmap_filter, quad: [[f32; 2]; 4]| {
        let descriptor = SamplerDescriptor {
            mipmap_filter,
            ..SamplerDescriptor::default()
        };
        let mips = texture(TextureFormat::Rgba8Unorm, &sizes, &reds, descriptor);
        let uv = Vec2::new(Quad(quad.map(|p| p[0])), Quad(quad.map(|p| p[1])));
        mips.sample(uv).x.0.map(|red| red * 255.0)
    };
    // One pixel spans `texels` texels of the base level, in x and in y.
    let even = |texels: f32| {
        [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].map(|p| p.map(|k| k * texels / 4.0))
    };
    let close = |found: [f32; 4], expected: f32| {
        assert!(
            found.iter().all(|red| (red - expected).abs() < 0.02),
            "{found:?}, not {expected}"
        );
    };
    close(with(FilterMode::Nearest, even(0.5)), 10.0);
    close(with(FilterMode::Nearest, even(1.4)), 10.0); // λ = 0.485
    close(with(FilterMode::Nearest, even(1.5)), 50.0); // λ = 0.585
    close(with(FilterMode::Nearest, even(16.0)), 90.0);
    close(with(FilterMode::Linear, even(2.0)), 50.0);
    close(with(FilterMode::Linear, even(2.828_427)), 70.0); // λ = 1.5
    close(with(FilterMode::Linear, even(1e9)), 90.0);
    // Only the first lane counts: the last one is far away.
    let mut bent = even(0.5);
    bent[3] = [99.0, 99.0];
    close(with(FilterMode::Linear, bent), 10.0);
    // NaN derivatives give the base level.
    close(with(FilterMode::Linear, [[f32::NAN; 2]; 4]), 10.0);
}

#[test]
fn log2_is_close_to_the_logarithm() {
    let mips = texture(
        TextureFormat::Rgba8Unorm,
        &[[1, 1]],
        &[0],
        SamplerDescriptor {
            lod_min_clamp: -100.0,
            ..SamplerDescriptor::default()
        },
    );
    for (span, lod) in [
        (1.0, 0.0),
        (2.0, 1.0),
        (8.0, 3.0),
        (0.25, -2.0),
        (0.0, -63.5),
    ] {
        assert_eq!(mips.lod([span, 0.0, 0.0, 0.0]), f32::max(lod, -100.0));
    }
    for k in 1..2000 {
        let span = k as f32 * 0.013;
        let exact = maths::log2(span);
        assert!(
            (mips.lod([0.0, 0.0, 0.0, span]) - exact).abs() < 7e-5,
            "{span}"
        );
    }
}

#[test]
fn broken_textures_read_zeros() {
    let none = texture(
        TextureFormat::Rgba8Unorm,
        &[],
        &[],
        SamplerDescriptor::default(),
    );
    assert_eq!(none.sample(Vec2::new(0.5, 0.5)).x, 0.0);
    let short = texture(
        TextureFormat::Rgba8Unorm,
        &[[4, 4]],
        &[9],
        SamplerDescriptor::default(),
    );
    assert_eq!(short.sample(Vec2::new(0.9, 0.9)).x, 0.0);
    let empty = texture(
        TextureFormat::Rgba8Unorm,
        &[[0, 0]],
        &[],
        SamplerDescriptor::trilinear_repeat(),
    );
    assert_eq!(empty.sample(Vec2::new(0.9, 0.9)).x, 0.0);
}
