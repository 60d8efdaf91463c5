//! Views of textures, and samplers.

use super::{ImageKey, Texture, TextureError};
use crate::Context;
use estampe_texture::{SampledTexture, TexelView};
use estampe_types::{
    SamplerDescriptor, TexelViewDescriptor, TextureAspect, TextureDimension, TextureFormat,
    ViewDimension,
};
use std::sync::Arc;

/// Describes a view: WebGPU's `GPUTextureViewDescriptor`. The default is all of the texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct TextureViewDescriptor {
    /// The format that the texels are read and written as: the texture's, or its sRGB or linear
    /// counterpart. Default the texture's.
    pub format: Option<TextureFormat>,
    /// Dimension of the view. Default the texture's; a 2D texture with several layers becomes an
    /// array.
    pub dimension: Option<ViewDimension>,
    /// First level of the texture; it is level 0 of the view. Default 0.
    pub base_mip_level: u32,
    /// Number of levels. Default all remaining ones.
    pub mip_level_count: Option<u32>,
    /// First layer of the texture; it is layer 0 of the view. Default 0.
    pub base_array_layer: u32,
    /// Number of layers, six per cube. Default all remaining ones; for `D2` one, for `Cube` six.
    pub array_layer_count: Option<u32>,
    /// Aspect of a depth-stencil format that is read. Default depth, or stencil without depth.
    pub aspect: TextureAspect,
}

/// A part of a texture as it is sampled, rendered to or copied. Cheap to clone.
///
/// ```
/// use estampe::{Device, DeviceDescriptor, Extent3d, TextureDescriptor, TextureFormat};
/// use estampe::{TextureViewDescriptor, ViewDimension};
///
/// let device = Device::new(&DeviceDescriptor::default())?;
/// let six = Extent3d { width: 64, height: 64, depth_or_array_layers: 6 };
/// let faces = device.create_texture(&TextureDescriptor {
///     size: six,
///     ..TextureDescriptor::new_2d(64, 64, TextureFormat::Rgba8UnormSrgb)
/// })?;
/// // Rendered to face by face, sampled as a cube.
/// let top = faces.image(0, 2)?;
/// assert_eq!((top.size(), top.array_layers()), ([64, 64], [2, 1]));
/// let cube = faces.create_view(&TextureViewDescriptor {
///     dimension: Some(ViewDimension::Cube),
///     ..TextureViewDescriptor::default()
/// })?;
/// assert_eq!(cube.array_layers(), [0, 6]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct TextureView {
    texture: Texture,
    format: TextureFormat,
    dimension: ViewDimension,
    levels: [u32; 2],
    layers: [u32; 2],
    aspect: TextureAspect,
}

impl Texture {
    /// A view of the texture.
    ///
    /// # Errors
    /// [`TextureError`] if the texture does not have what the descriptor asks for.
    pub fn create_view(
        &self,
        descriptor: &TextureViewDescriptor,
    ) -> Result<TextureView, TextureError> {
        let format = descriptor.format.unwrap_or(self.format());
        if format != self.format() && format.with_srgb(self.format().is_srgb()) != self.format() {
            return Err(TextureError::Unsupported {
                texture: self.name(),
                format: self.format(),
                samples: self.sample_count(),
                rule: "a view has the same format, or the one that differs in sRGB alone",
            });
        }
        // The rules of views are checked on a texture without texels.
        let shape = self.descriptor().without_texels();
        let view = TexelView::new(shape, &descriptor.of_texels())?;
        let level_count = u32::try_from(view.level_count()).unwrap_or(u32::MAX);
        let layer_count = match view.dimension() {
            ViewDimension::Cube | ViewDimension::CubeArray => view.layer_count() * 6,
            _ => view.layer_count(),
        };
        Ok(TextureView {
            texture: self.clone(),
            format,
            dimension: view.dimension(),
            levels: [descriptor.base_mip_level, level_count],
            layers: [descriptor.base_array_layer, layer_count],
            aspect: descriptor.aspect,
        })
    }

    /// A view of all of the texture.
    #[must_use]
    pub fn view(&self) -> TextureView {
        let descriptor = TextureViewDescriptor::default();
        self.create_view(&descriptor)
            .expect("every texture has a view of all of it")
    }

    /// A 2D view of one mip level of one layer, to render to.
    ///
    /// # Errors
    /// [`TextureError`] if the texture does not have the level or the layer, or is not 2D.
    pub fn image(&self, level: u32, layer: u32) -> Result<TextureView, TextureError> {
        self.create_view(&TextureViewDescriptor::image(level, layer))
    }
}

impl TextureViewDescriptor {
    /// A 2D view of one mip level of one layer.
    #[must_use]
    pub fn image(level: u32, layer: u32) -> Self {
        Self {
            dimension: Some(ViewDimension::D2),
            base_mip_level: level,
            mip_level_count: Some(1),
            base_array_layer: layer,
            array_layer_count: Some(1),
            ..Self::default()
        }
    }

