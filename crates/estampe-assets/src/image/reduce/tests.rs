//! Levels of images: against halves that are made one by one, and from each format.

use super::{Reducer, Reduction, RowOrder, TexelContent, reduce};
use crate::image::fault::most_texels;
use crate::image::samples::{noise, opaque};
use crate::image::tga::{self, TgaOptions};
use crate::image::{AlphaChannel, decode_reduced, decode_with_alpha, encode_png, encode_png_16};
use crate::{AssetError, Limits};
use estampe_format::srgb;
use estampe_scene::{AlphaMode, Image, Workers};

const CONTENTS: [TexelContent; 3] = [
    TexelContent::Color,
    TexelContent::Covering,
    TexelContent::Number,
];

/// The next level, by the rule's own words.
fn half(image: &Image, content: TexelContent) -> Image {
    let (width, height) = ((image.width / 2).max(1), (image.height / 2).max(1));
    let mut rgba = Vec::new();
    for y in 0..height {
        for x in 0..width {
            let at = |dx: u32, dy: u32| {
                let x = (2 * x + dx).min(image.width - 1);
                image.texel(x, (2 * y + dy).min(image.height - 1))
            };
            let four = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
            for channel in 0..4 {
                let codes = four.map(|texel| texel[channel]);
                let is_number = content == TexelContent::Number || channel == 3;
                let alphas = four.map(|texel| f32::from(texel[3]));
                let is_weighted = content == TexelContent::Covering && alphas != [0.0; 4];
                rgba.push(if !is_number && codes == [codes[0]; 4] {
                    codes[0]
                } else if !is_number && is_weighted {
                    let light = [0, 1, 2, 3].map(|k| srgb::decode(codes[k]) * alphas[k]);
                    let sum = (light[0] + light[1]) + (light[2] + light[3]);
                    let weight = (alphas[0] + alphas[1]) + (alphas[2] + alphas[3]);
                    srgb::encode(sum / weight)
                } else if !is_number {
                    let [a, b, c, d] = codes.map(srgb::decode);
                    srgb::encode(((a + b) + (c + d)) * 0.25)
                } else {
                    let sum: u32 = codes.iter().map(|&code| u32::from(code)).sum();
                    ((sum + 2) / 4) as u8
                });
            }
        }
    }
    Image {
        width,
        height,
        rgba,
    }
}

fn level(image: &Image, reduction: Reduction) -> Image {
    let mut image = image.clone();
    for _ in 0..reduction.level {
        image = half(&image, reduction.content);
    }
    image
}

/// A bitmap of 32 bits with alpha, from the bottom up or from the top down.
fn bmp(image: &Image, is_top_down: bool) -> Vec<u8> {
    let height = i32::try_from(image.height).expect("small");
    let height = if is_top_down { -height } else { height };
    let mut out = b"BM".to_vec();
    let mut words: Vec<u32> = vec![0, 0, 14 + 124, 124, image.width, height.cast_unsigned()];
    out.extend(words.drain(..).flat_map(u32::to_le_bytes));
    out.extend([1, 0, 32, 0]);
    words.extend([3, 0, 0, 0, 0, 0]);
    words.extend([0xff, 0xff00, 0xff_0000, 0xff00_0000]);
    words.resize(6 + 4 + 17, 0);
    out.extend(words.into_iter().flat_map(u32::to_le_bytes));
    assert_eq!(out.len(), 14 + 124);
    let mut rows: Vec<&[u8]> = image.rgba.chunks(image.width as usize * 4).collect();
    if !is_top_down {
        rows.reverse();
    }
    out.extend(rows.concat());
    out
}

/// DDS with masks for R, G, B and A, and these levels.
fn dds(levels: &[Image]) -> Vec<u8> {
    let mut words = vec![124, 0x2_1007, levels[0].height, levels[0].width, 0, 0];
    words.push(levels.len() as u32);
    words.extend([0; 11]);
    words.extend([32, 0x41, 0, 32, 0xff, 0xff00, 0xff_0000, 0xff00_0000]);
    words.extend([0x1000, 0, 0, 0, 0]);
    let mut out = b"DDS ".to_vec();
    out.extend(words.into_iter().flat_map(u32::to_le_bytes));
    out.extend(levels.iter().flat_map(|level| level.rgba.clone()));
    out
}

