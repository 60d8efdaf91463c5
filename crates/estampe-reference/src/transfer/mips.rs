//! Mip levels: each texel is the mean of those above it.
//!
//! Precision: f32 in the order of NUMERICS.md, *Textures*, *Mip levels*.

use super::PlainTexture;
use super::sampled::words_of;
use crate::color;
use crate::shared_exponent;
use crate::texture::texel::TexelReader;
use estampe_types::{SampleType, TexelEncoding, TextureAspect, TextureDimension, TextureFormat};

/// Returns true if mip levels can be generated: of numbers, and not of compressed blocks.
#[must_use]
pub fn is_possible(format: TextureFormat) -> bool {
    format.sample_type() == SampleType::Float && !format.is_compressed()
}

/// Makes each level from the one above, from level `first` on, which is not 0.
///
/// # Panics
/// If it is not [possible](is_possible).
pub fn generate(texture: &mut PlainTexture, first: u32) {
    assert!(is_possible(texture.format), "no mean of these texels");
    let level_count = u32::try_from(texture.levels.len()).expect("few levels");
    for level in first..level_count {
        let [width, height, slices] = texture.level_size(level);
        for slice in 0..slices {
            for y in 0..height {
                for x in 0..width {
                    let mean = mean(texture, level - 1, [x, y, slice]);
                    let texel = texture.block_mut(level, [x, y, slice]);
                    texel.copy_from_slice(&mean);
                }
            }
        }
    }
}

/// The bytes of the mean of the texels of level `above` that become texel `at` of the next one.
fn mean(texture: &PlainTexture, above: u32, [x, y, slice]: [u32; 3]) -> Vec<u8> {
    let format = texture.format;
    let reader = TexelReader {
        format: match format {
            // The words have R first.
            TextureFormat::Bgra8Unorm => TextureFormat::Rgba8Unorm,
            TextureFormat::Bgra8UnormSrgb => TextureFormat::Rgba8UnormSrgb,
            _ => format,
        },
        aspect: TextureAspect::All,
    };
    let size = texture.level_size(above);
    let both = |at: u32, axis: usize| [2 * at, (2 * at + 1).min(size[axis] - 1)];
    let (columns, rows) = (both(x, 0), both(y, 1));
    let units = |column: usize, row: usize, slice: u32| {
        let texel = texture.block(above, [columns[column], rows[row], slice]);
        reader.units(&words_of(format, texel))
    };
    let sum_of_slice = |slice: u32| {
        let [a, b] = [units(0, 0, slice), units(1, 0, slice)];
        let [c, d] = [units(0, 1, slice), units(1, 1, slice)];
        [0, 1, 2, 3].map(|k| (a[k] + b[k]) + (c[k] + d[k]))
    };
    let mean = if texture.dimension == TextureDimension::D3 {
        let [near, far] = both(slice, 2).map(sum_of_slice);
        [0, 1, 2, 3].map(|k| (near[k] + far[k]) * 0.125)
    } else {
        sum_of_slice(slice).map(|sum| sum * 0.25)
    };
    encoded(format, mean)
}

/// The bytes of a mean in units: codes are rounded, numbers are encoded.
#[expect(
    clippy::cast_possible_truncation,
    reason = "codes have at most 16 bits"
)]
fn encoded(format: TextureFormat, mean: [f32; 4]) -> Vec<u8> {
    use TexelEncoding as E;
    if format.encoding() == E::SharedExponent {
        let [r, g, b, _] = mean;
        return shared_exponent::encode([r, g, b]).to_le_bytes().to_vec();
    }
    let are_codes = matches!(
        format.encoding(),
        E::Unorm8 | E::Snorm8 | E::Unorm16 | E::Snorm16 | E::Unorm10_2
    );
    let channels = crate::channel::channels(format);
    let codes = [0, 1, 2, 3].map(|k| {
        if are_codes && !(format.is_srgb() && k < 3) {
            let code = (mean[k] + 0.5).floor() as i32;
            channels[k].cut(code.cast_unsigned())
        } else {
            channels[k].encode(mean[k])
        }
    });
    color::bytes(format, codes)
}
