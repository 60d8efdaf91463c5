//! The images that a frame is drawn to.

use crate::frame_style::clear_color;
use crate::options::RenderOptions;
use estampe::{
    ColorAttachment, DepthStencilAttachment, Device, Texture, TextureDescriptor, TextureError,
    TextureFormat,
};

/// The images of a frame.
pub(crate) struct Attachments {
    /// The samples, if there are several per pixel.
    samples: Option<Texture>,
    pub(crate) image: Texture,
    pub(crate) depth: Texture,
}

impl Attachments {
    pub(crate) fn new(
        options: &RenderOptions,
        format: TextureFormat,
        device: &Device,
    ) -> Result<Self, TextureError> {
        let image = TextureDescriptor::new_2d(options.width, options.height, format);
        let samples = TextureDescriptor {
            sample_count: options.samples,
            ..image.clone()
        };
        let depth = TextureDescriptor {
            format: TextureFormat::Depth32Float,
            ..samples.clone()
        };
        Ok(Self {
            samples: if options.samples > 1 {
                Some(device.create_texture(&samples)?)
            } else {
                None
            },
            image: device.create_texture(&image)?,
            depth: device.create_texture(&depth)?,
        })
    }

    /// The texture that is drawn to: that of the image, or of its samples.
    pub(crate) fn samples(&self) -> &Texture {
        self.samples.as_ref().unwrap_or(&self.image)
    }

    /// The depths, cleared.
    pub(crate) fn cleared_depth(&self) -> DepthStencilAttachment {
        DepthStencilAttachment::clear(&self.depth.view(), 1.0)
    }

    /// The colours, cleared, and resolved to the image.
    pub(crate) fn color(&self, options: &RenderOptions) -> ColorAttachment {
        let clear = clear_color(options).map(f64::from);
        match &self.samples {
            Some(samples) => ColorAttachment {
                resolve_target: Some(self.image.view()),
                ..ColorAttachment::clear(&samples.view(), clear)
            },
            None => ColorAttachment::clear(&self.image.view(), clear),
        }
    }
}
