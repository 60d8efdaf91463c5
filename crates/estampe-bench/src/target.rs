//! The images that a frame is drawn into.

use crate::frame::FrameSize;
use estampe::{
    ColorAttachment, DepthStencilAttachment, Device, Texture, TextureDescriptor, TextureError,
    TextureFormat,
};

/// The formats of a target.
#[derive(Debug, Clone)]
pub(crate) struct TargetDescriptor {
    pub(crate) size: FrameSize,
    pub(crate) samples: u32,
    pub(crate) color_formats: Vec<TextureFormat>,
    pub(crate) depth_stencil: Option<TextureFormat>,
}

impl TargetDescriptor {
    /// RGBA8 and 32-bit depth of one sample.
    pub(crate) fn new(size: FrameSize) -> Self {
        Self {
            size,
            samples: 1,
            color_formats: vec![TextureFormat::Rgba8Unorm],
            depth_stencil: Some(TextureFormat::Depth32Float),
        }
    }
}

/// Colour and depth images of one size.
#[derive(Debug)]
pub(crate) struct Target {
    pub(crate) colors: Vec<Texture>,
    pub(crate) depth_stencil: Option<Texture>,
}

impl Target {
    pub(crate) fn new(
        device: &Device,
        descriptor: &TargetDescriptor,
    ) -> Result<Self, TextureError> {
        let FrameSize { width, height } = descriptor.size;
        let create = |format: TextureFormat| {
            device.create_texture(&TextureDescriptor {
                sample_count: descriptor.samples,
                ..TextureDescriptor::new_2d(width, height, format)
            })
        };
        let colors = descriptor.color_formats.iter().copied().map(create);
        Ok(Self {
            colors: colors.collect::<Result<_, _>>()?,
            depth_stencil: descriptor.depth_stencil.map(create).transpose()?,
        })
    }

    /// The colour attachments, cleared to a colour.
    pub(crate) fn colors(&self, clear: [f64; 4]) -> Vec<Option<ColorAttachment>> {
        let colors = self.colors.iter();
        let colors = colors.map(|color| Some(ColorAttachment::clear(&color.view(), clear)));
        colors.collect()
    }

    /// The depth attachment, cleared to 1.
    pub(crate) fn depth_stencil(&self) -> Option<DepthStencilAttachment> {
        let texture = self.depth_stencil.as_ref()?;
        Some(DepthStencilAttachment::clear(&texture.view(), 1.0))
    }
}
