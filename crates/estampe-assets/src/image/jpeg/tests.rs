//! JPEG: written files, hand-made files with one, three and four components, and damaged files.

use super::*;
use crate::image::samples::{Random, disc, noise};

/// A JPEG of one 8×8 block per component, each of one value, assembled by hand.
///
/// All quantisers are 8, so that the mean (DC) term is the value itself less 128; every other term
/// is omitted by an end-of-block code.
fn flat_jpeg(values: &[u8], adobe_transform: Option<u8>) -> Vec<u8> {
    let count = values.len() as u8;
    let mut out = vec![0xff, 0xd8];
    if let Some(transform) = adobe_transform {
        push_segment(&mut out, 0xee, b"Adobe\0\x64\0\0\0\0");
        out.push(transform);
        let at = out.len() - 13;
        out[at] += 1;
    }
    push_segment(&mut out, 0xdb, &[&[0][..], &[8; 64]].concat());
    let components = (1..=count).flat_map(|id| [id, 0x11, 0]);
    let frame: Vec<u8> = [8, 0, 8, 0, 8, count]
        .into_iter()
        .chain(components)
        .collect();
    push_segment(&mut out, 0xc0, &frame);
    // Means: categories 0 to 11 in codes of 4 bits. Others: one code, the bit 0, for "end of
    // block".
    let mut means = vec![0x00, 0, 0, 0, 12, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];
    means.extend(0..12);
    push_segment(&mut out, 0xc4, &means);
    push_segment(
        &mut out,
        0xc4,
        &[0x10, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0],
    );
    let components = (1..=count).flat_map(|id| [id, 0]);
    let scan: Vec<u8> = [count]
        .into_iter()
        .chain(components)
        .chain([0, 63, 0])
        .collect();
    push_segment(&mut out, 0xda, &scan);

    let mut bits = String::new();
    for &value in values {
        let mean = i32::from(value) - 128;
        let category = 32 - mean.unsigned_abs().leading_zeros();
        bits += &format!("{category:04b}");
        if category > 0 {
            let code = if mean < 0 {
                mean + (1 << category) - 1
            } else {
                mean
            };
            bits += &format!("{code:0width$b}", width = category as usize);
        }
        bits += "0";
    }
    while !bits.len().is_multiple_of(8) {
        bits += "1";
    }
    for byte in bits.as_bytes().chunks(8) {
        let byte = byte.iter().fold(0, |byte, &bit| byte << 1 | (bit - b'0'));
        out.push(byte);
        if byte == 0xff {
            out.push(0);
        }
    }
    out.extend_from_slice(&[0xff, 0xd9]);
    out
}

fn push_segment(out: &mut Vec<u8>, marker: u8, body: &[u8]) {
    out.extend_from_slice(&[0xff, marker]);
    out.extend_from_slice(&(body.len() as u16 + 2).to_be_bytes());
    out.extend_from_slice(body);
}

#[track_caller]
fn check_flat(bytes: &[u8], expected: [u8; 4]) {
    let image = decode(bytes, &Limits::default()).expect("a valid JPEG");
    assert_eq!((image.width, image.height), (8, 8));
    for texel in image.rgba.as_chunks::<4>().0 {
        for (got, want) in texel.iter().zip(expected) {
            assert!(got.abs_diff(want) <= 1, "{texel:?} instead of {expected:?}");
        }
    }
}

/// Rows: I2.
#[test]
fn grey_files() {
    for value in [0, 1, 77, 128, 255] {
        check_flat(&flat_jpeg(&[value], None), [value, value, value, 255]);
    }
}

/// Rows: I2.
#[test]
fn three_components_are_ycbcr_unless_the_file_says_rgb() {
    // ITU-T T.871: R = Y + 1.402 (Cr − 128).
    check_flat(&flat_jpeg(&[100, 128, 178], None), [170, 64, 100, 255]);
    check_flat(&flat_jpeg(&[10, 20, 30], Some(0)), [10, 20, 30, 255]);
}

/// Rows: I2.
#[test]
fn four_inks_become_colours() {
    // Adobe stores inks inverted: 255 is no ink. Colour = ink · black.
    check_flat(&flat_jpeg(&[255, 0, 0, 255], Some(0)), [255, 0, 0, 255]);
    check_flat(
        &flat_jpeg(&[200, 100, 50, 255], Some(0)),
        [200, 100, 50, 255],
    );
    check_flat(&flat_jpeg(&[200, 100, 50, 0], Some(0)), [0, 0, 0, 255]);
    // YCCK: the inks as YCbCr.
    check_flat(
        &flat_jpeg(&[100, 128, 128, 255], Some(2)),
        [155, 155, 155, 255],
    );
}

/// Rows: I2.
#[test]
fn written_jpegs_read_back_nearly() {
    let image = disc(100, 60);
    let mut sizes = Vec::new();
    for (quality, most) in [(50, 6.0), (90, 2.5), (100, 1.5)] {
        let bytes = encode_jpeg(&image, quality).expect("a valid image");
        let decoded = decode(&bytes, &Limits::default()).expect("our own JPEG");
        let total: u32 = image
            .rgba
            .iter()
            .zip(&decoded.rgba)
            .map(|(a, b)| u32::from(a.abs_diff(*b)))
            .sum();
        let mean = f64::from(total) / image.rgba.len() as f64;
        assert!(mean < most, "quality {quality}: mean difference {mean}");
        sizes.push(bytes.len());
    }
    assert!(sizes.is_sorted(), "{sizes:?}");
    assert_eq!(encode_jpeg(&image, 0), encode_jpeg(&image, 1));
}

/// Rows: I2.
#[test]
fn prefixes_and_random_damage_never_panic() {
    let limits = Limits {
        max_image_pixels: 1 << 16,
        ..Limits::default()
    };
    let files = [
        encode_jpeg(&noise(20, 12, 1), 80).expect("a valid image"),
        flat_jpeg(&[1, 2, 3, 4], Some(2)),
        flat_jpeg(&[9], None),
    ];
    for file in &files {
        for len in 0..file.len() {
            let _ = decode(&file[..len], &limits);
        }
        assert!(decode(&file[..file.len() / 4], &limits).is_err());
    }
    let mut random = Random::new(99);
    for round in 0..6000 {
        let bytes = random.mutated(&files[round % files.len()]);
        if let Ok(image) = decode(&bytes, &limits) {
            assert_eq!(
                image.rgba.len(),
                image.width as usize * image.height as usize * 4
            );
        }
    }
}

#[test]
fn a_large_size_in_a_small_file_takes_no_memory() {
    let mut bytes = flat_jpeg(&[9], None);
    let size = bytes
        .windows(4)
        .position(|w| w == [0, 8, 0, 8])
        .expect("the frame's size");
    bytes[size..size + 4].copy_from_slice(&[0x40, 0, 0x40, 0]);
    let error = decode(&bytes, &Limits::default()).expect_err("too large");
    assert!(error.to_string().contains("cannot have"), "{error}");
}
