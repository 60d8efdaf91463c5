//! Texture descriptors: validation, and creation of textures of every dimension and format from the
//! format's own bytes.

use crate::upload::{self, LevelData};
use crate::{MipGeneration, TextureError, generate, region};
use estampe_types::{
    Limits, Lines, MipLevel, TexelData, TextureDimension, TextureFormat, TextureShape,
};
use std::sync::Arc;

/// The most 32-bit words of a texture: their indices fit the signed 32-bit integers of lane code.
const MAX_WORDS: u64 = i32::MAX as u64;

/// The longest side of a 3D texture.
const MAX_SIDE_3D: u32 = 2048;

/// The most layers of an array.
const MAX_LAYERS: u32 = 256;

/// Describes a texture to create: WebGPU's `GPUTextureDescriptor`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TexelDescriptor {
    /// Dimension: the number of axes along which the texture is filtered.
    pub dimension: TextureDimension,
    /// Width in texels, 1 to 16384 (3D: 2048).
    pub width: u32,
    /// Height in texels, 1 to 16384 (3D: 2048); 1 for a 1D texture.
    pub height: u32,
    /// Depth of a 3D texture, 1 to 2048; otherwise the number of array layers, 1 to 256 (1D: 1),
    /// six per cube.
    pub depth_or_layers: u32,
    /// Number of mip levels: 1 up to the length of the chain from the full size down to one texel.
    pub mip_level_count: u32,
    /// Samples per texel: 1, or 2, 4, 8 or 16 for a 2D texture of one level and an uncompressed
    /// format.
    pub sample_count: u32,
    /// Format of the texels.
    pub format: TextureFormat,
}

impl TexelDescriptor {
    /// A 2D texture of one level.
    #[must_use]
    pub fn new_2d(width: u32, height: u32, format: TextureFormat) -> Self {
        Self {
            dimension: TextureDimension::D2,
            width,
            height,
            depth_or_layers: 1,
            mip_level_count: 1,
            sample_count: 1,
            format,
        }
    }

    /// This descriptor with all mip levels down to one texel.
    #[must_use]
    pub fn with_all_levels(self) -> Self {
        Self {
            mip_level_count: self.most_levels(),
            ..self
        }
    }

