//! DDS: blocks and texels written by hand, and damaged files.

use super::{decode, stated_size};
use crate::error::Location;
use crate::image::samples::Random;
use crate::{AssetError, Limits};

/// A file with pixel format `flags`, `code`, bits and masks.
struct Fixture {
    size: [u32; 2],
    flags: u32,
    code: [u8; 4],
    bits: u32,
    masks: [u32; 4],
    /// Cube map, volume.
    shape: u32,
    /// DXGI format, dimension, flags, layers, alpha.
    dx10: Option<[u32; 5]>,
    texels: Vec<u8>,
}

impl Fixture {
    fn code(code: &[u8; 4], size: [u32; 2], texels: &[u8]) -> Self {
        Self {
            size,
            flags: 4,
            code: *code,
            bits: 0,
            masks: [0; 4],
            shape: 0,
            dx10: None,
            texels: texels.to_vec(),
        }
    }

    fn dxgi(format: u32, size: [u32; 2], texels: &[u8]) -> Self {
        Self {
            dx10: Some([format, 3, 0, 1, 0]),
            ..Self::code(b"DX10", size, texels)
        }
    }

    fn masked(flags: u32, bits: u32, masks: [u32; 4], texels: &[u8]) -> Self {
        Self {
            flags,
            bits,
            masks,
            ..Self::code(&[0; 4], [2, 1], texels)
        }
    }

    fn bytes(&self) -> Vec<u8> {
        let mut words = vec![124, 0x1007, self.size[1], self.size[0], 0, 0, 1];
        words.extend([0; 11]);
        words.extend([32, self.flags, u32::from_le_bytes(self.code), self.bits]);
        words.extend(self.masks);
        words.extend([0x1000, self.shape, 0, 0, 0]);
        words.extend(self.dx10.into_iter().flatten());
        let mut out = b"DDS ".to_vec();
        out.extend(words.into_iter().flat_map(u32::to_le_bytes));
        out.extend(&self.texels);
        out
    }

    #[track_caller]
    fn texels(&self) -> Vec<[u8; 4]> {
        let bytes = self.bytes();
        let image = decode(&bytes, &Limits::default()).expect("a valid file");
        assert_eq!([image.width, image.height], self.size);
        assert_eq!(stated_size(&bytes), Some((self.size[0], self.size[1])));
        image.rgba.as_chunks::<4>().0.to_vec()
    }
}

/// A BC1 block between red and blue, whose rows have the indices 0, 1, 2 and 3.
const RED_TO_BLUE: [u8; 8] = [
    0,
    0xf8,
    0x1f,
    0,
    0b0000_0000,
    0b0101_0101,
    0b1010_1010,
    0xff,
];
/// A block of one channel between 200 and 40: index 0 in all texels but the first, which has 1.
const ONE_CHANNEL: [u8; 8] = [200, 40, 1, 0, 0, 0, 0, 0];

const RED: [u8; 4] = [255, 0, 0, 255];
const BLUE: [u8; 4] = [0, 0, 255, 255];

/// Rows: I5.
#[test]
fn blocks_of_colours_hold_two_ends_and_thirds() {
    for file in [
        Fixture::code(b"DXT1", [4, 4], &RED_TO_BLUE),
        Fixture::dxgi(71, [4, 4], &RED_TO_BLUE),
        Fixture::dxgi(72, [4, 4], &RED_TO_BLUE),
    ] {
        let texels = file.texels();
        assert_eq!(texels[..8], [[RED; 4], [BLUE; 4]].concat());
        assert_eq!(texels[8..12], [[170, 0, 85, 255]; 4]);
        assert_eq!(texels[12..], [[85, 0, 170, 255]; 4]);
    }
    // With the ends in the other order, index 3 is transparent.
    let mut block = RED_TO_BLUE;
    block[..4].copy_from_slice(&[0x1f, 0, 0, 0xf8]);
    let texels = Fixture::code(b"DXT1", [4, 4], &block).texels();
    assert_eq!((texels[0], texels[15]), (BLUE, [0; 4]));
}

