//! Textures as plain data, their views and sampler state. `estampe-texture` samples them.

mod byte_squares;
mod sampler;
mod shape;
mod storage;
mod view;

pub use byte_squares::ByteSquares;
pub use sampler::{AddressMode, BorderColor, FilterMode, SamplerDescriptor};
pub use shape::{TextureDimension, TextureShape};
pub use storage::StorageTexture;
pub use view::{TexelViewDescriptor, TextureAspect, ViewDimension};

use crate::format::TextureFormat;
use crate::morton::spread;
use crate::shader::AlphaMaps;
use crate::{Lines, depth_minmax};
use estampe_simd::Level;
use std::sync::{Arc, LazyLock};

/// A texture with its mip levels; immutable and shared by reference.
///
/// Texels are stored level by level; in each level slice by slice (the layers of an array, six
/// faces per cube, or the depths of a 3D texture); in each slice row by row from the top; in each
/// row texel by texel; in each texel sample by sample. A sample takes
/// [`TexelData::words_per_texel`] words, which hold the bytes of [`TexelData::stored_format`] from
/// the lowest on.
#[derive(Debug, Clone)]
pub struct TexelData {
    /// Format with which the texture was created.
    pub format: TextureFormat,
    /// The levels, the full size first. Each side is half that of the level before, rounded down,
    /// at least 1.
    pub levels: Vec<MipLevel>,
    /// The texels of all levels. Formats with four 8-bit channels have R in the low byte of each
    /// word.
    pub texels: Arc<Lines<u32>>,
    /// True if alpha is 255 in every texel, so that samplers may skip it; `false` is always
    /// correct.
    pub is_opaque: bool,
    /// Dimension, depth or layers, and samples. The default is one 2D image with one sample per
    /// texel.
    pub shape: TextureShape,
    /// Where alpha may pass tests: what was found of these texels. Other texels need new maps.
    pub alpha_maps: Arc<AlphaMaps>,
    /// The squares of texels of one byte, once they are made. Other texels need new ones.
    pub squares: Arc<ByteSquares>,
}

impl TexelData {
    /// Takes the texels out and leaves none, which allocates no memory.
    pub fn take_texels(&mut self) -> Arc<Lines<u32>> {
        static NONE: LazyLock<Arc<Lines<u32>>> = LazyLock::new(Arc::default);
        self.alpha_maps = Arc::default();
        self.squares = Arc::default();
        std::mem::replace(&mut self.texels, Arc::clone(&NONE))
    }
}

/// One level of a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MipLevel {
    /// Width in texels.
    pub width: u32,
    /// Height in texels.
    pub height: u32,
    /// Number of texels stored before this level, all samples and slices counted.
    pub offset: u32,
}

/// Side of a storage block of a [`ShadowMap`], in texels.
pub(crate) const BLOCK: usize = 64;

/// A depth texture for comparisons in shaders, such as a shadow map: a copy of a depth attachment's
/// contents. Cheap to clone.
///
/// It is stored as attachments are, so that an attachment is sampled in place: 64×64 storage blocks
/// in row order, and Morton order inside a block (bit i of x is bit 2i, bit i of y is bit 2i + 1).
/// The depth min/max of windows of 8×8 texels is stored row by row; it decides most samples of a
/// shadow map.
#[derive(Debug, Clone, Default)]
pub struct ShadowMap {
    width: u32,
    height: u32,
    depths: Arc<Lines<f32>>,
    windows: Arc<Vec<u32>>,
}

impl ShadowMap {
    /// Scale by which depths are multiplied before they are stored in [`ShadowMap::windows`].
    pub const BOUND_SCALE: f32 = 32_768.0;

    /// The greatest width and height, in texels.
    pub const MAX_SIDE: u32 = 16_384;

