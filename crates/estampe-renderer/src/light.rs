//! Frames of light: linear floats without a bound, in place of the codes of a screen.
//!
//! ```text
//!   Display   8-bit target   tone map, 0 to 1, sRGB codes           straight alpha
//!   Light     Rgba32Float    exposure, no tone map, 0 and above     multiplied by alpha
//! ```
//!
//! Everything else is the same code with the same numbers: shaders write linear colours either way,
//! and the target alone decides whether they are clamped and rounded.

use crate::alpha::{Encoding, decode};
use crate::canvas::Canvas;
use estampe::TextureFormat;
use estampe_scene::HdrImage;

/// What the pixels of a frame hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FrameOutput {
    /// Codes for a screen.
    Display,
    /// Linear floats before the tone map.
    Light,
}

impl FrameOutput {
    /// The format of the frame's target.
    pub(crate) fn format(self, encoding: Encoding) -> TextureFormat {
        match (self, encoding) {
            (Self::Light, _) => TextureFormat::Rgba32Float,
            (Self::Display, Encoding::Srgb) => TextureFormat::Rgba8UnormSrgb,
            (Self::Display, Encoding::Linear) => TextureFormat::Rgba8Unorm,
        }
    }
}

/// A picture of light: linear colours from 0 on without a bound, multiplied by alpha, row by row
/// from the top.
#[derive(Clone, PartialEq)]
pub struct LightImage {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// `width * height` pixels, 4 finite numbers each: R, G, B, which are at least 0 and multiplied
    /// by alpha, and alpha in 0..=1.
    pub rgba: Vec<f32>,
}

impl std::fmt::Debug for LightImage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "LightImage({}x{})", self.width, self.height)
    }
}

impl LightImage {
    /// The image of a target's bytes. What is no number becomes 0, and infinity the greatest
    /// number. If the background is opaque, so is each pixel: rounding may have left a little less.
    pub(crate) fn of_bytes((width, height): (u32, u32), bytes: &[u8], is_opaque: bool) -> Self {
        let number = |bytes: &[u8; 4]| f32::from_le_bytes(*bytes);
        let mut rgba: Vec<f32> = bytes.as_chunks().0.iter().map(number).collect();
        for pixel in rgba.as_chunks_mut::<4>().0 {
            for channel in &mut pixel[..3] {
                // `max` gives 0 for NaN, which `clamp` keeps.
                *channel = channel.clamp(0.0, f32::MAX).max(0.0);
            }
            pixel[3] = if is_opaque {
                1.0
            } else {
                pixel[3].clamp(0.0, 1.0).max(0.0)
            };
        }
        Self {
            width,
            height,
            rgba,
        }
    }

    /// The light over a background of one colour, sRGB, for formats without alpha.
    #[must_use]
    pub fn over(&self, background: [u8; 3]) -> HdrImage {
        let background = background.map(|code| decode(code, Encoding::Srgb));
        let pixels = self.rgba.as_chunks::<4>().0.iter();
        let rgb = pixels.flat_map(|&[r, g, b, alpha]| {
            let behind = background.map(|channel| channel * (1.0 - alpha));
            [r + behind[0], g + behind[1], b + behind[2]]
        });
        HdrImage {
            width: self.width,
            height: self.height,
            rgb: rgb.collect(),
        }
    }
}

/// An image on which marks are drawn, whose colours are made of codes in this way.
pub(crate) struct MarkedLight<'a>(pub(crate) &'a mut LightImage, pub(crate) Encoding);

impl Canvas for MarkedLight<'_> {
    fn size(&self) -> [u32; 2] {
        [self.0.width, self.0.height]
    }

    fn blend(&mut self, [x, y]: [u32; 2], color: [u8; 3], coverage: f32) {
        let at = (y as usize * self.0.width as usize + x as usize) * 4;
        let Some(pixel) = self.0.rgba.get_mut(at..at + 4) else {
            return;
        };
        let [r, g, b] = color.map(|code| decode(code, self.1));
        for (channel, own) in pixel.iter_mut().zip([r, g, b, 1.0]) {
            *channel = own * coverage + *channel * (1.0 - coverage);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{LightImage, MarkedLight};
    use crate::alpha::Encoding;
    use crate::canvas::Canvas;

    fn image(pixels: &[[f32; 4]], is_opaque: bool) -> LightImage {
        let numbers = pixels.iter().flatten();
        let bytes: Vec<u8> = numbers.flat_map(|number| number.to_le_bytes()).collect();
        let width = u32::try_from(pixels.len()).expect("few");
        LightImage::of_bytes((width, 1), &bytes, is_opaque)
    }

    #[test]
    fn pixels_are_finite_and_keep_what_is_above_one() {
        let pixels = [
            [1000.0, 0.5, -1.0, 0.25],
            [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::NAN],
        ];
        let clear = image(&pixels, false);
        assert_eq!(clear.rgba[..4], [1000.0, 0.5, 0.0, 0.25]);
        assert_eq!(clear.rgba[4..], [0.0, f32::MAX, 0.0, 0.0]);
        assert_eq!(image(&pixels, true).rgba[3], 1.0);
    }

    #[test]
    fn light_is_mixed_with_a_background_by_its_alpha() {
        let light = image(&[[2.0, 0.0, 0.5, 0.5], [3.0, 0.0, 0.0, 1.0]], false);
        let over = light.over([255, 255, 0]);
        assert_eq!(over.rgb, [2.5, 0.5, 0.5, 3.0, 0.0, 0.0]);
    }

    #[test]
    fn marks_cover_light() {
        let mut light = image(&[[4.0, 0.0, 0.0, 1.0], [0.0; 4]], false);
        let mut marked = MarkedLight(&mut light, Encoding::Srgb);
        marked.blend([0, 0], [255, 255, 255], 0.5);
        marked.blend([1, 0], [255, 0, 0], 0.25);
        marked.blend([2, 0], [255; 3], 1.0);
        assert_eq!(light.rgba[..4], [2.5, 0.5, 0.5, 1.0]);
        assert_eq!(light.rgba[4..], [0.25, 0.0, 0.0, 0.25]);
    }
}
