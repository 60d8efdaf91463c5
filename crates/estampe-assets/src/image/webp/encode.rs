//! Writing WebP: VP8L, the lossless bitstream.

use estampe_scene::Image;
use image_webp::{ColorType, EncodingError, WebPEncoder};

use crate::AssetError;
use crate::image::AlphaChannel;
use crate::image::fault::{check_texels, too_large};
use crate::image::png::rgb_from_rgba;

/// The longest side, which VP8L stores in 14 bits.
const MAX_SIDE: u32 = 1 << 14;

/// Writes a lossless WebP of RGB or RGBA with constant settings: the predictor transform, and runs
/// without a search for matches.
///
/// # Errors
/// `Malformed` if the image has no pixels or its bytes do not fit its size; `LimitExceeded` if a
/// side is over 16384.
pub fn encode_webp(image: &Image, alpha: AlphaChannel) -> Result<Vec<u8>, AssetError> {
    check_texels(image)?;
    // The encoder panics where sides do not fit.
    if image.width.max(image.height) > MAX_SIDE {
        return Err(too_large(image, "WebP", MAX_SIDE));
    }
    let opaque: Vec<u8>;
    let (color, samples) = if alpha.is_written_for(image) {
        (ColorType::Rgba8, &image.rgba)
    } else {
        opaque = rgb_from_rgba(&image.rgba);
        (ColorType::Rgb8, &opaque)
    };
    let mut out = Vec::with_capacity(samples.len() / 4 + 1024);
    let encoder = WebPEncoder::new(&mut out);
    match encoder.encode(samples, image.width, image.height, color) {
        Ok(()) => Ok(out),
        Err(EncodingError::InvalidDimensions) => Err(too_large(image, "WebP", MAX_SIDE)),
        Err(error) => Err(AssetError::limit_exceeded(
            format!("{image:?} cannot be written as WebP: {error}"),
            "write a PNG",
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::samples::{disc, noise, opaque};
    use image_webp::WebPDecoder;
    use std::io::Cursor;

    /// The picture of a file, and whether the file has alpha.
    fn read(bytes: &[u8]) -> (Image, bool) {
        let mut decoder = WebPDecoder::new(Cursor::new(bytes)).expect("a WebP");
        assert!(!decoder.is_lossy());
        let (width, height) = decoder.dimensions();
        let mut samples = vec![0; decoder.output_buffer_size().expect("small")];
        decoder.read_image(&mut samples).expect("a whole WebP");
        let rgba = if decoder.has_alpha() {
            samples
        } else {
            let texels = samples.as_chunks::<3>().0.iter();
            texels.flat_map(|&[r, g, b]| [r, g, b, 255]).collect()
        };
        let image = Image {
            width,
            height,
            rgba,
        };
        (image, decoder.has_alpha())
    }

    #[test]
    fn pictures_of_all_sizes_read_back() {
        for (width, height) in [(1, 1), (2, 1), (1, 7), (17, 5), (64, 64), (257, 3)] {
            for image in [
                noise(width, height, 3),
                opaque(noise(width, height, 9)),
                disc(width, height),
                Image::filled(width, height, [7, 0, 255, 255]),
            ] {
                let bytes = encode_webp(&image, AlphaChannel::WhenNeeded).expect("valid");
                assert_eq!(read(&bytes).0, image, "{width}x{height}");
            }
        }
    }

    #[test]
    fn alpha_is_written_when_needed_or_asked() {
        let translucent = Image::filled(3, 2, [1, 2, 3, 4]);
        let solid = Image::filled(3, 2, [1, 2, 3, 255]);
        for (image, rule, has_alpha) in [
            (&translucent, AlphaChannel::WhenNeeded, true),
            (&solid, AlphaChannel::WhenNeeded, false),
            (&solid, AlphaChannel::Always, true),
            (&translucent, AlphaChannel::Never, false),
        ] {
            let bytes = encode_webp(image, rule).expect("valid");
            let (read, has) = read(&bytes);
            assert_eq!(has, has_alpha, "{rule:?}");
            assert_eq!(read.texel(2, 1)[..3], [1, 2, 3], "{rule:?}");
        }
    }

    #[test]
    fn the_bytes_are_the_same_everywhere() {
        let bytes = encode_webp(
            &Image::filled(2, 1, [9, 8, 7, 255]),
            AlphaChannel::WhenNeeded,
        );
        let bytes = bytes.expect("valid");
        assert_eq!(&bytes[..4], b"RIFF");
        let size = u32::try_from(bytes.len() - 8).expect("small");
        assert_eq!(bytes[4..8], size.to_le_bytes());
        assert_eq!(&bytes[8..16], b"WEBPVP8L");
        // The signature, then width − 1 and height − 1 in 14 bits each, no alpha, version 0.
        assert_eq!(bytes[20..25], [0x2f, 1, 0, 0, 0]);
        let image = noise(61, 47, 5);
        let bytes = encode_webp(&image, AlphaChannel::WhenNeeded).expect("valid");
        // FNV-1a.
        let digest = bytes
            .iter()
            .fold(0xcbf2_9ce4_8422_2325, |digest: u64, &byte| {
                (digest ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3)
            });
        assert_eq!((bytes.len(), digest), (11_060, 17_455_236_764_884_904_858));
    }

    #[test]
    fn drawn_pictures_are_smaller_than_their_texels() {
        let image = disc(640, 480);
        let bytes = encode_webp(&image, AlphaChannel::WhenNeeded).expect("valid");
        assert!(bytes.len() < image.rgba.len() / 4, "{} bytes", bytes.len());
    }
}