#[test]
fn levels_are_halves_of_halves_in_every_order_of_rows() {
    let limits = Limits::default();
    for (width, height) in [(1, 1), (16, 16), (13, 7), (1, 9), (31, 1), (6, 21), (5, 67)] {
        let image = noise(width, height, 5);
        let from_top = TgaOptions::default();
        let files = [
            encode_png(&image, AlphaChannel::Always).expect("a valid image"),
            tga::encode(&image, from_top).expect("a valid image"),
            bmp(&image, true),
            bmp(&image, false),
            dds(std::slice::from_ref(&image)),
        ];
        for content in CONTENTS {
            for at in 0..7 {
                let reduction = Reduction { level: at, content };
                let expected = level(&image, reduction);
                for (file, bytes) in files.iter().enumerate() {
                    let what = format!("{width}x{height} to {at}, file {file}, {content:?}");
                    let read = decode_reduced(bytes, reduction, &limits);
                    assert_eq!(read.as_ref(), Ok(&expected), "{what}");
                }
                for threads in [1, 2, 7] {
                    let reduced = reduce(&image, reduction, Workers::new(threads));
                    assert_eq!(reduced.expect("a small image").image, expected, "{threads}");
                }
            }
        }
    }
}

/// The whole image is never in memory: neither in a reader, whose images are counted, nor in the
/// rows that wait for their pairs.
#[test]
fn a_few_rows_are_kept() {
    let image = noise(256, 192, 5);
    let files = [
        encode_png(&image, AlphaChannel::Always).expect("a valid image"),
        encode_png(&opaque(image.clone()), AlphaChannel::Never).expect("a valid image"),
        tga::encode(&image, TgaOptions::default()).expect("a valid image"),
        bmp(&image, true),
        bmp(&image, false),
        dds(std::slice::from_ref(&image)),
    ];
    let reduction = Reduction {
        level: 4,
        content: TexelContent::Color,
    };
    let limits = Limits::default();
    for (file, bytes) in files.iter().enumerate() {
        let texels = most_texels(|| {
            decode_reduced(bytes, reduction, &limits).expect("a valid file");
        });
        assert_eq!(texels, 16 * 12, "file {file}");
        let whole = most_texels(|| {
            decode_reduced(bytes, Reduction::NONE, &limits).expect("a valid file");
        });
        assert!(whole >= 256 * 192, "file {file}");
    }
    let size = (256, 192);
    let reducer = Reducer::new(size, reduction, RowOrder::TopDown);
    let mut reducer = reducer.expect("a small image");
    let row = vec![0xff80_4020; 256];
    for _ in 0..192 {
        reducer.push(&row);
        // A row of each level and its half, and the result.
        let rows = (256 + 128 + 64 + 32) + (128 + 64 + 32 + 16);
        assert!(
            reducer.kept_bytes() <= 4 * (rows + 16 * 12),
            "{}",
            reducer.kept_bytes()
        );
    }
}

#[test]
fn grey_and_deep_png_are_reduced() {
    let codes: Vec<u16> = (0..8 * 6).map(|i| i * 1300).collect();
    let grey = encode_png_16((8, 6), &codes).expect("a valid image");
    let limits = Limits::default();
    let whole = decode_reduced(&grey, Reduction::NONE, &limits).expect("a valid file");
    for content in CONTENTS {
        let reduction = Reduction { level: 2, content };
        let read = decode_reduced(&grey, reduction, &limits);
        assert_eq!(read, Ok(level(&whole, reduction)));
    }
}

