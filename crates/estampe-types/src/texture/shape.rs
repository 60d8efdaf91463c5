//! Shape of a texture besides its width and height, and the layout of its texels in memory.

use super::TexelData;
use crate::format::{TexelEncoding, TextureFormat};

/// Number of axes along which a texture is filtered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum TextureDimension {
    /// One axis: a row of texels.
    D1,
    /// Two axes: an image, or several of one size (arrays, cubes, arrays of cubes).
    #[default]
    D2,
    /// Three axes: a volume of texels.
    D3,
}

/// Shape of a texture besides its width and height.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct TextureShape {
    /// Number of axes along which the texture is filtered.
    pub dimension: TextureDimension,
    /// Depth of the full size of a 3D texture, which is halved from level to level. Otherwise the
    /// number of layers.
    pub depth_or_layers: u32,
    /// Samples per texel: 1 unless the texture is multisampled.
    pub samples: u32,
}

impl Default for TextureShape {
    /// One 2D image with one sample per texel.
    fn default() -> Self {
        Self {
            dimension: TextureDimension::D2,
            depth_or_layers: 1,
            samples: 1,
        }
    }
}

impl TextureShape {
    /// Number of slices of a level: its depth, or the layers.
    #[must_use]
    pub fn slices(&self, level: usize) -> u32 {
        match self.dimension {
            TextureDimension::D3 => (self.depth_or_layers >> level.min(31)).max(1),
            TextureDimension::D1 | TextureDimension::D2 => self.depth_or_layers,
        }
    }
}

impl TexelData {
    /// Format in which the texels are stored in memory: compressed blocks are decoded when a
    /// texture is created, and BGRA becomes RGBA.
    #[must_use]
    pub const fn stored_format(&self) -> TextureFormat {
        stored_format(self.format)
    }

    /// Words per sample of a texel; smaller formats fill the lower bits of one word.
    #[must_use]
    pub const fn words_per_texel(&self) -> usize {
        self.stored_format().block_bytes().div_ceil(4) as usize
    }
}

/// Format in which texels of a format are stored in memory.
///
/// Compressed blocks of 8-bit colours are decoded to 8-bit colours. Blocks of one or two channels
/// have more than 8 bits of precision and become floats. Blocks of half floats become half floats.
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
