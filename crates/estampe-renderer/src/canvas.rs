//! Images on which marks are drawn: of codes, or of light.

use crate::alpha::{Encoding, decode, encode};
use estampe_scene::Image;

/// An image of which single pixels are covered by a colour.
pub(crate) trait Canvas {
    /// Width and height in pixels.
    fn size(&self) -> [u32; 2];

    /// Covers a share of a pixel, column and row from the top left, by an sRGB colour. A pixel that
    /// the image has not is left out.
    fn blend(&mut self, at: [u32; 2], color: [u8; 3], coverage: f32);
}

impl Canvas for Image {
    fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    fn blend(&mut self, [x, y]: [u32; 2], color: [u8; 3], coverage: f32) {
        let at = (y as usize * self.width as usize + x as usize) * 4;
        if let Some(pixel) = self.rgba.get_mut(at..at + 4) {
            blend(pixel, color, coverage);
        }
    }
}

/// Source over destination (Porter and Duff 1984), with straight alpha and in linear light.
pub(crate) fn blend(pixel: &mut [u8], color: [u8; 3], coverage: f32) {
    let behind = decode(pixel[3], Encoding::Linear) * (1.0 - coverage);
    let alpha = coverage + behind;
    for (code, own) in pixel.iter_mut().zip(color) {
        let (own, other) = (decode(own, Encoding::Srgb), decode(*code, Encoding::Srgb));
        *code = encode((own * coverage + other * behind) / alpha, Encoding::Srgb);
    }
    pixel[3] = encode(alpha, Encoding::Linear);
}
