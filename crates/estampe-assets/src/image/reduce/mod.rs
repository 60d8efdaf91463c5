//! Reduction of images while they are decoded: row by row to a mip level, so that the full image is
//! never in memory.
//!
//! ```text
//!   rows of the file -> halves of halves … -> rows of the level
//! ```
//!
//! The rule is that of the pipeline's mip levels: the mean of 2×2 texels, rounded at each level, a
//! side halved and rounded down, at least 1. So the result has the bytes of the level that a texture
//! of the full image would have, and a picture that samples only this level and smaller ones is the
//! same. A larger box filter over the file's texels rounds once instead of once per level; it was
//! not chosen, because then pictures would change.

use estampe_format::box_filter::{Averaged, halve_rows};
use estampe_scene::{AlphaMode, Image};

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
/// always averaged as it is stored, and colours are not weighted with it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TexelContent {
    /// sRGB colours, averaged as linear light.
    Color,
    /// Numbers, such as normals and heights, averaged as they are stored.
    Number,
}

/// A reduced image, and the use of the alpha of the whole one: all 255 or all 0 is opaque.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Reduced {
    pub(crate) image: Image,
    pub(crate) alpha: AlphaMode,
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
            averaged: Averaged::of(reduction.content == TexelContent::Color),
            order,
            levels,
            size,
            texels: allocate_texels(size.0 as usize * size.1 as usize)?,
            alpha: AlphaUse {
                all_bits: u32::MAX,
                any_bits: 0,
                is_binary: true,
            },
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
    pub(super) fn finish(mut self) -> Reduced {
        let (width, height) = self.size;
        let row_len = width as usize * 4;
        self.texels.resize(row_len * height as usize, 0);
        if self.order == RowOrder::BottomUp {
            let mut rest = self.texels.as_mut_slice();
            while rest.len() >= 2 * row_len {
                let (first, others) = rest.split_at_mut(row_len);
                let (between, last) = others.split_at_mut(others.len() - row_len);
                first.swap_with_slice(last);
                rest = between;
            }
        }
        Reduced {
            alpha: self.alpha.mode(),
            image: Image {
                width,
                height,
                rgba: self.texels,
            },
        }
    }
}

impl AlphaUse {
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
pub(super) fn reduce(image: &Image, reduction: Reduction) -> Result<Reduced, AssetError> {
    let size = (image.width, image.height);
    let mut reducer = Reducer::new(size, reduction, RowOrder::TopDown)?;
    let mut row = Vec::with_capacity(image.width as usize);
    for texels in image.rgba.chunks_exact((image.width as usize * 4).max(4)) {
        row.clear();
        row.extend(texels.as_chunks().0.iter().map(|&t| u32::from_le_bytes(t)));
        reducer.push(&row);
    }
    Ok(reducer.finish())
}

#[cfg(test)]
#[expect(
    clippy::cast_possible_truncation,
    reason = "the tests' own rule cuts means to bytes"
)]
mod tests;
