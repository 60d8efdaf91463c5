//! What a texture is beside its width and height, and how its texels lie in memory.

use super::Texture;
use crate::format::{TexelEncoding, TextureFormat};

/// Along how many axes a texture is filtered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum TextureDimension {
    /// A row of texels.
    D1,
    /// An image, or several of one size: arrays, cubes, arrays of cubes.
    #[default]
    D2,
    /// A block of texels.
    D3,
}

/// What a texture is beside its width and height.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct TextureShape {
    /// Along how many axes it is filtered.
    pub dimension: TextureDimension,
    /// The depth of a 3D texture's full size, halved from level to level; else how many layers each level has.
    pub depth_or_layers: u32,
    /// Samples of each texel: 1 unless it is multisampled.
    pub samples: u32,
}

impl Default for TextureShape {
    /// One image with one sample a texel.
    fn default() -> Self {
        Self {
            dimension: TextureDimension::D2,
            depth_or_layers: 1,
            samples: 1,
        }
    }
}

impl TextureShape {
    /// How many slices a level has: its depth, or the layers.
    #[must_use]
    pub fn slices(&self, level: usize) -> u32 {
        match self.dimension {
            TextureDimension::D3 => (self.depth_or_layers >> level.min(31)).max(1),
            TextureDimension::D1 | TextureDimension::D2 => self.depth_or_layers,
        }
    }
}

impl Texture {
    /// As what the texels lie in memory: blocks are decoded when a texture is made, and B is moved behind G.
    #[must_use]
    pub const fn stored_format(&self) -> TextureFormat {
        stored_format(self.format)
    }

    /// Words of each sample of a texel: smaller formats fill the lower bits of one.
    #[must_use]
    pub const fn words_per_texel(&self) -> usize {
        self.stored_format().block_bytes().div_ceil(4) as usize
    }
}

/// As what texels of a format lie in memory.
///
/// What blocks of 8-bit colours decode to are such colours; those of one or two channels have more than 8 bits and
/// become floats, those of half floats stay so.
pub(super) const fn stored_format(format: TextureFormat) -> TextureFormat {
    use TextureFormat as F;
    match format {
        F::Bgra8Unorm => F::Rgba8Unorm,
        F::Bgra8UnormSrgb => F::Rgba8UnormSrgb,
        F::Bc4RUnorm | F::Bc4RSnorm | F::EacR11Unorm | F::EacR11Snorm => F::R32Float,
        F::Bc5RgUnorm | F::Bc5RgSnorm | F::EacRg11Unorm | F::EacRg11Snorm => F::Rg32Float,
        F::Bc6hRgbUfloat | F::Bc6hRgbFloat => F::Rgba16Float,
        _ if !matches!(format.encoding(), TexelEncoding::Compressed) => format,
        _ if format.is_srgb() => F::Rgba8UnormSrgb,
        _ => F::Rgba8Unorm,
    }
}
