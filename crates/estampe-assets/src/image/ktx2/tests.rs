//! KTX2: files written by hand, and what is refused.

use super::{SIGNATURE, decode, decode_reduced, stated_size};
use crate::error::Location;
use crate::image::reduce::{Reduction, TexelContent};
use crate::{AssetError, Limits};
use estampe_scene::{AlphaMode, Image};
use std::io::Write;

/// A file of levels, as they are stored.
#[derive(Clone)]
struct Fixture {
    format: u32,
    size: [u32; 3],
    layers: u32,
    faces: u32,
    scheme: u32,
    /// Colour model, primaries, transfer function, flags.
    model: [u8; 4],
    /// Pairs of a key and a value, with a zero between.
    values: Vec<&'static [u8]>,
    levels: Vec<Vec<u8>>,
}

impl Fixture {
    fn new(format: u32, [width, height]: [u32; 2], texels: &[u8]) -> Self {
        Self {
            format,
            size: [width, height, 0],
            layers: 0,
            faces: 1,
            scheme: 0,
            model: [1, 1, 2, 0],
            values: Vec::new(),
            levels: vec![texels.to_vec()],
        }
    }

    fn bytes(&self) -> Vec<u8> {
        let descriptor_at = 80 + 24 * self.levels.len() as u32;
        let mut values = Vec::new();
        for pair in &self.values {
            values.extend((pair.len() as u32).to_le_bytes());
            values.extend(*pair);
            values.resize(values.len().next_multiple_of(4), 0);
        }
        let mut out = SIGNATURE.to_vec();
        let mut words = vec![self.format, 1];
        words.extend(self.size);
        words.extend([
            self.layers,
            self.faces,
            self.levels.len() as u32,
            self.scheme,
        ]);
        words.extend([descriptor_at, 28, descriptor_at + 28, values.len() as u32]);
        out.extend(words.into_iter().flat_map(u32::to_le_bytes));
        out.extend([0; 16]);
        let mut at = u64::from(descriptor_at) + 28 + values.len() as u64;
        for level in &self.levels {
            let len = level.len() as u64;
            out.extend([at, len, len].into_iter().flat_map(u64::to_le_bytes));
            at += len;
        }
        out.extend([28, 0, 24 << 16 | 2].into_iter().flat_map(u32::to_le_bytes));
        out.extend(self.model);
        out.extend([0; 12]);
        out.extend(values);
        out.extend(self.levels.concat());
        out
    }

    #[track_caller]
    fn image(&self) -> Image {
        let bytes = self.bytes();
        assert_eq!(stated_size(&bytes), Some((self.size[0], self.size[1])));
        decode(&bytes, &Limits::default()).expect("a valid file")
    }

    #[track_caller]
    fn texels(&self) -> Vec<[u8; 4]> {
        self.image().rgba.as_chunks::<4>().0.to_vec()
    }

    fn refused(&self) -> AssetError {
        decode(&self.bytes(), &Limits::default()).expect_err("not read")
    }
}

/// Rows: I5.
#[test]
fn channels_are_in_their_places() {
    for (number, expected) in [(37, [1, 2, 3, 4]), (43, [1, 2, 3, 4]), (44, [3, 2, 1, 4])] {
        let file = Fixture::new(number, [1, 1], &[1, 2, 3, 4]);
        assert_eq!(file.texels(), [expected], "{number}");
    }
    for (number, expected) in [(23, [1, 2, 3, 255]), (36, [3, 2, 1, 255])] {
        let file = Fixture::new(number, [2, 1], &[1, 2, 3, 9, 9, 9]);
        assert_eq!(file.texels(), [expected, [9, 9, 9, 255]], "{number}");
    }
    assert_eq!(Fixture::new(9, [1, 1], &[7]).texels(), [[7, 7, 7, 255]]);
    // 204 is 0.6 and 128 is 1/255, which leave slightly less than 0.8.
    let normal = Fixture::new(16, [1, 1], &[204, 128]);
    assert_eq!(normal.texels(), [[204, 128, 229, 255]]);
}

/// BC1 between red and blue, whose first end is the smaller number: index 3 is transparent.
const BC1: [u8; 8] = [0x1f, 0, 0, 0xf8, 0, 0, 0, 0xff];

