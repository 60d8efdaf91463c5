//! How a texture is sampled.

use crate::state::CompareFunction;

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
    /// The texture and its mirror image left of 0; beyond, the texel at the border. (Vulkan's
    /// `MIRROR_CLAMP_TO_EDGE`.)
    MirrorOnce,
    /// The sampler's border colour.
    ClampToBorder,
}

impl AddressMode {
    /// Whether [`AddressMode::Repeat`], [`AddressMode::MirrorRepeat`] or [`AddressMode::ClampToEdge`], those of
    /// WebGPU.
    #[must_use]
    pub const fn is_plain(self) -> bool {
        matches!(self, Self::ClampToEdge | Self::Repeat | Self::MirrorRepeat)
    }
}

/// What lies around a texture whose coordinates are clamped to the border. Channels that the format lacks read
/// there too as 0, alpha as 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum BorderColor {
    /// 0, 0, 0, 0.
    #[default]
    TransparentBlack,
    /// 0, 0, 0, 1.
    OpaqueBlack,
    /// 1, 1, 1, 1.
    OpaqueWhite,
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
    /// For the third coordinate of a 3D texture.
    pub address_mode_w: AddressMode,
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
    /// What is added to every level of detail before it is clamped (Vulkan's `mipLodBias`). Default 0.
    pub lod_bias: f32,
    /// How many times as long as wide a pixel's image in the texture is filtered: 1 to 16. Default 1.
    pub max_anisotropy: u16,
    /// What [`AddressMode::ClampToBorder`] reads.
    pub border_color: BorderColor,
    /// How a comparison sampler compares: `reference OP texel`. Default none.
    pub compare: Option<CompareFunction>,
}

impl Default for SamplerDescriptor {
    fn default() -> Self {
        Self {
            address_mode_u: AddressMode::ClampToEdge,
            address_mode_v: AddressMode::ClampToEdge,
            address_mode_w: AddressMode::ClampToEdge,
            mag_filter: FilterMode::Nearest,
            min_filter: FilterMode::Nearest,
            mipmap_filter: FilterMode::Nearest,
            lod_min_clamp: 0.0,
            lod_max_clamp: 32.0,
            lod_bias: 0.0,
            max_anisotropy: 1,
            border_color: BorderColor::TransparentBlack,
            compare: None,
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
            address_mode_w: AddressMode::Repeat,
            mag_filter: FilterMode::Linear,
            min_filter: FilterMode::Linear,
            mipmap_filter: FilterMode::Linear,
            ..Self::default()
        }
    }
}
