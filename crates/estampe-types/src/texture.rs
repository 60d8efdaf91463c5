//! Textures as plain data, and how they are to be sampled. Sampling itself is `estampe-texture`'s.

mod sampler;
mod shape;
mod storage;
mod view;

pub use sampler::{AddressMode, BorderColor, FilterMode, SamplerDescriptor};
pub use shape::{TextureDimension, TextureShape};
pub use storage::StorageTexture;
pub use view::{TextureAspect, TextureViewDescriptor, ViewDimension};

use crate::format::TextureFormat;
use crate::{Lines, depth_bounds};
use std::sync::Arc;

/// A texture with its mip levels; immutable and shared by reference.
///
/// Level after level, of each level slice after slice (the layers of an array, six faces a cube, or the depths of
/// a 3D texture), of each slice row after row from the top, of each row texel after texel, of each texel sample
/// after sample: each of [`Texture::words_per_texel`] words, the bytes of [`Texture::stored_format`] from the
/// lowest on.
#[derive(Debug, Clone)]
pub struct Texture {
    /// What the texels are: what they were given as.
    pub format: TextureFormat,
    /// The levels, the full size first; each is half the one before, rounded down, at least 1.
    pub levels: Vec<MipLevel>,
    /// The texels of all levels: of four 8-bit channels R in the low byte of each word.
    pub texels: Arc<[u32]>,
    /// Whether alpha is 255 in every texel, so that samplers may leave it out; `false` is always right.
    pub is_opaque: bool,
    /// What there is beside width and height; by default nothing.
    pub shape: TextureShape,
}

/// One level of a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MipLevel {
    /// Width in texels.
    pub width: u32,
    /// Height in texels.
    pub height: u32,
    /// How many texels are stored before it, samples and slices counted.
    pub offset: u32,
}

/// Side of a block of a [`DepthTexture`], in texels.
pub(crate) const BLOCK: usize = 64;

/// A depth image that shaders compare with, such as a shadow map: what a depth attachment held when it
/// was taken. Cheap to clone.
///
/// It is stored as attachments are: blocks of 64×64 texels in row order, inside a block Morton order
/// (bit i of x is bit 2i, bit i of y is bit 2i + 1), so that an attachment is sampled where it lies. Beside
/// it lie the bounds of each 4×4 texels, row by row: most samples of a shadow map are decided by them.
#[derive(Debug, Clone, Default)]
pub struct DepthTexture {
    width: u32,
    height: u32,
    depths: Arc<Lines<f32>>,
    bounds: Arc<Vec<u32>>,
}

impl DepthTexture {
    /// What depths are multiplied by before they become the halves of [`DepthTexture::bounds`].
    pub const BOUND_SCALE: f32 = 32_768.0;

    /// The longest side.
    pub const MAX_SIDE: u32 = 16_384;

    /// An image from depths row by row from the top. They are confined to 0..=1, NaN becomes 0. Where their
    /// number is not width times height, or a side is longer than [`DepthTexture::MAX_SIDE`], it is empty.
    #[must_use]
    pub fn from_rows(width: u32, height: u32, rows: &[f32]) -> Self {
        if rows.len() as u64 != u64::from(width) * u64::from(height)
            || rows.is_empty()
            || width.max(height) > Self::MAX_SIDE
        {
            return Self::default();
        }
        let blocks = [width, height].map(|side| (side as usize).div_ceil(BLOCK));
        let mut depths = vec![0.0; blocks[0] * blocks[1] * BLOCK * BLOCK];
        for (y, row) in rows.chunks(width.max(1) as usize).enumerate() {
            for (x, depth) in row.iter().enumerate() {
                let block = (y / BLOCK) * blocks[0] + x / BLOCK;
                let inside = spread(x % BLOCK) | spread(y % BLOCK) << 1;
                let clamped = if *depth > 0.0 { depth.min(1.0) } else { 0.0 };
                depths[block * BLOCK * BLOCK + inside] = clamped;
            }
        }
        let mut bounds = vec![0; Self::bounds_len(width, height)];
        let stride = Self::bounds_stride(width);
        for (row, depths) in depths.chunks(blocks[0] * BLOCK * BLOCK).enumerate() {
            let first = row * stride * (BLOCK / 4);
            Self::bound(depths, &mut bounds[first..][..stride * (BLOCK / 4)]);
        }
        Self::from_storage(
            (width, height),
            Arc::new(Lines::from(depths)),
            Arc::new(bounds),
        )
    }

    /// An image from depths in storage order, all in 0..=1, and their bounds. Where these are not of the
    /// size's lengths, the image is empty.
    #[must_use]
    pub fn from_storage(
        (width, height): (u32, u32),
        depths: Arc<Lines<f32>>,
        bounds: Arc<Vec<u32>>,
    ) -> Self {
        let stored =
            Self::bounds_stride(width) * 16 * (height as usize).next_multiple_of(BLOCK) / 4;
        let len = Self::bounds_len(width, height);
        if width == 0
            || height == 0
            || width.max(height) > Self::MAX_SIDE
            || depths.len() != stored
            || bounds.len() != len
        {
            return Self::default();
        }
        Self {
            width,
            height,
            depths,
            bounds,
        }
    }

    /// Width in texels; 0 of an empty image.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height in texels; 0 of an empty image.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The depth of a texel; 0 beyond the image.
    #[must_use]
    pub fn texel(&self, x: u32, y: u32) -> f32 {
        if x >= self.width || y >= self.height {
            return 0.0;
        }
        let (x, y) = (x as usize, y as usize);
        let block = y / BLOCK * (self.width as usize).div_ceil(BLOCK) + x / BLOCK;
        let inside = spread(x % BLOCK) | spread(y % BLOCK) << 1;
        let depth = self.depths.get(block * BLOCK * BLOCK + inside);
        depth.copied().unwrap_or_default()
    }

    /// The depths in storage order, all in 0..=1.
    #[must_use]
    pub fn depths(&self) -> &[f32] {
        &self.depths
    }

    /// Least and greatest depth of each 4×4 texels, row by row, [`DepthTexture::bounds_stride`] to a row:
    /// in units of 1/[`DepthTexture::BOUND_SCALE`], the least rounded down in the low half of a word, the
    /// greatest rounded up in the high half. One word more stands at the end, so that pairs can be read.
    #[must_use]
    pub fn bounds(&self) -> &[u32] {
        &self.bounds
    }

    /// Words in a row of the bounds of an image of a width in texels.
    #[must_use]
    pub fn bounds_stride(width: u32) -> usize {
        (width as usize).next_multiple_of(BLOCK) / 4
    }

    /// Words of the bounds of an image of a size in texels.
    #[must_use]
    pub fn bounds_len(width: u32, height: u32) -> usize {
        Self::bounds_stride(width) * ((height as usize).next_multiple_of(BLOCK) / 4) + 1
    }

    /// The bounds of a row of blocks, in storage order: sixteen rows of words.
    pub fn bound(depths: &[f32], bounds: &mut [u32]) {
        depth_bounds::of_blocks(depths, bounds);
    }
}

/// Moves bit i of a six-bit number to bit 2i.
pub(crate) const fn spread(v: usize) -> usize {
    let v = (v | (v << 4)) & 0x30F;
    let v = (v | (v << 2)) & 0x333;
    (v | (v << 1)) & 0x555
}
