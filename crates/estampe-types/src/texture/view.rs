//! As what, and how much of it, a texture is read.

/// As what a texture is read: WebGPU's `GPUTextureViewDimension`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ViewDimension {
    /// A row of texels.
    D1,
    /// One image; multisampled, if the texture is.
    D2,
    /// Layers, each an image.
    D2Array,
    /// Six layers as the faces +X, −X, +Y, −Y, +Z, −Z of a cube around the origin.
    Cube,
    /// Cubes, six layers each.
    CubeArray,
    /// A block of texels.
    D3,
}

/// Which part of a texture is seen. The default is all of it: an array if there are several layers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct TextureViewDescriptor {
    /// As what it is read.
    pub dimension: Option<ViewDimension>,
    /// The first level, which becomes level 0.
    pub base_mip_level: u32,
    /// How many levels there are; `None`: the rest.
    pub mip_level_count: Option<u32>,
    /// The first layer, which becomes layer 0.
    pub base_array_layer: u32,
    /// How many layers there are, six for each cube; `None`: the rest, of D2 one, of Cube six.
    pub array_layer_count: Option<u32>,
    /// Whether stencil is read where there is depth too.
    pub aspect: TextureAspect,
}

/// The half of a depth-stencil format that is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum TextureAspect {
    /// Colours, or depth where there is depth, else stencil.
    #[default]
    All,
    /// Stencil values.
    Stencil,
}
