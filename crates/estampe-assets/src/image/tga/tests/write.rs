//! Written files conform to the TGA specification and are read back unchanged.

use estampe_scene::Image;

use crate::Limits;
use crate::image::samples::{Random, disc, noise, opaque};
use crate::image::tga::{TgaOptions, decode, encode};
use crate::image::{AlphaChannel, ImageFormat};

fn written(image: &Image, options: TgaOptions) -> Vec<u8> {
    encode(image, options).expect("a valid image")
}

fn read_back(bytes: &[u8]) -> Image {
    decode(bytes, &Limits::default()).expect("our own file")
}

/// Rows: I1.
#[test]
fn a_small_file_byte_for_byte() {
    let image = Image {
        width: 3,
        height: 2,
        rgba: [[1, 2, 3, 255], [1, 2, 3, 255], [4, 5, 6, 255]]
            .into_iter()
            .chain([[7, 8, 9, 255], [1, 1, 1, 255], [2, 2, 2, 255]])
            .flatten()
            .collect(),
    };
    let head = |kind| [0, 0, kind, 0, 0, 0, 0, 0, 0, 0, 0, 0, 3, 0, 2, 0, 24, 0x20];
    let foot = b"\0\0\0\0\0\0\0\0TRUEVISION-XFILE.\0";

    let packets = [
        0x81, 3, 2, 1, 0x00, 6, 5, 4, 0x02, 9, 8, 7, 1, 1, 1, 2, 2, 2,
    ];
    let expected = [&head(10)[..], &packets, foot].concat();
    assert_eq!(written(&image, TgaOptions::default()), expected);

    let raw = [3, 2, 1, 3, 2, 1, 6, 5, 4, 9, 8, 7, 1, 1, 1, 2, 2, 2];
    let expected = [&head(2)[..], &raw, foot].concat();
    assert_eq!(
        written(
            &image,
            TgaOptions {
                rle: false,
                ..TgaOptions::default()
            }
        ),
        expected
    );
}

/// Rows: I1.
#[test]
fn alpha_is_written_when_needed_or_asked() {
    let clear = noise(4, 4, 3);
    let solid = opaque(clear.clone());
    for (image, alpha, depth, descriptor) in [
        (&solid, AlphaChannel::WhenNeeded, 24, 0x20),
        (&solid, AlphaChannel::Always, 32, 0x28),
        (&clear, AlphaChannel::WhenNeeded, 32, 0x28),
        (&clear, AlphaChannel::Never, 24, 0x20),
    ] {
        let bytes = written(
            image,
            TgaOptions {
                alpha,
                ..TgaOptions::default()
            },
        );
        assert_eq!((bytes[16], bytes[17]), (depth, descriptor), "{alpha:?}");
        let kept = if alpha == AlphaChannel::Never {
            &solid
        } else {
            image
        };
        assert_eq!(read_back(&bytes), *kept);
    }
}

/// Rows: I1.
#[test]
fn pictures_of_all_sizes_read_back() {
    let mut random = Random::new(11);
    let sizes = (1..12).chain([126, 127, 128, 129, 130, 255, 256, 257, 300]);
    for width in sizes {
        let height = 1 + random.below(5) as u32;
        let image = noise(width, height, random.next());
        for rle in [true, false] {
            for alpha in [AlphaChannel::WhenNeeded, AlphaChannel::Always] {
                let bytes = written(&image, TgaOptions { rle, alpha });
                assert_eq!(read_back(&bytes), image, "{width}×{height} {rle} {alpha:?}");
            }
        }
    }
}

#[test]
fn packets_end_with_their_row_and_never_grow_a_row_by_much() {
    let mut random = Random::new(5);
    for width in [1, 2, 127, 128, 129, 256, 391] {
        let image = opaque(noise(width, 3, random.next()));
        let bytes = written(&image, TgaOptions::default());
        let mut at = 18;
        for _ in 0..3 {
            let (start, mut columns) = (at, 0);
            while columns < width {
                let count = u32::from(bytes[at] & 0x7f) + 1;
                at += 1 + 3 * if bytes[at] & 0x80 == 0 {
                    count as usize
                } else {
                    1
                };
                columns += count;
            }
            assert_eq!(columns, width, "a packet crosses its row");
            let most = 3 * width as usize + (width as usize).div_ceil(128);
            assert!(
                at - start <= most,
                "{} bytes for {width} texels",
                at - start
            );
        }
        assert_eq!(at + 26, bytes.len());
    }
}

#[test]
fn plain_grounds_shrink() {
    let image = disc(256, 256);
    let bytes = crate::image::encode(&image, ImageFormat::Tga).expect("a valid image");
    assert!(bytes.len() < 256 * 256 * 3 * 3 / 4, "{} bytes", bytes.len());
    let plain = Image::filled(256, 256, [1, 2, 3, 255]);
    assert_eq!(
        written(&plain, TgaOptions::default()).len(),
        18 + 256 * 2 * 4 + 26
    );
}
