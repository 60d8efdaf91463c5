//! PNG, read and written through the `png` crate.

use std::io::Cursor;

use estampe_scene::{Image, Workers};
use png::{BitDepth, ColorType, DecodingError, Transformations};

use super::AlphaChannel;
use super::fault::{allocate_texels, check_size, check_texels, malformed, unsupported};
use super::reduce::{Reduced, Reducer, Reduction, RowOrder, reduce};
use crate::{AssetError, Limits};

/// The first bytes of every PNG file.
pub(super) const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";

/// Deflate expands one byte into at most this many (258 bytes per pair of 1-bit codes; RFC 1951).
const MAX_DEFLATE_RATIO: u64 = 1032;

/// Reads a PNG of any colour type, depth and interlacing; of an animation, the default image.
///
/// 16-bit values are rounded to 8 bits; gamma and colour profiles are not applied: values are sRGB.
///
/// # Errors
/// See [`decode`](super::decode).
pub fn decode(bytes: &[u8], limits: &Limits) -> Result<Image, AssetError> {
    located(bytes, |cursor| read(cursor, bytes.len(), limits))
}

/// [`decode`] of a level of the image, row by row unless the PNG is interlaced.
pub(super) fn decode_reduced(
    bytes: &[u8],
    reduction: Reduction,
    limits: &Limits,
) -> Result<Reduced, AssetError> {
    let reduced = located(bytes, |cursor| {
        read_reduced(cursor, bytes.len(), reduction, limits)
    })?;
    match reduced {
        Some(reduced) => Ok(reduced),
        None => reduce(
            &decode(bytes, limits)?,
            reduction,
            Workers::new(limits.threads),
        ),
    }
}

/// Gives the decoder's errors the place that it has reached.
fn located<T>(
    bytes: &[u8],
    read: impl FnOnce(&mut Cursor<&[u8]>) -> Result<T, Refusal>,
) -> Result<T, AssetError> {
    let mut cursor = Cursor::new(bytes);
    read(&mut cursor).map_err(|fault| match fault {
        Refusal::Ours(error) => error,
        Refusal::Decoder(DecodingError::LimitsExceeded) => AssetError::limit_exceeded(
            "the PNG's side data needs more memory than its pixels",
            "remove its metadata",
        ),
        Refusal::Decoder(error) => {
            let offset = usize::try_from(cursor.position()).unwrap_or(bytes.len());
            malformed(
                offset.min(bytes.len()),
                format!("the PNG is not valid: {error}"),
            )
        }
    })
}

/// Width and height from the header.
pub(super) fn stated_size(bytes: &[u8]) -> Option<(u32, u32)> {
    // The signature, then IHDR's length and name, then the two numbers.
    let side = |at: usize| Some(u32::from_be_bytes(*bytes.get(at..)?.first_chunk()?));
    Some((side(16)?, side(20)?))
}

/// The reason why a PNG was refused: an error of the decoder, still without location, or ours.
enum Refusal {
    Decoder(DecodingError),
    Ours(AssetError),
}

impl From<DecodingError> for Refusal {
    fn from(error: DecodingError) -> Self {
        Self::Decoder(error)
    }
}

impl From<AssetError> for Refusal {
    fn from(error: AssetError) -> Self {
        Self::Ours(error)
    }
}

/// A decoder whose header and length were checked.
fn open<'c, 'b>(
    cursor: &'c mut Cursor<&'b [u8]>,
    len: usize,
    limits: &Limits,
) -> Result<png::Reader<&'c mut Cursor<&'b [u8]>>, Refusal> {
    let mut decoder = png::Decoder::new(cursor);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    decoder.set_transformations(Transformations::EXPAND);

    // Before any allocation, check the size in the header, and that the file is long enough for it.
    let header = decoder.read_header_info()?;
    let (width, height) = (header.width, header.height);
    check_size(width, height, limits)?;
    let row_bits =
        u64::from(width) * (header.color_type.samples() * header.bit_depth as usize) as u64;
    let stored_len = row_bits.div_ceil(8).saturating_mul(u64::from(height));
    if stored_len / MAX_DEFLATE_RATIO > len as u64 {
        let what = format!("a PNG of {width} × {height} pixels cannot have {len} bytes");
        return Err(malformed(16, what).into());
    }
    Ok(decoder.read_info()?)
}

