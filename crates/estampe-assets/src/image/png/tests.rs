//! PNG of every colour type, read from files assembled by hand; our writer; and damaged files.

use super::*;
use crate::image::samples::{Random, disc, noise, opaque};

/// Bits of the samples of one texel, most significant first.
type Texel = Vec<u32>;

/// A PNG file of the texels `at(x, y)`, stored without compression or filters, assembled by hand.
struct Fixture {
    color: u8,
    depth: u8,
    interlaced: bool,
    size: (u32, u32),
    palette: Vec<u8>,
    transparency: Vec<u8>,
}

impl Fixture {
    fn new(color: u8, depth: u8, size: (u32, u32)) -> Self {
        let (palette, transparency) = (Vec::new(), Vec::new());
        Self {
            color,
            depth,
            interlaced: false,
            size,
            palette,
            transparency,
        }
    }

    fn bytes(&self, at: impl Fn(u32, u32) -> Texel) -> Vec<u8> {
        // Adam7: first column, column step, first row, row step of each pass.
        const ADAM7: [(u32, u32, u32, u32); 7] = [
            (0, 8, 0, 8),
            (4, 8, 0, 8),
            (0, 4, 4, 8),
            (2, 4, 0, 4),
            (0, 2, 2, 4),
            (1, 2, 0, 2),
            (0, 1, 1, 2),
        ];
        let (width, height) = self.size;
        let passes = if self.interlaced {
            &ADAM7[..]
        } else {
            &[(0, 1, 0, 1)]
        };
        let mut scanlines = Vec::new();
        for &(x0, dx, y0, dy) in passes.iter().filter(|p| p.0 < width) {
            for y in (y0..height).step_by(dy as usize) {
                scanlines.push(0);
                let samples = (x0..width).step_by(dx as usize).flat_map(|x| at(x, y));
                scanlines.extend(packed(samples, self.depth));
            }
        }
        let mut header = Vec::new();
        header.extend_from_slice(&width.to_be_bytes());
        header.extend_from_slice(&height.to_be_bytes());
        header.extend_from_slice(&[self.depth, self.color, 0, 0, u8::from(self.interlaced)]);
        let mut out = SIGNATURE.to_vec();
        push_chunk(&mut out, b"IHDR", &header);
        for (name, body) in [(b"PLTE", &self.palette), (b"tRNS", &self.transparency)] {
            if !body.is_empty() {
                push_chunk(&mut out, name, body);
            }
        }
        push_chunk(&mut out, b"IDAT", &zlib_stored(&scanlines));
        push_chunk(&mut out, b"IEND", &[]);
        out
    }
}

/// Samples of `depth` bits in bytes, the first in the highest bits, the last byte filled up.
fn packed(samples: impl Iterator<Item = u32>, depth: u8) -> Vec<u8> {
    let bits: Vec<u32> = samples
        .flat_map(|v| (0..depth).rev().map(move |bit| v >> bit & 1))
        .collect();
    bits.chunks(8)
        .map(|byte| {
            byte.iter()
                .zip((0..8).rev())
                .map(|(b, at)| (b << at) as u8)
                .sum()
        })
        .collect()
}

fn push_chunk(out: &mut Vec<u8>, name: &[u8; 4], body: &[u8]) {
    out.extend_from_slice(&(body.len() as u32).to_be_bytes());
    let start = out.len();
    out.extend_from_slice(name);
    out.extend_from_slice(body);
    let mut crc = u32::MAX;
    for &byte in &out[start..] {
        crc ^= u32::from(byte);
        for _ in 0..8 {
            crc = crc >> 1 ^ if crc & 1 == 1 { 0xedb8_8320 } else { 0 };
        }
    }
    out.extend_from_slice(&(!crc).to_be_bytes());
}

fn zlib_stored(data: &[u8]) -> Vec<u8> {
    let mut out = vec![0x78, 0x01, 1];
    out.extend_from_slice(&(data.len() as u16).to_le_bytes());
    out.extend_from_slice(&(!(data.len() as u16)).to_le_bytes());
    out.extend_from_slice(data);
    let (a, b) = data.iter().fold((1, 0), |(a, b), &v| {
        let a = (a + u32::from(v)) % 65_521;
        (a, (b + a) % 65_521)
    });
    out.extend_from_slice(&(b << 16 | a).to_be_bytes());
    out
}

#[track_caller]
fn check(fixture: &Fixture, at: impl Fn(u32, u32) -> Texel, expected: impl Fn(&Texel) -> [u8; 4]) {
    let bytes = fixture.bytes(&at);
    let image = decode(&bytes, &Limits::default()).expect("a valid PNG");
    assert_eq!((image.width, image.height), fixture.size);
    for y in 0..image.height {
        for x in 0..image.width {
            assert_eq!(image.texel(x, y), expected(&at(x, y)), "({x}, {y})");
        }
    }
}

