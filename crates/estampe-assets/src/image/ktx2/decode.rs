//! The KTX2 reader.

use super::header::{self, ChannelSource, Header, Level};
use super::inflate::inflated;
use crate::image::channel::unmultiplied;
use crate::image::fault::{check_size, malformed};
use crate::image::reduce::{Reduced, Reducer, Reduction, RowOrder};
use crate::image::transform::{flip_horizontal, flip_vertical};
use crate::{AssetError, Limits};
use estampe_scene::{AlphaMode, Image};

/// Reads the first mip level of a 2D texture: 8-bit channels, BC1 to BC7, ETC2 and EAC, ASTC.
///
/// # Errors
/// `Malformed` with a byte offset if the file is truncated or contradicts itself; `Unsupported` for
/// cube maps, arrays, other dimensions, formats and supercompressions; `LimitExceeded` before any
/// texel is stored.
pub(in crate::image) fn decode(bytes: &[u8], limits: &Limits) -> Result<Image, AssetError> {
    decode_reduced(bytes, Reduction::NONE, limits).map(|reduced| reduced.image)
}

/// [`decode`] of a level of the image: a stored one, from which further ones are made.
pub(in crate::image) fn decode_reduced(
    bytes: &[u8],
    reduction: Reduction,
    limits: &Limits,
) -> Result<Reduced, AssetError> {
    let (width, height) = header::size(bytes)?;
    check_size(width, height, limits)?;
    let header = Header::parse(bytes)?;
    let last = u32::try_from(header.levels.len() - 1).unwrap_or(0);
    let stored = reduction.level.min(last);
    let reduced = level(bytes, &header, stored, reduction)?;
    if stored == 0 || reduced.alpha == AlphaMode::Opaque {
        return Ok(reduced);
    }
    // Smaller levels of a mask have alphas between, so the first level tells the use of alpha.
    let alpha = level(bytes, &header, 0, reduction)?.alpha;
    Ok(Reduced { alpha, ..reduced })
}

/// Width and height from the header.
pub(in crate::image) fn stated_size(bytes: &[u8]) -> Option<(u32, u32)> {
    header::size(bytes).ok()
}

/// A reduction of the whole image from a stored level.
fn level(
    bytes: &[u8],
    header: &Header,
    level: u32,
    reduction: Reduction,
) -> Result<Reduced, AssetError> {
    let side = |of: u32| of.checked_shr(level).unwrap_or(0).max(1);
    let size = (side(header.size.0), side(header.size.1));
    let place = header.levels[level as usize];
    let (start, stored) = stored_bytes(bytes, place)?;
    let needed = header.texels.len_bytes(size);
    let texels = inflated(stored, header.scheme, needed, start)?;
    let further = Reduction {
        level: reduction.level - level,
        ..reduction
    };
    let mut reducer = Reducer::new(size, further, RowOrder::TopDown)?;
    for_each_row(&texels, header, size, |row| reducer.push(row));
    let mut reduced = reducer.finish();
    if header.orientation.is_upside_down {
        reduced.image = flip_vertical(&reduced.image);
    }
    if header.orientation.is_mirrored {
        reduced.image = flip_horizontal(&reduced.image);
    }
    Ok(reduced)
}

/// The bytes of a level with their offset.
fn stored_bytes(bytes: &[u8], place: Level) -> Result<(usize, &[u8]), AssetError> {
    let outside = || {
        let what = format!(
            "the KTX2 level of {} bytes at byte {} is beyond the end of the file",
            place.len, place.offset
        );
        malformed(bytes.len(), what)
    };
    let end = place.offset.checked_add(place.len).ok_or_else(outside)?;
    let start = usize::try_from(place.offset).map_err(|_| outside())?;
    let end = usize::try_from(end).map_err(|_| outside())?;
    if place.len == 0 {
        return Err(malformed(place.entry, "a KTX2 level without bytes"));
    }
    let stored = bytes.get(start..end).ok_or_else(outside)?;
    Ok((start, stored))
}

/// Calls `put` with each row of texels, as words with R in the lowest byte.
fn for_each_row(
    stored: &[u8],
    header: &Header,
    (width, height): (u32, u32),
    mut put: impl FnMut(&[u32]),
) {
    let (width, height) = (width as usize, height as usize);
    let layout = header.texels;
    let [columns, rows] = layout.block_size();
    let row_len = width.div_ceil(columns) * layout.block_len();
    let mut block_texels = vec![[0; 4]; columns * rows];
    let mut texels = vec![0; width * rows];
    for (y, blocks) in stored.chunks_exact(row_len).enumerate() {
        for (x, block) in blocks.chunks_exact(layout.block_len()).enumerate() {
            layout.decode(block, &mut block_texels);
            let start = x * columns;
            let len = (width - start).min(columns);
            let rows_out = texels.chunks_exact_mut(width);
            for (out, row) in rows_out.zip(block_texels.chunks_exact(columns)) {
                for (out, &texel) in out[start..start + len].iter_mut().zip(row) {
                    *out = u32::from_le_bytes(finished(texel, header));
                }
            }
        }
        let left = height.saturating_sub(y * rows);
        texels.chunks_exact(width).take(left).for_each(&mut put);
    }
}

/// A texel with straight alpha and its channels in their places.
#[inline]
fn finished(mut texel: [u8; 4], header: &Header) -> [u8; 4] {
    if header.is_premultiplied {
        let alpha = texel[3];
        texel = texel.map(|color| unmultiplied(color, alpha));
        texel[3] = alpha;
    }
    header.swizzle.map(|source| match source {
        ChannelSource::Channel(channel) => texel[channel],
        ChannelSource::Zero => 0,
        ChannelSource::One => 255,
    })
}