/// Rows: I5.
#[test]
fn blocks_of_every_family_are_decoded() {
    let transparent = Fixture::new(133, [4, 4], &BC1).texels();
    assert_eq!(
        (transparent[0], transparent[15]),
        ([0, 0, 255, 255], [0; 4])
    );
    let opaque = Fixture::new(131, [4, 4], &BC1).texels();
    assert_eq!(opaque[15], [0, 0, 0, 255]);

    // One channel between 200 and 40, with index 0.
    let one = [200, 40, 0, 0, 0, 0, 0, 0];
    assert_eq!(
        Fixture::new(139, [4, 4], &one).texels()[0],
        [200, 200, 200, 255]
    );
    let x = [204, 204, 0, 0, 0, 0, 0, 0];
    let y = [128, 127, 0, 0, 0, 0, 0, 0];
    let two = Fixture::new(141, [4, 4], &[x, y].concat()).texels();
    assert_eq!(two[0], [204, 128, 229, 255]);

    // ETC1's individual mode: 8 · 17 + 2 in each channel.
    let etc = [0x88, 0x88, 0x88, 0, 0, 0, 0, 0];
    assert_eq!(
        Fixture::new(147, [4, 4], &etc).texels(),
        [[138, 138, 138, 255]; 16]
    );
    // EAC: (128 · 8 + 4 − 3) ÷ 2047.
    let eac = [128, 0, 0, 0, 0, 0, 0, 0];
    assert_eq!(
        Fixture::new(153, [4, 4], &eac).texels(),
        [[128, 128, 128, 255]; 16]
    );

    // ASTC of one colour, in blocks of 4×4 and 12×12, cut at the image's border.
    let mut astc = [0xff_u8; 16];
    astc[..2].copy_from_slice(&[0xfc, 0xfd]);
    for (pair, code) in astc[8..]
        .as_chunks_mut::<2>()
        .0
        .iter_mut()
        .zip([10, 20, 30, 40])
    {
        *pair = [code, code];
    }
    for (number, blocks) in [(157, 4), (158, 4), (184, 1)] {
        let file = Fixture::new(number, [5, 7], &astc.repeat(blocks));
        assert_eq!(file.texels(), [[10, 20, 30, 40]; 35], "{number}");
    }
}

/// Rows: I5.
#[test]
fn supercompressed_levels_are_read() {
    let texels: Vec<u8> = (0..64).collect();
    let mut zlib = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
    zlib.write_all(&texels).expect("memory");
    let zlib = zlib.finish().expect("memory");
    // A frame of one segment, 64 bytes long, in one raw block.
    let mut zstandard = vec![0x28, 0xb5, 0x2f, 0xfd, 0x20, 64];
    // The last block, raw: 1 + 8 · 64.
    zstandard.extend([1, 2, 0]);
    zstandard.extend(&texels);
    for (scheme, stored) in [(0, texels.clone()), (2, zstandard), (3, zlib)] {
        let file = Fixture {
            scheme,
            levels: vec![stored],
            ..Fixture::new(37, [4, 4], &[])
        };
        assert_eq!(file.image().rgba, texels, "scheme {scheme}");
        let short = Fixture {
            size: [4, 5, 0],
            ..file
        };
        let error = short.refused().to_string();
        assert!(error.contains("needs 80 bytes and has 64"), "{error}");
    }
}

/// Rows: I5.
#[test]
fn stored_levels_are_used() {
    let (first, second) = ([[200, 0, 0, 0]; 4], [[9, 8, 7, 255]; 1]);
    let mut first = first.to_vec();
    first[0][3] = 255;
    let file = Fixture {
        levels: vec![first.concat(), second.concat()],
        ..Fixture::new(37, [2, 2], &[])
    };
    let reduction = Reduction {
        level: 1,
        content: TexelContent::Color,
    };
    let limits = Limits::default();
    let read = decode_reduced(&file.bytes(), reduction, &limits).expect("a valid file");
    assert_eq!(read.image.rgba, [9, 8, 7, 255]);
    assert_eq!(read.alpha, AlphaMode::Opaque);
    // A level that is not opaque has the use of alpha of the first one.
    let file = Fixture {
        levels: vec![first.concat(), vec![9, 8, 7, 64]],
        ..file
    };
    let read = decode_reduced(&file.bytes(), reduction, &limits).expect("a valid file");
    assert_eq!(read.image.rgba, [9, 8, 7, 64]);
    assert_eq!(read.alpha, AlphaMode::Mask);
    // No level is stored: all are made from the whole image.
    let file = Fixture {
        levels: vec![first.concat()],
        ..file
    };
    let read = decode_reduced(&file.bytes(), reduction, &limits).expect("a valid file");
    assert_eq!(read.image.rgba, [200, 0, 0, 64]);
}

