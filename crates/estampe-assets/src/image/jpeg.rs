//! JPEG, read and written through the `image` crate.

use std::io::Cursor;

use estampe_scene::Image;
use image::codecs::jpeg::{JpegDecoder, JpegEncoder};
use image::{ColorType, ExtendedColorType, ImageDecoder, ImageError};

use super::fault::{allocate_texels, check_size, check_texels, malformed, too_large, unsupported};
use super::png::rgb_from_rgba;
use crate::{AssetError, Limits};

/// The first bytes of every JPEG file (SOI).
pub(super) const START_OF_IMAGE: &[u8] = &[0xff, 0xd8];

/// The quality that pictures are written at where nobody chooses, of 1 to 100.
pub const DEFAULT_QUALITY: u8 = 90;

/// The most pixels that a byte can stand for: a block of 8×8 takes at least one bit for its mean in
/// the component with the most blocks, whose two sampling factors may each miss the largest by 2.
const MAX_PIXELS_PER_BYTE: u64 = 8 * 64 * 4;

/// Reads a JPEG: baseline and progressive, grey, YCbCr, RGB, CMYK and YCCK.
///
/// Profiles and the orientation of cameras are not applied.
///
/// # Errors
/// See [`decode`](super::decode).
pub fn decode(bytes: &[u8], limits: &Limits) -> Result<Image, AssetError> {
    let refuse = |error: ImageError| match error {
        ImageError::Unsupported(error) => unsupported(format!("this JPEG ({error})")),
        ImageError::Limits(error) => AssetError::limit_exceeded(
            format!("the JPEG is too large: {error}"),
            "make the picture smaller",
        ),
        // The decoder gives no place: say how far the file reaches.
        error => malformed(bytes.len(), format!("the JPEG is not valid: {error}")),
    };
    let decoder = JpegDecoder::new(Cursor::new(bytes)).map_err(refuse)?;

    // Check the announced size, and that so few bytes can hold it, before anything is allocated.
    let (width, height) = decoder.dimensions();
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
    let color = decoder.color_type();
    let mut samples = allocate_texels(texels)?;
    samples.resize(texels * usize::from(color.bytes_per_pixel()), 0);
    decoder.read_image(&mut samples).map_err(refuse)?;
    let mut rgba = allocate_texels(texels)?;
    match color {
        ColorType::L8 => rgba.extend(samples.iter().flat_map(|&v| [v, v, v, 255])),
        ColorType::Rgb8 => {
            rgba.extend(
                samples
                    .as_chunks()
                    .0
                    .iter()
                    .flat_map(|&[r, g, b]| [r, g, b, 255]),
            );
        }
        other => return Err(unsupported(format!("a JPEG of {other:?} pixels"))),
    }
    Ok(Image {
        width,
        height,
        rgba,
    })
}

/// Writes a baseline JPEG of `quality` 1 to 100. Every pixel is taken as opaque: composite over a
/// background first.
///
/// # Errors
/// `LimitExceeded` for sides over 65535, `Malformed` when the image has no pixels or its bytes are
/// not its size's.
pub fn encode_jpeg(image: &Image, quality: u8) -> Result<Vec<u8>, AssetError> {
    check_texels(image)?;
    if image.width.max(image.height) > u32::from(u16::MAX) {
        return Err(too_large(image, "JPEG", u32::from(u16::MAX)));
    }
    let rgb = rgb_from_rgba(&image.rgba);
    let mut out = Vec::with_capacity(rgb.len() / 8 + 1024);
    JpegEncoder::new_with_quality(&mut out, quality.clamp(1, 100))
        .encode(&rgb, image.width, image.height, ExtendedColorType::Rgb8)
        .map_err(|error| {
            AssetError::limit_exceeded(
                format!("{image:?} cannot be written as JPEG: {error}"),
                "write a PNG",
            )
        })?;
    Ok(out)
}

#[cfg(test)]
#[expect(
    clippy::cast_possible_truncation,
    reason = "fixtures cut numbers to size"
)]
mod tests;
