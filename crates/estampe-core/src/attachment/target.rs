//! A render target: colour attachments and a depth attachment of one size.

use super::texels::{ColorTexels, DepthStencilTexels, ImageSize};
use crate::commands::Discards;
use crate::depth_format::DepthFormat;
use crate::layout::{TileGrid, texel_words};
use estampe_types::{Lines, TextureFormat};
use std::ops::Range;
use std::sync::Arc;

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
    pub(crate) size: ImageSize,
    /// The tiles of the pass at hand.
    grid: TileGrid,
    pub(crate) colors: Vec<ColorTexels>,
    pub(crate) color_formats: Vec<TextureFormat>,
    pub(crate) depth_stencil: Option<DepthStencilTexels>,
    pub(crate) resolves: Vec<ColorResolve>,
    pub(crate) rows: Vec<ColorRows>,
}

/// An image in row order that takes the texels of a colour attachment of one sample.
#[derive(Debug, Clone)]
pub struct ColorRows {
    /// The index of the colour attachment.
    pub color: usize,
    /// Words among which the image lies. Nobody else may share them: else they are not stored to.
    pub texels: Arc<Lines<u32>>,
    /// The words of the image: [`row_order_words`](super::row_order_words).
    pub range: Range<usize>,
    /// True if the image holds what the pass has drawn.
    pub is_done: bool,
}

impl ColorRows {
    /// The words of the image, unless they are shared.
    pub(crate) fn words_mut(&mut self) -> Option<&mut [u32]> {
        Arc::get_mut(&mut self.texels)?.get_mut(self.range.clone())
    }
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
            grid: size.grid(),
            color_formats: colors.iter().map(|color| color.format).collect(),
            colors,
            depth_stencil,
            resolves: Vec::new(),
            rows: Vec::new(),
        }
    }

    /// Takes memory for the images that have none, but for those of which workers keep a tile, and
    /// says how many they are. The error is the size of an image for which memory is short, in
    /// bytes.
    pub(crate) fn take_memory(&mut self, in_workers: Discards) -> Result<u64, u64> {
        let size = self.size;
        let mut taken = 0;
        let bytes = |words: usize| (size.stored_samples() * words) as u64 * 4;
        for (index, color) in self.colors.iter_mut().enumerate() {
            if !color.has_memory() && in_workers.colors >> index & 1 == 0 {
                let format = color.format;
                let zeros = ColorTexels::zeros(format, size);
                *color = zeros.ok_or_else(|| bytes(texel_words(format)))?;
                taken += 1;
            }
        }
        if let Some(texels) = &mut self.depth_stencil
            && !texels.has_memory()
            && !in_workers.depth_stencil
        {
            *texels = DepthStencilTexels::zeros(texels.format, size).ok_or_else(|| bytes(1))?;
            taken += 1;
        }
        Ok(taken)
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

    /// Has passes store the texels of a colour attachment, which must have one sample, to an image
    /// in row order while they are in the cache. If a pass discards the attachment, the image holds
    /// its texels all the same, and the attachment may be left as it is.
    pub fn store_rows(&mut self, color: usize, texels: Arc<Lines<u32>>, range: Range<usize>) {
        debug_assert_eq!(self.size.samples, 1, "rows of one sample");
        self.rows.push(ColorRows {
            color,
            texels,
            range,
            is_done: false,
        });
    }

    /// Takes the images in row order.
    pub fn take_rows(&mut self) -> Vec<ColorRows> {
        std::mem::take(&mut self.rows)
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

    /// Divides the target into tiles for a pass that so many threads draw.
    pub(crate) fn divide_for(&mut self, threads: usize, has_few_primitives: bool) {
        let grid = self.size.grid();
        self.grid = if has_few_primitives {
            grid.for_threads_with_few_primitives(threads)
        } else {
            grid.for_threads(threads)
        };
    }

    /// The tiles of the pass at hand.
    pub(crate) fn grid(&self) -> TileGrid {
        self.grid
    }
}