#[test]
fn jpeg_and_webp_are_reduced_after_they_are_decoded() {
    let image = opaque(noise(19, 12, 3));
    let limits = Limits::default();
    for bytes in [
        crate::image::encode_jpeg(&image, 90).expect("a valid image"),
        crate::image::encode_webp(&image, AlphaChannel::Never).expect("a valid image"),
    ] {
        let whole = decode_reduced(&bytes, Reduction::NONE, &limits).expect("a valid file");
        let reduction = Reduction {
            level: 1,
            content: TexelContent::Color,
        };
        let read = decode_reduced(&bytes, reduction, &limits);
        assert_eq!(read, Ok(level(&whole, reduction)));
    }
}

#[test]
fn stored_levels_are_used_and_further_ones_made() {
    let first = noise(8, 8, 1);
    // Another image than the half of the first.
    let second = noise(4, 4, 2);
    let bytes = dds(&[first.clone(), second.clone()]);
    let limits = Limits::default();
    for content in CONTENTS {
        let at = |level| decode_reduced(&bytes, Reduction { level, content }, &limits);
        assert_eq!(at(0).as_ref(), Ok(&first));
        assert_eq!(at(1).as_ref(), Ok(&second));
        let further = Reduction { level: 1, content };
        assert_eq!(at(2), Ok(level(&second, further)));
    }
    // A file that ends before the level that it states.
    let cut = &bytes[..bytes.len() - 1];
    let reduction = Reduction {
        level: 1,
        content: TexelContent::Number,
    };
    let read = decode_reduced(cut, reduction, &limits);
    assert_eq!(read, Ok(level(&first, reduction)));
}

#[test]
fn the_use_of_alpha_is_that_of_the_whole_image() {
    let reduction = Reduction {
        level: 2,
        content: TexelContent::Color,
    };
    for (alphas, expected) in [
        ([255, 255], AlphaMode::Opaque),
        ([0, 0], AlphaMode::Opaque),
        ([0, 255], AlphaMode::Mask),
        ([255, 254], AlphaMode::Blend),
    ] {
        let mut image = noise(8, 8, 9);
        for (at, texel) in image.rgba.as_chunks_mut::<4>().0.iter_mut().enumerate() {
            texel[3] = alphas[usize::from(at % 7 == 3)];
        }
        for bytes in [
            encode_png(&image, AlphaChannel::Always).expect("a valid image"),
            bmp(&image, false),
        ] {
            let read = decode_with_alpha(&bytes, reduction, &Limits::default());
            assert_eq!(
                read.map(|reduced| reduced.alpha),
                Ok(expected),
                "{alphas:?}"
            );
        }
    }
}

#[test]
fn a_stored_level_without_alpha_is_opaque_and_any_other_has_the_use_of_the_first() {
    let reduction = Reduction {
        level: 1,
        content: TexelContent::Color,
    };
    let first = |alphas: [u8; 2]| Image {
        width: 2,
        height: 1,
        rgba: vec![1, 2, 3, alphas[0], 4, 5, 6, alphas[1]],
    };
    for (alphas, of_level, expected) in [
        ([0, 255], 255, AlphaMode::Opaque),
        ([0, 255], 127, AlphaMode::Mask),
        ([9, 255], 127, AlphaMode::Blend),
    ] {
        let second = Image {
            width: 1,
            height: 1,
            rgba: vec![7, 8, 9, of_level],
        };
        let bytes = dds(&[first(alphas), second]);
        let read = decode_with_alpha(&bytes, reduction, &Limits::default());
        assert_eq!(read.map(|reduced| reduced.alpha), Ok(expected));
    }
}

#[test]
fn errors_are_those_of_whole_images() {
    let bytes = encode_png(&noise(64, 64, 1), AlphaChannel::Always).expect("a valid image");
    let reduction = Reduction {
        level: 3,
        content: TexelContent::Color,
    };
    let cut = decode_reduced(&bytes[..bytes.len() / 2], reduction, &Limits::default());
    assert!(matches!(cut, Err(AssetError::Malformed(_))), "{cut:?}");
    let few = Limits {
        max_image_pixels: 64 * 64 - 1,
        ..Limits::default()
    };
    let refused = decode_reduced(&bytes, reduction, &few);
    assert!(matches!(refused, Err(AssetError::LimitExceeded(_))));
}
