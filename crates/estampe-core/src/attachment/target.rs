//! A render target: colour attachments and a depth attachment of one size.

use super::texels::{ColorTexels, DepthStencilTexels, ImageSize};
use crate::depth_format::DepthFormat;
use crate::layout::TileGrid;
use estampe_types::TextureFormat;

/// The samples and formats of a target, without its pixels.
#[derive(Debug, Clone, Copy)]
pub struct TargetShape<'a> {
    /// Samples per pixel.
    pub samples: u32,
    /// Formats of the colour attachments.
    pub color_formats: &'a [TextureFormat],
    /// Format of depth and stencil, if there are any.
    pub depth_stencil: Option<TextureFormat>,
}

/// The attachments of a pass: colours, depth and stencil of one size.
#[derive(Debug, Clone)]
pub struct RenderTarget {
    size: ImageSize,
    pub(crate) colors: Vec<ColorTexels>,
    color_formats: Vec<TextureFormat>,
    pub(crate) depth_stencil: Option<DepthStencilTexels>,
    pub(crate) resolves: Vec<ColorResolve>,
}

/// An image of one sample that takes the means of a colour attachment's samples.
#[derive(Debug, Clone)]
pub struct ColorResolve {
    /// The index of the colour attachment.
    pub color: usize,
    /// The image, of the attachment's width, height and format.
    pub into: ColorTexels,
    /// True if the image holds the means: the last tiles of a pass were resolved while they were in
    /// the cache. False if they are to be computed yet.
    pub is_done: bool,
}

impl RenderTarget {
    /// A target of images of this size.
    #[must_use]
    pub fn of_images(
        size: ImageSize,
        colors: Vec<ColorTexels>,
        depth_stencil: Option<DepthStencilTexels>,
    ) -> Self {
        debug_assert!(
            colors.iter().all(|color| color.size == size)
                && depth_stencil.iter().all(|depth| depth.size == size),
            "attachments of different sizes"
        );
        Self {
            size,
            color_formats: colors.iter().map(|color| color.format).collect(),
            colors,
            depth_stencil,
            resolves: Vec::new(),
        }
    }

    /// Has passes resolve a colour attachment into an image, which must have one sample and the
    /// attachment's width, height and format.
    pub fn resolve_into(&mut self, color: usize, into: ColorTexels) {
        debug_assert!(
            self.colors
                .get(color)
                .is_some_and(|from| from.format == into.format
                    && [from.size.width, from.size.height] == [into.size.width, into.size.height]),
            "an image of another size or format"
        );
        self.resolves.push(ColorResolve {
            color,
            into,
            is_done: false,
        });
    }

    /// Takes the images that attachments are resolved into.
    pub fn take_resolves(&mut self) -> Vec<ColorResolve> {
        std::mem::take(&mut self.resolves)
    }

    /// The samples and formats.
    pub(crate) fn shape(&self) -> TargetShape<'_> {
        TargetShape {
            samples: self.size.samples,
            color_formats: &self.color_formats,
            depth_stencil: self.depth_stencil_format(),
        }
    }

    /// The images of the target.
    #[must_use]
    pub fn into_images(self) -> (Vec<ColorTexels>, Option<DepthStencilTexels>) {
        (self.colors, self.depth_stencil)
    }

    /// Width in pixels.
    pub(crate) fn width(&self) -> u32 {
        self.size.width
    }

    /// Height in pixels.
    pub(crate) fn height(&self) -> u32 {
        self.size.height
    }

    /// Samples per pixel.
    pub(crate) fn samples(&self) -> u32 {
        self.size.samples
    }

    /// Formats of the colour attachments.
    pub(crate) fn color_formats(&self) -> &[TextureFormat] {
        &self.color_formats
    }

    /// The format of the depth and stencil attachment.
    pub(crate) fn depth_stencil_format(&self) -> Option<TextureFormat> {
        self.depth_stencil.as_ref().map(|depth| depth.format)
    }

    /// Returns true if there is a depth attachment.
    pub(crate) fn has_depth(&self) -> bool {
        let format = self.depth_stencil_format();
        format.is_some_and(TextureFormat::has_depth)
    }

    pub(crate) fn depth_format(&self) -> DepthFormat {
        DepthFormat::new(self.depth_stencil_format())
    }

    /// Returns true if there is a stencil attachment.
    pub(crate) fn has_stencil(&self) -> bool {
        let format = self.depth_stencil_format();
        format.is_some_and(TextureFormat::has_stencil)
    }

    pub(crate) fn grid(&self) -> TileGrid {
        self.size.grid()
    }
}
