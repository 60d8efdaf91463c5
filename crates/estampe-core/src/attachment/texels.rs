//! The texels of one image as attachments store them: one mip level of one layer of a texture.

use super::depth_texture::DepthBounds;
use crate::depth_format::DepthFormat;
use crate::layout::{TileGrid, texel_words};
use estampe_types::{Lines, TextureFormat};
use std::sync::Arc;

/// The size of an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ImageSize {
    /// Width in pixels, 1 to 16384.
    pub width: u32,
    /// Height in pixels, 1 to 16384.
    pub height: u32,
    /// Samples per pixel: 1, 2, 4, 8 or 16.
    pub samples: u32,
}

impl ImageSize {
    /// The tiles of a pass that one thread draws.
    pub(crate) fn grid(self) -> TileGrid {
        TileGrid::new(self.width, self.height, self.samples)
    }

    /// The number of samples that are stored, with the padding to whole tiles.
    pub(super) fn stored_samples(self) -> usize {
        self.grid().stored_pixels() * self.samples as usize
    }
}

/// A colour image in storage order.
#[derive(Debug, Clone)]
pub struct ColorTexels {
    pub(super) format: TextureFormat,
    pub(super) size: ImageSize,
    /// A texel of each sample is one, two or four [`words`](crate::layout::texel_words) of sixteen
    /// lanes. RGBA8 has R in the low byte, BGRA8 B. Shared with who reads the image in this order;
    /// drawing while somebody does draws into a copy.
    pub(super) words: Arc<Lines<u32>>,
}

impl ColorTexels {
    /// An image of zeros; `None` if memory is short. The format must be renderable.
    #[must_use]
    pub fn zeros(format: TextureFormat, size: ImageSize) -> Option<Self> {
        debug_assert!(
            format.is_renderable(),
            "{} is not renderable",
            format.name()
        );
        let words = size.stored_samples().checked_mul(texel_words(format))?;
        Some(Self {
            format,
            size,
            words: Arc::new(Lines::zeros(words)?),
        })
    }

    /// An image without memory, for a pass that clears it first and discards it last. A pass that
    /// needs its memory takes it.
    #[must_use]
    pub fn without_memory(format: TextureFormat, size: ImageSize) -> Self {
        Self {
            format,
            size,
            words: Arc::default(),
        }
    }

    /// False for an image [without memory](Self::without_memory) that no pass has needed.
    #[must_use]
    pub fn has_memory(&self) -> bool {
        !self.words.is_empty()
    }

    /// Reinterprets the texels in another format, which differs in sRGB alone.
    #[must_use]
    pub fn with_format(self, format: TextureFormat) -> Self {
        debug_assert_eq!(format.with_srgb(false), self.format.with_srgb(false));
        Self { format, ..self }
    }

    /// Replaces the texels by those of an image of the same size, whose format differs at most in
    /// sRGB.
    pub fn copy_from(&mut self, from: &Self) {
        debug_assert_eq!(from.format.with_srgb(false), self.format.with_srgb(false));
        debug_assert_eq!(from.size, self.size);
        self.words_mut().copy_from_slice(&from.words);
    }

    /// The texels in storage order, to be changed.
    pub(crate) fn words_mut(&mut self) -> &mut Lines<u32> {
        Arc::make_mut(&mut self.words)
    }

    /// The texels in storage order; none of an image without memory.
    #[must_use]
    pub fn words(&self) -> &Arc<Lines<u32>> {
        &self.words
    }

    /// The format of the texels.
    #[must_use]
    pub fn format(&self) -> TextureFormat {
        self.format
    }
}

/// A depth and stencil image in storage order; either of them may be missing.
#[derive(Debug, Clone)]
pub struct DepthStencilTexels {
    pub(super) format: TextureFormat,
    pub(super) size: ImageSize,
    /// One element per sample; empty without depth. Shared with the depth textures that were taken
    /// of it; drawing while one lives draws into a copy. What changes it goes through
    /// [`DepthStencilTexels::depths_mut`] or [`DepthStencilTexels::tiles_mut`].
    pub(super) depth: Arc<Lines<f32>>,
    /// One byte per sample; empty without stencil.
    pub(crate) stencil: Lines<u8>,
    pub(super) bounds: DepthBounds,
}

impl DepthStencilTexels {
    /// An image of zeros; `None` if memory is short. The format must have depth or stencil.
    #[must_use]
    pub fn zeros(format: TextureFormat, size: ImageSize) -> Option<Self> {
        let samples = size.stored_samples();
        let depth = if format.has_depth() { samples } else { 0 };
        let stencil = if format.has_stencil() { samples } else { 0 };
        Some(Self {
            format,
            size,
            depth: Arc::new(Lines::zeros(depth)?),
            stencil: Lines::zeros(stencil)?,
            bounds: DepthBounds::default(),
        })
    }

    /// An image without memory: see [`ColorTexels::without_memory`].
    #[must_use]
    pub fn without_memory(format: TextureFormat, size: ImageSize) -> Self {
        Self {
            format,
            size,
            depth: Arc::default(),
            stencil: Lines::default(),
            bounds: DepthBounds::default(),
        }
    }

    /// False for an image [without memory](Self::without_memory) that no pass has needed.
    #[must_use]
    pub fn has_memory(&self) -> bool {
        !self.depth.is_empty() || !self.stencil.is_empty()
    }

    /// The format of the texels.
    #[must_use]
    pub fn format(&self) -> TextureFormat {
        self.format
    }

    /// The size of the image.
    #[must_use]
    pub fn size(&self) -> ImageSize {
        self.size
    }

    /// Replaces depths and stencil values by those of an image of the same size and format.
    pub fn copy_from(&mut self, from: &Self) {
        debug_assert_eq!((from.format, from.size), (self.format, self.size));
        self.depths_mut().copy_from_slice(&from.depth);
        self.stencil.copy_from_slice(&from.stencil);
    }

    /// The depths in storage order; none of an image without depth or memory.
    #[must_use]
    pub fn depths(&self) -> &Arc<Lines<f32>> {
        &self.depth
    }

    pub(crate) fn depth_format(&self) -> DepthFormat {
        DepthFormat::new(Some(self.format))
    }
}
