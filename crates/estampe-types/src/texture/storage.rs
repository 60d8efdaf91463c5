//! Textures that shaders store to.

use super::{TextureDimension, TextureShape};
use crate::format::TextureFormat;
use estampe_simd::advise_huge_pages;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

/// A texture of one level that shaders load from and store to, texel by texel, on all threads at
/// once. Clones share the texels. The functions for shaders are in `estampe-texture`.
///
/// Each texel is [`StorageTexture::words_per_texel`] words, which are stored one by one. If several
/// fragments store to one texel, each word has the value of one of them; which one is undefined, as
/// in the specifications.
#[derive(Clone)]
pub struct StorageTexture {
    format: TextureFormat,
    shape: TextureShape,
    width: u32,
    height: u32,
    words_per_texel: usize,
    words: Arc<Vec<AtomicU32>>,
}

impl StorageTexture {
    /// A texture of zeros, or `None` if there is not enough memory.
    #[must_use]
    pub fn zeros(
        format: TextureFormat,
        (width, height): (u32, u32),
        dimension: TextureDimension,
        depth_or_layers: u32,
    ) -> Option<Self> {
        let mut made = Self {
            format,
            shape: TextureShape {
                dimension,
                depth_or_layers,
                samples: 1,
            },
            width,
            height,
            words_per_texel: super::shape::stored_format(format)
                .block_bytes()
                .div_ceil(4) as usize,
            words: Arc::default(),
        };
        let slice = (width as usize).checked_mul(height as usize)?;
        let texels = slice.checked_mul(depth_or_layers as usize)?;
        let count = texels.checked_mul(made.words_per_texel)?;
        let mut words = Vec::new();
        words.try_reserve_exact(count).ok()?;
        advise_huge_pages(words.spare_capacity_mut());
        words.resize_with(count, AtomicU32::default);
        made.words = Arc::new(words);
        Some(made)
    }

    /// Returns true if both are clones that share their texels.
    #[must_use]
    pub fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.words, &other.words)
    }

    /// Format of the texels.
    #[must_use]
    pub fn format(&self) -> TextureFormat {
        self.format
    }

    /// Dimension, depth or layers, and samples.
    #[must_use]
    pub fn shape(&self) -> TextureShape {
        self.shape
    }

    /// Width in texels.
    #[must_use]
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height in texels.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Words per texel, as in a [`TexelData`](super::TexelData).
    #[must_use]
    pub const fn words_per_texel(&self) -> usize {
        self.words_per_texel
    }

    /// Index of the first word of texel (x, y) of a slice (a layer, or a depth); `None` outside the
    /// texture.
    #[inline]
    #[must_use]
    pub fn index(&self, [x, y, slice]: [i32; 3]) -> Option<usize> {
        let [x, y, slice] = [x, y, slice].map(i32::cast_unsigned);
        // A negative coordinate is beyond every side.
        if x >= self.width || y >= self.height || slice >= self.shape.depth_or_layers {
            return None;
        }
        let row = slice as usize * self.height as usize + y as usize;
        Some((row * self.width as usize + x as usize) * self.words_per_texel)
    }

    /// Loads a word; 0 beyond the end.
    #[inline]
    #[must_use]
    pub fn load(&self, index: usize) -> u32 {
        self.words
            .get(index)
            .map_or(0, |word| word.load(Ordering::Relaxed))
    }

    /// Stores a word; does nothing beyond the end.
    #[inline]
    pub fn store(&self, index: usize, word: u32) {
        if let Some(to) = self.words.get(index) {
            to.store(word, Ordering::Relaxed);
        }
    }

    /// The words, unless a clone of the texture lives: they can be read and replaced at the rate of
    /// a copy then.
    #[must_use]
    pub fn own_words(&mut self) -> Option<&mut [AtomicU32]> {
        Some(Arc::get_mut(&mut self.words)?.as_mut_slice())
    }

    /// All words, in the order of [`index`](Self::index).
    #[inline]
    #[must_use]
    pub fn words(&self) -> &[AtomicU32] {
        &self.words
    }

    /// Number of words.
    #[must_use]
    pub fn len(&self) -> usize {
        self.words.len()
    }

    /// True if there are no words.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.words.is_empty()
    }
}

impl std::fmt::Debug for StorageTexture {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { width, height, .. } = self;
        write!(
            f,
            "StorageTexture({:?}, {width}×{height}, {:?})",
            self.format, self.shape
        )
    }
}
