//! From storage order to rows of the format's bytes, of several samples their mean: images as the
//! host reads them.

use super::detile::{RowsJob, StoredTexels, StoredWords};
use super::resolve::Mean;
use super::texels::ColorTexels;
use crate::layout::texel_words;

impl ColorTexels {
    /// Cuts the filling of an image with texels in the format's bytes into jobs. The image must
    /// have width · height · the format's bytes.
    pub(crate) fn byte_rows_jobs<'a>(
        &'a self,
        image: &'a mut [u8],
    ) -> impl Iterator<Item = RowsJob<'a>> {
        let samples = self.size.samples as usize;
        let words = match samples {
            1 => StoredWords::One(&self.words),
            _ => StoredWords::Mean {
                words: &self.words,
                samples,
                mean: Mean::new(self.format, samples),
            },
        };
        let stored = StoredTexels {
            words,
            grid: self.size.grid(),
            words_each: texel_words(self.format),
        };
        let bytes_each = self.format.block_bytes() as usize;
        RowsJob::all(stored, self.size.width as usize, bytes_each, image)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::attachment::ImageSize;
    use crate::attachment::resolve::mean_words;
    use estampe_format::AttachmentCodec;
    use estampe_simd::{LANE_X, LANE_Y, LANES, Level};
    use estampe_types::TextureFormat;

    /// An image of pseudo-random texels.
    fn texels(format: TextureFormat, samples: u32, (width, height): (u32, u32)) -> ColorTexels {
        let size = ImageSize {
            width,
            height,
            samples,
        };
        let mut texels = ColorTexels::zeros(format, size).unwrap();
        let used = u32::MAX >> (32 - format.block_bytes().min(4) * 8);
        let mut state = width;
        for word in texels.words_mut().iter_mut() {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            *word = (state ^ state >> 16) & used;
        }
        texels
    }

    /// The definition: pixel by pixel, the words of the one sample from where they are stored, or
    /// the codec's mean of several.
    fn defined(image: &ColorTexels) -> Vec<u8> {
        let codec = AttachmentCodec::new(image.format);
        let (count, elements) = (image.size.samples as usize, LANES * codec.words());
        let mut bytes = Vec::new();
        for y in 0..image.size.height {
            for x in 0..image.size.width {
                let is_here = |lane: &usize| {
                    let at = (u32::from(LANE_X[*lane]), u32::from(LANE_Y[*lane]));
                    at == (x % 4, y % 4)
                };
                let lane = (0..LANES).find(is_here).unwrap();
                let packet = image.size.grid().packet_of(x, y) * count;
                let texels = &image.words[packet * elements..][..elements * count];
                let words = if count == 1 {
                    texels.to_vec()
                } else {
                    mean_words(codec, texels, count).as_flattened()[..elements].to_vec()
                };
                let texel: Vec<u8> = words
                    .chunks_exact(LANES)
                    .flat_map(|word| word[lane].to_le_bytes())
                    .collect();
                bytes.extend(&texel[..image.format.block_bytes() as usize]);
            }
        }
        bytes
    }

    /// Checks at every SIMD level that the bytes are those of the definition, and that all are
    /// written.
    fn check(format: TextureFormat, samples: u32, size: (u32, u32)) {
        let texels = texels(format, samples, size);
        let expected = defined(&texels);
        for level in Level::all_available() {
            let mut image = vec![0xA5; expected.len()];
            let jobs = texels.byte_rows_jobs(&mut image);
            jobs.for_each(|mut job| job.run(level));
            assert!(
                image == expected,
                "{}, {samples} samples, {size:?}, {}",
                format.name(),
                level.name()
            );
        }
    }

    #[test]
    fn rows_are_those_of_the_definition() {
        for &format in TextureFormat::ALL.iter().filter(|f| f.is_renderable()) {
            for samples in [1, 2, 4, 8, 16] {
                for size in [(1, 1), (16, 4), (37, 21)] {
                    check(format, samples, size);
                }
            }
        }
    }

    #[test]
    fn large_odd_sizes_are_read_whole() {
        for (format, size) in [
            (TextureFormat::Bgra8Unorm, (203, 131)),
            (TextureFormat::R8Unorm, (130, 67)),
            (TextureFormat::Rg16Float, (65, 64)),
            (TextureFormat::Rgba16Float, (129, 17)),
            (TextureFormat::Rgba32Float, (80, 81)),
        ] {
            check(format, 1, size);
        }
    }
}
