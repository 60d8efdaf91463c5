//! Reduction of images while they are decoded: row by row to a mip level, so that the full image is
//! never in memory.
//!
//! ```text
//!   rows of the file -> halves of halves … -> rows of the level
//! ```
//!
//! The rule is that of the pipeline's mip levels: the mean of 2×2 texels, rounded at each level, a
//! side halved and rounded down, at least 1. So the result has the bytes of the level that a
//! texture of the full image would have, and a picture that samples only this level and smaller
//! ones is the same. A larger box filter over the file's texels rounds once instead of once per
//! level; it was not chosen, because then pictures would change.

use estampe_format::box_filter::{Averaged, halve_rows};
use estampe_scene::{AlphaMode, Image, Workers};

use super::fault::allocate_texels;
use crate::AssetError;

/// The mip level of an image that is decoded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Reduction {
    /// The level: 0 is the whole image, each further one has half its sides. Beyond the last level,
    /// which has one texel, it is that one.
    pub level: u32,
    /// The meaning of red, green and blue.
    pub content: TexelContent,
}

impl Reduction {
    /// The whole image.
    pub const NONE: Self = Self {
        level: 0,
        content: TexelContent::Color,
    };
}

/// The meaning of an image's red, green and blue, which decides how they are averaged. Alpha is
/// always averaged as it is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TexelContent {
    /// sRGB colours, averaged as linear light, without regard to alpha.
    Color,
    /// sRGB colours, averaged as linear light and weighted with alpha, so that what is invisible
    /// has no colour in a smaller level.
    Covering,
    /// Numbers, such as normals and heights, averaged as they are stored.
    Number,
}

/// A reduced image, and the use of the alpha of the whole one: all 255 or all 0 is opaque.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Reduced {
    pub(crate) image: Image,
    pub(crate) alpha: AlphaMode,
    /// True if every alpha of the whole image is 255.
    pub(crate) is_solid: bool,
}

/// The order in which rows come.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum RowOrder {
    TopDown,
    BottomUp,
}

/// Receives the rows of an image, and keeps those of one of its levels.
pub(super) struct Reducer {
    averaged: Averaged,
    order: RowOrder,
    levels: Vec<Halving>,
    /// Width and height of the result.
    size: (u32, u32),
    texels: Vec<u8>,
    alpha: AlphaUse,
}

/// The step from a level to the next one.
struct Halving {
    /// Rows that are left out before the first pair: 1 for an odd number from the bottom up.
    left_out: usize,
    /// The level above has one row.
    is_single: bool,
    /// The first row of a pair whose second one has not come yet.
    first: Vec<u32>,
    has_first: bool,
    half: Vec<u32>,
}

/// The alphas that have come.
#[derive(Debug, Clone, Copy)]
struct AlphaUse {
    /// All bits that every alpha has.
    all_bits: u32,
    /// All bits that some alpha has.
    any_bits: u32,
    is_binary: bool,
}

impl Reducer {
    /// A reducer of an image of this size; both sides are at least 1.
    pub(super) fn new(
        (width, height): (u32, u32),
        reduction: Reduction,
        order: RowOrder,
    ) -> Result<Self, AssetError> {
        let last = width.max(height).max(1).ilog2();
        let mut size = (width.max(1), height.max(1));
        let levels = (0..reduction.level.min(last)).map(|_| {
            let (wide, high) = size;
            size = ((wide / 2).max(1), (high / 2).max(1));
            let is_odd_from_below = order == RowOrder::BottomUp && high % 2 == 1 && high > 1;
            Halving {
                left_out: usize::from(is_odd_from_below),
                is_single: high == 1,
                first: Vec::with_capacity(wide as usize),
                has_first: false,
                half: vec![0; size.0 as usize],
            }
        });
        let levels = levels.collect();
        Ok(Self {
            averaged: match reduction.content {
                TexelContent::Color => Averaged::Linear,
                TexelContent::Covering => Averaged::Weighted,
                TexelContent::Number => Averaged::Stored,
            },
            order,
            levels,
            size,
            texels: allocate_texels(size.0 as usize * size.1 as usize)?,
            alpha: AlphaUse::NONE,
        })
    }

    /// Takes the next row, as words with R in the lowest byte.
    pub(super) fn push(&mut self, row: &[u32]) {
        self.alpha.add(row);
        self.push_to(0, row);
    }

    fn push_to(&mut self, level: usize, row: &[u32]) {
        let Some(halving) = self.levels.get_mut(level) else {
            self.texels
                .extend(row.iter().flat_map(|texel| texel.to_le_bytes()));
            return;
        };
        if halving.left_out > 0 {
            halving.left_out -= 1;
            return;
        }
        if !halving.is_single && !halving.has_first {
            halving.first.clear();
            halving.first.extend_from_slice(row);
            halving.has_first = true;
            return;
        }
        let mut half = std::mem::take(&mut halving.half);
        if halving.is_single {
            halve_rows(row, row, &mut half, self.averaged);
        } else if self.order == RowOrder::TopDown {
            halve_rows(&halving.first, row, &mut half, self.averaged);
        } else {
            halve_rows(row, &halving.first, &mut half, self.averaged);
        }
        halving.has_first = false;
        self.push_to(level + 1, &half);
        self.levels[level].half = half;
    }

