//! Conversion of the target's premultiplied pixels to the straight alpha of image files.

use estampe::srgb;
use estampe_scene::Image;

/// Encoding of the target's 8-bit channels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Encoding {
    /// Channel value ÷ 255.
    Linear,
    /// The sRGB curve, for R, G and B.
    Srgb,
}

/// Divides colours by their alpha: an image drawn over transparent black becomes straight alpha.
pub(crate) fn straighten(rgba: &mut [u8], encoding: Encoding) {
    for pixel in rgba.chunks_exact_mut(4) {
        let alpha = pixel[3];
        if alpha == 0 {
            pixel[..3].fill(0);
        } else if alpha < 255 {
            let coverage = f32::from(alpha) / 255.0;
            for code in &mut pixel[..3] {
                *code = encode(decode(*code, encoding) / coverage, encoding);
            }
        }
    }
}

/// Composites the image over a background of one colour, for formats without alpha. The result is
/// opaque. Both are sRGB; they are mixed in linear light.
#[must_use]
pub fn composite_over(image: &Image, background: [u8; 3]) -> Image {
    let mut rgba = image.rgba.clone();
    for pixel in rgba.chunks_exact_mut(4) {
        let coverage = f32::from(pixel[3]) / 255.0;
        if pixel[3] < 255 {
            for (code, behind) in pixel.iter_mut().zip(background) {
                let (own, behind) = (
                    decode(*code, Encoding::Srgb),
                    decode(behind, Encoding::Srgb),
                );
                *code = encode(own * coverage + behind * (1.0 - coverage), Encoding::Srgb);
            }
        }
        pixel[3] = 255;
    }
    Image {
        width: image.width,
        height: image.height,
        rgba,
    }
}

pub(crate) fn decode(code: u8, encoding: Encoding) -> f32 {
    match encoding {
        Encoding::Linear => f32::from(code) / 255.0,
        Encoding::Srgb => srgb::decode(code),
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to 0..=255"
)]
pub(crate) fn encode(value: f32, encoding: Encoding) -> u8 {
    match encoding {
        Encoding::Linear => (value.clamp(0.0, 1.0) * 255.0 + 0.5).floor() as u8,
        Encoding::Srgb => srgb::encode(value),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn straight_alpha_composites_to_what_was_drawn() {
        // Half of white over nothing is linear ½, premultiplied.
        let half = srgb::encode(128.0 / 255.0);
        let mut rgba = vec![half, half, half, 128, 9, 9, 9, 0, 10, 20, 30, 255];
        straighten(&mut rgba, Encoding::Srgb);
        assert_eq!(&rgba[..4], [255, 255, 255, 128]);
        assert_eq!(&rgba[4..], [0, 0, 0, 0, 10, 20, 30, 255]);
        let image = Image {
            width: 3,
            height: 1,
            rgba,
        };
        let over = composite_over(&image, [0, 0, 0]);
        assert_eq!(over.texel(0, 0), [half, half, half, 255]);
        let over = composite_over(&image, [0xf2; 3]);
        assert_eq!(over.texel(1, 0), [0xf2, 0xf2, 0xf2, 255]);
        assert_eq!(over.texel(2, 0), [10, 20, 30, 255]);
    }

    #[test]
    fn linear_values_are_divided_by_alpha() {
        let mut rgba = vec![64, 32, 0, 128];
        straighten(&mut rgba, Encoding::Linear);
        assert_eq!(rgba, [128, 64, 0, 128]);
    }
}
