//! The DDS reader.

use estampe_scene::{AlphaMode, Image};

use super::blocks::BlockFormat;
use super::header::{self, Header, Texels};
use crate::image::channel::{Channel, unmultiplied};
use crate::image::fault::{allocate_texels, check_size, malformed};
use crate::image::reduce::{Reduced, Reducer, Reduction, RowOrder};
use crate::{AssetError, Limits};

/// Reads the first mip level of a 2D texture: BC1 to BC5 and BC7, or texels described by bit masks.
///
/// # Errors
/// `Malformed` with a byte offset if the file is truncated; `Unsupported` for cube maps, volumes,
/// layers and other formats; `LimitExceeded` before any texel is stored.
pub(in crate::image) fn decode(bytes: &[u8], limits: &Limits) -> Result<Image, AssetError> {
    let surface = Surface::first(bytes, limits)?;
    let (width, height) = surface.size;
    let mut rgba = allocate_texels(width as usize * height as usize)?;
    surface.for_each_row(|row| rgba.extend_from_slice(row.as_flattened()));
    Ok(Image {
        width,
        height,
        rgba,
    })
}

/// [`decode`] of a level of the image: a stored one, from which further ones are made.
pub(in crate::image) fn decode_reduced(
    bytes: &[u8],
    reduction: Reduction,
    limits: &Limits,
) -> Result<Reduced, AssetError> {
    let first = Surface::first(bytes, limits)?;
    let stored = { 1..=reduction.level }
        .rev()
        .find_map(|level| Some((level, first.level(bytes, level)?)));
    if let Some((level, surface)) = stored {
        let further = Reduction {
            level: reduction.level - level,
            ..reduction
        };
        let reduced = surface.reduced(further)?;
        // Smaller levels of a mask have alphas between, so the first level tells the use of alpha.
        if reduced.alpha == AlphaMode::Opaque {
            return Ok(reduced);
        }
        let alpha = first.reduced(reduction)?.alpha;
        return Ok(Reduced { alpha, ..reduced });
    }
    first.reduced(reduction)
}

/// A mip level with its bytes.
struct Surface<'b> {
    header: Header,
    size: (u32, u32),
    stored: &'b [u8],
}

impl<'b> Surface<'b> {
    /// The first level of a file whose header and length were checked.
    fn first(bytes: &'b [u8], limits: &Limits) -> Result<Self, AssetError> {
        let size @ (width, height) = header::size(bytes)?;
        check_size(width, height, limits)?;
        let header = Header::parse(bytes)?;
        let needed = header.texels.len_bytes(size);
        let stored = bytes.get(header.texels_start..).unwrap_or_default();
        let Some(stored) = stored.get(..needed) else {
            let what = format!(
                "the DDS needs {needed} bytes for {width} × {height} texels and has {}",
                stored.len()
            );
            return Err(malformed(bytes.len(), what));
        };
        Ok(Self {
            header,
            size,
            stored,
        })
    }

    /// A further level, if the file has it.
    fn level(&self, bytes: &'b [u8], level: u32) -> Option<Self> {
        let halved = |by: u32| {
            let side = |of: u32| of.checked_shr(by).unwrap_or(0).max(1);
            (side(self.size.0), side(self.size.1))
        };
        if level >= self.header.level_count {
            return None;
        }
        let start = { 0..level }.try_fold(self.header.texels_start, |start, above| {
            start.checked_add(self.header.texels.len_bytes(halved(above)))
        })?;
        let size = halved(level);
        let end = start.checked_add(self.header.texels.len_bytes(size))?;
        Some(Self {
            header: self.header,
            size,
            stored: bytes.get(start..end)?,
        })
    }

    fn reduced(&self, reduction: Reduction) -> Result<Reduced, AssetError> {
        let mut reducer = Reducer::new(self.size, reduction, RowOrder::TopDown)?;
        let mut words = Vec::with_capacity(self.size.0 as usize);
        self.for_each_row(|row| {
            words.clear();
            words.extend(row.iter().map(|&texel| u32::from_le_bytes(texel)));
            reducer.push(&words);
        });
        Ok(reducer.finish())
    }

    /// Calls `put` with the texels of each row, from the top.
    fn for_each_row(&self, mut put: impl FnMut(&[[u8; 4]])) {
        let (width, height) = (self.size.0 as usize, self.size.1 as usize);
        let mut put = |row: &mut [[u8; 4]]| {
            if self.header.is_premultiplied {
                for texel in &mut *row {
                    let alpha = texel[3];
                    *texel = texel.map(|color| unmultiplied(color, alpha));
                    texel[3] = alpha;
                }
            }
            put(row);
        };
        match self.header.texels {
            Texels::Blocks(format) => {
                let row_len = width.div_ceil(4) * format.len_bytes();
                let mut texels = vec![[0; 4]; width * 4];
                for (y, blocks) in self.stored.chunks_exact(row_len).enumerate() {
                    block_row(blocks, format, width, &mut texels);
                    let rows = texels.chunks_exact_mut(width);
                    rows.take(height - (4 * y).min(height)).for_each(&mut put);
                }
            }
            Texels::Words {
                len_bytes,
                channels,
            } => {
                let mut texels = vec![[0; 4]; width];
                for row in self.stored.chunks_exact(width * len_bytes) {
                    for (word, out) in row.chunks_exact(len_bytes).zip(&mut texels) {
                        *out = texel(word, &channels);
                    }
                    put(&mut texels);
                }
            }
        }
    }
}

impl Texels {
    /// Bytes of an image.
    fn len_bytes(self, (width, height): (u32, u32)) -> usize {
        let (width, height) = (width as usize, height as usize);
        match self {
            Self::Blocks(format) => width
                .div_ceil(4)
                .saturating_mul(height.div_ceil(4))
                .saturating_mul(format.len_bytes()),
            Self::Words { len_bytes, .. } => width.saturating_mul(height).saturating_mul(len_bytes),
        }
    }
}

/// Width and height from the header.
pub(in crate::image) fn stated_size(bytes: &[u8]) -> Option<(u32, u32)> {
    header::size(bytes).ok()
}

/// A row of blocks as four rows of texels.
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
