//! Texture views: how a texture's dimension, mip levels and layers are reinterpreted.

/// Dimension of a view: WebGPU's `GPUTextureViewDimension`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ViewDimension {
    /// A row of texels.
    D1,
    /// One image; multisampled if the texture is.
    D2,
    /// Layers, each of which is an image.
    D2Array,
    /// Six layers as the faces +X, −X, +Y, −Y, +Z, −Z of a cube around the origin.
    Cube,
    /// Cubes, six layers each.
    CubeArray,
    /// A volume of texels.
    D3,
}

/// The part of a texture that a view shows. The default is the whole texture, as an array if it has
/// several layers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct TexelViewDescriptor {
    /// Dimension of the view. `None` is the texture's dimension; a 2D texture with several layers
    /// becomes [`ViewDimension::D2Array`].
    pub dimension: Option<ViewDimension>,
    /// First level of the texture; it is level 0 of the view.
    pub base_mip_level: u32,
    /// Number of levels; `None` for all remaining ones.
    pub mip_level_count: Option<u32>,
    /// First layer of the texture; it is layer 0 of the view.
    pub base_array_layer: u32,
    /// Number of layers, six per cube. `None` for all remaining ones; for `D2` one, for `Cube` six.
    pub array_layer_count: Option<u32>,
    /// Aspect of a depth-stencil format that is read.
    pub aspect: TextureAspect,
}

/// Aspect of a depth-stencil format.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum TextureAspect {
    /// Colour, or depth if the format has it, else stencil.
    #[default]
    All,
    /// Depths.
    Depth,
    /// Stencil values.
    Stencil,
}