/// Rows: I5.
#[test]
fn blocks_are_cut_at_the_border_of_the_image() {
    let mut green = RED_TO_BLUE;
    green[..4].copy_from_slice(&[0xe0, 7, 0, 0]);
    let file = Fixture::code(b"DXT1", [5, 2], &[RED_TO_BLUE, green].concat());
    let texels = file.texels();
    assert_eq!(texels[..5], [RED, RED, RED, RED, [0, 255, 0, 255]]);
    assert_eq!(texels[5..], [BLUE, BLUE, BLUE, BLUE, [0, 0, 0, 255]]);
}

/// Rows: I5.
#[test]
fn alpha_of_four_bits_and_interpolated_alpha() {
    let four_bits = [
        [0x10, 0x32, 0x54, 0x76, 0x98, 0xba, 0xdc, 0xfe],
        RED_TO_BLUE,
    ]
    .concat();
    let texels = Fixture::code(b"DXT3", [4, 4], &four_bits).texels();
    assert!((0..).zip(&texels).all(|(i, texel)| texel[3] == i * 17));
    let interpolated = [ONE_CHANNEL, RED_TO_BLUE].concat();
    for file in [
        Fixture::code(b"DXT5", [4, 4], &interpolated),
        Fixture::dxgi(77, [4, 4], &interpolated),
    ] {
        assert_eq!(file.texels()[..2], [[255, 0, 0, 40], [255, 0, 0, 200]]);
    }
    // Colours that are multiplied by alpha are brighter than it here, so they saturate.
    let texels = Fixture::code(b"DXT4", [4, 4], &interpolated).texels();
    assert_eq!(texels[8], [217, 0, 108, 200]);
}

/// Rows: I5.
#[test]
fn one_channel_is_grey_and_two_are_a_normal() {
    let texels = Fixture::code(b"ATI1", [4, 4], &ONE_CHANNEL).texels();
    assert_eq!(texels[..2], [[40, 40, 40, 255], [200, 200, 200, 255]]);
    // −127 and 127 as two's complements.
    let signed = [0x7f, 0x81, 1, 0, 0, 0, 0, 0];
    let texels = Fixture::dxgi(81, [4, 4], &signed).texels();
    assert_eq!(texels[..2], [[0, 0, 0, 255], [255; 4]]);
    // x = 0.6 and y = 1/255 leave slightly less than z = 0.8, which would be 229.5.
    let x = [204, 204, 0, 0, 0, 0, 0, 0];
    let y = [128, 127, 0, 0, 0, 0, 0, 0];
    for file in [
        Fixture::code(b"ATI2", [4, 4], &[x, y].concat()),
        Fixture::dxgi(83, [4, 4], &[x, y].concat()),
    ] {
        assert_eq!(file.texels(), [[204, 128, 229, 255]; 16]);
    }
}

/// Rows: I5.
#[test]
fn bc7_blocks_are_read() {
    // Mode 5 without rotation: ends of 7 bits, alpha of 8 bits, all indices 0.
    // Bits from the lowest: 000001, 2 of rotation, R0 R1 G0 G1 B0 B1, A0 A1.
    let mut bits: u128 = 1 << 5;
    for (value, at) in [(127_u128, 8), (64, 22), (1, 36), (99, 50)] {
        bits |= value << at;
    }
    let texels = Fixture::dxgi(98, [4, 4], &bits.to_le_bytes()).texels();
    assert_eq!(texels, [[255, 129, 2, 99]; 16]);
}

