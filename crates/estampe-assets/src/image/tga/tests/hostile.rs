//! Damaged files give an error or an image.

use super::Fixture;
use crate::error::Location;
use crate::image::samples::{Random, noise};
use crate::image::tga::{TgaOptions, decode, encode};
use crate::{AssetError, Limits};

/// One file of each kind, all small.
fn files() -> Vec<Vec<u8>> {
    let mut mapped = Fixture::new(1, 8, (3, 2), &[10, 11, 12, 10, 11, 12]);
    mapped.map = Some((10, 3, 16));
    mapped.map_bytes = vec![1, 2, 3, 4, 5, 6];
    let mut mapped_rle = Fixture {
        kind: 9,
        ..mapped.clone()
    };
    mapped_rle.texels = vec![0x84, 10, 0, 12];
    let mut grey = Fixture::new(3, 16, (2, 2), &[1, 2, 3, 4, 5, 6, 7, 8]);
    grey.id = b"an image ID".to_vec();
    grey.attributes = Some(3);
    let short = Fixture::new(10, 16, (4, 2), &[0x85, 1, 2, 1, 3, 4, 5, 6]);
    let mut files: Vec<_> = [mapped, mapped_rle, grey, short]
        .iter()
        .map(Fixture::bytes)
        .collect();
    let image = noise(9, 5, 8);
    for rle in [true, false] {
        let options = TgaOptions {
            rle,
            ..TgaOptions::default()
        };
        files.push(encode(&image, options).expect("a valid image"));
    }
    files
}

/// Rows: I1.
#[test]
fn every_prefix_is_located_or_complete() {
    let limits = Limits::default();
    for file in files() {
        let whole = decode(&file, &limits).expect("a valid file");
        for len in 0..file.len() {
            match decode(&file[..len], &limits) {
                // Only the bytes after the texels are missing. Without the extension area, alpha
                // may differ.
                Ok(image) => assert_eq!((image.width, image.height), (whole.width, whole.height)),
                Err(AssetError::Malformed(fault)) => {
                    assert_eq!(fault.location, Some(Location::Byte(len as u64)), "{fault}");
                }
                Err(other) => panic!("{len} bytes: {other}"),
            }
        }
    }
}

#[test]
fn the_last_texel_is_needed() {
    let file = Fixture::new(10, 24, (2, 1), &[0x00, 1, 2, 3, 0x00, 4, 5, 6]).bytes();
    assert!(decode(&file, &Limits::default()).is_ok());
    let error = decode(&file[..file.len() - 1], &Limits::default()).expect_err("cut short");
    let message = error.to_string();
    assert!(
        message.contains("byte 25") && message.contains("1 of 2 read"),
        "{message}"
    );
}

#[test]
fn a_large_size_in_a_small_file_takes_no_memory() {
    for (kind, depth) in [(2, 32), (10, 32), (3, 8), (11, 8)] {
        let file = Fixture::new(kind, depth, (16_384, 16_384), &[0xff; 900]).bytes();
        let error = decode(&file, &Limits::default()).expect_err("cannot hold the texels");
        assert!(matches!(error, AssetError::Malformed(_)), "{error}");
        let file = Fixture::new(kind, depth, (65_535, 65_535), &[0xff; 900]).bytes();
        let error = decode(&file, &Limits::default()).expect_err("over the limit");
        assert!(matches!(error, AssetError::LimitExceeded(_)), "{error}");
    }
}

/// Rows: I1.
#[test]
fn random_damage_never_panics() {
    let files = files();
    let limits = Limits {
        max_image_pixels: 1 << 20,
        ..Limits::default()
    };
    let mut random = Random::new(0xdead_beef);
    let mut read = 0;
    for round in 0..12_000 {
        let bytes = random.mutated(&files[round % files.len()]);
        if let Ok(image) = decode(&bytes, &limits) {
            assert_eq!(
                image.rgba.len(),
                image.width as usize * image.height as usize * 4
            );
            read += 1;
        }
    }
    assert!(
        (1000..11_000).contains(&read),
        "{read} of 12000 damaged files still decode"
    );
}

#[test]
fn wrong_extension_offsets_are_ignored() {
    let mut file = Fixture {
        attributes: Some(0),
        ..Fixture::new(2, 32, (1, 1), &[1, 2, 3, 4])
    };
    file.descriptor |= 8;
    let good = file.bytes();
    let at = good.len() - 26;
    for offset in [0, 1, u32::MAX, at as u32, good.len() as u32] {
        let mut bytes = good.clone();
        bytes[at..at + 4].copy_from_slice(&offset.to_le_bytes());
        let image = decode(&bytes, &Limits::default()).expect("the area is optional");
        assert_eq!(image.rgba, [3, 2, 1, 4], "offset {offset}");
    }
}