fn read(cursor: &mut Cursor<&[u8]>, len: usize, limits: &Limits) -> Result<Image, Refusal> {
    let mut reader = open(cursor, len, limits)?;
    let (width, height) = reader.info().size();
    let (color, depth) = reader.output_color_type();
    let Some(buffer_len) = reader.output_buffer_size() else {
        return Err(unsupported(format!("a PNG of {width} × {height} pixels")).into());
    };
    let mut rgba = allocate_texels(width as usize * height as usize)?;
    if reader.info().interlaced || (color, depth) == (ColorType::Rgba, BitDepth::Eight) {
        let mut samples = allocate_texels(buffer_len.div_ceil(4))?;
        samples.resize(buffer_len, 0);
        reader.next_frame(&mut samples)?;
        if (color, depth) == (ColorType::Rgba, BitDepth::Eight) {
            rgba = samples;
        } else {
            rgba_from_samples(&mut samples, (color, depth), &mut rgba)?;
        }
    } else {
        // Row by row, the samples stay in the cache.
        let mut samples = Vec::new();
        while let Some(row) = reader.next_row()? {
            samples.clear();
            samples.extend_from_slice(row.data());
            rgba_from_samples(&mut samples, (color, depth), &mut rgba)?;
        }
    }
    Ok(Image {
        width,
        height,
        rgba,
    })
}

/// A level of the image; `None` if its rows do not come in order.
fn read_reduced(
    cursor: &mut Cursor<&[u8]>,
    len: usize,
    reduction: Reduction,
    limits: &Limits,
) -> Result<Option<Reduced>, Refusal> {
    let mut reader = open(cursor, len, limits)?;
    if reader.info().interlaced {
        return Ok(None);
    }
    let (width, height) = reader.info().size();
    let (color, depth) = reader.output_color_type();
    let mut reducer = Reducer::new((width, height), reduction, RowOrder::TopDown)?;
    let mut texels = Vec::with_capacity(width as usize);
    let (mut samples, mut rgba) = (Vec::new(), Vec::new());
    while let Some(row) = reader.next_row()? {
        samples.clear();
        samples.extend_from_slice(row.data());
        rgba.clear();
        rgba_from_samples(&mut samples, (color, depth), &mut rgba)?;
        texels.clear();
        let words = rgba.as_chunks().0.iter();
        texels.extend(words.map(|&rgba| u32::from_le_bytes(rgba)));
        reducer.push(&texels);
    }
    Ok(Some(reducer.finish()))
}

/// Appends samples as four channels of 8 bits.
fn rgba_from_samples(
    samples: &mut Vec<u8>,
    (color, depth): (ColorType, BitDepth),
    rgba: &mut Vec<u8>,
) -> Result<(), AssetError> {
    if depth == BitDepth::Sixteen {
        let len = samples.len() / 2;
        for at in 0..len {
            samples[at] = unorm8_from_unorm16([samples[2 * at], samples[2 * at + 1]]);
        }
        samples.truncate(len);
    }
    match color {
        ColorType::Rgba => rgba.extend_from_slice(samples),
        ColorType::Rgb => {
            let (rgb, _) = samples.as_chunks::<3>();
            let start = rgba.len();
            rgba.resize(start + rgb.len() * 4, 255);
            let (texels, _) = rgba[start..].as_chunks_mut::<4>();
            for (texel, &[r, g, b]) in texels.iter_mut().zip(rgb) {
                *texel = [r, g, b, 255];
            }
        }
        ColorType::GrayscaleAlpha => {
            let grey = samples.as_chunks().0.iter();
            rgba.extend(grey.flat_map(|&[v, a]| [v, v, v, a]));
        }
        ColorType::Grayscale => rgba.extend(samples.iter().flat_map(|&v| [v, v, v, 255])),
        ColorType::Indexed => {
            return Err(unsupported(
                "a PNG whose palette the decoder leaves in place",
            ));
        }
    }
    Ok(())
}

/// A big-endian 16-bit value as 8 bits: round(v · 255 / 65535), that is v / 257.
#[expect(clippy::cast_possible_truncation, reason = "(65535 + 128) / 257 = 255")]
fn unorm8_from_unorm16(value: [u8; 2]) -> u8 {
    ((u32::from(u16::from_be_bytes(value)) + 128) / 257) as u8
}

