//! The images that the fast path draws a case into.

use crate::case::Case;
use crate::readback::Stored;
use estampe::{
    AspectOperations, ColorAttachment, DepthStencilAttachment, Device, Extent3d, LoadOp,
    PassExtent, RenderPass, StoreOp, TextureAspect, TextureDescriptor, TextureView,
    TextureViewDescriptor,
};
use estampe_types::TextureFormat;

/// Colour, depth and stencil images of one size.
#[derive(Debug)]
pub struct Target {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Samples per pixel.
    pub samples: u32,
    /// The colour images.
    pub colors: Vec<TextureView>,
    /// The depth and stencil image.
    pub depth_stencil: Option<TextureView>,
}

/// The place of an image in its texture.
#[derive(Debug, Clone, Copy)]
struct Place {
    level: u32,
    layer: u32,
}

impl Target {
    /// Images of these formats.
    ///
    /// # Panics
    /// If the device refuses them.
    #[must_use]
    pub fn new(
        device: &Device,
        size: [u32; 2],
        samples: u32,
        colors: &[TextureFormat],
        depth_stencil: Option<TextureFormat>,
    ) -> Self {
        let first = Place { level: 0, layer: 0 };
        let create = |format| image(device, size, samples, format, first);
        Self {
            size,
            samples,
            colors: colors.iter().copied().map(create).collect(),
            depth_stencil: depth_stencil.map(create),
        }
    }

    /// The images of a case.
    #[must_use]
    pub fn of_case(device: &Device, case: &Case) -> Self {
        let formats = case.formats();
        Self::new(
            device,
            case.size,
            case.samples,
            &formats,
            case.depth_stencil,
        )
    }

    /// A pass that clears the images to a case's values, or keeps them.
    #[must_use]
    pub fn pass(&self, case: &Case, clears: bool) -> Attachments {
        let color = case.clear_color.map(f64::from);
        let load = if clears {
            LoadOp::Clear(color)
        } else {
            LoadOp::Load
        };
        let colors = self.colors.iter().map(|view| {
            Some(ColorAttachment {
                load,
                ..ColorAttachment::load(view)
            })
        });
        let depth_stencil = self.depth_stencil.as_ref().map(|view| {
            if !clears {
                return DepthStencilAttachment::load(view);
            }
            DepthStencilAttachment {
                stencil: AspectOperations::Write {
                    load: LoadOp::Clear(case.clear_stencil),
                    store: StoreOp::Store,
                },
                ..DepthStencilAttachment::clear(view, case.clear_depth)
            }
        });
        Attachments {
            colors: colors.collect(),
            depth_stencil,
            extent: PassExtent {
                width: self.size[0],
                height: self.size[1],
                samples: self.samples,
            },
        }
    }

    /// Reads every sample of the images, and resolves them.
    ///
    /// # Panics
    /// If the device refuses to.
    #[must_use]
    pub fn read(&self, device: &Device) -> Stored {
        let samples = 0..self.samples;
        let read = |view: &TextureView, sample: u32| {
            let read = device.read_sample(view, sample);
            read.expect("a sample that there is")
        };
        let texels = self.colors.iter().flat_map(|view| {
            let samples = samples.clone();
            samples.map(move |sample| read(view, sample))
        });
        let texels = texels.collect();
        let aspect = |aspect: TextureAspect, has: fn(TextureFormat) -> bool| -> Vec<Vec<u8>> {
            let view = self.depth_stencil.as_ref();
            let view = view.filter(|view| has(view.format()));
            let view = view.map(|view| {
                let [level, layer] = [view.mip_levels()[0], view.array_layers()[0]];
                let view = view.texture().create_view(&TextureViewDescriptor {
                    aspect,
                    ..TextureViewDescriptor::image(level, layer)
                });
                view.expect("an aspect of an image that there is")
            });
            let values = samples
                .clone()
                .map(|sample| view.as_ref().map_or(Vec::new(), |view| read(view, sample)));
            values.collect()
        };
        let format = self.depth_stencil.as_ref().map(TextureView::format);
        let depths = aspect(TextureAspect::Depth, TextureFormat::has_depth);
        Stored {
            texels,
            resolved: self.resolved(device),
            depths: depths
                .iter()
                .map(|bytes| depth_bits(format, bytes))
                .collect(),
            stencils: aspect(TextureAspect::Stencil, TextureFormat::has_stencil),
        }
    }

