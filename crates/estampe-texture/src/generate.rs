//! Generation of mip levels of every dimension and filterable format from the level above.
//!
//! A side is halved and rounded down, at least 1. A texel is the mean of the 2×2 texels (2×2×2 of
//! 3D textures) from (2x, 2y, 2z) on in the level above. The second coordinate is clamped where a
//! side is 1; the last texel of an odd side is left out.
//! [`MipGeneration::Full`](crate::MipGeneration::Full) states this rule.

use crate::mips;
use estampe_format::TexelCodec;
use estampe_types::{SampleType, TexelData, TexelEncoding, TextureDimension, TextureFormat};

/// Returns true if mip levels can be generated for the texture's format: formats of numbers,
/// compressed ones included.
#[must_use]
pub fn is_possible(texture: &TexelData) -> bool {
    texture.format.sample_type() == SampleType::Float
}

/// Generates a level from the one above in the texture's words; level 0 has none above.
pub fn level(texture: &TexelData, level: usize, words: &mut [u32]) {
    let Some(above) = level.checked_sub(1) else {
        return;
    };
    let stored = texture.stored_format();
    let (from, to) = (texture.levels[above], texture.levels[level]);
    let codec = TexelCodec::new(stored);
    let per_texel = codec.words();
    let is_3d = texture.shape.dimension == TextureDimension::D3;
    let (from_slices, slices) = (
        texture.shape.slices(above) as usize,
        texture.shape.slices(level) as usize,
    );
    let (width, height) = (from.width as usize, from.height as usize);
    let (above, rest) = words.split_at_mut(to.offset as usize * per_texel);
    let above = &above[from.offset as usize * per_texel..];
    let mut made = rest.chunks_exact_mut(per_texel);
    for slice in 0..slices {
        let near = if is_3d { 2 * slice } else { slice };
        let far = if is_3d {
            (near + 1).min(from_slices - 1)
        } else {
            near
        };
        for y in 0..to.height as usize {
            let rows = [2 * y, (2 * y + 1).min(height - 1)];
            for x in 0..to.width as usize {
                let columns = [2 * x, (2 * x + 1).min(width - 1)];
                let texel = |slice: usize, row: usize, column: usize| {
                    let at = (slice * height + rows[row]) * width + columns[column];
                    &above[at * per_texel..][..per_texel]
                };
                let four = |slice| {
                    [
                        texel(slice, 0, 0),
                        texel(slice, 0, 1),
                        texel(slice, 1, 0),
                        texel(slice, 1, 1),
                    ]
                };
                let Some(made) = made.next() else { return };
                let mean = match (stored, is_3d) {
                    (TextureFormat::Rgba8Unorm | TextureFormat::Rgba8UnormSrgb, false) => {
                        let mean = mips::mean_of_four(stored);
                        [mean(four(near).map(|texel| texel[0])), 0, 0, 0]
                    }
                    (_, false) => mean(stored, &codec, &[four(near)]),
                    (_, true) => mean(stored, &codec, &[four(near), four(far)]),
                };
                made.copy_from_slice(&mean[..per_texel]);
            }
        }
    }
}

/// The mean of four texels, or of eight.
fn mean(format: TextureFormat, codec: &TexelCodec, fours: &[[&[u32]; 4]]) -> [u32; 4] {
    use TexelEncoding as E;
    let factor = 0.25 / fours.len() as f32;
    let mut of_slices = [[0.0; 4]; 2];
    for (sum, four) in of_slices.iter_mut().zip(fours) {
        let [a, b, c, d] = four.map(|texel| codec.units(texel));
        for k in 0..4 {
            sum[k] = (a[k] + b[k]) + (c[k] + d[k]);
        }
    }
    let is_code = matches!(
        format.encoding(),
        E::Unorm8 | E::Snorm8 | E::Unorm16 | E::Snorm16 | E::Unorm10_2
    );
    let value = std::array::from_fn(|k| {
        let sum = if fours.len() == 2 {
            of_slices[0][k] + of_slices[1][k]
        } else {
            of_slices[0][k]
        };
        let mean = sum * factor;
        // Sums of encoded integers are exact, and so is the result ⌊mean + ½⌋. R, G and B of sRGB
        // are linear numbers.
        if is_code && !(format.is_srgb() && k < 3) {
            (mean + 0.5).floor() * codec.scale()[k]
        } else {
            mean
        }
    });
    codec.encode(value)
}
