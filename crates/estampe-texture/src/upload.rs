//! Upload of texel data: rows of a format's bytes become stored texels.

use crate::TextureError;
use crate::blocks::{self, MAX_WORDS};
use estampe_types::{TexelData, TextureFormat};

/// The bytes of one mip level in the format's layout: slice after slice, row after row of texels,
/// or of blocks if the format is compressed; the samples of a multisampled texel are adjacent. This
/// is WebGPU's `GPUTexelCopyBufferLayout`.
///
/// A depth of 24 bits is the lower part of four bytes, with the stencil above it; after a depth of
/// 32 bits, the stencil is the first of four further bytes.
#[derive(Debug, Clone, Copy, Default)]
pub struct LevelData<'a> {
    /// The bytes; with a given stride there may be more than needed.
    pub bytes: &'a [u8],
    /// Bytes from the start of a row to the start of the next; `None`: rows have no padding.
    pub bytes_per_row: Option<u32>,
    /// Rows (of blocks if the format is compressed) from the start of a slice to the start of the
    /// next; `None`: slices have no padding.
    pub rows_per_image: Option<u32>,
}

impl<'a> LevelData<'a> {
    /// Data without padding between rows and slices.
    #[must_use]
    pub fn tight(bytes: &'a [u8]) -> Self {
        Self {
            bytes,
            ..Self::default()
        }
    }
}

/// The layout of a level's rows in its bytes.
struct Layout {
    rows: usize,
    row_bytes: usize,
    row_stride: usize,
    slice_stride: usize,
}

/// Fills a level in the words of a texture.
pub(crate) fn level(
    texture: &TexelData,
    level: usize,
    data: &LevelData<'_>,
    words: &mut [u32],
) -> Result<(), TextureError> {
    let layout = layout(texture, level, data)?;
    let size = texture.levels[level];
    let samples = texture.shape.samples as usize;
    let (width, height) = (size.width as usize, size.height as usize);
    let slice_texels = width * height * samples;
    let per_texel = texture.words_per_texel();
    for slice in 0..texture.shape.slices(level) as usize {
        let begin = (size.offset as usize + slice * slice_texels) * per_texel;
        let to = &mut words[begin..][..slice_texels * per_texel];
        let from = &data.bytes[slice * layout.slice_stride..];
        for row in 0..layout.rows {
            let bytes = &from[row * layout.row_stride..][..layout.row_bytes];
            if texture.format.is_compressed() {
                row_of_blocks(texture, bytes, row, (width, height), to);
            } else {
                let row_words = width * samples * per_texel;
                row_of_texels(texture, bytes, &mut to[row * row_words..][..row_words]);
            }
        }
    }
    Ok(())
}

fn layout(texture: &TexelData, level: usize, data: &LevelData<'_>) -> Result<Layout, TextureError> {
    let size = texture.levels[level];
    let [block_width, block_height] = texture.format.block_size();
    let columns = u64::from(size.width.div_ceil(block_width)) * u64::from(texture.shape.samples);
    let rows = u64::from(size.height.div_ceil(block_height));
    let row_bytes = columns * u64::from(texture.format.block_bytes());
    let row_stride = data.bytes_per_row.map_or(row_bytes, u64::from);
    let image_rows = data.rows_per_image.map_or(rows, u64::from);
    if row_stride < row_bytes || image_rows < rows {
        return Err(TextureError::RowLayout {
            level,
            bytes_per_row: row_bytes,
            rows_per_image: rows,
        });
    }
    let slices = u64::from(texture.shape.slices(level));
    let slice_stride = row_stride.saturating_mul(image_rows);
    let expected = slice_stride
        .saturating_mul(slices - 1)
        .saturating_add(row_stride * (rows - 1) + row_bytes);
    let actual = data.bytes.len() as u64;
    let is_tight = data.bytes_per_row.is_none() && data.rows_per_image.is_none();
    if actual < expected || is_tight && actual != expected {
        return Err(TextureError::ByteCount {
            level,
            expected,
            actual,
        });
    }
    // Values that are used do not exceed the length of the bytes; a stride may, if there is only
    // one row or slice.
    let within = |value| usize::try_from(value).unwrap_or(0);
    Ok(Layout {
        rows: within(rows),
        row_bytes: within(row_bytes),
        row_stride: within(row_stride),
        slice_stride: within(slice_stride),
    })
}

fn row_of_texels(texture: &TexelData, bytes: &[u8], words: &mut [u32]) {
    let size = texture.format.block_bytes() as usize;
    let per_texel = texture.words_per_texel();
    for (texel, words) in bytes
        .chunks_exact(size)
        .zip(words.chunks_exact_mut(per_texel))
    {
        words_of_bytes(texture.format, texel, words);
    }
}

/// The words of one texel, from the format's bytes. Bits that neither depth nor stencil has become
/// zeros, as attachments do not keep them.
pub(crate) fn words_of_bytes(format: TextureFormat, texel: &[u8], words: &mut [u32]) {
    for (word, bytes) in words.iter_mut().zip(texel.chunks(4)) {
        let mut four = [0; 4];
        four[..bytes.len()].copy_from_slice(bytes);
        *word = u32::from_le_bytes(four);
    }
    match format {
        TextureFormat::Bgra8Unorm | TextureFormat::Bgra8UnormSrgb => {
            let [b, g, r, a] = words[0].to_le_bytes();
            words[0] = u32::from_le_bytes([r, g, b, a]);
        }
        TextureFormat::Depth24Plus => words[0] &= 0x00FF_FFFF,
        TextureFormat::Depth32FloatStencil8 => words[1] &= 0xFF,
        _ => {}
    }
}

/// The format's bytes of one texel: the inverse of [`words_of_bytes`].
pub(crate) fn bytes_of_words(format: TextureFormat, words: &[u32], texel: &mut [u8]) {
    for (bytes, word) in texel.chunks_mut(4).zip(words) {
        bytes.copy_from_slice(&word.to_le_bytes()[..bytes.len()]);
    }
    if format.is_bgra() {
        texel.swap(0, 2);
    }
}

/// Decodes a row of blocks into the slice; texels beyond the level are dropped.
fn row_of_blocks(
    texture: &TexelData,
    bytes: &[u8],
    row: usize,
    (width, height): (usize, usize),
    slice: &mut [u32],
) {
    let [block_width, block_height] = texture.format.block_size().map(|side| side as usize);
    let per_texel = texture.words_per_texel();
    let size = texture.format.block_bytes() as usize;
    let mut block = [0; MAX_WORDS];
    for (column, bytes) in bytes.chunks_exact(size).enumerate() {
        blocks::decode(texture.format, bytes, &mut block);
        let left = column * block_width;
        let columns = block_width.min(width - left);
        for (y, texels) in (row * block_height..height).zip(block.chunks(block_width * per_texel)) {
            if y >= (row + 1) * block_height {
                break;
            }
            slice[(y * width + left) * per_texel..][..columns * per_texel]
                .copy_from_slice(&texels[..columns * per_texel]);
        }
    }
}
