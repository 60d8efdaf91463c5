//! The quads of a user interface, and the atlas of letters that they show.

use super::Outcome;
use estampe::{Device, Texture, TextureDescriptor, TextureFormat};

/// The columns of the letters A to Z, five bytes each, the top row in the lowest bit.
const COLUMNS: &str = "7E1111117E 7F49494936 3E41414122 7F4141221C 7F49494941 7F09090901 \
    3E4149497A 7F0808087F 00417F4100 2040413F01 7F08142241 7F40404040 7F020C027F 7F0408107F \
    3E4141413E 7F09090906 3E4151215E 7F09192946 4649494931 01017F0101 3F4040403F 1F2040201F \
    3F4038403F 6314081463 0708700807 6151494543";

/// The cell behind the letters is white.
const WHITE: f32 = 26.0;

/// Cells of 6×8 texels, side by side.
pub(crate) fn atlas(device: &Device) -> Outcome<Texture> {
    let mut texels = [0; 162 * 8];
    for (cell, letter) in COLUMNS.split(' ').chain(["FFFFFFFFFF"]).enumerate() {
        let columns = u64::from_str_radix(letter, 16)?.to_be_bytes();
        for (x, column) in columns[3..].iter().enumerate() {
            for y in (0..8).filter(|y| column >> y & 1 == 1) {
                texels[y * 162 + cell * 6 + x] = 255;
            }
        }
    }
    let descriptor = TextureDescriptor::new_2d(162, 8, TextureFormat::R8Unorm);
    Ok(device.create_texture_with_data(&descriptor, &[&texels])?)
}

/// For each quad: left, top, width and height in pixels, the premultiplied colour, the radius of
/// its corners, and its cell of the atlas.
#[derive(Default)]
pub(crate) struct Page(pub(crate) Vec<[f32; 10]>);

impl Page {
    /// A panel, by its straight colour.
    pub(crate) fn panel(&mut self, [x, y, w, h]: [f32; 4], radius: f32, color: [f32; 4]) {
        let [r, g, b, a] = color;
        let (r, g, b) = (r * a, g * a, b * a);
        self.0.push([x, y, w, h, r, g, b, a, radius, WHITE]);
    }

    /// Letters of 5×7 pixels times `size`.
    pub(crate) fn text(&mut self, [x, y]: [f32; 2], size: f32, [r, g, b]: [f32; 3], text: &str) {
        let [w, h] = [5.0 * size, 7.0 * size];
        for (k, letter) in (0_u8..).zip(text.bytes()) {
            if letter.is_ascii_uppercase() {
                let (x, cell) = (x + f32::from(k) * 6.0 * size, f32::from(letter - b'A'));
                self.0.push([x, y, w, h, r, g, b, 1.0, 0.0, cell]);
            }
        }
    }
}
