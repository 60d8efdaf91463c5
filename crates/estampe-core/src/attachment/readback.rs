//! From storage order to rows: the only place where the layout becomes visible as an image.

use super::RenderTarget;
use super::detile::{RowsJob, Selection, StoredTexels};
use super::resolve::Mean;
use super::texels::{ColorTexels, DepthStencilTexels};
use crate::layout::texel_words;
use estampe_simd::{LANE_X, LANE_Y, LANES, Level};

/// Why nothing was read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ReadbackError {
    /// There is no such colour attachment.
    #[error("no colour attachment {index}: the target has {count}")]
    NoAttachment {
        /// The requested index.
        index: usize,
        /// The number of colour attachments.
        count: usize,
    },
    /// The memory for the image is too short or too long.
    #[error("{actual} bytes of memory for an image of {expected} bytes: see color_len_bytes")]
    Length {
        /// The length of the image in bytes.
        expected: usize,
        /// The length of the given memory in bytes.
        actual: usize,
    },
}

impl RenderTarget {
    /// Returns the length in bytes of a colour attachment as rows of texels without padding
    /// (width · height · bytes of the format); 0 if `index` is beyond the last attachment.
    #[must_use]
    pub fn color_len_bytes(&self, index: usize) -> usize {
        let formats = self.color_formats();
        let bytes = formats.get(index).map_or(0, |format| format.block_bytes());
        self.width() as usize * self.height() as usize * bytes as usize
    }

    /// A colour attachment's texels in the format's own bytes (of RGBA8 R, G, B, A), row by row
    /// from the top; several samples are resolved to their mean (linear for sRGB). Beyond the last
    /// attachment it is empty.
    ///
    /// One thread does it; a device does it with all of its threads, and into memory that is there
    /// already.
    #[must_use]
    pub fn read_color(&self, index: usize) -> Vec<u8> {
        // Zeroed memory comes from the system untouched, so that filling it touches each page for
        // the first time.
        let mut image = vec![0; self.color_len_bytes(index)];
        if let Ok(jobs) = self.color_jobs(index, &mut image) {
            run_all(jobs);
        }
        image
    }

    /// [`Self::read_color`] into memory of [`Self::color_len_bytes`].
    ///
    /// # Errors
    /// [`ReadbackError`] beyond the last attachment, or when the memory has another length; nothing
    /// is written then.
    pub fn read_color_into(&self, index: usize, image: &mut [u8]) -> Result<(), ReadbackError> {
        run_all(self.color_jobs(index, image)?);
        Ok(())
    }

    /// The texels of one sample of a colour attachment in the format's own bytes, row by row from
    /// the top. Beyond the last attachment or sample it is empty.
    #[must_use]
    pub fn read_texels(&self, index: usize, sample: u32) -> Vec<u8> {
        if sample >= self.samples() {
            return Vec::new();
        }
        let mut image = vec![0; self.color_len_bytes(index)];
        if let Ok(jobs) = self.jobs(index, Some(sample as usize), &mut image) {
            run_all(jobs);
        }
        image
    }

