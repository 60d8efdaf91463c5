//! Textures as plain data, and how they are to be sampled. Sampling itself is `estampe-texture`'s.

use crate::format::TextureFormat;
use std::sync::Arc;

/// A two-dimensional texture with its mip levels; immutable and shared by reference.
#[derive(Debug, Clone)]
pub struct Texture {
    /// What the texels hold.
    pub format: TextureFormat,
    /// The levels, the full size first; each is half the one before, rounded down, at least 1.
    pub levels: Vec<MipLevel>,
    /// The texels of all levels, row by row from the top: R in the low byte of each word.
    pub texels: Arc<[u32]>,
}

/// One level of a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MipLevel {
    /// Width in texels.
    pub width: u32,
    /// Height in texels.
    pub height: u32,
    /// Where the level begins in [`Texture::texels`].
    pub offset: u32,
}

/// How a coordinate outside 0..1 finds a texel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum AddressMode {
    /// The texel at the border.
    #[default]
    ClampToEdge,
    /// The texture is tiled.
    Repeat,
    /// The texture is tiled, every other tile mirrored.
    MirrorRepeat,
}

/// How texels or mip levels are combined.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum FilterMode {
    /// The nearest one.
    #[default]
    Nearest,
    /// The weighted mean of the neighbours.
    Linear,
}

/// How a texture is sampled. The default is nearest and clamped, as in WebGPU.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SamplerDescriptor {
    /// For u.
    pub address_mode_u: AddressMode,
    /// For v.
    pub address_mode_v: AddressMode,
    /// When the level of detail is ≤ 0: a texel covers a pixel or more.
    pub mag_filter: FilterMode,
    /// When the level of detail is > 0.
    pub min_filter: FilterMode,
    /// Between mip levels.
    pub mipmap_filter: FilterMode,
    /// The least level of detail. Default 0.
    pub lod_min_clamp: f32,
    /// The greatest level of detail. Default 32.
    pub lod_max_clamp: f32,
}

impl Default for SamplerDescriptor {
    fn default() -> Self {
        Self {
            address_mode_u: AddressMode::ClampToEdge,
            address_mode_v: AddressMode::ClampToEdge,
            mag_filter: FilterMode::Nearest,
            min_filter: FilterMode::Nearest,
            mipmap_filter: FilterMode::Nearest,
            lod_min_clamp: 0.0,
            lod_max_clamp: 32.0,
        }
    }
}

impl SamplerDescriptor {
    /// Linear in every direction and between levels, tiled.
    #[must_use]
    pub fn trilinear_repeat() -> Self {
        Self {
            address_mode_u: AddressMode::Repeat,
            address_mode_v: AddressMode::Repeat,
            mag_filter: FilterMode::Linear,
            min_filter: FilterMode::Linear,
            mipmap_filter: FilterMode::Linear,
            ..Self::default()
        }
    }
}