/// A value of `bits` bits that differs from texel to texel and from channel to channel.
fn sample(x: u32, y: u32, channel: u32, bits: u8) -> u32 {
    ((x * 40_503) ^ (y * 30_011) ^ (channel * 21_701)) & ((1 << bits) - 1)
}

fn unorm8(value: u32, bits: u8) -> u8 {
    let top = f64::from((1_u32 << bits) - 1);
    (f64::from(value) / top * 255.0 + 0.5) as u8
}

/// Rows: I2.
#[test]
fn every_colour_type_and_depth_interlaced_or_not() {
    for interlaced in [false, true] {
        for size in [(1, 1), (5, 3), (13, 11)] {
            for (color, channels, depths) in [
                (0, 1, &[1, 2, 4, 8, 16][..]),
                (2, 3, &[8, 16]),
                (4, 2, &[8, 16]),
                (6, 4, &[8, 16]),
            ] {
                for &depth in depths {
                    let fixture = Fixture {
                        interlaced,
                        ..Fixture::new(color, depth, size)
                    };
                    let at = |x, y| (0..channels).map(|c| sample(x, y, c, depth)).collect();
                    check(&fixture, at, |texel| {
                        let v: Vec<u8> = texel.iter().map(|&v| unorm8(v, depth)).collect();
                        match channels {
                            1 => [v[0], v[0], v[0], 255],
                            2 => [v[0], v[0], v[0], v[1]],
                            3 => [v[0], v[1], v[2], 255],
                            _ => [v[0], v[1], v[2], v[3]],
                        }
                    });
                }
            }
        }
    }
}

/// Rows: I2.
#[test]
fn palettes_of_every_depth_with_and_without_transparency() {
    for depth in [1, 2, 4, 8] {
        for transparency in [vec![], vec![0, 100]] {
            let entries = 1_u32 << depth;
            let palette: Vec<u8> = (0..entries)
                .flat_map(|i| [i as u8, 255 - i as u8, 7])
                .collect();
            let mut fixture = Fixture::new(3, depth, (9, 4));
            fixture.palette = palette;
            fixture.transparency = transparency.clone();
            check(
                &fixture,
                |x, y| vec![sample(x, y, 0, depth)],
                |texel| {
                    let index = texel[0] as usize;
                    let alpha = *transparency.get(index).unwrap_or(&255);
                    [index as u8, 255 - index as u8, 7, alpha]
                },
            );
        }
    }
}

/// Rows: I2.
#[test]
fn one_colour_can_be_transparent() {
    let mut grey = Fixture::new(0, 8, (4, 1));
    grey.transparency = vec![0, 2];
    check(
        &grey,
        |x, _| vec![x],
        |v| {
            [
                v[0] as u8,
                v[0] as u8,
                v[0] as u8,
                if v[0] == 2 { 0 } else { 255 },
            ]
        },
    );
    let mut rgb = Fixture::new(2, 16, (4, 1));
    rgb.transparency = vec![1, 3, 0, 0, 0, 0];
    check(
        &rgb,
        |x, _| vec![0x100 + x, 0, 0],
        |v| [1, 0, 0, if v[0] == 0x103 { 0 } else { 255 }],
    );
}

/// Rows: I2.
#[test]
fn written_files_read_back() {
    let mut random = Random::new(2);
    for width in (1..20).chain([127, 256, 300]) {
        let image = noise(width, 1 + random.below(7) as u32, random.next());
        for (alpha, kept) in [
            (AlphaChannel::WhenNeeded, image.clone()),
            (AlphaChannel::Always, image.clone()),
            (AlphaChannel::Never, opaque(image.clone())),
        ] {
            let bytes = encode_png(&image, alpha).expect("a valid image");
            assert_eq!(decode(&bytes, &Limits::default()), Ok(kept));
        }
    }
}

#[test]
fn opaque_pictures_take_three_channels_unless_asked() {
    let image = disc(64, 48);
    let color = |alpha| encode_png(&image, alpha).expect("a valid image")[25];
    assert_eq!(color(AlphaChannel::WhenNeeded), 2);
    assert_eq!(color(AlphaChannel::Never), 2);
    assert_eq!(color(AlphaChannel::Always), 6);
    let clear = noise(3, 3, 1);
    assert_eq!(
        encode_png(&clear, AlphaChannel::WhenNeeded).expect("a valid image")[25],
        6
    );
}

