//! Damaged images of every format: an error with its place or an image, within the limits, in time.

use estampe_assets::image::{
    AlphaChannel, ExrChannel, ExrSamples, Reduction, TexelContent, decode, decode_exr, decode_hdr,
    decode_reduced, encode_exr, encode_hdr, encode_jpeg, encode_png, encode_webp, jpeg, tga,
};
use estampe_assets::{AssetError, Limits};
use estampe_scene::{HdrImage, Image};
use std::time::{Duration, Instant};

/// Pixels of the largest image that a damaged file may become.
const MOST_PIXELS: u64 = 1 << 20;
/// The longest time for one file.
const LONGEST: Duration = Duration::from_secs(10);

/// Reads a file to the number of its pixels.
type Read = fn(&[u8], &Limits) -> Result<u64, AssetError>;

/// A format, with small files of its kinds.
struct Format {
    name: &'static str,
    files: Vec<Vec<u8>>,
    read: &'static [Read],
}

fn pixels(image: &Image) -> u64 {
    let pixels = u64::from(image.width) * u64::from(image.height);
    assert_eq!(image.rgba.len() as u64, pixels * 4);
    pixels
}

fn whole(bytes: &[u8], limits: &Limits) -> Result<u64, AssetError> {
    decode(bytes, limits).map(|image| pixels(&image))
}

fn reduced(bytes: &[u8], limits: &Limits) -> Result<u64, AssetError> {
    let reduction = Reduction {
        level: 1,
        content: TexelContent::Color,
    };
    decode_reduced(bytes, reduction, limits).map(|image| pixels(&image))
}

fn hdr(bytes: &[u8], limits: &Limits) -> Result<u64, AssetError> {
    decode_hdr(bytes, limits).map(|image| u64::from(image.width) * u64::from(image.height))
}

fn exr(bytes: &[u8], limits: &Limits) -> Result<u64, AssetError> {
    decode_exr(bytes, limits).map(|image| u64::from(image.width) * u64::from(image.height))
}

const READERS: &[Read] = &[whole, reduced];

fn noise(width: u32, height: u32) -> Image {
    let mut random = fastrand::Rng::with_seed(3);
    let mut texel = [0; 4];
    let rgba = (0..width * height).flat_map(|_| {
        if random.u8(..3) == 0 {
            texel = random.u32(..).to_le_bytes();
        }
        texel
    });
    Image {
        width,
        height,
        rgba: rgba.collect(),
    }
}

fn words(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

/// Bitmaps: 24 bits, and run-length encoded with two colours.
fn bitmaps() -> Vec<Vec<u8>> {
    let header = |offset: u32, bits: u16, compression: u32, colors: u32| {
        let mut out = b"BM".to_vec();
        out.extend(words(&[0, 0, offset, 40, 8, 4]));
        out.extend([1, 0]);
        out.extend(bits.to_le_bytes());
        out.extend(words(&[compression, 0, 0, 0, colors, 0]));
        out
    };
    let mut plain = header(54, 24, 0, 0);
    plain.extend((0..96).map(|i| i * 2));
    let mut runs = header(62, 8, 1, 2);
    runs.extend(words(&[0xff, 0xff00]));
    runs.extend([8, 1, 0, 0, 0, 3, 0, 1, 1, 0, 0, 0, 0, 2, 1, 1, 3, 0, 0, 1]);
    vec![plain, runs]
}

/// DDS: blocks of BC1 with two levels, and words.
fn surfaces() -> Vec<Vec<u8>> {
    let header = |flags, code, bits, masks: [u32; 4], levels| {
        let mut all = vec![124, 0x2_1007, 8, 8, 0, 0, levels];
        all.extend([0; 11]);
        all.extend([32, flags, code, bits]);
        all.extend(masks);
        all.extend([0x1000, 0, 0, 0, 0]);
        [b"DDS ".to_vec(), words(&all)].concat()
    };
    let mut blocks = header(4, u32::from_le_bytes(*b"DXT1"), 0, [0; 4], 2);
    blocks.extend((0..40).map(|i| i * 6));
    let mut plain = header(0x41, 0, 32, [0xff, 0xff00, 0xff_0000, 0xff00_0000], 1);
    plain.extend((0..=255).cycle().take(8 * 8 * 4));
    vec![blocks, plain]
}

/// KTX2 without supercompression, with zlib, and with Zstandard.
fn textures() -> Vec<Vec<u8>> {
    let texels: Vec<u8> = (0..=255).cycle().take(8 * 8 * 4).collect();
    let mut zlib = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::best());
    std::io::Write::write_all(&mut zlib, &texels).expect("memory");
    let zlib = zlib.finish().expect("memory");
    let zstandard =
        ruzstd::encoding::compress_to_vec(&texels[..], ruzstd::encoding::CompressionLevel::Fastest);
    let file = |format, scheme, texels: &[u8]| {
        let mut out = b"\xabKTX 20\xbb\r\n\x1a\n".to_vec();
        out.extend(words(&[
            format, 1, 8, 8, 0, 0, 1, 1, scheme, 104, 28, 132, 24,
        ]));
        out.extend([0; 16]);
        let len = texels.len() as u64;
        out.extend([156, len, len].into_iter().flat_map(u64::to_le_bytes));
        out.extend(words(&[28, 0, 24 << 16 | 2, 0x20101, 0, 0, 0]));
        out.extend(words(&[18]));
        out.extend(b"KTXorientation\0ru\0\0\0");
        out.extend(texels);
        out
    };
    vec![
        file(37, 0, &texels),
        file(37, 3, &zlib),
        file(37, 2, &zstandard),
        // ETC2, and ASTC of 8×8.
        file(147, 0, &texels[..32]),
        file(171, 0, &texels[..16]),
    ]
}

