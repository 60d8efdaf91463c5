//! The BMP reader.

use estampe_scene::{Image, Workers};

use super::header::{Fields, Header, Texels};
use super::runs;
use crate::image::channel::Channel;
use crate::image::fault::{allocate_texels, check_size, malformed};
use crate::image::reduce::{Reduced, Reducer, Reduction, RowOrder, reduce};
use crate::image::transform::flip_vertical;
use crate::{AssetError, Limits};

/// Reads a bitmap of 1, 4, 8, 16, 24 or 32 bits per texel, with bit masks, or run-length encoded.
///
/// # Errors
/// `Malformed` with a byte offset if the file is truncated, contradicts itself or uses a colour
/// that its palette lacks; `Unsupported` for other kinds (JPEG and PNG in a BMP, fax codes);
/// `LimitExceeded` before any texel is stored.
pub(in crate::image) fn decode(bytes: &[u8], limits: &Limits) -> Result<Image, AssetError> {
    let (header, (width, height)) = parse(bytes, limits)?;
    let mut rgba;
    if let Texels::Runs { bits, palette } = &header.texels {
        rgba = runs::decode(bytes, &header, *bits, palette)?;
    } else {
        check_rows(bytes, &header)?;
        rgba = allocate_texels(width as usize * height as usize)?;
        rgba.resize(width as usize * height as usize * 4, 0);
        let mut rows = rgba.as_chunks_mut::<4>().0.chunks_exact_mut(width as usize);
        for_each_row(bytes, &header, |row| {
            if let Some(out) = rows.next() {
                out.copy_from_slice(row);
            }
        })?;
    }
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

/// [`decode`] of a level of the image, row by row unless it is run-length encoded.
pub(in crate::image) fn decode_reduced(
    bytes: &[u8],
    reduction: Reduction,
    limits: &Limits,
) -> Result<Reduced, AssetError> {
    let (header, size) = parse(bytes, limits)?;
    if matches!(header.texels, Texels::Runs { .. }) {
        return reduce(
            &decode(bytes, limits)?,
            reduction,
            Workers::new(limits.threads),
        );
    }
    check_rows(bytes, &header)?;
    let order = match header.is_top_down {
        true => RowOrder::TopDown,
        false => RowOrder::BottomUp,
    };
    let mut reducer = Reducer::new(size, reduction, order)?;
    let mut words = Vec::with_capacity(size.0 as usize);
    for_each_row(bytes, &header, |row| {
        words.clear();
        words.extend(row.iter().map(|&texel| u32::from_le_bytes(texel)));
        reducer.push(&words);
    })?;
    Ok(reducer.finish())
}

/// The header and the size of an image within the limits.
fn parse(bytes: &[u8], limits: &Limits) -> Result<(Header, (u32, u32)), AssetError> {
    let fields = Fields::parse(bytes)?;
    let (width, height) = fields.size()?;
    check_size(width, height, limits)?;
    Ok((fields.header(bytes)?, (width, height)))
}

/// Width and height from the header.
pub(in crate::image) fn stated_size(bytes: &[u8]) -> Option<(u32, u32)> {
    Fields::parse(bytes).and_then(|fields| fields.size()).ok()
}

/// The bits of a texel in a row.
fn texel_bits(texels: &Texels) -> usize {
    match texels {
        Texels::Mapped { bits, .. } | Texels::Runs { bits, .. } => usize::from(*bits),
        Texels::Words { len_bytes, .. } => len_bytes * 8,
    }
}

/// The bytes of a row, which end at a multiple of four.
fn row_len(header: &Header) -> usize {
    (header.width as usize * texel_bits(&header.texels)).div_ceil(32) * 4
}

/// Refuses a file that is too short for its rows.
fn check_rows(bytes: &[u8], header: &Header) -> Result<(), AssetError> {
    let (width, height) = (header.width as usize, header.height as usize);
    // The padding of the last row may be missing.
    let last_len = (width * texel_bits(&header.texels)).div_ceil(8);
    let before = row_len(header).saturating_mul(height - 1);
    let needed = before.saturating_add(last_len);
    let stored = bytes.get(header.texels_start..).unwrap_or_default();
    if stored.len() >= needed {
        return Ok(());
    }
    let what = format!(
        "the BMP needs {needed} bytes for {width} × {height} texels and has {}",
        stored.len()
    );
    Err(malformed(bytes.len(), what))
}

/// Calls `put` with the texels of each row in the order of the file, which is long enough.
fn for_each_row(
    bytes: &[u8],
    header: &Header,
    mut put: impl FnMut(&[[u8; 4]]),
) -> Result<(), AssetError> {
    let row_len = row_len(header);
    let stored = bytes.get(header.texels_start..).unwrap_or_default();
    let mut out = vec![[0; 4]; header.width as usize];
    let rows = stored.chunks(row_len).take(header.height as usize);
    for (y, row) in rows.enumerate() {
        let start = header.texels_start + y * row_len;
        match &header.texels {
            Texels::Mapped { bits, palette } => {
                mapped_row((start, row), *bits, palette, &mut out)?;
            }
            Texels::Words {
                len_bytes,
                channels,
            } => words_row(row, *len_bytes, channels, &mut out),
            Texels::Runs { .. } => unreachable!("runs have no rows"),
        }
        put(&out);
    }
    Ok(())
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