    /// Creates the texture from the data of its first levels. The other levels are generated from
    /// those if `mips` says so, else they are zeros: in compressed formats blocks of zero bytes.
    /// The descriptor alone determines the number of levels.
    ///
    /// # Errors
    /// [`TextureError`] when the descriptor breaks one of its rules, bytes are missing, or memory
    /// is short.
    pub fn create(
        &self,
        data: &[LevelData<'_>],
        mips: MipGeneration,
        limits: &Limits,
    ) -> Result<TexelData, TextureError> {
        self.check(limits)?;
        if data.len() > self.mip_level_count as usize {
            return Err(TextureError::LevelCount {
                most: self.mip_level_count as usize,
                actual: data.len(),
            });
        }
        let mut texture = TexelData {
            format: self.format,
            levels: Vec::new(),
            texels: Arc::default(),
            is_opaque: false,
            alpha_maps: Arc::default(),
            squares: Arc::default(),
            shape: self.shape(),
        };
        let count = self.mip_level_count as usize;
        let made = data.len().max(1)..count;
        if mips == MipGeneration::Full && !made.is_empty() && !generate::is_possible(&texture) {
            return Err(TextureError::MipGeneration {
                format: self.format,
            });
        }
        let mut texels = 0;
        for level in 0..count {
            let (width, height) = self.size_of(level);
            // No bits are lost: `check` limits the words of all levels to 31 bits.
            let offset = u32::try_from(texels).unwrap_or(u32::MAX);
            texture.levels.push(MipLevel {
                width,
                height,
                offset,
            });
            texels += self.texels_of(level);
        }
        let texels = usize::try_from(texels).unwrap_or(usize::MAX);
        let mut words = zeros(texels.saturating_mul(texture.words_per_texel()))?;
        for (level, data) in data.iter().enumerate() {
            upload::level(&texture, level, data, &mut words)?;
        }
        if self.format.is_compressed() {
            for level in data.len()..count {
                for slice in 0..texture.shape.slices(level) as usize {
                    region::write_zeros(&texture, level, slice, &mut words);
                }
            }
        }
        if mips == MipGeneration::Full {
            for level in made {
                generate::level(&texture, level, &mut words);
            }
        }
        texture.is_opaque = texture.stored_format() == TextureFormat::Rgba8Unorm
            && words.iter().all(|word| word >> 24 == 255);
        texture.texels = Arc::new(words);
        Ok(texture)
    }

    /// A texture with the levels of the descriptor and no texels: to check views. The descriptor
    /// must keep its [rules](TexelDescriptor::check).
    #[must_use]
    pub fn without_texels(&self) -> TexelData {
        let mut first = 0_u64;
        let levels = (0..self.mip_level_count as usize).map(|level| {
            let (width, height) = self.size_of(level);
            let offset = u32::try_from(first).unwrap_or(u32::MAX);
            first += self.texels_of(level);
            MipLevel {
                width,
                height,
                offset,
            }
        });
        TexelData {
            format: self.format,
            levels: levels.collect(),
            texels: Arc::default(),
            is_opaque: false,
            alpha_maps: Arc::default(),
            squares: Arc::default(),
            shape: self.shape(),
        }
    }

    /// Checks the rules of the descriptor, before any of its sizes is used.
    ///
    /// # Errors
    /// [`TextureError`] names the rule that it breaks.
    pub fn check(&self, limits: &Limits) -> Result<(), TextureError> {
        let (width, height, slices) = (self.width, self.height, self.depth_or_layers);
        if width == 0 || height == 0 {
            return Err(TextureError::Empty { width, height });
        }
        let is_3d = self.dimension == TextureDimension::D3;
        let limit = if is_3d {
            MAX_SIDE_3D.min(limits.max_texture_dimension_2d)
        } else {
            limits.max_texture_dimension_2d
        };
        if width > limit || height > limit {
            return Err(TextureError::TooLarge {
                width,
                height,
                limit,
            });
        }
        let most_slices = match self.dimension {
            TextureDimension::D1 => 1,
            TextureDimension::D2 => MAX_LAYERS,
            TextureDimension::D3 => limit,
        };
        if slices == 0
            || slices > most_slices
            || (self.dimension == TextureDimension::D1 && height != 1)
        {
            return Err(TextureError::Slices {
                dimension: self.dimension,
                height,
                slices,
                most: most_slices,
            });
        }
        let is_flat = self.dimension == TextureDimension::D2;
        let has_blocks = self.format.is_compressed();
        let is_depth = self.format.has_depth() || self.format.has_stencil();
        if !is_flat && (has_blocks || is_depth) {
            return Err(TextureError::NotFlat {
                format: self.format,
            });
        }
        let (most, levels) = (self.most_levels(), self.mip_level_count);
        if levels == 0 || levels > most {
            return Err(TextureError::LevelCount {
                most: most as usize,
                actual: levels as usize,
            });
        }
        let samples = self.sample_count;
        let is_multisampled = samples != 1;
        if !matches!(samples, 1 | 2 | 4 | 8 | 16)
            || is_multisampled && (!is_flat || has_blocks || levels != 1)
        {
            return Err(TextureError::Samples { samples });
        }
        let texels = (0..levels as usize)
            .map(|level| self.texels_of(level))
            .fold(0, u64::saturating_add);
        let words = u64::from(self.stored_words());
        if texels.saturating_mul(words) > MAX_WORDS {
            return Err(TextureError::TooManyTexels { texels });
        }
        Ok(())
    }

    /// The texture's dimension, its depth or layers, and its samples.
    pub(crate) fn shape(&self) -> TextureShape {
        TextureShape {
            dimension: self.dimension,
            depth_or_layers: self.depth_or_layers,
            samples: self.sample_count,
        }
    }

    fn stored_words(&self) -> u32 {
        let texture = TexelData {
            format: self.format,
            levels: Vec::new(),
            texels: Arc::default(),
            is_opaque: false,
            alpha_maps: Arc::default(),
            squares: Arc::default(),
            shape: self.shape(),
        };
        texture.stored_format().block_bytes().div_ceil(4)
    }

    /// The number of levels from the full size down to one texel.
    fn most_levels(&self) -> u32 {
        let depth = match self.dimension {
            TextureDimension::D3 => self.depth_or_layers,
            TextureDimension::D1 | TextureDimension::D2 => 1,
        };
        self.width.max(self.height).max(depth).max(1).ilog2() + 1
    }

    fn size_of(&self, level: usize) -> (u32, u32) {
        ((self.width >> level).max(1), (self.height >> level).max(1))
    }

    /// The number of texels of a level, over all slices and samples.
    fn texels_of(&self, level: usize) -> u64 {
        let (width, height) = self.size_of(level);
        let slices = self.shape().slices(level);
        // At most 2¹⁴ · 2¹⁴ · 2¹¹ · 2⁴.
        u64::from(width) * u64::from(height) * u64::from(slices) * u64::from(self.sample_count)
    }
}

/// Allocates zeros; an error if there is not enough memory.
pub(crate) fn zeros(count: usize) -> Result<Lines<u32>, TextureError> {
    let bytes = count as u64 * 4;
    Lines::zeros(count).ok_or(TextureError::OutOfMemory { bytes })
}