    fn of_texels(&self) -> TexelViewDescriptor {
        TexelViewDescriptor {
            dimension: self.dimension,
            base_mip_level: self.base_mip_level,
            mip_level_count: self.mip_level_count,
            base_array_layer: self.base_array_layer,
            array_layer_count: self.array_layer_count,
            aspect: self.aspect,
        }
    }
}

impl TextureView {
    /// The texture.
    #[must_use]
    pub fn texture(&self) -> &Texture {
        &self.texture
    }

    /// The format that the texels are read and written as.
    #[must_use]
    pub fn format(&self) -> TextureFormat {
        self.format
    }

    /// The dimension.
    #[must_use]
    pub fn dimension(&self) -> ViewDimension {
        self.dimension
    }

    /// The aspect of a depth-stencil format that is read.
    #[must_use]
    pub fn aspect(&self) -> TextureAspect {
        self.aspect
    }

    /// The first mip level, and the number of levels.
    #[must_use]
    pub fn mip_levels(&self) -> [u32; 2] {
        self.levels
    }

    /// The first layer, and the number of layers, six per cube.
    #[must_use]
    pub fn array_layers(&self) -> [u32; 2] {
        self.layers
    }

    /// The view of one layer, counted from the view's first.
    pub(crate) fn layer(&self, layer: u32) -> Self {
        Self {
            dimension: ViewDimension::D2,
            layers: [self.layers[0] + layer, 1],
            ..self.clone()
        }
    }

    /// Width and height of the view's first mip level, in texels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        let size = self.texture.level_size(self.levels[0]);
        [size.width, size.height]
    }

    /// The one image of the view, if it is one that can be rendered to: a level of a layer, or of
    /// `depth_slice` of a 3D texture.
    pub(crate) fn image_key(&self, depth_slice: Option<u32>) -> Option<ImageKey> {
        let is_3d = self.texture.dimension() == TextureDimension::D3;
        let depth = self
            .texture
            .level_size(self.levels[0])
            .depth_or_array_layers;
        let layer = match depth_slice {
            Some(slice) if is_3d && slice < depth => slice,
            None if !is_3d && self.layers[1] == 1 => self.layers[0],
            _ => return None,
        };
        (self.levels[1] == 1).then_some(ImageKey {
            level: self.levels[0],
            layer,
        })
    }

    /// Returns true if the view shows an image.
    pub(crate) fn contains(&self, key: ImageKey) -> bool {
        let within = |[first, count]: [u32; 2], at: u32| (first..first + count).contains(&at);
        let is_3d = self.texture.dimension() == TextureDimension::D3;
        within(self.levels, key.level) && (is_3d || within(self.layers, key.layer))
    }

    /// Checks that a sampler can sample the view.
    pub(crate) fn check_sampler(&self, sampler: &Sampler) -> Result<(), TextureError> {
        SampledTexture::new(self.shape()?, *sampler.descriptor)?;
        Ok(())
    }

    fn of_texels(&self) -> TexelViewDescriptor {
        TexelViewDescriptor {
            dimension: Some(self.dimension),
            base_mip_level: self.levels[0],
            mip_level_count: Some(self.levels[1]),
            base_array_layer: self.layers[0],
            array_layer_count: Some(self.layers[1]),
            aspect: self.aspect,
        }
    }

    /// The view without texels, in the texture's own format.
    pub(crate) fn shape(&self) -> Result<TexelView, TextureError> {
        let shape = self.texture.descriptor().without_texels();
        Ok(TexelView::new(shape, &self.of_texels())?)
    }

    /// The texels as they are now, as shaders read them.
    pub(crate) fn texels(&self, context: &Context) -> Result<TexelView, TextureError> {
        let mut data = self.texture.lock().rows(&self.texture, context)?;
        if self.format != self.texture.format() {
            let mut changed = (*data).clone();
            changed.format = self.format;
            changed.is_opaque = false;
            data = Arc::new(changed);
        }
        Ok(TexelView::new(data, &self.of_texels())?)
    }
}

/// How a texture is sampled: a checked [`SamplerDescriptor`]. Cheap to clone.
///
/// ```
/// use estampe::{Device, DeviceDescriptor, SamplerDescriptor};
///
/// let device = Device::new(&DeviceDescriptor::default())?;
/// let sampler = device.create_sampler(&SamplerDescriptor::linear())?;
/// assert_eq!(sampler.descriptor().max_anisotropy, 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Sampler {
    descriptor: Arc<SamplerDescriptor>,
}

impl Sampler {
    pub(crate) fn new(descriptor: &SamplerDescriptor) -> Result<Self, TextureError> {
        SampledTexture::check_sampler(descriptor)?;
        Ok(Self {
            descriptor: Arc::new(*descriptor),
        })
    }

    /// The state.
    #[must_use]
    pub fn descriptor(&self) -> &SamplerDescriptor {
        &self.descriptor
    }
}

/// A texture's texels as they are now, with a sampler, for a shader that owns it.
pub(crate) fn sampled_texture(
    context: &Context,
    view: &TextureView,
    sampler: &Sampler,
) -> Result<SampledTexture, TextureError> {
    let texels = view.texels(context)?;
    let sampled = SampledTexture::new(texels, *sampler.descriptor)?;
    Ok(sampled.at_level(context.level()))
}
