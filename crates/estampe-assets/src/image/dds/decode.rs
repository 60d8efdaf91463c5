//! The DDS reader.

use estampe_scene::Image;

use super::blocks::BlockFormat;
use super::header::{self, Header, Texels};
use crate::image::channel::{Channel, unmultiplied};
use crate::image::fault::{allocate_texels, check_size, malformed};
use crate::{AssetError, Limits};

/// Reads the first mip level of a 2D texture: BC1 to BC5 and BC7, or texels described by bit masks.
///
/// # Errors
/// `Malformed` with a byte offset if the file is truncated; `Unsupported` for cube maps, volumes,
/// layers and other formats; `LimitExceeded` before any texel is stored.
pub(in crate::image) fn decode(bytes: &[u8], limits: &Limits) -> Result<Image, AssetError> {
    let (width, height) = header::size(bytes)?;
    check_size(width, height, limits)?;
    let header = Header::parse(bytes)?;
    let (columns, rows) = (width as usize, height as usize);
    let row_len = match header.texels {
        Texels::Blocks(format) => columns.div_ceil(4) * format.len_bytes(),
        Texels::Words { len_bytes, .. } => columns * len_bytes,
    };
    let rows_stored = match header.texels {
        Texels::Blocks(_) => rows.div_ceil(4),
        Texels::Words { .. } => rows,
    };
    let needed = row_len.saturating_mul(rows_stored);
    let stored = bytes.get(header.texels_start..).unwrap_or_default();
    if stored.len() < needed {
        let what = format!(
            "the DDS needs {needed} bytes for {width} × {height} texels and has {}",
            stored.len()
        );
        return Err(malformed(bytes.len(), what));
    }

    let mut rgba = allocate_texels(columns * rows)?;
    rgba.resize(columns * rows * 4, 0);
    let texels = rgba.as_chunks_mut::<4>().0;
    match header.texels {
        Texels::Blocks(format) => {
            let rows_out = texels.chunks_mut(columns * 4);
            for (row, out) in stored.chunks_exact(row_len).zip(rows_out) {
                block_row(row, format, columns, out);
            }
        }
        Texels::Words {
            len_bytes,
            channels,
        } => {
            for (word, out) in stored.chunks_exact(len_bytes).zip(&mut *texels) {
                *out = texel(word, &channels);
            }
        }
    }
    if header.is_premultiplied {
        for texel in texels {
            let alpha = texel[3];
            *texel = texel.map(|color| unmultiplied(color, alpha));
            texel[3] = alpha;
        }
    }
    Ok(Image {
        width,
        height,
        rgba,
    })
}

/// Width and height from the header.
pub(in crate::image) fn stated_size(bytes: &[u8]) -> Option<(u32, u32)> {
    header::size(bytes).ok()
}

/// A row of blocks; `out` is up to four rows of texels.
fn block_row(row: &[u8], format: BlockFormat, width: usize, out: &mut [[u8; 4]]) {
    for (x, block) in row.chunks_exact(format.len_bytes()).enumerate() {
        let texels = format.decode(block);
        let start = x * 4;
        let len = (width - start).min(4);
        for (out, texels) in out.chunks_exact_mut(width).zip(texels.as_chunks::<4>().0) {
            out[start..start + len].copy_from_slice(&texels[..len]);
        }
    }
}

/// A texel of one to four bytes.
fn texel(bytes: &[u8], channels: &[Channel; 4]) -> [u8; 4] {
    let fold = |word, &byte| word << 8 | u32::from(byte);
    let word = bytes.iter().rev().fold(0, fold);
    let mut texel = channels.map(|channel| channel.unorm8(word));
    if channels[3].is_absent() {
        texel[3] = 255;
    }
    texel
}