    /// A texture from depths row by row from the top, clamped to 0..=1; NaN becomes 0. The texture
    /// is empty if the number of depths is not width times height, or if a side exceeds
    /// [`ShadowMap::MAX_SIDE`].
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
        for (y, row) in (0..).zip(rows.chunks(width as usize)) {
            for (x, depth) in (0..).zip(row) {
                let clamped = if *depth > 0.0 { depth.min(1.0) } else { 0.0 };
                depths[storage_index(x, y, blocks[0])] = clamped;
            }
        }
        let mut bounds = vec![0; Self::bounds_len(width, height)];
        let stride = Self::bounds_stride(width);
        for (block, depths) in depths.chunks_exact(BLOCK * BLOCK).enumerate() {
            let (x, y) = (block % blocks[0], block / blocks[0]);
            let first = y * stride * (BLOCK / 4) + x * (BLOCK / 4);
            let rows = bounds[first..].chunks_mut(stride);
            for (row, of_row) in rows.zip(Self::bounds_of_block(Level::best(), depths)) {
                row[..BLOCK / 4].copy_from_slice(&of_row);
            }
        }
        let mut windows = vec![0; bounds.len()];
        Self::find_windows(Level::best(), stride, &bounds, &mut windows);
        Self::from_storage(
            (width, height),
            Arc::new(Lines::from(depths)),
            Arc::new(windows),
        )
    }

    /// A texture from depths in storage order, all in 0..=1, and their windows. The texture is
    /// empty if the lengths do not fit the size.
    #[must_use]
    pub fn from_storage(
        (width, height): (u32, u32),
        depths: Arc<Lines<f32>>,
        windows: Arc<Vec<u32>>,
    ) -> Self {
        let stored =
            Self::bounds_stride(width) * 16 * (height as usize).next_multiple_of(BLOCK) / 4;
        let len = Self::bounds_len(width, height);
        if width == 0
            || height == 0
            || width.max(height) > Self::MAX_SIDE
            || depths.len() != stored
            || windows.len() != len
        {
            return Self::default();
        }
        Self {
            width,
            height,
            depths,
            windows,
        }
    }

    /// Width in texels; 0 if the texture is empty.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height in texels; 0 if the texture is empty.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The depth of a texel; 0 outside the texture.
    #[must_use]
    pub fn texel(&self, x: u32, y: u32) -> f32 {
        if x >= self.width || y >= self.height {
            return 0.0;
        }
        let index = storage_index(x, y, (self.width as usize).div_ceil(BLOCK));
        let depth = self.depths.get(index);
        depth.copied().unwrap_or_default()
    }

    /// The depths in storage order, all in 0..=1.
    #[must_use]
    pub fn depths(&self) -> &[f32] {
        &self.depths
    }

    /// Depth min/max of the 8×8 texels from each 4×4 texels on, as far as they are in the texture's
    /// storage blocks: row by row, [`ShadowMap::bounds_stride`] words per row, in units of
    /// 1/[`ShadowMap::BOUND_SCALE`]. The least depth rounded down is in the low half of a word, the
    /// greatest rounded up in the high half.
    ///
    /// Samples beside each other most often read texels of one such window.
    #[must_use]
    pub fn windows(&self) -> &[u32] {
        &self.windows
    }

    /// Words per row of the bounds of a texture, and of its windows, given its width in texels.
    #[must_use]
    pub fn bounds_stride(width: u32) -> usize {
        (width as usize).next_multiple_of(BLOCK) / 4
    }

    /// Words of the bounds of a texture, and of its windows, given its size in texels.
    #[must_use]
    pub fn bounds_len(width: u32, height: u32) -> usize {
        Self::bounds_stride(width) * ((height as usize).next_multiple_of(BLOCK) / 4)
    }

    /// Computes the bounds of one storage block, the min/max of each 4×4 depths: sixteen rows of
    /// words.
    #[must_use]
    pub fn bounds_of_block(level: Level, depths: &[f32]) -> [[u32; BLOCK / 4]; BLOCK / 4] {
        depth_minmax::of_block(level, depths)
    }

    /// The bounds of 4×4 texels of one depth in 0..=1.
    #[must_use]
    pub fn bounds_of_depth(depth: f32) -> u32 {
        depth_minmax::of_depth(depth)
    }

    /// Joins the bounds of 4×4 texels to those of [`ShadowMap::windows`], so many rows of `stride`
    /// words as `windows` has; `bounds` may have one more.
    pub fn find_windows(level: Level, stride: usize, bounds: &[u32], windows: &mut [u32]) {
        depth_minmax::windows(level, stride, bounds, windows);
    }
}

/// The index in storage order of texel (x, y) of a depth texture that is `blocks` blocks wide.
fn storage_index(x: u32, y: u32, blocks: usize) -> usize {
    let block = y as usize / BLOCK * blocks + x as usize / BLOCK;
    block * BLOCK * BLOCK + (spread(x) | spread(y) << 1) as usize
}
