//! Images with a palette, for other formats that have one.

use super::dither::Ditherer;
use super::palette::palette;
use estampe_scene::Image;

/// The most colours: one of 256 indices is transparent.
pub(super) const MOST_COLORS: usize = 255;

/// An image whose texels are numbers of colours.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Indexed {
    /// At most 255 colours, sRGB.
    pub palette: Vec<[u8; 3]>,
    /// A number for each texel, row by row from the top. That after the last colour, the length of
    /// the palette, is transparent.
    pub indices: Vec<u8>,
}

/// The image in the colours of a GIF: its own if they are few, else chosen in Oklab and dithered.
/// Texels with alpha below 128 are transparent, and the others opaque.
#[must_use]
pub fn indexed(image: &Image) -> Indexed {
    let palette = palette(std::slice::from_ref(image), MOST_COLORS);
    let indices = Ditherer::new(&palette).indices(image);
    Indexed { palette, indices }
}
