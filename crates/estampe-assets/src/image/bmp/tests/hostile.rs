//! Damaged files give an error or an image.

use super::Fixture;
use crate::error::Location;
use crate::image::bmp::decode;
use crate::image::samples::Random;
use crate::{AssetError, Limits};

/// One file of each kind, all small.
fn files() -> Vec<Vec<u8>> {
    let palette = [[1, 2, 3], [4, 5, 6], [7, 8, 9]];
    let mapped = Fixture::new(8, (3, 2), &[0, 1, 2, 0, 2, 1, 0, 0]).with_palette(&palette);
    let mut runs = Fixture::new(8, (4, 2), &[3, 1, 0, 0, 0, 3, 0, 2, 1, 0, 0, 1]);
    runs.compression = 1;
    let mut short = Fixture::new(24, (1, -2), &[1, 2, 3, 0, 4, 5, 6, 0]);
    short.header_len = 12;
    let mut masked = Fixture::new(32, (1, 2), &[1, 2, 3, 4, 5, 6, 7, 8]);
    masked.compression = 6;
    masked.masks = vec![0xff, 0xff00, 0xff_0000, 0xff00_0000];
    let bit = Fixture::new(1, (33, 2), &[0b0101_0101; 16]).with_palette(&palette[..2]);
    [mapped, runs.with_palette(&palette), short, masked, bit]
        .iter()
        .map(Fixture::bytes)
        .collect()
}

#[track_caller]
fn refusal(file: &Fixture) -> AssetError {
    decode(&file.bytes(), &Limits::default()).expect_err("an invalid file")
}

/// Rows: I5.
#[test]
fn every_prefix_is_located_or_complete() {
    let limits = Limits::default();
    for file in files() {
        let whole = decode(&file, &limits).expect("a valid file");
        for len in 0..file.len() {
            match decode(&file[..len], &limits) {
                // Only the padding of the last row is missing.
                Ok(image) => assert_eq!(image, whole),
                Err(AssetError::Malformed(fault)) => {
                    assert_eq!(fault.location, Some(Location::Byte(len as u64)), "{fault}");
                }
                Err(other) => panic!("{len} bytes: {other}"),
            }
        }
    }
}

/// Rows: I5.
#[test]
fn a_large_size_in_a_small_file_takes_no_memory() {
    for (bits, compression) in [(1, 0), (8, 0), (8, 1), (4, 2), (24, 0), (32, 0)] {
        let mut file = Fixture::new(bits, (16_384, 16_384), &[0; 900]);
        file.compression = compression;
        file = file.with_palette(&[[0; 3]; 2]);
        let error = refusal(&file);
        assert!(matches!(error, AssetError::Malformed(_)), "{error}");
        for (width, height) in [(i32::MAX, i32::MIN), (16_385, 16_384), (i32::MAX, 1)] {
            (file.width, file.height) = (width, height);
            let error = refusal(&file);
            assert!(matches!(error, AssetError::LimitExceeded(_)), "{error}");
        }
    }
}

/// Rows: I5.
#[test]
fn contradictions_are_refused_with_their_place() {
    let say = |file: &Fixture| refusal(file).to_string();
    let mapped = Fixture::new(8, (2, 1), &[0, 2, 0, 0]).with_palette(&[[1; 3]; 2]);
    let message = say(&mapped);
    assert!(
        message.contains("byte 63: colour 2 of a BMP palette of 2"),
        "{message}"
    );
    for (width, height) in [(0, 1), (1, 0), (-1, 1)] {
        let file = Fixture::new(24, (width, height), &[0; 8]);
        assert!(say(&file).contains("byte 18"), "{}", say(&file));
    }
    let mut masked = Fixture::new(32, (1, 1), &[0; 4]);
    masked.compression = 3;
    masked.masks = vec![0xf0f, 0, 0];
    assert!(say(&masked).contains("have gaps"), "{}", say(&masked));
    for (bits, compression) in [(24, 4), (0, 5), (2, 0), (64, 0), (24, 3), (8, 2)] {
        let mut file = Fixture::new(bits, (1, 1), &[0; 8]);
        file.compression = compression;
        let error = refusal(&file);
        assert!(matches!(error, AssetError::Unsupported(_)), "{error}");
    }
}

/// Rows: I5.
#[test]
fn random_damage_never_panics() {
    let files = files();
    let limits = Limits {
        max_image_pixels: 1 << 20,
        ..Limits::default()
    };
    let mut random = Random::new(0xb175);
    let mut read = 0;
    for round in 0..12_000 {
        let bytes = random.mutated(&files[round % files.len()]);
        if let Ok(image) = decode(&bytes, &limits) {
            let texels = image.width as usize * image.height as usize;
            assert_eq!(image.rgba.len(), texels * 4);
            read += 1;
        }
    }
    assert!((1000..11_000).contains(&read), "{read} of 12000 are read");
}
