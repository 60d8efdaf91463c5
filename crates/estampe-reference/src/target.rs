//! What is drawn into: colour attachments, depth and stencil.

use crate::channel::{clear_depth, quantised_depth};
use crate::color::{self, Codes};
use crate::raster::sample_positions;
use estampe_types::TextureFormat;

/// The largest width and height.
const MAX_DIMENSION: u32 = 16_384;

/// Attachments of one size and one number of samples per pixel.
///
/// In each, sample s of pixel (x, y) is element `(y * width + x) * samples + s`: see [`Target::index`].
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Samples of a pixel: 1, 2, 4, 8 or 16.
    pub samples: u32,
    /// What the colours of each attachment are.
    pub color_formats: Vec<TextureFormat>,
    /// What holds depth, stencil or both, if anything.
    pub depth_stencil: Option<TextureFormat>,
    /// The stored codes R, G, B, A: all samples of attachment 0, then all of attachment 1, and so on.
    pub color: Vec<Codes>,
    /// The stored depths, in every format as f32; empty where there are none.
    pub depth: Vec<f32>,
    /// The stored stencil values; empty where there are none.
    pub stencil: Vec<u8>,
}

impl Target {
    /// One colour attachment and a float depth, of zeros and depth 1.
    #[must_use]
    pub fn new(width: u32, height: u32, samples: u32, color_format: TextureFormat) -> Self {
        let depth = Some(TextureFormat::Depth32Float);
        Self::with_attachments([width, height], samples, &[color_format], depth)
    }

    /// Attachments of zeros and depth 1. Sizes beyond 16384 are cut to it; a number of samples that there is not
    /// means 1.
    #[must_use]
    pub fn with_attachments(
        size: [u32; 2],
        samples: u32,
        color_formats: &[TextureFormat],
        depth_stencil: Option<TextureFormat>,
    ) -> Self {
        let [width, height] = size.map(|along| along.min(MAX_DIMENSION));
        let per_pixel = sample_positions(samples).len();
        let len = width as usize * height as usize * per_pixel;
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
        }
    }

    /// Sets every sample to a colour (linear RGBA, converted as a store is) and a depth (confined to 0..=1).
    pub fn clear(&mut self, color: [f32; 4], depth: f32) {
        for index in 0..self.color_formats.len() {
            self.clear_color(index, color.map(f64::from));
        }
        self.clear_depth(depth);
    }

    /// Sets every sample of a colour attachment.
    pub fn clear_color(&mut self, attachment: usize, color: [f64; 4]) {
        let codes = color::clear_codes(self.color_formats[attachment], color);
        let range = self.plane(attachment);
        self.color[range].fill(codes);
    }

    /// Sets every depth: confined to 0..=1, and to what the format can hold.
    pub fn clear_depth(&mut self, depth: f32) {
        if let Some(format) = self.depth_stencil {
            self.depth.fill(clear_depth(format, depth));
        }
    }

    /// Sets every stencil value.
    pub fn clear_stencil(&mut self, stencil: u8) {
        self.stencil.fill(stencil);
    }

    /// Where sample `sample` of pixel (x, y) stands in [`Target::depth`], [`Target::stencil`] and, of attachment 0,
    /// [`Target::color`].
    #[must_use]
    pub fn index(&self, [x, y]: [u32; 2], sample: u32) -> usize {
        (y as usize * self.width as usize + x as usize) * self.samples as usize + sample as usize
    }

    /// What the depth attachment makes of a depth; itself where there is none.
    #[must_use]
    pub fn quantised(&self, depth: f32) -> f32 {
        match self.depth_stencil {
            Some(format) => quantised_depth(format, depth),
            None => depth,
        }
    }

    /// One texel per pixel of an attachment, row by row: the mean of its samples.
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

    /// How many samples an attachment has.
    #[must_use]
    pub fn len(&self) -> usize {
        self.width as usize * self.height as usize * self.samples as usize
    }

    /// Whether it has no samples.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    fn plane(&self, attachment: usize) -> std::ops::Range<usize> {
        let len = self.len();
        attachment * len..(attachment + 1) * len
    }
}
