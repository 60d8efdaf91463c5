//! Every kind of texel, with the values that Microsoft's documentation gives it.

use super::Fixture;
use crate::Limits;
use crate::image::bmp::{decode, stated_size};

const WHITE: [u8; 4] = [255; 4];
const BLACK: [u8; 4] = [0, 0, 0, 255];
/// B, G, R of red, green, blue and white.
const PALETTE: [[u8; 3]; 4] = [[0, 0, 255], [0, 255, 0], [255, 0, 0], [255, 255, 255]];
const RED: [u8; 4] = [255, 0, 0, 255];
const GREEN: [u8; 4] = [0, 255, 0, 255];
const BLUE: [u8; 4] = [0, 0, 255, 255];

#[track_caller]
fn assert_texels(fixture: &Fixture, expected: &[[u8; 4]]) {
    let bytes = fixture.bytes();
    let image = decode(&bytes, &Limits::default()).expect("a valid file");
    assert_eq!(image.rgba.as_chunks::<4>().0, expected);
    let size = (image.width, image.height);
    assert_eq!(stated_size(&bytes), Some(size));
    assert_eq!(i64::from(size.1), i64::from(fixture.height.abs()));
}

/// Rows: I5.
#[test]
fn indices_of_1_4_and_8_bits_start_in_the_high_bits() {
    let bit = Fixture::new(1, (9, 1), &[0b1010_0001, 0b1000_0000, 0, 0]);
    let [w, k] = [WHITE, BLACK];
    assert_texels(
        &bit.with_palette(&[[0; 3], [255; 3]]),
        &[w, k, w, k, k, k, k, w, w],
    );
    let nibbles = Fixture::new(4, (3, 2), &[0x01, 0x20, 0, 0, 0x33, 0x10, 0, 0]);
    assert_texels(
        &nibbles.with_palette(&PALETTE),
        &[RED, GREEN, BLUE, WHITE, WHITE, GREEN],
    );
    let bytes = Fixture::new(8, (3, 1), &[2, 1, 0, 99]);
    assert_texels(&bytes.with_palette(&PALETTE), &[BLUE, GREEN, RED]);
}

/// Rows: I5.
#[test]
fn rows_run_from_the_bottom_unless_the_height_is_negative() {
    let mut file = Fixture::new(24, (1, 2), &[1, 2, 3, 0, 4, 5, 6, 0]);
    assert_texels(&file, &[[3, 2, 1, 255], [6, 5, 4, 255]]);
    file.height = 2;
    assert_texels(&file, &[[6, 5, 4, 255], [3, 2, 1, 255]]);
    // The padding of the last row may be missing.
    file.texels.pop();
    assert_texels(&file, &[[6, 5, 4, 255], [3, 2, 1, 255]]);
}

/// Rows: I5.
#[test]
fn words_have_five_bits_a_channel_or_masks() {
    // 0 rrrrr ggggg bbbbb: red 31, green 16, blue 1; the top bit is not used.
    let word = 0x8000_u16 | 31 << 10 | 16 << 5 | 1;
    let [low, high] = word.to_le_bytes();
    let mut file = Fixture::new(16, (1, 1), &[low, high, 0, 0]);
    assert_texels(&file, &[[255, 132, 8, 255]]);
    // 5, 6 and 5 bits.
    file.compression = 3;
    file.masks = vec![0xf800, 0x7e0, 0x1f];
    // rrrrr gggggg bbbbb of the same word: 31, 48, 1 without the lowest red bit.
    let (red, green, blue) = (word >> 11, word >> 5 & 63, word & 31);
    let scale = |v: u16, max: f64| (f64::from(v) * 255.0 / max).round();
    let expected = [scale(red, 31.0), scale(green, 63.0), scale(blue, 31.0)];
    let image = decode(&file.bytes(), &Limits::default()).expect("a valid file");
    assert_eq!(expected, [0, 1, 2].map(|at| f64::from(image.rgba[at])));
    assert_eq!(image.rgba[3], 255);
}

/// Rows: I5.
#[test]
fn alpha_needs_a_mask() {
    let mut file = Fixture::new(32, (2, 1), &[1, 2, 3, 4, 5, 6, 7, 8]);
    assert_texels(&file, &[[3, 2, 1, 255], [7, 6, 5, 255]]);
    file.compression = 3;
    file.masks = vec![0xff, 0xff00, 0xff_0000];
    assert_texels(&file, &[[1, 2, 3, 255], [5, 6, 7, 255]]);
    file.masks.push(0xff00_0000);
    for (header_len, compression) in [(40, 6), (56, 3), (108, 3), (124, 3)] {
        (file.header_len, file.compression) = (header_len, compression);
        assert_texels(&file, &[[1, 2, 3, 4], [5, 6, 7, 8]]);
    }
    // A header of 52 bytes ends before the mask of alpha.
    (file.header_len, file.compression) = (52, 3);
    file.masks.pop();
    assert_texels(&file, &[[1, 2, 3, 255], [5, 6, 7, 255]]);
}

/// Rows: I5.
#[test]
fn headers_of_os_2_have_short_fields_and_palettes() {
    let mut file = Fixture::new(8, (2, -1), &[0, 1, 0, 0]).with_palette(&PALETTE);
    file.header_len = 12;
    file.colors = 0;
    file.palette = PALETTE.concat();
    assert_texels(&file, &[RED, GREEN]);
    let mut file = Fixture::new(8, (2, 1), &[0, 1, 0, 0]).with_palette(&PALETTE);
    file.header_len = 64;
    assert_texels(&file, &[RED, GREEN]);
}

/// Rows: I5.
#[test]
fn runs_of_8_bits() {
    let codes = [
        &[3, 1, 0, 0][..],        // three green ones, next row
        &[0, 3, 0, 2, 1, 99],     // red, blue, green as they are, and filling
        &[0, 0, 0, 2, 1, 1],      // next row; one to the right, one row on
        &[200, 3, 0, 1, 1, 1, 1], // white over the end of the row; the end, and more
    ]
    .concat();
    let mut file = Fixture::new(8, (4, 4), &codes).with_palette(&PALETTE);
    file.compression = 1;
    let [r, g, b, w] = [RED, GREEN, BLUE, WHITE];
    assert_texels(&file, &[g, g, g, r, r, b, g, r, r, r, r, r, r, w, w, w]);
}

/// Rows: I5.
#[test]
fn runs_of_4_bits_alternate() {
    let codes = [5, 0x12, 0, 0, 0, 5, 0x01, 0x23, 0x30, 99, 0, 1];
    let mut file = Fixture::new(4, (6, 2), &codes).with_palette(&PALETTE);
    file.compression = 2;
    let [r, g, b, w] = [RED, GREEN, BLUE, WHITE];
    assert_texels(&file, &[g, b, g, b, g, r, r, g, b, w, w, r]);
}