    /// The jobs that fill an image with a colour attachment's resolved texels.
    pub(crate) fn color_jobs<'a>(
        &'a self,
        index: usize,
        image: &'a mut [u8],
    ) -> Result<impl Iterator<Item = RowsJob<'a>>, ReadbackError> {
        let sample = (self.samples() == 1).then_some(0);
        self.jobs(index, sample, image)
    }

    /// The jobs that fill an image with one sample of a colour attachment, or with the mean of all.
    fn jobs<'a>(
        &'a self,
        index: usize,
        sample: Option<usize>,
        image: &'a mut [u8],
    ) -> Result<impl Iterator<Item = RowsJob<'a>>, ReadbackError> {
        let Some(texels) = self.colors.get(index) else {
            return Err(ReadbackError::NoAttachment {
                index,
                count: self.colors.len(),
            });
        };
        let expected = self.color_len_bytes(index);
        if image.len() != expected {
            return Err(ReadbackError::Length {
                expected,
                actual: image.len(),
            });
        }
        Ok(texels.rows_jobs(sample, image))
    }

    /// The depth attachment, row by row from the top; of several samples the first. Depths of
    /// fixed-point formats are the numbers nearest to their codes. Without depth it is empty.
    #[must_use]
    pub fn read_depth(&self) -> Vec<f32> {
        self.read_depth_sample(0)
    }

    /// The depths of one sample. Without depth, or beyond the last sample, it is empty.
    #[must_use]
    pub fn read_depth_sample(&self, sample: u32) -> Vec<f32> {
        let texels = self.depth_stencil.as_ref();
        texels.map_or(Vec::new(), |texels| texels.depth_rows(sample))
    }

    /// The stencil values of one sample, row by row from the top. Without stencil, or beyond the
    /// last sample, it is empty.
    #[must_use]
    pub fn read_stencil(&self, sample: u32) -> Vec<u8> {
        let texels = self.depth_stencil.as_ref();
        texels.map_or(Vec::new(), |texels| texels.stencil_rows(sample))
    }
}

impl ColorTexels {
    /// The jobs that fill rows of the format's bytes with one sample, or with the mean of all. The
    /// image must have the right length.
    pub(crate) fn rows_jobs<'a>(
        &'a self,
        sample: Option<usize>,
        image: &'a mut [u8],
    ) -> impl Iterator<Item = RowsJob<'a>> {
        let samples = self.size.samples as usize;
        let stored = StoredTexels {
            words: &self.words,
            grid: self.size.grid(),
            words_each: texel_words(self.format),
            samples,
            selection: match sample {
                Some(sample) => Selection::Sample(sample),
                None => Selection::Mean(Mean::new(self.format, samples)),
            },
        };
        let bytes_each = self.format.block_bytes() as usize;
        RowsJob::all(stored, self.size.width as usize, bytes_each, image)
    }
}

impl DepthStencilTexels {
    /// The depths of one sample, row by row. Without depth, or beyond the last sample, it is empty.
    #[must_use]
    pub fn depth_rows(&self, sample: u32) -> Vec<f32> {
        self.rows_of_sample(&self.depth, sample)
    }

    /// The stencil values of one sample, row by row. Without stencil, or beyond the last sample, it
    /// is empty.
    #[must_use]
    pub fn stencil_rows(&self, sample: u32) -> Vec<u8> {
        self.rows_of_sample(&self.stencil, sample)
    }

    /// Rows of one value a pixel, packet by packet.
    fn rows_of_sample<T: Copy + Default>(&self, stored: &[T], sample: u32) -> Vec<T> {
        if stored.is_empty() || sample >= self.size.samples {
            return Vec::new();
        }
        let (width, height) = (self.size.width, self.size.height);
        let mut rows = vec![T::default(); width as usize * height as usize];
        let (samples, sample) = (self.size.samples as usize, sample as usize);
        let grid = self.size.grid();
        for y in (0..height).step_by(4) {
            for x in (0..width).step_by(4) {
                let first = (grid.packet_of(x, y) * samples + sample) * LANES;
                let packet = &stored[first..][..LANES];
                for (lane, &value) in packet.iter().enumerate() {
                    let (x, y) = (x + u32::from(LANE_X[lane]), y + u32::from(LANE_Y[lane]));
                    if x < width && y < height {
                        rows[y as usize * width as usize + x as usize] = value;
                    }
                }
            }
        }
        rows
    }
}

