//! What is drawn into: one colour and one depth attachment.

use crate::arithmetic::clamp;
use crate::color;
use estampe_types::TextureFormat;

/// The largest width and height.
const MAX_DIMENSION: u32 = 16_384;

/// A colour and a depth attachment of one size, with one or four samples per pixel.
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Samples of a pixel: 1 or 4.
    pub samples: u32,
    /// What the colours are: `Rgba8Unorm` or `Rgba8UnormSrgb`.
    pub color_format: TextureFormat,
    /// The stored codes R, G, B, A; sample s of pixel (x, y) is element
    /// `(y * width + x) * samples + s`.
    pub color: Vec<[u8; 4]>,
    /// The stored depths, in the same order.
    pub depth: Vec<f32>,
}

impl Target {
    /// A target of zeros and depth 1. Sizes beyond 16384 are cut to it; any number of samples but 4
    /// means 1.
    #[must_use]
    pub fn new(width: u32, height: u32, samples: u32, color_format: TextureFormat) -> Self {
        let (width, height) = (width.min(MAX_DIMENSION), height.min(MAX_DIMENSION));
        let samples = if samples == 4 { 4 } else { 1 };
        let len = width as usize * height as usize * samples as usize;
        Self {
            width,
            height,
            samples,
            color_format,
            color: vec![[0; 4]; len],
            depth: vec![1.0; len],
        }
    }

    /// Sets every sample to a colour (linear RGBA, converted as a store is) and a depth (confined to
    /// 0..=1).
    pub fn clear(&mut self, color: [f32; 4], depth: f32) {
        self.color.fill(color::encode(self.color_format, color));
        self.depth.fill(clamp(depth, 0.0, 1.0));
    }

    /// Where sample `sample` of pixel (x, y) stands in [`Target::color`] and [`Target::depth`].
    #[must_use]
    pub fn index(&self, [x, y]: [u32; 2], sample: u32) -> usize {
        (y as usize * self.width as usize + x as usize) * self.samples as usize + sample as usize
    }

    /// One code per pixel, row by row: the mean of its samples, taken in linear light.
    #[must_use]
    pub fn resolve(&self) -> Vec<[u8; 4]> {
        self.color
            .chunks_exact(self.samples as usize)
            .map(|samples| color::resolve(self.color_format, samples))
            .collect()
    }
}
