//! Sampler state: addressing, filtering and level of detail.

use crate::state::CompareFunction;

/// Addressing of texels for coordinates outside 0..1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum AddressMode {
    /// The texel at the edge.
    #[default]
    ClampToEdge,
    /// The texture is tiled.
    Repeat,
    /// The texture is tiled, every other tile mirrored.
    MirrorRepeat,
    /// The texture and its mirror image left of 0; beyond these, the texel at the edge. (Vulkan's
    /// `MIRROR_CLAMP_TO_EDGE`.)
    MirrorOnce,
    /// The sampler's border colour.
    ClampToBorder,
}

impl AddressMode {
    /// True for the modes of WebGPU: [`AddressMode::Repeat`], [`AddressMode::MirrorRepeat`] and
    /// [`AddressMode::ClampToEdge`].
    #[must_use]
    pub const fn is_plain(self) -> bool {
        matches!(self, Self::ClampToEdge | Self::Repeat | Self::MirrorRepeat)
    }
}

/// Colour around a texture whose coordinates are clamped to the border. Channels that the format
/// does not store read as 0 there too, alpha as 1.
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

/// Combination of texels or mip levels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum FilterMode {
    /// The nearest one.
    #[default]
    Nearest,
    /// The weighted mean of the neighbours.
    Linear,
}

/// Sampler state. The default is nearest filtering, clamped to the edge, as in WebGPU.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SamplerDescriptor {
    /// Addressing of u.
    pub address_mode_u: AddressMode,
    /// Addressing of v.
    pub address_mode_v: AddressMode,
    /// Addressing of the third coordinate of a 3D texture.
    pub address_mode_w: AddressMode,
    /// Filter if the level of detail is ≤ 0: a texel covers a pixel or more.
    pub mag_filter: FilterMode,
    /// Filter if the level of detail is > 0.
    pub min_filter: FilterMode,
    /// Combination of mip levels.
    pub mipmap_filter: FilterMode,
    /// The least level of detail. Default 0.
    pub lod_min_clamp: f32,
    /// The greatest level of detail. Default 32.
    pub lod_max_clamp: f32,
    /// Bias that is added to the level of detail before it is clamped (Vulkan's `mipLodBias`).
    /// Default 0.
    pub lod_bias: f32,
    /// Greatest anisotropy: the ratio of length to width up to which a pixel's footprint in the
    /// texture is filtered, 1 to 16. Default 1.
    pub max_anisotropy: u16,
    /// Colour for [`AddressMode::ClampToBorder`].
    pub border_color: BorderColor,
    /// Comparison of a comparison sampler: `reference OP texel`. Default none.
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
    /// Linear filtering of the nearest mip level, clamped to the edge.
    #[must_use]
    pub fn linear() -> Self {
        Self {
            mag_filter: FilterMode::Linear,
            min_filter: FilterMode::Linear,
            ..Self::default()
        }
    }

    /// Linear filtering within and between mip levels, repeated.
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
