//! The target: colour attachments, depth and stencil.

use crate::channel::{clear_depth, quantised_depth};
use crate::color::{self, Codes};
use crate::raster::sample_positions;
use crate::viewport::PixelBounds;
use estampe_types::TextureFormat;

/// The greatest width and height, in pixels.
const MAX_DIMENSION: u32 = 16_384;

/// Attachments of one size and one number of samples per pixel.
///
/// In each of them, sample s of pixel (x, y) is element `(y * width + x) * samples + s`, counted in
/// the pixels that are stored: see [`Target::index`].
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Samples per pixel: 1, 2, 4, 8 or 16.
    pub samples: u32,
    /// The format of each colour attachment.
    pub color_formats: Vec<TextureFormat>,
    /// The format of the depth-stencil attachment, if there is one.
    pub depth_stencil: Option<TextureFormat>,
    /// The stored codes R, G, B, A: all samples of attachment 0, then all of attachment 1, and so
    /// on.
    pub color: Vec<Codes>,
    /// The stored depths, as f32 in every format; empty without a depth attachment.
    pub depth: Vec<f32>,
    /// The stored stencil values; empty without a stencil attachment.
    pub stencil: Vec<u8>,
    /// The pixels that are stored.
    stored: PixelBounds,
}

/// The stored values of one sample.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredSample {
    /// The codes R, G, B, A of each colour attachment.
    pub colors: Vec<Codes>,
    /// The depth, as f32 in every format; `None` without a depth attachment.
    pub depth: Option<f32>,
    /// The stencil value; `None` without a stencil attachment.
    pub stencil: Option<u8>,
}

impl Target {
    /// One colour attachment of zeros and a float depth attachment of 1.
    #[must_use]
    pub fn new(width: u32, height: u32, samples: u32, color_format: TextureFormat) -> Self {
        let depth = Some(TextureFormat::Depth32Float);
        Self::with_attachments([width, height], samples, &[color_format], depth)
    }

    /// Attachments of zeros, with depth 1. Sizes are limited to 16384; numbers of samples other
    /// than 1, 2, 4, 8 and 16 are taken as 1.
    #[must_use]
    pub fn with_attachments(
        size: [u32; 2],
        samples: u32,
        color_formats: &[TextureFormat],
        depth_stencil: Option<TextureFormat>,
    ) -> Self {
        let [width, height] = size.map(|along| along.min(MAX_DIMENSION));
        let stored = PixelBounds {
            x: 0..width,
            y: 0..height,
        };
        Self::of_part(size, samples, color_formats, depth_stencil, stored)
    }

    /// Attachments of which only some pixels are stored; no others may be drawn to or read.
    #[must_use]
    pub fn of_part(
        size: [u32; 2],
        samples: u32,
        color_formats: &[TextureFormat],
        depth_stencil: Option<TextureFormat>,
        stored: PixelBounds,
    ) -> Self {
        let [width, height] = size.map(|along| along.min(MAX_DIMENSION));
        let per_pixel = sample_positions(samples).len();
        let len = stored.x.len() * stored.y.len() * per_pixel;
        let has = |what: fn(TextureFormat) -> bool| usize::from(depth_stencil.is_some_and(what));
        Self {
            width,
            height,
            samples: u32::try_from(per_pixel).expect("at most 16"),
            color_formats: color_formats.to_vec(),
            depth_stencil,
            color: vec![[0; 4]; len * color_formats.len()],
            depth: vec![1.0; len * has(TextureFormat::has_depth)],
            stencil: vec![0; len * has(TextureFormat::has_stencil)],
            stored,
        }
    }

    /// Sets every sample to a colour (linear RGBA, encoded as a store does) and a depth (clamped to
    /// 0..=1).
    pub fn clear(&mut self, color: [f32; 4], depth: f32) {
        for index in 0..self.color_formats.len() {
            self.clear_color(index, color.map(f64::from));
        }
        self.clear_depth(depth);
    }

    /// Sets every sample of a colour attachment to a colour (linear RGBA; integers for integer
    /// formats).
    pub fn clear_color(&mut self, attachment: usize, color: [f64; 4]) {
        let codes = color::clear_codes(self.color_formats[attachment], color);
        let range = self.plane(attachment);
        self.color[range].fill(codes);
    }

    /// Sets every depth: clamped to 0..=1 and rounded to the format.
    pub fn clear_depth(&mut self, depth: f32) {
        if let Some(format) = self.depth_stencil {
            self.depth.fill(clear_depth(format, depth));
        }
    }

    /// Sets every stencil value.
    pub fn clear_stencil(&mut self, stencil: u8) {
        self.stencil.fill(stencil);
    }

    /// The index of sample `sample` of pixel (x, y) in [`Target::depth`], [`Target::stencil`] and,
    /// for attachment 0, [`Target::color`].
    #[must_use]
    pub fn index(&self, [x, y]: [u32; 2], sample: u32) -> usize {
        let (column, row) = (x - self.stored.x.start, y - self.stored.y.start);
        let pixel = row as usize * self.stored.x.len() + column as usize;
        pixel * self.samples as usize + sample as usize
    }

    /// The stored values of the sample at an [index](Target::index).
    #[must_use]
    pub fn sample(&self, index: usize) -> StoredSample {
        let colors = (0..self.color_formats.len()).map(|at| self.color[at * self.len() + index]);
        StoredSample {
            colors: colors.collect(),
            depth: self.depth.get(index).copied(),
            stencil: self.stencil.get(index).copied(),
        }
    }

    /// A depth as the depth attachment stores it; unchanged without a depth attachment.
    #[must_use]
    pub fn quantised(&self, depth: f32) -> f32 {
        match self.depth_stencil {
            Some(format) => quantised_depth(format, depth),
            None => depth,
        }
    }

    /// The resolved attachment, row by row: for each pixel the mean of its samples.
    #[must_use]
    pub fn resolve(&self, attachment: usize) -> Vec<Codes> {
        let format = self.color_formats[attachment];
        self.color[self.plane(attachment)]
            .chunks_exact(self.samples as usize)
            .map(|samples| color::resolve(format, samples))
            .collect()
    }

    /// The bytes of one sample of every pixel of an attachment, row by row.
    #[must_use]
    pub fn texels(&self, attachment: usize, sample: u32) -> Vec<u8> {
        let format = self.color_formats[attachment];
        let of_sample = self.color[self.plane(attachment)]
            .iter()
            .skip(sample as usize)
            .step_by(self.samples as usize);
        of_sample
            .flat_map(|&codes| color::bytes(format, codes))
            .collect()
    }

    /// The pixels that are stored: all, unless the target was made of a part.
    #[must_use]
    pub fn stored(&self) -> &PixelBounds {
        &self.stored
    }

    /// The number of samples of an attachment.
    #[must_use]
    pub fn len(&self) -> usize {
        self.stored.x.len() * self.stored.y.len() * self.samples as usize
    }

    /// Returns true if the target has no samples.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn plane(&self, attachment: usize) -> std::ops::Range<usize> {
        let len = self.len();
        attachment * len..(attachment + 1) * len
    }
}