/// Writes a PNG of 8-bit RGB or RGBA with constant settings: the `png` crate's own deflate
/// (fdeflate), and an adaptive filter per row.
///
/// Measured on a shaded, faceted sphere of 1280×720: 2.9 ms and 298 KB; always "up" 2.0 ms and 362
/// KB; deflate level 2 11 ms and 230 KB; the default level 56 ms and 211 KB.
///
/// # Errors
/// `Malformed` if the image has no pixels or its bytes do not fit its size; `LimitExceeded` if a
/// side is over 2^31 − 1.
pub fn encode_png(image: &Image, alpha: AlphaChannel) -> Result<Vec<u8>, AssetError> {
    encode_with(image, alpha, png::Compression::Fast, png::Filter::Adaptive)
}

/// Writes a PNG of a drawing: few colours, lines and texts. No filter helps those, and a search for
/// long matches makes the file several times smaller than that of [`encode_png`]. Opaque drawings
/// are stored without alpha.
///
/// # Errors
/// As of [`encode_png`].
pub fn encode_drawing_png(image: &Image) -> Result<Vec<u8>, AssetError> {
    let (compression, filter) = (png::Compression::Balanced, png::Filter::NoFilter);
    encode_with(image, AlphaChannel::WhenNeeded, compression, filter)
}

fn encode_with(
    image: &Image,
    alpha: AlphaChannel,
    compression: png::Compression,
    filter: png::Filter,
) -> Result<Vec<u8>, AssetError> {
    check_texels(image)?;
    let opaque: Vec<u8>;
    let (color, samples) = if alpha.is_written_for(image) {
        (ColorType::Rgba, &image.rgba)
    } else {
        opaque = rgb_from_rgba(&image.rgba);
        (ColorType::Rgb, &opaque)
    };
    let mut out = Vec::with_capacity(samples.len() / 4 + 1024);
    let mut encoder = png::Encoder::new(&mut out, image.width, image.height);
    encoder.set_color(color);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(compression);
    encoder.set_filter(filter);
    let written = encoder.write_header().and_then(|mut writer| {
        writer.write_image_data(samples)?;
        writer.finish()
    });
    match written {
        Ok(()) => Ok(out),
        Err(error) => Err(AssetError::limit_exceeded(
            format!("{image:?} cannot be written as PNG: {error}"),
            "write a smaller image",
        )),
    }
}

/// Writes a PNG of 16 bits: grey for one code a pixel, RGB for three.
///
/// # Errors
/// `Malformed` if there are no pixels, or another number of codes.
pub fn encode_png_16((width, height): (u32, u32), codes: &[u16]) -> Result<Vec<u8>, AssetError> {
    let pixels = u64::from(width) * u64::from(height);
    let color = match codes.len() as u64 {
        count if count == pixels && pixels > 0 => ColorType::Grayscale,
        count if count == pixels.saturating_mul(3) && pixels > 0 => ColorType::Rgb,
        count => {
            return Err(AssetError::malformed(
                format!("{count} codes for an image of {width}x{height} pixels"),
                "give one or three to every pixel",
            ));
        }
    };
    let samples: Vec<u8> = codes.iter().flat_map(|code| code.to_be_bytes()).collect();
    let mut out = Vec::with_capacity(samples.len() / 4 + 1024);
    let mut encoder = png::Encoder::new(&mut out, width, height);
    encoder.set_color(color);
    encoder.set_depth(BitDepth::Sixteen);
    encoder.set_compression(png::Compression::Fast);
    encoder.set_filter(png::Filter::Adaptive);
    let written = encoder.write_header().and_then(|mut writer| {
        writer.write_image_data(&samples)?;
        writer.finish()
    });
    match written {
        Ok(()) => Ok(out),
        Err(error) => Err(AssetError::limit_exceeded(
            format!("{width}x{height} pixels cannot be written as PNG: {error}"),
            "write a smaller image",
        )),
    }
}

/// The colours without alpha.
pub(super) fn rgb_from_rgba(rgba: &[u8]) -> Vec<u8> {
    let mut rgb = vec![0; rgba.len() / 4 * 3];
    for (to, from) in rgb
        .as_chunks_mut::<3>()
        .0
        .iter_mut()
        .zip(rgba.as_chunks::<4>().0)
    {
        *to = [from[0], from[1], from[2]];
    }
    rgb
}

#[cfg(test)]
#[expect(
    clippy::cast_possible_truncation,
    reason = "fixtures cut numbers to size"
)]
mod tests;