#[test]
fn the_same_picture_is_the_same_bytes_and_small() {
    let image = disc(256, 256);
    let bytes = encode_png(&image, AlphaChannel::WhenNeeded).expect("a valid image");
    assert_eq!(
        encode_png(&image, AlphaChannel::WhenNeeded),
        Ok(bytes.clone())
    );
    assert!(bytes.len() < 256 * 256 * 3 / 3, "{} bytes", bytes.len());
}

/// Rows: I2.
#[test]
fn every_prefix_is_refused_inside_the_file() {
    let bytes = encode_png(&noise(6, 6, 4), AlphaChannel::Always).expect("a valid image");
    // Only the end marker (12 bytes) and the checksum before it may be missing.
    for len in 0..bytes.len() - 20 {
        let error = decode(&bytes[..len], &Limits::default()).expect_err("cut short");
        assert!(matches!(error, AssetError::Malformed(_)), "{len}: {error}");
        let Some(crate::error::Location::Byte(at)) = error.fault().location else {
            panic!("{error} has no place");
        };
        assert!(at <= len as u64, "{error}");
    }
}

#[test]
fn a_large_size_in_a_small_file_takes_no_memory() {
    let mut bytes = encode_png(&noise(2, 2, 4), AlphaChannel::Always).expect("a valid image");
    for side in [16_384_u32, u32::MAX >> 1] {
        let mut header = Vec::new();
        header.extend_from_slice(&side.to_be_bytes());
        header.extend_from_slice(&side.to_be_bytes());
        header.extend_from_slice(&[8, 6, 0, 0, 0]);
        let mut head = SIGNATURE.to_vec();
        push_chunk(&mut head, b"IHDR", &header);
        bytes[..head.len()].copy_from_slice(&head);
        let error = decode(&bytes, &Limits::default()).expect_err("too large");
        let expected = if side == 16_384 {
            "cannot have"
        } else {
            "limit"
        };
        assert!(error.to_string().contains(expected), "{error}");
    }
}

/// Rows: I2.
#[test]
fn random_damage_never_panics() {
    let limits = Limits {
        max_image_pixels: 1 << 16,
        ..Limits::default()
    };
    let mut random = Random::new(77);
    let mut grey = Fixture::new(0, 16, (9, 9));
    grey.interlaced = true;
    grey.transparency = vec![0, 2];
    let mut mapped = Fixture::new(3, 4, (9, 9));
    mapped.palette = vec![3; 48];
    let files = [
        grey.bytes(|x, y| vec![x * y]),
        mapped.bytes(|x, y| vec![x ^ y]),
        encode_png(&noise(9, 9, 4), AlphaChannel::Always).expect("a valid image"),
    ];
    for round in 0..6000 {
        let mut bytes = random.mutated(&files[round % files.len()]);
        if round % 2 == 0 {
            mend_checksums(&mut bytes);
        }
        if let Ok(image) = decode(&bytes, &limits) {
            assert_eq!(
                image.rgba.len(),
                image.width as usize * image.height as usize * 4
            );
        }
    }
}

/// Corrects each chunk's checksum, so that readers do not stop at it.
fn mend_checksums(bytes: &mut [u8]) {
    let mut at = SIGNATURE.len();
    while let Some(head) = bytes.get(at..at + 8) {
        let len = u32::from_be_bytes([head[0], head[1], head[2], head[3]]) as usize;
        let name = [head[4], head[5], head[6], head[7]];
        let Some(body) = bytes.get(at + 8..at + 8 + len) else {
            return;
        };
        let mut chunk = Vec::new();
        push_chunk(&mut chunk, &name, body);
        if at + chunk.len() > bytes.len() {
            return;
        }
        bytes[at..at + chunk.len()].copy_from_slice(&chunk);
        at += chunk.len();
    }
}

#[test]
fn drawings_are_smaller_and_the_same() {
    let mut image = noise(160, 120, 4);
    for (at, pixel) in image.rgba.as_chunks_mut::<4>().0.iter_mut().enumerate() {
        let is_line = at / 160 % 17 == 0 || at % 160 % 23 == 0;
        *pixel = if is_line {
            [200, 30, 20, 255]
        } else {
            [250, 250, 255, 255]
        };
    }
    let drawing = encode_drawing_png(&image).expect("a valid image");
    let picture = encode_png(&image, AlphaChannel::WhenNeeded).expect("a valid image");
    assert!(
        drawing.len() * 2 < picture.len(),
        "{} {}",
        drawing.len(),
        picture.len()
    );
    let limits = crate::Limits::default();
    assert_eq!(
        crate::image::decode(&drawing, &limits).expect("a PNG"),
        image
    );
}
