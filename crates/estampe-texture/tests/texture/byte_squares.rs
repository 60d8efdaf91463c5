//! Squares of texels of one byte: what they are, and when they are made.

use super::Random;
use super::bytes::sampled_again;
use estampe_simd::Level;
use estampe_texture::{
    BoundTexture, FilterMode, Limits, MipGeneration, MipLevel, SamplerDescriptor, TexelData,
    TexelDescriptor, TexelView, TextureFormat,
};
use std::sync::Arc;

/// A texture of some layers with all levels, of random texels.
fn texture([width, height]: [u32; 2], format: TextureFormat) -> TexelData {
    let descriptor = TexelDescriptor {
        depth_or_layers: 3,
        ..TexelDescriptor::new_2d(width, height, format)
    };
    let descriptor = descriptor.with_all_levels();
    let made = descriptor.create(&[], MipGeneration::None, &Limits::default());
    let mut texture = made.expect("a small texture");
    let random = &mut Random::new(width * 100 + height);
    let words = texture.texels.iter().map(|_| random.bits() & 0xFF);
    texture.texels = Arc::new(words.collect::<Vec<u32>>().into());
    texture
}

#[test]
fn squares_are_texels_with_the_next_ones() {
    for size in [[1, 1], [1, 6], [7, 1], [40, 24]] {
        let view = TexelView::of(texture(size, TextureFormat::R8Unorm)).expect("valid");
        let _ = sampled_again(&view, SamplerDescriptor::trilinear_repeat());
        let data = view.texture();
        let squares = data.squares.get().expect("sampled again");
        assert_eq!(squares.len(), data.texels.len());
        let mut at = 0;
        for (number, level) in data.levels.iter().enumerate() {
            let [width, height] = [level.width, level.height];
            for (layer, y) in (0..3).flat_map(|layer| (0..height).map(move |y| (layer, y))) {
                for x in 0..width {
                    let places = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)];
                    let bytes = places.map(|(x, y)| {
                        let [x, y] = [x % width, y % height].map(u32::cast_signed);
                        let mip = i32::try_from(number).expect("a few levels");
                        let texel = view.fetch([x, y, layer], mip, 0).x * 255.0;
                        #[expect(
                            clippy::cast_possible_truncation,
                            clippy::cast_sign_loss,
                            reason = "the code of a byte"
                        )]
                        let code = texel.round() as u8;
                        code
                    });
                    assert_eq!(
                        squares[at].to_le_bytes(),
                        bytes,
                        "{size:?} {number} {x} {y}"
                    );
                    at += 1;
                }
            }
        }
        assert_eq!(at, squares.len());
    }
}

/// Texels that are sampled in one pass alone need none; nor do others.
#[test]
fn squares_are_made_when_texels_are_sampled_again() {
    let linear = SamplerDescriptor::trilinear_repeat();
    let mut data = texture([20, 20], TextureFormat::R8Unorm);
    let view = TexelView::of(data.clone()).expect("valid");
    let bound = || BoundTexture::new(view.clone(), None, Level::best());
    let squares = &view.texture().squares;
    // Bound, and not sampled.
    for _ in 0..3 {
        drop(bound());
    }
    // Twice in one pass.
    let both = [bound(), bound()];
    assert!(both.iter().all(|bound| bound.sampled(&linear).is_some()));
    assert!(squares.get().is_none());
    drop(both);
    assert!(squares.get().is_none());
    let next = bound();
    assert!(squares.get().is_none());
    assert!(next.sampled(&linear).is_some() && squares.get().is_some());
    // Other texels have none.
    data.squares = Arc::clone(squares);
    let texels = data.take_texels();
    data.texels = texels;
    assert!(data.squares.get().is_none());

    let nearest = SamplerDescriptor {
        mag_filter: FilterMode::Nearest,
        min_filter: FilterMode::Nearest,
        ..linear
    };
    let anisotropic = SamplerDescriptor {
        max_anisotropy: 4,
        ..linear
    };
    for (format, sampler) in [
        (TextureFormat::R8Unorm, nearest),
        (TextureFormat::R8Unorm, anisotropic),
        (TextureFormat::R8Snorm, linear),
        (TextureFormat::Rg8Unorm, linear),
        (TextureFormat::Rgba8Unorm, linear),
    ] {
        let view = TexelView::of(texture([20, 20], format)).expect("valid");
        let again = sampled_again(&view, sampler);
        assert!(
            again.view().texture().squares.get().is_none(),
            "{format:?} {sampler:?}"
        );
    }
}

/// The fields of a texture are public, and may hold anything.
#[test]
fn missing_texels_have_no_squares() {
    let whole = texture([20, 20], TextureFormat::R8Unorm);
    let level = whole.levels[1];
    for (level, count) in [
        (level, 0),
        (level, 500),
        (
            MipLevel {
                offset: u32::MAX,
                ..level
            },
            3000,
        ),
        (MipLevel { width: 0, ..level }, 3000),
        (
            MipLevel {
                width: u32::MAX,
                height: u32::MAX,
                ..level
            },
            3000,
        ),
    ] {
        let mut data = whole.clone();
        data.levels[1] = level;
        data.texels = Arc::new(
            whole.texels[..count.min(whole.texels.len())]
                .to_vec()
                .into(),
        );
        data.squares = Arc::default();
        let view = TexelView::of(data).expect("it has levels");
        let again = sampled_again(&view, SamplerDescriptor::trilinear_repeat());
        let squares = again.view().texture().squares.get().expect("sampled again");
        assert_eq!(squares.len(), count.min(whole.texels.len()));
    }
}