    /// The reduced image.
    pub(super) fn finish(self) -> Reduced {
        let (size, order) = (self.size, self.order);
        let (mut texels, alpha) = self.into_rows();
        if order == RowOrder::BottomUp {
            let row_len = size.0 as usize * 4;
            let mut rest = texels.as_mut_slice();
            while rest.len() >= 2 * row_len {
                let (first, others) = rest.split_at_mut(row_len);
                let (between, last) = others.split_at_mut(others.len() - row_len);
                first.swap_with_slice(last);
                rest = between;
            }
        }
        Reduced::new(size, texels, alpha)
    }

    /// The rows of the result in the order in which they came, and the use of alpha.
    fn into_rows(mut self) -> (Vec<u8>, AlphaUse) {
        let len = self.size.0 as usize * 4 * self.size.1 as usize;
        self.texels.resize(len, 0);
        (self.texels, self.alpha)
    }

    /// Bytes of all rows that are in memory, those of the result included.
    #[cfg(test)]
    fn kept_bytes(&self) -> usize {
        let rows = self.levels.iter();
        let rows = rows.map(|level| level.first.capacity() + level.half.capacity());
        self.texels.capacity() + 4 * rows.sum::<usize>()
    }
}

impl Reduced {
    fn new((width, height): (u32, u32), rgba: Vec<u8>, alpha: AlphaUse) -> Self {
        Self {
            alpha: alpha.mode(),
            is_solid: alpha.all_bits >> 24 == 255,
            image: Image {
                width,
                height,
                rgba,
            },
        }
    }
}

impl AlphaUse {
    /// No alpha has come.
    const NONE: Self = Self {
        all_bits: u32::MAX,
        any_bits: 0,
        is_binary: true,
    };

    /// Those of two parts of an image.
    fn and(self, other: Self) -> Self {
        Self {
            all_bits: self.all_bits & other.all_bits,
            any_bits: self.any_bits | other.any_bits,
            is_binary: self.is_binary && other.is_binary,
        }
    }

    fn add(&mut self, row: &[u32]) {
        let (mut all, mut any) = (self.all_bits, self.any_bits);
        for &texel in row {
            all &= texel;
            any |= texel;
        }
        (self.all_bits, self.any_bits) = (all, any);
        if self.is_binary && all >> 24 != 255 {
            self.is_binary = row.iter().all(|texel| matches!(texel >> 24, 0 | 255));
        }
    }

    /// All 255, or all 0, is opaque; 0 and 255 are a mask; all else blends.
    fn mode(self) -> AlphaMode {
        if self.all_bits >> 24 == 255 || self.any_bits >> 24 == 0 {
            AlphaMode::Opaque
        } else if self.is_binary {
            AlphaMode::Mask
        } else {
            AlphaMode::Blend
        }
    }
}

/// Reduces an image that is in memory.
pub(super) fn reduce(
    image: &Image,
    reduction: Reduction,
    workers: Workers,
) -> Result<Reduced, AssetError> {
    let row_len = (image.width as usize * 4).max(4);
    let rows: Vec<&[u8]> = image.rgba.chunks_exact(row_len).collect();
    reduce_rows((image.width, image.height), reduction, workers, |y, row| {
        let texels = rows.get(y).map_or(&[][..], |row| row.as_chunks().0);
        row.extend(texels.iter().map(|&texel| u32::from_le_bytes(texel)));
    })
}

/// Reduces an image whose rows are known, in bands of rows by several threads. `add_row` appends
/// the texels of a row to an empty list.
pub(super) fn reduce_rows(
    (width, height): (u32, u32),
    reduction: Reduction,
    workers: Workers,
    add_row: impl Fn(usize, &mut Vec<u32>) + Sync,
) -> Result<Reduced, AssetError> {
    let level = reduction.level.min(width.max(height).max(1).ilog2());
    // Of an image with fewer rows than a row of the level takes, this is 0: one band.
    let rows_out = height >> level;
    let size = ((width >> level).max(1), rows_out.max(1));
    let bands = u32::try_from(workers.count() * BANDS_PER_THREAD).unwrap_or(u32::MAX);
    let band = rows_out.div_ceil(bands.max(1)).max(1);
    let starts: Vec<u32> = (0..size.1).step_by(band as usize).collect();
    let reduced = workers.map(&starts, |&start| {
        let first = start << level;
        // The last band takes the rows that are left over, too.
        let is_last = start + band >= rows_out;
        let end = if is_last {
            height
        } else {
            (start + band) << level
        };
        let part = Reduction { level, ..reduction };
        let mut reducer = Reducer::new((width, end - first), part, RowOrder::TopDown)?;
        let mut row = Vec::with_capacity(width as usize);
        for y in first..end {
            row.clear();
            add_row(y as usize, &mut row);
            reducer.push(&row);
        }
        Ok(reducer.into_rows())
    });
    let mut texels = allocate_texels(size.0 as usize * size.1 as usize)?;
    let mut alpha = AlphaUse::NONE;
    for part in reduced {
        let (rows, part) = part?;
        texels.extend_from_slice(&rows);
        alpha = alpha.and(part);
    }
    Ok(Reduced::new(size, texels, alpha))
}

/// Bands of rows for each thread, so that none waits long for the others.
const BANDS_PER_THREAD: usize = 4;

#[cfg(test)]
#[expect(
    clippy::cast_possible_truncation,
    reason = "the tests' own rule cuts means to bytes"
)]
mod tests;