fn formats() -> Vec<Format> {
    let image = noise(13, 9);
    let lit: Vec<f32> = image
        .rgba
        .iter()
        .map(|&code| f32::from(code) / 64.0)
        .collect();
    let bright = HdrImage {
        width: 13,
        height: 9,
        rgb: lit[..13 * 9 * 3].to_vec(),
    };
    let channel = |name: &str| ExrChannel {
        name: name.to_owned(),
        samples: ExrSamples::Float(lit[..13 * 9].to_vec()),
    };
    let exr_channels = vec![channel("B"), channel("G"), channel("R")];
    let valid = "a valid image";
    let tga = |rle| {
        let options = tga::TgaOptions {
            rle,
            ..tga::TgaOptions::default()
        };
        tga::encode(&image, options).expect(valid)
    };
    let format = |name, files, read| Format { name, files, read };
    vec![
        format(
            "PNG",
            vec![
                encode_png(&image, AlphaChannel::Always).expect(valid),
                encode_png(&image, AlphaChannel::Never).expect(valid),
            ],
            READERS,
        ),
        format(
            "JPEG",
            vec![
                encode_jpeg(&image, jpeg::DEFAULT_QUALITY).expect(valid),
                encode_jpeg(&image, 20).expect(valid),
            ],
            READERS,
        ),
        format(
            "WebP",
            vec![encode_webp(&image, AlphaChannel::Always).expect(valid)],
            READERS,
        ),
        format("TGA", vec![tga(false), tga(true)], READERS),
        format("BMP", bitmaps(), READERS),
        format("DDS", surfaces(), READERS),
        format("KTX2", textures(), READERS),
        format("HDR", vec![encode_hdr(&bright).expect(valid)], &[hdr]),
        format(
            "EXR",
            vec![encode_exr((13, 9), exr_channels).expect(valid)],
            &[exr],
        ),
    ]
}

/// `bytes` with one to eight changes.
fn damaged(bytes: &[u8], random: &mut fastrand::Rng) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for _ in 0..=random.usize(..8) {
        if bytes.is_empty() {
            break;
        }
        let at = random.usize(..bytes.len());
        match random.u8(..8) {
            0 => bytes.truncate(at),
            1 => bytes.insert(at, random.u8(..)),
            2 => {
                let end = (at + 1 + random.usize(..16)).min(bytes.len());
                let piece = bytes[at..end].to_vec();
                bytes.splice(at..at, piece);
            }
            3 => bytes[at] = [0, 1, 0x7f, 0x80, 0xff][random.usize(..5)],
            4 => bytes[at] ^= 1 << random.u8(..8),
            // Sizes and types are near the start.
            5 => bytes[at % 100.min(at + 1)] = random.u8(..),
            _ => bytes[at] = random.u8(..),
        }
    }
    bytes
}

/// Reads a file by all readers of its format; returns true if it is an image.
fn check(format: &Format, bytes: &[u8], what: &str) -> bool {
    let limits = Limits {
        max_image_pixels: MOST_PIXELS,
        ..Limits::default()
    };
    let mut is_read = false;
    for read in format.read {
        let start = Instant::now();
        let result = read(bytes, &limits);
        let time = start.elapsed();
        assert!(time < LONGEST, "{what}: {time:?}");
        match result {
            Ok(pixels) => {
                assert!((1..=MOST_PIXELS).contains(&pixels), "{what}: {pixels}");
                is_read = true;
            }
            Err(AssetError::Malformed(fault)) => {
                assert!(fault.location.is_some(), "{what}: {fault:?}");
            }
            Err(AssetError::Unsupported(_) | AssetError::LimitExceeded(_)) => {}
            Err(other) => panic!("{what}: {other:?}"),
        }
    }
    is_read
}

/// Damages files of all formats `rounds` times each.
fn mutations(rounds: usize) {
    for format in &formats() {
        let mut random = fastrand::Rng::with_seed(0x1_3a6e);
        let mut read = 0;
        for round in 0..rounds {
            let bytes = damaged(&format.files[round % format.files.len()], &mut random);
            let what = format!("{}, round {round}", format.name);
            read += usize::from(check(format, &bytes, &what));
        }
        // Both happen, or the damage says nothing.
        assert!(
            (1..rounds).contains(&read),
            "{}: {read} of {rounds}",
            format.name
        );
    }
}

/// Rows: I5.
#[test]
fn every_prefix_of_every_format_is_an_image_or_an_error_with_its_place() {
    for format in &formats() {
        for (number, file) in format.files.iter().enumerate() {
            let what = format!("{} {number}", format.name);
            assert!(check(format, file, &what), "{what} is not read");
            for len in 0..file.len() {
                check(format, &file[..len], &format!("{what}, {len} bytes"));
            }
        }
    }
}

/// Rows: I5.
#[test]
fn damage_of_every_format_does_no_harm() {
    mutations(300);
}

/// The greatest memory that the process has had, on Linux.
fn peak_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kibibytes: u64 = line.split_ascii_whitespace().nth(1)?.parse().ok()?;
    Some(kibibytes * 1024)
}

#[test]
#[ignore = "takes minutes: cargo test --workspace --test readers -- --ignored much_damage"]
fn much_damage_does_no_harm_and_takes_no_memory() {
    mutations(10_000);
    if let Some(bytes) = peak_bytes() {
        // An image within the limit has 4 MiB, and decoders need a few copies.
        assert!(bytes < 256 << 20, "{bytes} bytes");
    }
}
