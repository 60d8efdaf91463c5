//! Creation of 2D textures of four 8-bit channels from bytes.

use crate::descriptor::zeros;
use crate::{TextureError, mips};
use estampe_types::{
    Limits, Lines, MipLevel, TexelData, TexelEncoding, TextureFormat, TextureShape,
};
use std::sync::Arc;

/// The most texels of all levels: their offsets fit the signed 32-bit indices of lane code.
const MAX_TEXELS: u64 = i32::MAX as u64;

/// The smaller mip levels that are generated: none or all.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum MipGeneration {
    /// No level is generated.
    #[default]
    None,
    /// Levels down to 1×1 are generated, each half the size of the level above.
    ///
    /// A side is halved and rounded down, at least 1, as in WebGPU. Texel (x, y) is the mean of the
    /// texels (2x, 2y), (2x + 1, 2y), (2x, 2y + 1), (2x + 1, 2y + 1) above, the second clamped
    /// where a side is 1; the last row or column of an odd side is left out. Encoded unorm8 values
    /// a, b, c, d give `(a + b + c + d + 2) / 4`, rounded down; sRGB's R, G and B are averaged as
    /// linear values, in f32, `((a + b) + (c + d)) · 0.25`, and encoded again. Alpha is straight:
    /// colours are not weighted with it.
    Full,
}

/// Creates a texture from texels of four bytes, R G B A, row by row from the top.
///
/// # Errors
/// [`TextureError`] when a side is zero or beyond `limits`, the number of bytes is not
/// width · height · 4, or the format has other channels than four of 8 bits.
pub fn create_texture(
    width: u32,
    height: u32,
    format: TextureFormat,
    rgba: &[u8],
    mips: MipGeneration,
    limits: &Limits,
) -> Result<TexelData, TextureError> {
    let count = match mips {
        MipGeneration::None => 1,
        MipGeneration::Full => full_chain(width, height),
    };
    let levels = lay_out((width, height), format, count, limits)?;
    check_bytes(0, levels[0], rgba)?;
    let texels = filled(&levels, |texels| {
        store(texels, rgba);
        for pair in levels.windows(2) {
            mips::halve_level(texels, pair[0], pair[1], format);
        }
    })?;
    Ok(texture(format, levels, texels))
}

/// Creates a texture from its mip levels: the full size (width, height) first, each next level half
/// as wide and high, rounded down, at least 1. The chain may end before 1×1.
///
/// # Errors
/// [`TextureError`] as for [`create_texture`], and when there is no level, or there are more than
/// the chain down to 1×1 has.
pub fn create_texture_with_levels(
    size: (u32, u32),
    format: TextureFormat,
    levels: &[&[u8]],
    limits: &Limits,
) -> Result<TexelData, TextureError> {
    let layout = lay_out(size, format, levels.len(), limits)?;
    for (index, (level, bytes)) in layout.iter().zip(levels).enumerate() {
        check_bytes(index, *level, bytes)?;
    }
    let texels = filled(&layout, |texels| {
        for (level, bytes) in layout.iter().zip(levels) {
            store(&mut texels[level.offset as usize..], bytes);
        }
    })?;
    Ok(texture(format, layout, texels))
}

/// Texels of all levels, filled in their place.
fn filled(
    levels: &[MipLevel],
    fill: impl FnOnce(&mut [u32]),
) -> Result<Arc<Lines<u32>>, TextureError> {
    let mut texels = zeros(texel_count(levels))?;
    fill(&mut texels);
    Ok(Arc::new(texels))
}

fn texture(format: TextureFormat, levels: Vec<MipLevel>, texels: Arc<Lines<u32>>) -> TexelData {
    TexelData {
        format,
        levels,
        is_opaque: is_opaque(&texels),
        alpha_maps: Arc::default(),
        squares: Arc::default(),
        texels,
        shape: TextureShape::default(),
    }
}

/// True if no texel lets light through.
fn is_opaque(texels: &[u32]) -> bool {
    /// Texels that are looked at before the answer may be known.
    const PIECE: usize = 4096;
    texels.chunks(PIECE).all(|piece| {
        let all_bits = piece.iter().fold(u32::MAX, |all, texel| all & texel);
        all_bits >> 24 == 255
    })
}

/// The number of levels from this size down to 1×1.
fn full_chain(width: u32, height: u32) -> usize {
    width.max(height).max(1).ilog2() as usize + 1
}

/// The sizes and offsets of `count` levels, after checks of format, size and count.
fn lay_out(
    (width, height): (u32, u32),
    format: TextureFormat,
    count: usize,
    limits: &Limits,
) -> Result<Vec<MipLevel>, TextureError> {
    if format.encoding() != TexelEncoding::Unorm8 || format.components() != 4 {
        return Err(TextureError::Format { format });
    }
    if width == 0 || height == 0 {
        return Err(TextureError::Empty { width, height });
    }
    let limit = limits.max_texture_dimension_2d;
    if width > limit || height > limit {
        return Err(TextureError::TooLarge {
            width,
            height,
            limit,
        });
    }
    let most = full_chain(width, height);
    if count == 0 || count > most {
        return Err(TextureError::LevelCount {
            most,
            actual: count,
        });
    }
    let size = |level: usize| ((width >> level).max(1), (height >> level).max(1));
    let texels = (0..count)
        .map(|level| u64::from(size(level).0) * u64::from(size(level).1))
        .fold(0, u64::saturating_add);
    if texels > MAX_TEXELS {
        return Err(TextureError::TooManyTexels { texels });
    }
    let mut offset = 0;
    Ok((0..count)
        .map(|level| {
            let (width, height) = size(level);
            let placed = MipLevel {
                width,
                height,
                offset,
            };
            // Cannot overflow: all levels together have at most MAX_TEXELS.
            offset += width * height;
            placed
        })
        .collect())
}

fn texel_count(levels: &[MipLevel]) -> usize {
    levels
        .last()
        .map_or(0, |last| (last.offset + last.width * last.height) as usize)
}

fn check_bytes(level: usize, size: MipLevel, bytes: &[u8]) -> Result<(), TextureError> {
    let expected = u64::from(size.width) * u64::from(size.height) * 4;
    let actual = bytes.len() as u64;
    if actual == expected {
        Ok(())
    } else {
        Err(TextureError::ByteCount {
            level,
            expected,
            actual,
        })
    }
}

/// Stores texels from the first one on.
fn store(texels: &mut [u32], rgba: &[u8]) {
    let (whole, _) = rgba.as_chunks::<4>();
    for (texel, bytes) in texels.iter_mut().zip(whole) {
        *texel = u32::from_le_bytes(*bytes);
    }
}
