//! Regions of a level between the host's bytes and stored texels, row by row.
//!
//! The bytes of a texel are those of its format, in the order of [`LevelData`](crate::LevelData),
//! or of one aspect of a depth-stencil format: of depth four bytes (two of 16 bits), of stencil
//! one.

use crate::blocks::{self, MAX_WORDS};
use crate::upload::{bytes_of_words, words_of_bytes};
use estampe_types::{TexelData, TextureAspect, TextureFormat};

/// The most bytes of a compressed block.
const MAX_BLOCK_BYTES: usize = 16;

/// Part of one level and slice of a texture, in texels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RowSpan {
    /// Mip level.
    pub level: usize,
    /// Layer, or depth in a 3D texture.
    pub slice: usize,
    /// The first texel.
    pub x: usize,
    /// The row; of compressed formats the first row of blocks' texels.
    pub y: usize,
    /// The number of texels.
    pub width: usize,
}

/// Bytes of a texel, or of a block of a compressed format, of one aspect.
#[must_use]
pub fn aspect_bytes(format: TextureFormat, aspect: TextureAspect) -> usize {
    match aspect {
        TextureAspect::Stencil if format.has_stencil() => 1,
        TextureAspect::Depth if format == TextureFormat::Depth16Unorm => 2,
        TextureAspect::Depth if format.has_depth() => 4,
        _ => format.block_bytes() as usize,
    }
}

/// The words of a span's texels among those of the texture, all samples counted.
#[must_use]
pub fn row_words(texture: &TexelData, span: RowSpan) -> std::ops::Range<usize> {
    let level = texture.levels[span.level];
    let samples = texture.shape.samples as usize;
    let (width, height) = (level.width as usize, level.height as usize);
    let row = span.slice * height + span.y;
    let first = level.offset as usize + (row * width + span.x) * samples;
    let words = texture.words_per_texel();
    first * words..(first + span.width * samples) * words
}

/// Writes the texels of a row; not of compressed formats, nor of several samples.
pub fn write_row(
    texture: &TexelData,
    span: RowSpan,
    aspect: TextureAspect,
    bytes: &[u8],
    words: &mut [u32],
) {
    let words = &mut words[row_words(texture, span)];
    let each = aspect_bytes(texture.format, aspect);
    let texels = words.chunks_exact_mut(texture.words_per_texel());
    for (texel, bytes) in texels.zip(bytes.chunks_exact(each)) {
        if aspect == TextureAspect::All {
            words_of_bytes(texture.format, bytes, texel);
            continue;
        }
        // An aspect has at most four bytes.
        let bits = word(bytes);
        match (aspect, texture.format) {
            (TextureAspect::Stencil, TextureFormat::Depth24PlusStencil8) => {
                texel[0] = texel[0] & 0x00FF_FFFF | bits << 24;
            }
            (TextureAspect::Stencil, TextureFormat::Depth32FloatStencil8) => texel[1] = bits,
            (TextureAspect::Depth, TextureFormat::Depth24PlusStencil8) => {
                texel[0] = texel[0] & 0xFF00_0000 | bits & 0x00FF_FFFF;
            }
            (_, TextureFormat::Depth24Plus) => texel[0] = bits & 0x00FF_FFFF,
            _ => texel[0] = bits,
        }
    }
}

/// Copies an aspect of texels between rows of the same format, or of two that differ in sRGB.
pub fn copy_row(format: TextureFormat, aspect: TextureAspect, from: &[u32], to: &mut [u32]) {
    use TextureFormat as F;
    match (format, aspect) {
        (F::Depth24PlusStencil8, TextureAspect::Depth) => copy_bits(0x00FF_FFFF, from, to),
        (F::Depth24PlusStencil8, TextureAspect::Stencil) => copy_bits(0xFF00_0000, from, to),
        (F::Depth32FloatStencil8, TextureAspect::Depth) => copy_halves(0, from, to),
        (F::Depth32FloatStencil8, TextureAspect::Stencil) => copy_halves(1, from, to),
        _ => to.copy_from_slice(from),
    }
}

/// Copies some bits of each word.
fn copy_bits(bits: u32, from: &[u32], to: &mut [u32]) {
    for (to, from) in to.iter_mut().zip(from) {
        *to = *to & !bits | from & bits;
    }
}

