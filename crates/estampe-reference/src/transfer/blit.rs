//! Blits: a rectangle of an image, scaled, filtered and converted into one of another image.
//!
//! Precision: f32 in the order of NUMERICS.md, *Textures*, *Blits*.

use super::PlainImage;
use crate::color;
use crate::texture::ReferenceView;
use crate::texture::view::Sample;
use estampe_types::{FilterMode, TextureFormat};

/// A rectangle of texels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rectangle {
    /// Column and row of the first texel.
    pub origin: [u32; 2],
    /// Width and height, not zero.
    pub size: [u32; 2],
}

/// Blits a rectangle of a [2D view of one image](super::sampled::image_view), with the sampler's
/// magnification filter, into a rectangle of an image of a renderable format. Both rectangles lie
/// in their images.
pub fn blit(
    (from, source): (&ReferenceView, Rectangle),
    (into, format, destination): (&mut PlainImage, TextureFormat, Rectangle),
) {
    let level = &from.texture.levels[from.levels[0]];
    let sides = [level.width as f32, level.height as f32];
    let each = format.block_bytes() as usize;
    for y in 0..destination.size[1] {
        for x in 0..destination.size[0] {
            let place = [x, y];
            let at = [0, 1].map(|axis| {
                let (from_size, into_size) =
                    (source.size[axis] as f32, destination.size[axis] as f32);
                let pixel = place[axis] as f32 + 0.5;
                let first = source.origin[axis] as f32;
                match from.sampler.mag_filter {
                    FilterMode::Nearest => {
                        let texel = (pixel * from_size / into_size).floor() + first;
                        (texel + 0.5) * (1.0 / sides[axis])
                    }
                    FilterMode::Linear => {
                        (pixel * (from_size / into_size) + first) * (1.0 / sides[axis])
                    }
                }
            });
            let color = from.sample(&Sample {
                at: [at[0], at[1], 0.0],
                layer: 0,
                lod: from.biased(0.0, 0.0),
                probes: 1,
                step: [0.0; 3],
                offset: [0; 3],
                reference: None,
            });
            let texel = color::bytes(format, color::encode(format, color));
            let [column, row] = [0, 1].map(|axis| destination.origin[axis] + place[axis]);
            into.rows[row as usize][column as usize * each..][..each].copy_from_slice(&texel);
        }
    }
}
