//! Text on images: labels of sheets and of dimensions.
//!
//! The font is Noto Sans Mono, rasterized beforehand in four heights, so a label is the same bytes
//! on every machine. It has the characters of Latin-1 and Latin Extended-A; others are shown as
//! a replacement character. Text runs from left to right in one line.

#[cfg(test)]
mod tests;

use crate::canvas::Canvas;
use estampe_scene::Image;
use noto_sans_mono_bitmap::{
    FontWeight, RasterHeight, RasterizedChar, get_raster, get_raster_width,
};

/// Line height of text, in pixels. Letters are about 0.73 times as high.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum TextHeight {
    /// 16 pixels.
    Px16,
    /// 20 pixels.
    Px20,
    /// 24 pixels.
    Px24,
    /// 32 pixels.
    Px32,
}

impl TextHeight {
    /// The greatest height of at most `height_px`, or the smallest one.
    #[must_use]
    pub fn at_most(height_px: u32) -> Self {
        match height_px {
            0..=19 => Self::Px16,
            20..=23 => Self::Px20,
            24..=31 => Self::Px24,
            _ => Self::Px32,
        }
    }

    /// The height in pixels.
    #[must_use]
    pub fn px(self) -> u32 {
        match self {
            Self::Px16 => 16,
            Self::Px20 => 20,
            Self::Px24 => 24,
            Self::Px32 => 32,
        }
    }

    fn raster(self) -> RasterHeight {
        match self {
            Self::Px16 => RasterHeight::Size16,
            Self::Px20 => RasterHeight::Size20,
            Self::Px24 => RasterHeight::Size24,
            Self::Px32 => RasterHeight::Size32,
        }
    }
}

/// Colours of text, sRGB.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct TextStyle {
    /// The line height.
    pub height: TextHeight,
    /// Colour of the letters.
    pub color: [u8; 3],
    /// Colour of an outline one pixel wide, which keeps text legible on any picture.
    pub outline: Option<[u8; 3]>,
}

/// Width in pixels of a line of text: all characters are equally wide.
#[must_use]
pub fn text_width_px(text: &str, height: TextHeight) -> u32 {
    let characters = u32::try_from(text.chars().count()).unwrap_or(u32::MAX);
    characters.saturating_mul(character_width_px(height))
}

/// Width in pixels of one character.
#[must_use]
pub fn character_width_px(height: TextHeight) -> u32 {
    u32::try_from(get_raster_width(FontWeight::Regular, height.raster())).unwrap_or(u32::MAX)
}

/// Draws a line of text with its upper left corner at column `left` and row `top`, in pixels from
/// the image's upper left corner. What lies outside of the image is left out.
///
/// The colour is mixed with the image's in linear light, by the share of each pixel that the
/// letters cover; transparent pixels become as opaque as they are covered.
pub fn draw_text(image: &mut Image, place: (i64, i64), text: &str, style: TextStyle) {
    write_text(image, place, text, style);
}

/// [`draw_text`] on images of codes or of light.
pub(crate) fn write_text(
    image: &mut impl Canvas,
    (left, top): (i64, i64),
    text: &str,
    style: TextStyle,
) {
    if let Some(outline) = style.outline {
        for (dx, dy) in AROUND {
            line(image, (left + dx, top + dy), text, (style.height, outline));
        }
    }
    line(image, (left, top), text, (style.height, style.color));
}

/// The neighbours of a pixel.
const AROUND: [(i64, i64); 8] = [
    (-1, -1),
    (0, -1),
    (1, -1),
    (-1, 0),
    (1, 0),
    (-1, 1),
    (0, 1),
    (1, 1),
];

fn line(image: &mut impl Canvas, (left, top): (i64, i64), text: &str, ink: (TextHeight, [u8; 3])) {
    let (height, color) = ink;
    let step = i64::from(character_width_px(height));
    let mut x = left;
    for character in text.chars() {
        if x >= i64::from(image.size()[0]) {
            return;
        }
        if x + step > 0 {
            glyph(image, (x, top), &raster_of(character, height), color);
        }
        x += step;
    }
}

fn raster_of(character: char, height: TextHeight) -> RasterizedChar {
    let raster = |character| get_raster(character, FontWeight::Regular, height.raster());
    raster(character)
        .or_else(|| raster('\u{fffd}'))
        .or_else(|| raster('?'))
        .expect("the font has the question mark")
}

fn glyph(
    image: &mut impl Canvas,
    (left, top): (i64, i64),
    raster: &RasterizedChar,
    color: [u8; 3],
) {
    for (y, row) in (top..).zip(raster.rows()) {
        for (x, &coverage) in (left..).zip(row) {
            if let (true, Some(at)) = (coverage > 0, pixel(image, x, y)) {
                image.blend(at, color, f32::from(coverage) / 255.0);
            }
        }
    }
}

/// The column and row of a pixel, if the image has it.
fn pixel(image: &impl Canvas, x: i64, y: i64) -> Option<[u32; 2]> {
    let [width, height] = image.size();
    let x = u32::try_from(x).ok().filter(|&x| x < width)?;
    let y = u32::try_from(y).ok().filter(|&y| y < height)?;
    Some([x, y])
}
