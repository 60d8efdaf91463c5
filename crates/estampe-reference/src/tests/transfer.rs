//! Copies, clears, mip levels and blits of plain textures, by hand.

use super::*;
use crate::transfer::blit::{Rectangle, blit};
use crate::transfer::texel::{aspect_bytes, aspect_of, set_aspect};
use crate::transfer::{Layout, Place, PlainTexture, Rule, attachment, copy, mips, sampled};
use TextureFormat as F;
use std::sync::Arc;

const FIRST: Place = Place {
    level: 0,
    origin: [0; 3],
    aspect: TextureAspect::All,
};

fn flat(format: F, width: u32, height: u32) -> PlainTexture {
    PlainTexture::zeros(format, TextureDimension::D2, [width, height, 1], 1, 1)
}

/// An image of R8 texels.
fn bytes_of(width: u32, height: u32, bytes: &[u8]) -> PlainTexture {
    let mut texture = flat(F::R8Unorm, width, height);
    let size = [width, height, 1];
    copy::write(&mut texture, &FIRST, size, (bytes, &Layout::default())).expect("a whole image");
    texture
}

fn no_blocks(_: F, _: &[u8]) -> Vec<u32> {
    Vec::new()
}

#[test]
fn rows_in_memory_have_offset_padding_and_layers() {
    let mut texture = PlainTexture::zeros(F::Rg8Uint, TextureDimension::D2, [3, 4, 3], 2, 1);
    // Two texels of two rows of two layers: rows five bytes apart, layers three rows.
    let bytes: Vec<u8> = (0..60).collect();
    let layout = Layout {
        offset: 7,
        bytes_per_row: Some(5),
        rows_per_image: Some(3),
    };
    let place = Place {
        origin: [1, 2, 1],
        ..FIRST
    };
    copy::write(&mut texture, &place, [2, 2, 2], (&bytes, &layout)).expect("it fits");
    assert_eq!(texture.levels[0][1].rows[2], [0, 0, 7, 8, 9, 10]);
    assert_eq!(texture.levels[0][1].rows[3], [0, 0, 12, 13, 14, 15]);
    assert_eq!(texture.levels[0][2].rows[2], [0, 0, 22, 23, 24, 25]);
    assert_eq!(texture.levels[0][0].rows.concat(), [0; 24]);
    let mut back = vec![0xEE; 31];
    copy::read(&texture, &place, [2, 2, 2], (&mut back, &layout)).expect("it fits");
    assert_eq!(
        back[5..18],
        [0xEE, 0xEE, 7, 8, 9, 10, 0xEE, 12, 13, 14, 15, 0xEE, 0xEE]
    );
    assert_eq!(back[27..], [27, 28, 29, 30]);
    // The last byte is number 30.
    let refused = copy::read(&texture, &place, [2, 2, 2], (&mut back[..30], &layout));
    assert_eq!(refused, Err(Rule::Bytes));
}

#[test]
fn rules_of_regions() {
    // 9×6 texels are 3×2 blocks of 4×4.
    let texture = PlainTexture::zeros(F::Bc1RgbaUnorm, TextureDimension::D2, [9, 6, 1], 2, 1);
    assert_eq!(texture.levels[0][0].rows, vec![vec![0; 24]; 2]);
    let refused = |place: Place, size: [u32; 3]| {
        let mut bytes = vec![0; 200];
        copy::read(&texture, &place, size, (&mut bytes, &Layout::default())).err()
    };
    let from = |x: u32, y: u32| Place {
        origin: [x, y, 0],
        ..FIRST
    };
    assert_eq!(refused(FIRST, [9, 6, 1]), None);
    assert_eq!(refused(from(8, 4), [1, 2, 1]), None);
    assert_eq!(refused(from(8, 4), [0, 0, 0]), None);
    assert_eq!(refused(from(8, 4), [4, 2, 1]), Some(Rule::Region));
    assert_eq!(refused(from(2, 0), [4, 4, 1]), Some(Rule::Region));
    assert_eq!(refused(FIRST, [6, 4, 1]), Some(Rule::Region));
    assert_eq!(refused(FIRST, [4, 4, 2]), Some(Rule::Region));
    assert_eq!(
        refused(Place { level: 2, ..FIRST }, [0; 3]),
        Some(Rule::Region)
    );
    // Level 1 has 4×3 texels: one block.
    assert_eq!(refused(Place { level: 1, ..FIRST }, [4, 3, 1]), None);
    let depth = Place {
        aspect: TextureAspect::Depth,
        ..FIRST
    };
    assert_eq!(refused(depth, [4, 4, 1]), Some(Rule::Aspect));
}