/// Copies one word of each pair.
fn copy_halves(half: usize, from: &[u32], to: &mut [u32]) {
    for (to, from) in to.chunks_exact_mut(2).zip(from.chunks_exact(2)) {
        to[half] = from[half];
    }
}

/// Reads one sample of the texels of a row; not of compressed formats.
pub fn read_row(
    texture: &TexelData,
    span: RowSpan,
    (aspect, sample): (TextureAspect, usize),
    bytes: &mut [u8],
) {
    let words = &texture.texels[row_words(texture, span)];
    let each = aspect_bytes(texture.format, aspect);
    let samples = words.chunks_exact(texture.words_per_texel());
    let texels = samples.skip(sample).step_by(texture.shape.samples as usize);
    for (texel, bytes) in texels.zip(bytes.chunks_exact_mut(each)) {
        let bits = match (aspect, texture.format) {
            (TextureAspect::Stencil, TextureFormat::Depth24PlusStencil8) => texel[0] >> 24,
            (TextureAspect::Stencil, TextureFormat::Depth32FloatStencil8) => texel[1],
            (TextureAspect::Depth, TextureFormat::Depth24PlusStencil8) => texel[0] & 0x00FF_FFFF,
            (TextureAspect::Depth | TextureAspect::Stencil, _) => texel[0],
            (TextureAspect::All, _) => {
                bytes_of_words(texture.format, texel, bytes);
                continue;
            }
        };
        bytes.copy_from_slice(&bits.to_le_bytes()[..bytes.len()]);
    }
}

/// Decodes a row of blocks of a compressed format; texels beyond the level are dropped.
pub fn write_blocks(texture: &TexelData, span: RowSpan, bytes: &[u8], words: &mut [u32]) {
    let [block_width, block_height] = texture.format.block_size().map(|side| side as usize);
    let level = texture.levels[span.level];
    let (width, height) = (level.width as usize, level.height as usize);
    let each = texture.words_per_texel();
    let mut block = [0; MAX_WORDS];
    let blocks = bytes.chunks_exact(texture.format.block_bytes() as usize);
    for (column, bytes) in blocks.enumerate() {
        let x = span.x + column * block_width;
        if x >= width {
            break;
        }
        blocks::decode(texture.format, bytes, &mut block);
        let columns = block_width.min(width - x);
        let rows = (span.y..height).take(block_height);
        for (y, texels) in rows.zip(block.chunks(block_width * each)) {
            let row = RowSpan {
                x,
                y,
                width: columns,
                ..span
            };
            words[row_words(texture, row)].copy_from_slice(&texels[..columns * each]);
        }
    }
}

/// Sets the texels of one level of one slice to zeros; of compressed formats to those of blocks of
/// zero bytes, which need not be zeros (of ASTC they are the error colour).
pub fn write_zeros(texture: &TexelData, level: usize, slice: usize, words: &mut [u32]) {
    let size = texture.levels[level];
    let (width, height) = (size.width as usize, size.height as usize);
    let span = |y: usize| RowSpan {
        level,
        slice,
        x: 0,
        y,
        width,
    };
    let [first, last] = [0, height - 1].map(|y| row_words(texture, span(y)));
    words[first.start..last.end].fill(0);
    let format = texture.format;
    if !format.is_compressed() {
        return;
    }
    // Every block is the same: it is decoded once.
    let mut block = [0; MAX_WORDS];
    let bytes = [0; MAX_BLOCK_BYTES];
    blocks::decode(format, &bytes[..format.block_bytes() as usize], &mut block);
    if block == [0; MAX_WORDS] {
        return;
    }
    let [block_width, block_height] = format.block_size().map(|side| side as usize);
    let block_row = block_width * texture.words_per_texel();
    for y in 0..height {
        let row = &block[y % block_height * block_row..][..block_row];
        for texels in words[row_words(texture, span(y))].chunks_mut(block_row) {
            texels.copy_from_slice(&row[..texels.len()]);
        }
    }
}

fn word(bytes: &[u8]) -> u32 {
    let mut four = [0; 4];
    four[..bytes.len()].copy_from_slice(bytes);
    u32::from_le_bytes(four)
}