fn run_all<'a>(jobs: impl Iterator<Item = RowsJob<'a>>) {
    let level = Level::best();
    jobs.for_each(|mut job| job.run(level));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::RenderTargetDescriptor;
    use crate::attachment::resolve::mean_words;
    use estampe_format::AttachmentCodec;
    use estampe_types::{Limits, TextureFormat};

    /// A target whose attachment holds pseudo-random texels.
    fn target(format: TextureFormat, samples: u32, size: (u32, u32)) -> RenderTarget {
        let descriptor = RenderTargetDescriptor {
            samples,
            color_formats: vec![format],
            depth_stencil: None,
            ..RenderTargetDescriptor::new(size.0, size.1)
        };
        let mut target = RenderTarget::new(&descriptor, &Limits::default()).unwrap();
        let used = u32::MAX >> (32 - format.block_bytes().min(4) * 8);
        let mut state = size.0;
        for word in target.colors[0].words.iter_mut() {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            *word = (state ^ state >> 16) & used;
        }
        target
    }

    /// The definition: pixel by pixel, each texel's words from where they are stored, or the
    /// codec's mean of them.
    fn defined(target: &RenderTarget, sample: Option<usize>) -> Vec<u8> {
        let format = target.color_formats()[0];
        let codec = AttachmentCodec::new(format);
        let (count, words) = (target.samples() as usize, codec.words());
        let mut bytes = Vec::new();
        for y in 0..target.height() {
            for x in 0..target.width() {
                let is_here = |lane: &usize| {
                    let at = (u32::from(LANE_X[*lane]), u32::from(LANE_Y[*lane]));
                    at == (x % 4, y % 4)
                };
                let lane = (0..LANES).find(is_here).unwrap();
                let packet = target.grid().packet_of(x, y) * count;
                let elements = LANES * words;
                let texels = &target.colors[0].words[packet * elements..][..elements * count];
                let words = match sample {
                    Some(sample) => texels[sample * elements..][..elements].to_vec(),
                    None => mean_words(codec, texels, count).as_flattened()[..elements].to_vec(),
                };
                let texel: Vec<u8> = words
                    .chunks_exact(LANES)
                    .flat_map(|word| word[lane].to_le_bytes())
                    .collect();
                bytes.extend(&texel[..format.block_bytes() as usize]);
            }
        }
        bytes
    }

    #[test]
    fn rows_are_those_of_the_definition() {
        for &format in TextureFormat::ALL.iter().filter(|f| f.is_renderable()) {
            for samples in [1, 2, 4, 8, 16] {
                for size in [(1, 1), (16, 4), (37, 21)] {
                    let target = target(format, samples, size);
                    let place = format!("{}, {samples} samples, {size:?}", format.name());
                    let last = samples as usize - 1;
                    let texels = target.read_texels(0, samples - 1);
                    assert!(texels == defined(&target, Some(last)), "{place}");
                    let sample = (samples == 1).then_some(0);
                    let expected = defined(&target, sample);
                    assert!(target.read_color(0) == expected, "{place}");
                    for level in Level::all_available() {
                        let mut image = vec![0xA5; expected.len()];
                        let jobs = target.color_jobs(0, &mut image).unwrap();
                        jobs.for_each(|mut job| job.run(level));
                        assert!(image == expected, "{place}, {}", level.name());
                    }
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
            let target = target(format, 1, size);
            assert!(
                target.read_color(0) == defined(&target, Some(0)),
                "{format:?}"
            );
        }
    }

    #[test]
    fn memory_of_another_length_is_left_alone() {
        let target = target(TextureFormat::Rg8Unorm, 1, (5, 3));
        assert_eq!(target.color_len_bytes(0), 30);
        for actual in [0, 29, 31] {
            let mut image = vec![7; actual];
            let error = target.read_color_into(0, &mut image).unwrap_err();
            let expected = 30;
            assert_eq!(error, ReadbackError::Length { expected, actual });
            assert!(image.iter().all(|&byte| byte == 7));
        }
        let none = ReadbackError::NoAttachment { index: 1, count: 1 };
        assert_eq!(target.read_color_into(1, &mut []), Err(none));
        assert_eq!(target.color_len_bytes(1), 0);
        assert!(target.read_color(1).is_empty() && target.read_texels(0, 1).is_empty());
    }
}