#[test]
fn several_samples_are_copied_whole() {
    let mut from = PlainTexture::zeros(F::R8Uint, TextureDimension::D2, [2, 2, 1], 1, 4);
    from.levels[0][0].rows = vec![(1..9).collect(), (11..19).collect()];
    let mut into = PlainTexture {
        levels: vec![vec![crate::transfer::PlainImage {
            size: [2, 2],
            rows: vec![vec![0; 8]; 2],
        }]],
        ..from.clone()
    };
    let part = copy::copy((&from, &FIRST), (&mut into, &FIRST), [2, 1, 1]);
    assert_eq!(part, Err(Rule::Samples));
    let mut single = flat(F::R8Uint, 2, 2);
    let other = copy::copy((&from, &FIRST), (&mut single, &FIRST), [2, 2, 1]);
    assert_eq!(other, Err(Rule::Samples));
    copy::copy((&from, &FIRST), (&mut into, &FIRST), [2, 2, 1]).expect("whole images");
    assert_eq!(into, from);
    let third = copy::read_sample(&into, [0, 0], (TextureAspect::All, 2));
    assert_eq!(third, [3, 7, 13, 17]);
}

#[test]
fn aspects_are_parts_of_texels() {
    let mut texel = [0; 8];
    let both = [1, 2, 3, 4, 5, 6, 7, 8];
    set_aspect(
        F::Depth32FloatStencil8,
        TextureAspect::All,
        &mut texel,
        &both,
    );
    assert_eq!(texel, [1, 2, 3, 4, 5, 0, 0, 0]);
    let mut texel = [1, 2, 3, 4];
    set_aspect(
        F::Depth24PlusStencil8,
        TextureAspect::Depth,
        &mut texel,
        &[9; 4],
    );
    assert_eq!(texel, [9, 9, 9, 4]);
    set_aspect(
        F::Depth24PlusStencil8,
        TextureAspect::Stencil,
        &mut texel,
        &[7],
    );
    assert_eq!(texel, [9, 9, 9, 7]);
    let depth = aspect_of(F::Depth24PlusStencil8, TextureAspect::Depth, &texel);
    assert_eq!(depth, [9, 9, 9, 0]);
    let bytes = |format, aspect| aspect_bytes(format, aspect);
    assert_eq!(bytes(F::Depth16Unorm, TextureAspect::Depth), 2);
    assert_eq!(bytes(F::Depth32FloatStencil8, TextureAspect::Depth), 4);
    assert_eq!(bytes(F::Depth32FloatStencil8, TextureAspect::All), 8);
    assert_eq!(bytes(F::Stencil8, TextureAspect::Stencil), 1);
    assert_eq!(bytes(F::Bc7RgbaUnorm, TextureAspect::All), 16);
}

#[test]
fn depths_are_codes_or_clamped_numbers() {
    let mut texel = [0; 4];
    for code in [0, 1, 0x7F_FFFF, 0x80_0000, 0xFF_FFFE, 0xFF_FFFF_u32] {
        let bytes = code.to_le_bytes();
        let depth = attachment::depth(F::Depth24Plus, &bytes);
        attachment::set_depth(F::Depth24Plus, &mut texel, depth);
        assert_eq!(texel, bytes, "{depth}");
    }
    assert_eq!(attachment::depth(F::Depth16Unorm, &[0xFF, 0xFF]), 1.0);
    for (stored, depth) in [(1.5, 1.0), (-0.5, 0.0), (f32::NAN, 0.0), (0.25_f32, 0.25)] {
        let bytes = stored.to_le_bytes();
        assert_eq!(attachment::depth(F::Depth32Float, &bytes), depth);
    }
}

