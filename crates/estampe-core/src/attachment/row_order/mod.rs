//! Between storage order and the row order in which textures are sampled: the change of a texture's
//! role.
//!
//! In row order a texel's samples follow each other, and each is as many whole words as in an
//! attachment: of colours R, G, B, A from the low bits on, also where the format has B first; of
//! depth the f32 bits or the code, with the stencil above a code of 24 bits and in a second word
//! after an f32.

mod from_rows;
mod to_rows;

use super::texels::ImageSize;
use crate::layout::texel_words;
use estampe_types::TextureFormat;

/// The number of words of an image in row order.
#[must_use]
pub fn row_order_words(format: TextureFormat, size: ImageSize) -> usize {
    let pixels = size.width as usize * size.height as usize;
    pixels * size.samples as usize * words_each(format)
}

/// Words of a texel's sample in row order.
fn words_each(format: TextureFormat) -> usize {
    match format {
        TextureFormat::Depth32FloatStencil8 => 2,
        _ => texel_words(format).max(1),
    }
}

pub(super) fn swaps_red_and_blue(format: TextureFormat) -> bool {
    use TextureFormat as F;
    matches!(format, F::Bgra8Unorm | F::Bgra8UnormSrgb)
}

pub(super) fn swapped(word: u32) -> u32 {
    word & 0xFF00_FF00 | (word & 0xFF) << 16 | (word >> 16 & 0xFF)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::attachment::texels::{ColorTexels, DepthStencilTexels};
    use estampe_simd::{LANE_X, LANES, Level};

    /// Words that are valid texels of a format.
    fn rows(format: TextureFormat, size: ImageSize) -> Vec<u32> {
        let mut state = size.width * 7 + size.height;
        let each = words_each(format);
        let words = (0..row_order_words(format, size)).map(|at| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let bits = state ^ state >> 15;
            use TextureFormat as F;
            match format {
                F::Depth32Float => (bits as f32 / 4_294_967_296.0).to_bits(),
                F::Depth32FloatStencil8 if at % 2 == 0 => (bits as f32 / 4_294_967_296.0).to_bits(),
                F::Depth32FloatStencil8 | F::Stencil8 => bits & 0xFF,
                F::Depth24Plus => bits & 0x00FF_FFFF,
                F::Depth16Unorm => bits & 0xFFFF,
                _ if each == 1 => bits & u32::MAX >> (32 - 8 * format.block_bytes().min(4)),
                _ => bits,
            }
        });
        words.collect()
    }

    #[test]
    fn rows_survive_the_way_to_an_attachment_and_back() {
        for &format in TextureFormat::ALL {
            let is_depth = format.has_depth() || format.has_stencil();
            if !format.is_renderable() && !is_depth {
                continue;
            }
            for (width, height, samples) in [(1, 1, 1), (70, 66, 1), (37, 5, 4), (128, 64, 1)] {
                let size = ImageSize {
                    width,
                    height,
                    samples,
                };
                let rows = rows(format, size);
                for level in Level::all_available() {
                    let mut back = vec![0; rows.len()];
                    if is_depth {
                        let mut texels = DepthStencilTexels::zeros(format, size).unwrap();
                        texels
                            .storage_jobs(&rows)
                            .for_each(|mut job| job.run(level));
                        texels
                            .row_jobs(&mut back)
                            .for_each(|mut job| job.run(level));
                    } else {
                        let mut texels = ColorTexels::zeros(format, size).unwrap();
                        texels
                            .storage_jobs(&rows)
                            .for_each(|mut job| job.run(level));
                        texels
                            .row_jobs(&mut back)
                            .for_each(|mut job| job.run(level));
                    }
                    assert!(rows == back, "{}, {size:?}", format.name());
                }
            }
        }
    }

    /// Whole packets, which go through lanes, clamp depths and cut codes as the pixels at an edge
    /// do, which go one by one.
    #[test]
    fn hostile_depths_are_clamped_in_lanes_as_one_by_one() {
        let hostile = [
            f32::NAN.to_bits(),
            (-f32::NAN).to_bits(),
            (-0.0_f32).to_bits(),
            (-1.5_f32).to_bits(),
            1.5_f32.to_bits(),
            f32::INFINITY.to_bits(),
            1,
            0x3F7F_FFFF,
            u32::MAX,
        ];
        for &format in TextureFormat::ALL {
            if !(format.has_depth() || format.has_stencil()) {
                continue;
            }
            // The same words are a whole packet of the one image, cut by the edge of the other.
            let [whole, cut] = [4, 3].map(|width| {
                let size = ImageSize {
                    width,
                    height: 4,
                    samples: 1,
                };
                let each = words_each(format);
                let pixels = (0..4).flat_map(|y| (0..width).map(move |x| (x + y * 4) as usize));
                let rows: Vec<u32> = pixels
                    .flat_map(|pixel| (0..each).map(move |word| hostile[(pixel + word) % 9]))
                    .collect();
                Level::all_available().into_iter().map(move |level| {
                    let mut texels = DepthStencilTexels::zeros(format, size).unwrap();
                    texels
                        .storage_jobs(&rows)
                        .for_each(|mut job| job.run(level));
                    let lanes = (0..LANES).filter(|&lane| LANE_X[lane] < 3);
                    let values = lanes.map(|lane| {
                        let depth = texels.depth.get(lane).map(|depth| depth.to_bits());
                        (depth, texels.stencil.get(lane).copied())
                    });
                    values.collect::<Vec<_>>()
                })
            });
            for (whole, cut) in whole.zip(cut) {
                assert_eq!(whole, cut, "{}", format.name());
                let depths = whole.iter().filter_map(|value| value.0);
                assert!(depths.map(f32::from_bits).all(|d| (0.0..=1.0).contains(&d)));
                let is_float = format.has_depth()
                    && format.encoding() == estampe_types::TexelEncoding::Depth32;
                let negative_zeros = whole.iter().filter(|value| value.0 == Some(1 << 31));
                assert_eq!(is_float, negative_zeros.count() > 0, "{}", format.name());
            }
        }
    }

    /// The bytes that a colour attachment is read back as are those of its rows, R and B in the
    /// order of the format.
    #[test]
    fn rows_are_the_texels_that_are_read_back() {
        for format in [TextureFormat::Rgba8Unorm, TextureFormat::Bgra8Unorm] {
            let size = ImageSize {
                width: 21,
                height: 18,
                samples: 1,
            };
            let rows = rows(format, size);
            let mut texels = ColorTexels::zeros(format, size).unwrap();
            let level = Level::best();
            texels
                .storage_jobs(&rows)
                .for_each(|mut job| job.run(level));
            let mut bytes = vec![0; rows.len() * 4];
            let jobs = texels.byte_rows_jobs(&mut bytes);
            jobs.for_each(|mut job| job.run(level));
            let swaps = swaps_red_and_blue(format);
            let expected = rows.iter().map(|&w| if swaps { swapped(w) } else { w });
            assert!(expected.flat_map(u32::to_le_bytes).eq(bytes), "{format:?}");
        }
    }
}
