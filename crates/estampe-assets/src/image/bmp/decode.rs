//! The BMP reader.

use estampe_scene::Image;

use super::header::{Fields, Header, Texels};
use super::runs;
use crate::image::channel::Channel;
use crate::image::fault::{allocate_texels, check_size, malformed};
use crate::image::transform::flip_vertical;
use crate::{AssetError, Limits};

/// Reads a bitmap of 1, 4, 8, 16, 24 or 32 bits per texel, with bit masks, or run-length encoded.
///
/// # Errors
/// `Malformed` with a byte offset if the file is truncated, contradicts itself or uses a colour
/// that its palette lacks; `Unsupported` for other kinds (JPEG and PNG in a BMP, fax codes);
/// `LimitExceeded` before any texel is stored.
pub(in crate::image) fn decode(bytes: &[u8], limits: &Limits) -> Result<Image, AssetError> {
    let fields = Fields::parse(bytes)?;
    let (width, height) = fields.size()?;
    check_size(width, height, limits)?;
    let header = fields.header(bytes)?;
    let rgba = match &header.texels {
        Texels::Mapped { bits, palette } => rows(bytes, &header, usize::from(*bits), |row, out| {
            mapped_row(row, *bits, palette, out)
        }),
        Texels::Words {
            len_bytes,
            channels,
        } => rows(bytes, &header, len_bytes * 8, |(_, row), out| {
            words_row(row, *len_bytes, channels, out);
            Ok(())
        }),
        Texels::Runs { bits, palette } => runs::decode(bytes, &header, *bits, palette),
    }?;
    let image = Image {
        width,
        height,
        rgba,
    };
    Ok(match header.is_top_down {
        true => image,
        false => flip_vertical(&image),
    })
}

/// Width and height from the header.
pub(in crate::image) fn stated_size(bytes: &[u8]) -> Option<(u32, u32)> {
    Fields::parse(bytes).and_then(|fields| fields.size()).ok()
}

/// The RGBA of all rows in the order of the file. `read_row` takes a row and its offset.
fn rows(
    bytes: &[u8],
    header: &Header,
    bits: usize,
    read_row: impl Fn((usize, &[u8]), &mut [[u8; 4]]) -> Result<(), AssetError>,
) -> Result<Vec<u8>, AssetError> {
    let (width, height) = (header.width as usize, header.height as usize);
    let row_len = (width * bits).div_ceil(32) * 4;
    // The padding of the last row may be missing.
    let last_len = (width * bits).div_ceil(8);
    let needed = row_len.saturating_mul(height - 1).saturating_add(last_len);
    let stored = bytes.get(header.texels_start..).unwrap_or_default();
    if stored.len() < needed {
        let what = format!(
            "the BMP needs {needed} bytes for {width} × {height} texels and has {}",
            stored.len()
        );
        return Err(malformed(bytes.len(), what));
    }
    let mut rgba = allocate_texels(width * height)?;
    rgba.resize(width * height * 4, 0);
    let rows_out = rgba.as_chunks_mut::<4>().0.chunks_exact_mut(width);
    for (y, (row, out)) in stored.chunks(row_len).zip(rows_out).enumerate() {
        read_row((header.texels_start + y * row_len, row), out)?;
    }
    Ok(rgba)
}

/// A row of indices.
fn mapped_row(
    (start, row): (usize, &[u8]),
    bits: u8,
    palette: &[[u8; 4]],
    out: &mut [[u8; 4]],
) -> Result<(), AssetError> {
    let per_byte = 8 / usize::from(bits);
    let mask = 0xff >> (8 - bits);
    for (x, texel) in out.iter_mut().enumerate() {
        let shift = 8 - usize::from(bits) * (x % per_byte + 1);
        let index = row[x / per_byte] >> shift & mask;
        *texel = color(palette, index, start + x / per_byte)?;
    }
    Ok(())
}

/// The colour of `index`, which is stored at byte `at`.
pub(super) fn color(palette: &[[u8; 4]], index: u8, at: usize) -> Result<[u8; 4], AssetError> {
    palette.get(usize::from(index)).copied().ok_or_else(|| {
        let len = palette.len();
        malformed(at, format!("colour {index} of a BMP palette of {len}"))
    })
}

/// A row of words of 2, 3 or 4 bytes.
fn words_row(row: &[u8], len_bytes: usize, channels: &[Channel; 4], out: &mut [[u8; 4]]) {
    let is_opaque = channels[3].is_absent();
    for (stored, texel) in row.chunks_exact(len_bytes).zip(out) {
        let fold = |word, &byte| word << 8 | u32::from(byte);
        let word = stored.iter().rev().fold(0, fold);
        *texel = channels.map(|channel| channel.unorm8(word));
        if is_opaque {
            texel[3] = 255;
        }
    }
}
