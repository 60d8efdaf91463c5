//! JPEG: read by `zune-jpeg`, written by `jpeg-encoder`.

use estampe_scene::{Image, Workers};
use jpeg_encoder::{ColorType, Encoder, SamplingFactor};
use zune_jpeg::JpegDecoder;
use zune_jpeg::errors::DecodeErrors;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use super::fault::{allocate_texels, check_size, check_texels, malformed, too_large, unsupported};
use super::png::rgb_from_rgba;
use super::reduce::{Reduced, Reduction, reduce_rows};
use crate::{AssetError, Limits};

/// The first bytes of every JPEG file (SOI).
pub(super) const START_OF_IMAGE: &[u8] = &[0xff, 0xd8];

/// The default quality, of 1 to 100.
pub const DEFAULT_QUALITY: u8 = 90;

/// The most pixels that a byte can encode: a block of 8×8 takes at least one bit for its mean in
/// the component with the most blocks, whose two sampling factors may each be half of the largest.
const MAX_PIXELS_PER_BYTE: u64 = 8 * 64 * 4;

/// Reads a JPEG: baseline and progressive, grey, YCbCr, RGB, CMYK and YCCK.
///
/// Colour profiles and camera orientation are not applied.
///
/// # Errors
/// See [`decode`](super::decode).
pub fn decode(bytes: &[u8], limits: &Limits) -> Result<Image, AssetError> {
    let Samples {
        size: (width, height),
        is_grey,
        samples,
    } = samples(bytes, limits)?;
    let mut rgba = allocate_texels(width as usize * height as usize)?;
    if is_grey {
        rgba.extend(samples.iter().flat_map(|&v| [v, v, v, 255]));
    } else {
        let (pixels, _) = samples.as_chunks();
        rgba.extend(pixels.iter().flat_map(|&[r, g, b]| [r, g, b, 255]));
    }
    Ok(Image {
        width,
        height,
        rgba,
    })
}

/// [`decode`] of a level of the image, which is made of the decoded rows by several threads.
///
/// A decoder that makes a smaller image of the frequencies was not chosen: its texels are others
/// than those of the mip level, so pictures would change.
pub(super) fn decode_reduced(
    bytes: &[u8],
    reduction: Reduction,
    limits: &Limits,
) -> Result<Reduced, AssetError> {
    let Samples {
        size,
        is_grey,
        samples,
    } = samples(bytes, limits)?;
    let channels = if is_grey { 1 } else { 3 };
    let row_len = size.0 as usize * channels;
    reduce_rows(size, reduction, Workers::new(limits.threads), |y, row| {
        let stored = &samples[y * row_len..(y + 1) * row_len];
        let word = u32::from_le_bytes;
        if is_grey {
            row.extend(stored.iter().map(|&v| word([v, v, v, 255])));
        } else {
            let pixels = stored.as_chunks().0.iter();
            row.extend(pixels.map(|&[r, g, b]| word([r, g, b, 255])));
        }
    })
}

/// The decoded samples: grey, or R, G, B.
struct Samples {
    size: (u32, u32),
    is_grey: bool,
    samples: Vec<u8>,
}

fn samples(bytes: &[u8], limits: &Limits) -> Result<Samples, AssetError> {
    let refuse = |error: DecodeErrors| match error {
        DecodeErrors::Unsupported(error) => unsupported(format!("this JPEG ({error:?})")),
        // The decoder reports no location, so the error names the end of the file.
        error => malformed(bytes.len(), format!("the JPEG is not valid: {error}")),
    };
    // The limits of `check_size` apply in place of the decoder's.
    let options = DecoderOptions::default()
        .set_strict_mode(false)
        .set_max_width(usize::MAX)
        .set_max_height(usize::MAX);
    let mut decoder = JpegDecoder::new_with_options(ZCursor::new(bytes), options);
    decoder.decode_headers().map_err(refuse)?;
    let stored = decoder.input_colorspace().unwrap_or(ColorSpace::Unknown);
    let read = match stored {
        ColorSpace::Luma => ColorSpace::Luma,
        // The decoder's RGBA is wrong for files of RGB and of four inks.
        _ => ColorSpace::RGB,
    };
    decoder.set_options(options.jpeg_set_out_colorspace(read));

    // Before any allocation, check the size in the header, and that the file is long enough for it.
    let (width, height) = decoder.dimensions().unwrap_or_default();
    let (width, height) = (side(width), side(height));
    check_size(width, height, limits)?;
    let pixels = u64::from(width) * u64::from(height);
    if pixels / MAX_PIXELS_PER_BYTE > bytes.len() as u64 {
        let what = format!(
            "a JPEG of {width} × {height} pixels cannot have {} bytes",
            bytes.len()
        );
        return Err(malformed(0, what));
    }

    let texels = width as usize * height as usize;
    let mut samples = allocate_texels(texels)?;
    samples.resize(texels * read.num_components(), 0);
    decoder.decode_into(&mut samples).map_err(refuse)?;
    Ok(Samples {
        size: (width, height),
        is_grey: read == ColorSpace::Luma,
        samples,
    })
}

/// Width and height from the frame header.
pub(super) fn stated_size(bytes: &[u8]) -> Option<(u32, u32)> {
    let mut decoder = JpegDecoder::new(ZCursor::new(bytes));
    decoder.decode_headers().ok()?;
    let (width, height) = decoder.dimensions()?;
    Some((side(width), side(height)))
}

/// Writes a baseline JPEG of `quality` 1 to 100. Every pixel is treated as opaque: composite over a
/// background first.
///
/// # Errors
/// `LimitExceeded` for sides over 65535, `Malformed` if the image has no pixels or its bytes do not
/// fit its size.
pub fn encode_jpeg(image: &Image, quality: u8) -> Result<Vec<u8>, AssetError> {
    check_texels(image)?;
    let sides =
        u16::try_from(image.width).and_then(|width| Ok((width, u16::try_from(image.height)?)));
    let Ok((width, height)) = sides else {
        return Err(too_large(image, "JPEG", u32::from(u16::MAX)));
    };
    let rgb = rgb_from_rgba(&image.rgba);
    let mut out = Vec::with_capacity(rgb.len() / 8 + 1024);
    let mut encoder = Encoder::new(&mut out, quality.clamp(1, 100));
    encoder.set_sampling_factor(SamplingFactor::F_1_1);
    encoder
        .encode(&rgb, width, height, ColorType::Rgb)
        .map_err(|error| {
            AssetError::limit_exceeded(
                format!("{image:?} cannot be written as JPEG: {error}"),
                "write a PNG",
            )
        })?;
    Ok(out)
}

/// A side of a picture. JPEG stores sides in 16 bits.
fn side(pixels: usize) -> u32 {
    u32::try_from(pixels).unwrap_or(u32::MAX)
}

#[cfg(test)]
#[expect(
    clippy::cast_possible_truncation,
    reason = "fixtures cut numbers to size"
)]
mod tests;