/// Rows: I5.
#[test]
fn orientation_swizzle_and_premultiplied_alpha_are_applied() {
    let texels: Vec<u8> = [
        [1, 2, 3, 255],
        [4, 5, 6, 255],
        [7, 8, 9, 255],
        [10, 11, 12, 255],
    ]
    .concat();
    let file = Fixture::new(37, [2, 2], &texels);
    let with = |value: &'static [u8]| Fixture {
        values: vec![&b"KTXwriter\0x\0"[..], value],
        ..file.clone()
    };
    let firsts = |file: &Fixture| {
        file.texels()
            .iter()
            .map(|texel| texel[0])
            .collect::<Vec<_>>()
    };
    assert_eq!(firsts(&with(b"KTXorientation\0rd\0")), [1, 4, 7, 10]);
    assert_eq!(firsts(&with(b"KTXorientation\0ru\0")), [7, 10, 1, 4]);
    assert_eq!(firsts(&with(b"KTXorientation\0ld\0")), [4, 1, 10, 7]);
    assert_eq!(with(b"KTXswizzle\0bg01\0").texels()[0], [3, 2, 0, 255]);
    // An unknown letter has no effect.
    assert_eq!(with(b"KTXswizzle\0bgxx\0").texels()[0], [1, 2, 3, 255]);

    let premultiplied = Fixture {
        model: [1, 1, 2, 1],
        ..Fixture::new(37, [1, 1], &[50, 100, 0, 128])
    };
    assert_eq!(premultiplied.texels(), [[100, 199, 0, 128]]);
}

/// Rows: I5.
#[test]
fn other_kinds_are_errors_that_name_them() {
    let file = Fixture::new(37, [1, 1], &[1, 2, 3, 4]);
    let with_model = |model, scheme| Fixture {
        format: 0,
        scheme,
        model: [model, 1, 2, 0],
        ..file.clone()
    };
    for (refused, name) in [
        (
            Fixture {
                size: [4, 0, 0],
                ..file.clone()
            },
            "one dimension",
        ),
        (
            Fixture {
                size: [4, 4, 4],
                ..file.clone()
            },
            "three dimensions",
        ),
        (
            Fixture {
                faces: 6,
                ..file.clone()
            },
            "cube map",
        ),
        (
            Fixture {
                layers: 2,
                ..file.clone()
            },
            "array",
        ),
        (
            Fixture {
                format: 97,
                ..file.clone()
            },
            "VkFormat 97",
        ),
        (
            Fixture {
                scheme: 77,
                ..file.clone()
            },
            "supercompression 77",
        ),
        (with_model(163, 1), "Basis Universal (ETC1S)"),
        (with_model(166, 2), "UASTC"),
        (with_model(167, 0), "Basis Universal (UASTC HDR)"),
        (with_model(99, 0), "colour model 99"),
    ] {
        let error = refused.refused();
        assert!(matches!(error, AssetError::Unsupported(_)), "{error}");
        assert!(error.to_string().contains(name), "{error}");
    }
}

/// Rows: I5.
#[test]
fn every_prefix_is_located_and_large_sizes_take_no_memory() {
    let file = Fixture {
        values: vec![&b"KTXorientation\0rd\0"[..]],
        ..Fixture::new(133, [5, 3], &BC1.repeat(2))
    };
    let bytes = file.bytes();
    for len in 0..bytes.len() {
        let error = decode(&bytes[..len], &Limits::default()).expect_err("cut short");
        assert_eq!(
            error.fault().location,
            Some(Location::Byte(len as u64)),
            "{error}"
        );
    }
    let large = Fixture {
        size: [16_384, 16_384, 0],
        ..file.clone()
    };
    assert!(matches!(large.refused(), AssetError::Malformed(_)));
    let too_large = Fixture {
        size: [u32::MAX, u32::MAX, 0],
        ..file
    };
    assert!(matches!(too_large.refused(), AssetError::LimitExceeded(_)));
}