    /// The resolved texels of each colour image, if there are several samples.
    fn resolved(&self, device: &Device) -> Vec<Vec<u8>> {
        if self.samples == 1 || self.colors.is_empty() {
            return Vec::new();
        }
        let formats: Vec<_> = self.colors.iter().map(TextureView::format).collect();
        let into = Self::new(device, self.size, 1, &formats, None);
        let pairs = self.colors.iter().zip(&into.colors);
        let colors = pairs.map(|(from, into)| {
            Some(ColorAttachment {
                resolve_target: Some(into.clone()),
                ..ColorAttachment::load(from)
            })
        });
        let colors: Vec<_> = colors.collect();
        device
            .render(&RenderPass {
                color_attachments: &colors,
                ..RenderPass::default()
            })
            .expect("a pass without draws");
        let read = |view| device.read_sample(view, 0).expect("one sample");
        into.colors.iter().map(read).collect()
    }
}

/// An image of zeros at a place in a texture of three layers, which it has to itself. Multisampled
/// textures have one level.
fn image(
    device: &Device,
    [width, height]: [u32; 2],
    samples: u32,
    format: TextureFormat,
    place: Place,
) -> TextureView {
    let is_small = width.max(height) <= 1024;
    let level = if samples == 1 && is_small {
        place.level
    } else {
        0
    };
    let layer = if is_small { place.layer } else { 0 };
    let descriptor = TextureDescriptor {
        sample_count: samples,
        mip_level_count: level + 1,
        size: Extent3d {
            width: width << level,
            height: height << level,
            depth_or_array_layers: layer + 1,
        },
        ..TextureDescriptor::new_2d(width, height, format)
    };
    let texture = device.create_texture(&descriptor).expect("a valid texture");
    texture.image(level, layer).expect("an image that there is")
}

/// The attachments of a pass.
#[derive(Debug)]
pub struct Attachments {
    colors: Vec<Option<ColorAttachment>>,
    depth_stencil: Option<DepthStencilAttachment>,
    extent: PassExtent,
}

impl Attachments {
    /// A pass without draws.
    #[must_use]
    pub fn pass(&self) -> RenderPass<'_> {
        RenderPass {
            color_attachments: &self.colors,
            depth_stencil_attachment: self.depth_stencil.clone(),
            extent: Some(self.extent),
            ..RenderPass::default()
        }
    }
}

/// The bits of depths as numbers: those of fixed-point formats are the nearest to code ÷ (2ⁿ − 1).
fn depth_bits(format: Option<TextureFormat>, bytes: &[u8]) -> Vec<u32> {
    let words = |bytes: &[u8]| -> Vec<u32> {
        let words = bytes.as_chunks().0.iter();
        words.map(|bytes| u32::from_le_bytes(*bytes)).collect()
    };
    let number = |code: u32, most: f32| (code as f32 / most).to_bits();
    match format {
        Some(TextureFormat::Depth16Unorm) => {
            let codes = bytes.as_chunks().0.iter();
            let codes = codes.map(|bytes| u32::from(u16::from_le_bytes(*bytes)));
            codes.map(|code| number(code, 65_535.0)).collect()
        }
        Some(TextureFormat::Depth24Plus | TextureFormat::Depth24PlusStencil8) => {
            let codes = words(bytes).into_iter();
            codes.map(|code| number(code, 16_777_215.0)).collect()
        }
        _ => words(bytes),
    }
}
