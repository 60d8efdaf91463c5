//! A render target: colour attachments and a depth attachment of one size.

use super::texels::{ColorTexels, DepthStencilTexels, ImageSize};
use crate::depth_format::DepthFormat;
use crate::layout::{TileGrid, texel_words};
use estampe_types::{Limits, TextureFormat};

/// Describes a render target.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RenderTargetDescriptor {
    /// Width in pixels, from 1 on.
    pub width: u32,
    /// Height in pixels, from 1 on.
    pub height: u32,
    /// Samples per pixel: 1, 2, 4, 8 or 16. Default 1.
    pub samples: u32,
    /// Formats of the colour attachments. Default one `Rgba8Unorm`.
    pub color_formats: Vec<TextureFormat>,
    /// Format of the depth and stencil attachment, if there is one. Default `Depth32Float`.
    pub depth_stencil: Option<TextureFormat>,
}

impl RenderTargetDescriptor {
    /// The defaults, of a size in pixels.
    #[must_use]
    pub fn new(width: u32, height: u32) -> Self {
        Self {
            width,
            height,
            samples: 1,
            color_formats: vec![TextureFormat::Rgba8Unorm],
            depth_stencil: Some(TextureFormat::Depth32Float),
        }
    }
}

/// Why a target was refused.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TargetError {
    /// A side is zero or too long.
    #[error(
        "a render target of {width}x{height} pixels: each side must be from 1 to \
         max_texture_dimension_2d, which is {limit}"
    )]
    Size {
        /// Width in pixels.
        width: u32,
        /// Height in pixels.
        height: u32,
        /// The longest side.
        limit: u32,
    },
    /// The sample count is not offered.
    #[error("a render target has 1, 2, 4, 8 or 16 samples per pixel, not {0}")]
    SampleCount(u32),
    /// Too many colour attachments.
    #[error("{count} colour attachments; the limit max_color_attachments is {limit}")]
    TooManyColors {
        /// The number of colour attachments.
        count: usize,
        /// The largest number allowed.
        limit: u32,
    },
    /// A colour attachment with a format that cannot be drawn into.
    #[error(
        "colour attachment {index} has the format {}, into which colours cannot be drawn: depth, stencil and \
         compressed formats and rgb9e5ufloat are not renderable",
        format.name()
    )]
    NotRenderable {
        /// The index of the colour attachment.
        index: usize,
        /// Its format.
        format: TextureFormat,
    },
    /// A depth and stencil attachment with a format that holds neither.
    #[error("the depth attachment has the format {}, which holds neither depth nor stencil", .0.name())]
    NotDepthStencil(TextureFormat),
    /// The system has not enough memory.
    #[error("no memory for a render target of {bytes} bytes: make it smaller or use fewer samples")]
    OutOfMemory {
        /// The memory that the render target needs, in bytes.
        bytes: u64,
    },
}

/// The names of formats, separated by commas: for messages.
pub(crate) fn format_names(formats: &[TextureFormat]) -> String {
    let names: Vec<&str> = formats.iter().map(|format| format.name()).collect();
    names.join(", ")
}

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
}

impl RenderTarget {
    /// Makes a target of zeros.
    ///
    /// # Errors
    /// [`TargetError`] names the rule that the descriptor breaks, or that memory is short.
    pub fn new(descriptor: &RenderTargetDescriptor, limits: &Limits) -> Result<Self, TargetError> {
        check(descriptor, limits)?;
        let size = ImageSize {
            width: descriptor.width,
            height: descriptor.height,
            samples: descriptor.samples,
        };
        let error = || {
            let words = descriptor.color_formats.iter().map(|&f| texel_words(f));
            let depth = descriptor.depth_stencil;
            let words =
                words.sum::<usize>() + usize::from(depth.is_some_and(TextureFormat::has_depth));
            let stencil = depth.is_some_and(TextureFormat::has_stencil);
            let bytes_each = words as u64 * 4 + u64::from(stencil);
            TargetError::OutOfMemory {
                bytes: (size.stored_samples() as u64).saturating_mul(bytes_each),
            }
        };
        let formats = descriptor.color_formats.iter();
        let colors: Option<Vec<_>> = formats
            .map(|&format| ColorTexels::zeros(format, size))
            .collect();
        let depth_stencil = descriptor.depth_stencil;
        let depth_stencil = depth_stencil
            .map(|format| DepthStencilTexels::zeros(format, size).ok_or_else(error))
            .transpose()?;
        Ok(Self::of_images(
            size,
            colors.ok_or_else(error)?,
            depth_stencil,
        ))
    }

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
        }
    }

    /// The samples and formats.
    #[must_use]
    pub fn shape(&self) -> TargetShape<'_> {
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
    #[must_use]
    pub fn width(&self) -> u32 {
        self.size.width
    }

    /// Height in pixels.
    #[must_use]
    pub fn height(&self) -> u32 {
        self.size.height
    }

    /// Samples per pixel.
    #[must_use]
    pub fn samples(&self) -> u32 {
        self.size.samples
    }

    /// Formats of the colour attachments.
    #[must_use]
    pub fn color_formats(&self) -> &[TextureFormat] {
        &self.color_formats
    }

    /// The format of the depth and stencil attachment.
    #[must_use]
    pub fn depth_stencil_format(&self) -> Option<TextureFormat> {
        self.depth_stencil.as_ref().map(|depth| depth.format)
    }

    /// Returns true if there is a depth attachment.
    #[must_use]
    pub fn has_depth(&self) -> bool {
        let format = self.depth_stencil_format();
        format.is_some_and(TextureFormat::has_depth)
    }

    pub(crate) fn depth_format(&self) -> DepthFormat {
        DepthFormat::new(self.depth_stencil_format())
    }

    /// Returns true if there is a stencil attachment.
    #[must_use]
    pub fn has_stencil(&self) -> bool {
        let format = self.depth_stencil_format();
        format.is_some_and(TextureFormat::has_stencil)
    }

    pub(crate) fn grid(&self) -> TileGrid {
        self.size.grid()
    }
}

fn check(descriptor: &RenderTargetDescriptor, limits: &Limits) -> Result<(), TargetError> {
    let RenderTargetDescriptor {
        width,
        height,
        samples,
        ..
    } = *descriptor;
    // The fixed-point raster is made for 16384, whatever a caller's limits say.
    let limit = limits.max_texture_dimension_2d.min(16_384);
    if width == 0 || height == 0 || width > limit || height > limit {
        return Err(TargetError::Size {
            width,
            height,
            limit,
        });
    }
    if !matches!(samples, 1 | 2 | 4 | 8 | 16) {
        return Err(TargetError::SampleCount(samples));
    }
    let count = descriptor.color_formats.len();
    if count > limits.max_color_attachments as usize {
        return Err(TargetError::TooManyColors {
            count,
            limit: limits.max_color_attachments,
        });
    }
    for (index, format) in descriptor.color_formats.iter().enumerate() {
        if !format.is_renderable() {
            return Err(TargetError::NotRenderable {
                index,
                format: *format,
            });
        }
    }
    if let Some(format) = descriptor.depth_stencil
        && format.is_color()
    {
        return Err(TargetError::NotDepthStencil(format));
    }
    Ok(())
}
