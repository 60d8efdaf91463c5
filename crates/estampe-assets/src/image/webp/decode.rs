//! The WebP reader.

use std::io::Cursor;

use estampe_scene::Image;
use image_webp::{DecodingError, WebPDecoder};

use crate::image::fault::{allocate_texels, check_size, malformed, unsupported};
use crate::{AssetError, Limits};

/// The longest side of a frame. A canvas for several frames may be larger, but no image needs it.
const MAX_SIDE: u32 = 16_384;

/// True for the signature of WebP.
pub(in crate::image) fn is_webp(bytes: &[u8]) -> bool {
    bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WEBP")
}

/// Reads a WebP: lossy or lossless, with alpha; the first frame of an animation on its canvas.
///
/// Colour profiles are not applied.
///
/// # Errors
/// See [`decode`](crate::image::decode).
pub(in crate::image) fn decode(bytes: &[u8], limits: &Limits) -> Result<Image, AssetError> {
    let refuse = |error: DecodingError| match error {
        DecodingError::UnsupportedFeature(what) => unsupported(format!("WebP with {what}")),
        // The decoder reports no location, so the error names the end of the file.
        error => malformed(bytes.len(), format!("the WebP is not valid: {error}")),
    };
    let mut decoder = WebPDecoder::new(Cursor::new(bytes)).map_err(refuse)?;
    let (width, height) = decoder.dimensions();
    check_size(width, height, limits)?;
    if width.max(height) > MAX_SIDE {
        return Err(unsupported(format!(
            "a WebP canvas of {width} × {height} pixels"
        )));
    }
    // The decoder makes room for a frame by the frame's own header, before it compares the frame
    // with the canvas.
    for frame in frame_sizes(bytes) {
        if frame.0 > width || frame.1 > height {
            let what = format!(
                "a WebP frame of {} × {} pixels on a canvas of {width} × {height}",
                frame.0, frame.1
            );
            return Err(malformed(0, what));
        }
    }

    let texels = width as usize * height as usize;
    let channels = if decoder.has_alpha() { 4 } else { 3 };
    let mut samples = allocate_texels(texels)?;
    samples.resize(texels * channels, 0);
    decoder.read_image(&mut samples).map_err(refuse)?;
    if channels == 3 {
        let mut rgba = allocate_texels(texels)?;
        let (pixels, _) = samples.as_chunks();
        rgba.extend(pixels.iter().flat_map(|&[r, g, b]| [r, g, b, 255]));
        samples = rgba;
    }
    Ok(Image {
        width,
        height,
        rgba: samples,
    })
}

/// Width and height of the canvas.
pub(in crate::image) fn stated_size(bytes: &[u8]) -> Option<(u32, u32)> {
    let decoder = WebPDecoder::new(Cursor::new(bytes)).ok()?;
    Some(decoder.dimensions())
}

/// The sizes of all frames, from the headers of their coded images.
fn frame_sizes(bytes: &[u8]) -> impl Iterator<Item = (u32, u32)> {
    let outer = chunks(bytes, 12, bytes.len());
    outer.flat_map(|chunk| {
        // A frame of an animation: 16 bytes about it, and then chunks.
        let inner_end = match &chunk.name {
            b"ANMF" => chunk.end,
            _ => chunk.start,
        };
        let inner = chunks(bytes, chunk.start + 16, inner_end);
        std::iter::once(chunk)
            .chain(inner)
            .filter_map(|chunk| chunk.frame_size(bytes))
    })
}

/// A chunk's name, and the range of its bytes, which may lead out of the file.
struct Chunk {
    name: [u8; 4],
    start: usize,
    end: usize,
}

/// The chunks whose headers are before `end`. A header is a name and a length; the bytes that
/// follow are filled up to a multiple of two.
fn chunks(bytes: &[u8], mut at: usize, end: usize) -> impl Iterator<Item = Chunk> {
    std::iter::from_fn(move || {
        if at >= end {
            return None;
        }
        let &[n0, n1, n2, n3, l0, l1, l2, l3] = bytes.get(at..)?.first_chunk()?;
        let len = u32::from_le_bytes([l0, l1, l2, l3]) as usize;
        let start = at + 8;
        at = start.saturating_add(len).saturating_add(len % 2);
        Some(Chunk {
            name: [n0, n1, n2, n3],
            start,
            end: start.saturating_add(len),
        })
    })
}

impl Chunk {
    /// The size of a frame that is coded in this chunk.
    fn frame_size(&self, bytes: &[u8]) -> Option<(u32, u32)> {
        let body = bytes.get(self.start..)?;
        match &self.name {
            b"VP8 " => lossy_size(body),
            b"VP8L" => lossless_size(body),
            _ => None,
        }
    }
}

/// The size in a VP8 key frame (RFC 6386, section 9.1): 14 bits each after ten bytes.
fn lossy_size(body: &[u8]) -> Option<(u32, u32)> {
    let &[w0, w1, h0, h1] = body.get(6..)?.first_chunk()?;
    let side = |low, high| u32::from(u16::from_le_bytes([low, high]) & 0x3fff);
    Some((side(w0, w1), side(h0, h1)))
}

/// The size in a VP8L header: a signature, then 14 bits each, less 1.
fn lossless_size(body: &[u8]) -> Option<(u32, u32)> {
    let &[b0, b1, b2, b3] = body.get(1..)?.first_chunk()?;
    let bits = u32::from_le_bytes([b0, b1, b2, b3]);
    Some(((bits & 0x3fff) + 1, (bits >> 14 & 0x3fff) + 1))
}