/// Rows: I5.
#[test]
fn texels_with_masks_are_words() {
    let bgra = [0xff_0000, 0xff00, 0xff, 0xff00_0000];
    let file = Fixture::masked(0x41, 32, bgra, &[1, 2, 3, 4, 5, 6, 7, 8]);
    assert_eq!(file.texels(), [[3, 2, 1, 4], [7, 6, 5, 8]]);
    // Without the flag of alpha, its mask has no effect.
    let file = Fixture::masked(0x40, 32, bgra, &[1, 2, 3, 4, 5, 6, 7, 8]);
    assert_eq!(file.texels(), [[3, 2, 1, 255], [7, 6, 5, 255]]);
    let file = Fixture::masked(0x40, 24, [0xff, 0xff00, 0xff_0000, 0], &[1, 2, 3, 4, 5, 6]);
    assert_eq!(file.texels(), [[1, 2, 3, 255], [4, 5, 6, 255]]);
    let file = Fixture::masked(0x40, 16, [0xf800, 0x7e0, 0x1f, 0], &[0, 0xf8, 0xe0, 7]);
    assert_eq!(file.texels(), [RED, [0, 255, 0, 255]]);
    let file = Fixture::masked(0x2_0001, 16, [0xff, 0, 0, 0xff00], &[9, 10, 11, 12]);
    assert_eq!(file.texels(), [[9, 9, 9, 10], [11, 11, 11, 12]]);
    let texels = [1, 2, 3, 4, 5, 6, 7, 8];
    assert_eq!(Fixture::dxgi(28, [2, 1], &texels).texels()[1], [5, 6, 7, 8]);
    assert_eq!(Fixture::dxgi(91, [2, 1], &texels).texels()[1], [7, 6, 5, 8]);
    assert_eq!(
        Fixture::dxgi(88, [2, 1], &texels).texels()[1],
        [7, 6, 5, 255]
    );
}

/// Rows: I5.
#[test]
fn other_kinds_are_unsupported() {
    let cube = |shape| Fixture {
        shape,
        ..Fixture::code(b"DXT1", [4, 4], &RED_TO_BLUE)
    };
    let dx10 = |dx10| Fixture {
        dx10: Some(dx10),
        ..Fixture::dxgi(71, [4, 4], &RED_TO_BLUE)
    };
    for file in [
        cube(0x200),
        cube(0x20_0000),
        dx10([71, 4, 0, 1, 0]),
        dx10([71, 3, 4, 1, 0]),
        dx10([71, 3, 0, 2, 0]),
        dx10([95, 3, 0, 1, 0]),
        Fixture::code(b"ETC1", [4, 4], &RED_TO_BLUE),
        Fixture::masked(0x200, 32, [0; 4], &[0; 8]),
        Fixture::masked(0x40, 12, [0; 4], &[0; 8]),
    ] {
        let error = decode(&file.bytes(), &Limits::default()).expect_err("no 2D texture");
        assert!(matches!(error, AssetError::Unsupported(_)), "{error}");
    }
}

fn files() -> Vec<Vec<u8>> {
    [
        Fixture::code(b"DXT1", [5, 3], &[RED_TO_BLUE; 2].concat()),
        Fixture::dxgi(98, [4, 4], &[0x20; 16]),
        Fixture::dxgi(83, [4, 4], &[ONE_CHANNEL; 2].concat()),
        Fixture::masked(0x40, 16, [0xf800, 0x7e0, 0x1f, 0], &[0, 0xf8, 0xe0, 7]),
    ]
    .iter()
    .map(Fixture::bytes)
    .collect()
}

/// Rows: I5.
#[test]
fn every_prefix_is_located() {
    for file in files() {
        for len in 0..file.len() {
            let error = decode(&file[..len], &Limits::default()).expect_err("cut short");
            let location = error.fault().location;
            assert_eq!(location, Some(Location::Byte(len as u64)), "{error}");
        }
    }
}

/// Rows: I5.
#[test]
fn a_large_size_in_a_small_file_takes_no_memory() {
    for mut file in [
        Fixture::code(b"DXT1", [16_384; 2], &[0; 900]),
        Fixture::masked(0x40, 32, [0xff; 4], &[0; 900]),
    ] {
        file.size = [16_384; 2];
        let error = decode(&file.bytes(), &Limits::default()).expect_err("too short");
        assert!(matches!(error, AssetError::Malformed(_)), "{error}");
        file.size = [u32::MAX; 2];
        let error = decode(&file.bytes(), &Limits::default()).expect_err("too large");
        assert!(matches!(error, AssetError::LimitExceeded(_)), "{error}");
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
    let mut random = Random::new(0xdd5);
    let mut read = 0;
    for round in 0..12_000 {
        let bytes = random.mutated(&files[round % files.len()]);
        if let Ok(image) = decode(&bytes, &limits) {
            let texels = image.width as usize * image.height as usize;
            assert_eq!(image.rgba.len(), texels * 4);
            read += 1;
        }
    }
    assert!((500..11_500).contains(&read), "{read} of 12000 are read");
}
