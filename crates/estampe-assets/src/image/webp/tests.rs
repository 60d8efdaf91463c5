//! WebP: files that libwebp wrote, with the texels that it reads from them, and damaged files.

use super::{decode, stated_size};
use crate::image::samples::Random;
use crate::{AssetError, Limits};

/// 4 × 3 texels of [`gradient`], lossless.
const LOSSLESS: &str = "524946464c000000574542505650384c3f0000002f038000105f201048e21c7066826c9b830dfb0805130824e3e44f330e41b64d617faac9863549c8dbe109e7630b8020804421961c669965968523fa1ff87400";
/// The same without alpha.
const LOSSLESS_RGB: &str = "5249464644000000574542505650384c380000002f038000105f201048e21c7066826c9b830dfb0805130824e3e44f33cefc875508d10609f3b105401040a2104b0eb3cc32cbc211fd0f7c3a";
/// 16 × 16 texels near (200, 100, 50), alpha 128.
const LOSSY_ALPHA: &str = "524946465e00000057454250565038580a000000100000000f00000f0000414c50480a000000010750c088084444ff03565038202e000000f001009d012a1000100001402625a00274ba01f80004c80000feae17ff36040cd0fa60ffd26cf136789b3e398000";
/// The same without alpha.
const LOSSY: &str = "524946463a00000057454250565038202e000000f001009d012a1000100001402625a00274ba01f80004c80000feae17ff36040cd0fa60ffd26cf136789b3e398000";
/// Two frames of 4 × 2 texels, red and blue.
const ANIMATION: &str = "524946468400000057454250565038580a00000002000000030000010000414e494d06000000000000000000414e4d4628000000000000000000030000010000640000025650384c0f0000002f034000000710fd8ffe0722a2ff0100414e4d4628000000000000000000030000010000640000005650384c0f0000002f034000000710d1fffe0722a2ff0100";

fn file(hexadecimal: &str) -> Vec<u8> {
    let digits = hexadecimal.as_bytes().as_chunks::<2>().0;
    let digit = |byte: u8| {
        let value = char::from(byte).to_digit(16).expect("a digit");
        u8::try_from(value).expect("below 16")
    };
    digits
        .iter()
        .map(|&[a, b]| digit(a) << 4 | digit(b))
        .collect()
}

fn gradient(has_alpha: bool) -> Vec<u8> {
    let texels = (0..3_u8).flat_map(|y| (0..4_u8).map(move |x| (x, y)));
    let rgba = texels.flat_map(|(x, y)| {
        let is_opaque = (x + y) % 3 != 0 || !has_alpha;
        [
            x * 60,
            y * 90,
            (x ^ y) * 40,
            if is_opaque { 255 } else { 100 },
        ]
    });
    rgba.collect()
}

/// Rows: I5.
#[test]
fn lossless_texels_are_exact() {
    for (hexadecimal, has_alpha) in [(LOSSLESS, true), (LOSSLESS_RGB, false)] {
        let bytes = file(hexadecimal);
        let image = decode(&bytes, &Limits::default()).expect("a valid file");
        assert_eq!((image.width, image.height), (4, 3));
        assert_eq!(stated_size(&bytes), Some((4, 3)));
        assert_eq!(image.rgba, gradient(has_alpha));
    }
}

/// Rows: I5.
#[test]
fn lossy_texels_are_near_and_their_alpha_is_exact() {
    for (hexadecimal, alpha) in [(LOSSY, 255), (LOSSY_ALPHA, 128)] {
        let image = decode(&file(hexadecimal), &Limits::default()).expect("a valid file");
        assert_eq!((image.width, image.height), (16, 16));
        for &[r, g, b, a] in image.rgba.as_chunks::<4>().0 {
            let off = [r.abs_diff(200), g.abs_diff(100), b.abs_diff(50)];
            assert!(off.iter().all(|&off| off <= 3), "{r} {g} {b}");
            assert_eq!(a, alpha);
        }
    }
}

/// Rows: I5.
#[test]
fn the_first_frame_of_an_animation_is_read() {
    let image = decode(&file(ANIMATION), &Limits::default()).expect("a valid file");
    assert_eq!((image.width, image.height), (4, 2));
    assert_eq!(image.rgba, [255, 0, 0, 255].repeat(8));
}

/// Rows: I5.
#[test]
fn sizes_are_bounded_before_memory_is_allocated() {
    let few = Limits {
        max_image_pixels: 11,
        ..Limits::default()
    };
    let error = decode(&file(LOSSLESS), &few).expect_err("over the limit");
    assert!(matches!(error, AssetError::LimitExceeded(_)), "{error}");
    // A canvas of 2^24 × 1 texels.
    let mut wide = file(LOSSY_ALPHA);
    wide[24..30].copy_from_slice(&[0xff, 0xff, 0xff, 0, 0, 0]);
    let error = decode(&wide, &Limits::default()).expect_err("too wide");
    assert!(matches!(error, AssetError::Unsupported(_)), "{error}");
    // A frame of 16383 × 16383 texels on a canvas of 16 × 16.
    let mut large = file(LOSSY_ALPHA);
    let at = large
        .windows(3)
        .position(|w| w == [0x9d, 1, 0x2a])
        .expect("a frame")
        + 3;
    large[at..at + 4].copy_from_slice(&[0xff, 0x3f, 0xff, 0x3f]);
    let error = decode(&large, &Limits::default()).expect_err("no such frame");
    assert!(error.to_string().contains("16383 × 16383"), "{error}");
}

/// Rows: I5.
#[test]
fn prefixes_and_random_damage_never_panic() {
    let files = [LOSSLESS, LOSSLESS_RGB, LOSSY, LOSSY_ALPHA, ANIMATION].map(file);
    let limits = Limits {
        max_image_pixels: 1 << 18,
        ..Limits::default()
    };
    for file in &files {
        for len in 0..file.len() {
            if let Err(error) = decode(&file[..len], &limits) {
                assert!(matches!(error, AssetError::Malformed(_)), "{len}: {error}");
            }
        }
    }
    let mut random = Random::new(0x3eb9);
    let mut read = 0;
    for round in 0..8_000 {
        let bytes = random.mutated(&files[round % files.len()]);
        if let Ok(image) = decode(&bytes, &limits) {
            let texels = image.width as usize * image.height as usize;
            assert_eq!(image.rgba.len(), texels * 4);
            read += 1;
        }
    }
    assert!((300..7_700).contains(&read), "{read} of 8000 are read");
}