#[test]
fn means_leave_out_the_last_row_of_odd_sides() {
    let mut texture = PlainTexture::zeros(F::R8Unorm, TextureDimension::D2, [5, 3, 1], 3, 1);
    texture.levels[0][0].rows = vec![
        vec![1, 2, 30, 40, 255],
        vec![3, 5, 50, 60, 255],
        vec![255; 5],
    ];
    mips::generate(&mut texture, 1);
    // (1 + 2 + 3 + 5 + 2) ÷ 4, (30 + 40 + 50 + 60 + 2) ÷ 4; then 3 and 45 twice.
    assert_eq!(texture.levels[1][0].rows, [[3, 45]]);
    assert_eq!(texture.levels[2][0].rows, [[24]]);

    let mut volume = PlainTexture::zeros(F::R16Snorm, TextureDimension::D3, [2, 1, 3], 2, 1);
    for (image, texels) in volume.levels[0]
        .iter_mut()
        .zip([[-8, -5], [4, -2], [99, 99]])
    {
        image.rows = vec![texels.iter().flat_map(|t: &i16| t.to_le_bytes()).collect()];
    }
    mips::generate(&mut volume, 1);
    // Each counts twice, as the height is 1: −22 ÷ 8, + ½, rounded down.
    assert_eq!(volume.levels[1][0].rows, [(-3_i16).to_le_bytes()]);
}

#[test]
fn means_of_srgb_are_linear_and_bgra_keeps_its_order() {
    let mut texture = PlainTexture::zeros(F::Bgra8UnormSrgb, TextureDimension::D2, [2, 1, 1], 2, 1);
    texture.levels[0][0].rows = vec![vec![0, 0, 255, 10, 255, 0, 255, 20]];
    mips::generate(&mut texture, 1);
    // The mean of black and white is the code 188.
    assert_eq!(texture.levels[1][0].rows, [[188, 0, 255, 15]]);
}

#[test]
fn shared_exponents() {
    use crate::shared_exponent::encode;
    assert_eq!(encode([0.0, -1.0, f32::NAN]), 0);
    // 1 = 256 · 2⁻⁸: exponent 16.
    assert_eq!(encode([1.0, 0.5, 0.0]), 256 | 128 << 9 | 16 << 27);
    assert_eq!(encode([1e9, 0.0, 0.0]), 511 | 31 << 27);
    // 0.9995 · 512 rounds to 512, so the exponent grows.
    assert_eq!(encode([0.9995, 0.0, 0.0]), 256 | 16 << 27);
}

#[test]
fn blits_scale_filter_and_convert() {
    let from = bytes_of(4, 1, &[0, 100, 200, 40]);
    let view = |filter| {
        let texture = Arc::new(sampled::texture(&from, F::R8Unorm, no_blocks));
        let sampler = SamplerDescriptor {
            mag_filter: filter,
            ..SamplerDescriptor::default()
        };
        sampled::image_view(texture, [0, 0], sampler)
    };
    let row = |[x, width]: [u32; 2]| Rectangle {
        origin: [x, 0],
        size: [width, 1],
    };
    let mut into = flat(F::Rgba8Unorm, 5, 1);
    let target = &mut into.levels[0][0];
    // Texels 1 and 2 become pixels 1 to 4.
    let near = view(FilterMode::Nearest);
    blit((&near, row([1, 2])), (target, F::Rgba8Unorm, row([1, 4])));
    let pixels = |red: [u8; 5]| {
        let pixel = |(at, red)| if at == 0 { [0; 4] } else { [red, 0, 0, 255] };
        vec![
            red.into_iter()
                .enumerate()
                .flat_map(pixel)
                .collect::<Vec<u8>>(),
        ]
    };
    assert_eq!(target.rows, pixels([0, 100, 100, 200, 200]));
    // At 1.25, 1.75, 2.25 and 2.75 texels: a quarter of the way from one centre to another.
    let smooth = view(FilterMode::Linear);
    blit((&smooth, row([1, 2])), (target, F::Rgba8Unorm, row([1, 4])));
    assert_eq!(target.rows, pixels([0, 75, 125, 175, 160]));
}

#[test]
fn every_colour_is_found_again_in_its_bytes() {
    let random = &mut Random::new(3);
    for &format in F::ALL.iter().filter(|format| format.is_renderable()) {
        for _ in 0..50 {
            let bytes: Vec<u8> = (0..format.block_bytes()).map(|_| random.0.u8(..)).collect();
            let codes = color::codes(format, &bytes);
            assert_eq!(color::bytes(format, codes), bytes, "{}", format.name());
        }
    }
}
