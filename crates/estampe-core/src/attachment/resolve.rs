//! Resolving: the samples of each pixel become their mean, in storage order.
//!
//! Both targets are made of the same packets in the same order: packet i of the image is the mean of the
//! samples' lines of packet i. So the work is one pass over memory, cut anywhere.

use super::RenderTarget;
use crate::layout::texel_words;
use crate::per_sample::texel::{MAX_WORDS, TexelCodec};
use crate::raster::general::MAX_SAMPLES;
use estampe_simd::LANES;
use estampe_types::TextureFormat;
use estampe_types::srgb::{LINEAR_FROM_SRGB, srgb_from_linear};

/// Samples of the pixels that have a function of their own: four of RGBA8.
const SAMPLES: usize = 4;

/// Packets of one job: a 64×64 block.
const JOB_PACKETS: usize = 256;

/// A run of packets for one worker.
#[derive(Debug)]
pub(crate) struct ResolveJob<'a> {
    samples: &'a [u32],
    pixels: &'a mut [u32],
    format: TextureFormat,
    /// Samples of a pixel.
    count: usize,
}

impl<'a> ResolveJob<'a> {
    /// Cuts the resolving of a target's colours into jobs; none where the targets do not fit together.
    pub(crate) fn all(from: &'a RenderTarget, into: &'a mut RenderTarget) -> Vec<Self> {
        let (from_size, into_size) = ((from.width(), from.height()), (into.width(), into.height()));
        let fits = from_size == into_size
            && from.samples() > 1
            && into.samples() == 1
            && from.color_formats() == into.color_formats();
        if !fits {
            return Vec::new();
        }
        let count = from.samples() as usize;
        let attachments = from.colors.iter().zip(&mut into.colors);
        let attachments = attachments.zip(from.color_formats());
        let jobs = attachments.flat_map(|((samples, pixels), format)| {
            let elements = JOB_PACKETS * LANES * texel_words(*format);
            let samples = samples.chunks(elements * count);
            samples
                .zip(pixels.chunks_mut(elements))
                .map(move |(samples, pixels)| Self {
                    samples,
                    pixels,
                    format: *format,
                    count,
                })
        });
        jobs.collect()
    }

    /// Resolves the job's packets.
    pub(crate) fn run(&mut self) {
        let is_srgb = self.format.is_srgb();
        if self.count != SAMPLES || !is_rgba8(self.format) {
            self.run_any();
            return;
        }
        let samples = self.samples.as_chunks::<{ LANES * SAMPLES }>().0;
        let pixels = self.pixels.as_chunks_mut::<LANES>().0;
        for (samples, pixels) in samples.iter().zip(pixels) {
            let [a, b, c, d] = [0, 1, 2, 3].map(|sample| &samples[sample * LANES..][..LANES]);
            for (lane, pixel) in pixels.iter_mut().enumerate() {
                let of_pixel = [a[lane], b[lane], c[lane], d[lane]];
                *pixel = if is_srgb {
                    mean_srgb(of_pixel)
                } else {
                    mean_unorm(of_pixel)
                };
            }
        }
    }

    /// Of any format and number of samples.
    fn run_any(&mut self) {
        let codec = TexelCodec::new(self.format);
        let elements = LANES * codec.words;
        let samples = self.samples.chunks_exact(elements * self.count);
        for (samples, pixels) in samples.zip(self.pixels.chunks_exact_mut(elements)) {
            let words = mean_words(&codec, samples, self.count);
            pixels.copy_from_slice(&words.as_flattened()[..elements]);
        }
    }
}

/// Whether four samples of a format have functions of their own.
pub(super) fn is_rgba8(format: TextureFormat) -> bool {
    matches!(
        format,
        TextureFormat::Rgba8Unorm | TextureFormat::Rgba8UnormSrgb
    )
}

/// The words of a packet's texels: the means of its samples.
pub(super) fn mean_words(
    codec: &TexelCodec,
    samples: &[u32],
    count: usize,
) -> [[u32; LANES]; MAX_WORDS] {
    let mut codes = [[[0; LANES]; 4]; MAX_SAMPLES];
    let of_samples = samples.chunks_exact(LANES * codec.words);
    for (codes, texels) in codes.iter_mut().zip(of_samples) {
        *codes = codec.unpack(&codec.words_of(texels));
    }
    codec.pack(&codec.mean(&codes[..count.min(MAX_SAMPLES)]))
}

/// The mean of four unorm pixels, rounded to the nearest code: floor(sum/4 + ½) in integers, two channels
/// at a time in halves of 16 bits.
#[inline(always)]
pub(super) fn mean_unorm([a, b, c, d]: [u32; 4]) -> u32 {
    const HALVES: u32 = 0x00FF_00FF;
    const ROUNDING: u32 = 0x0002_0002;
    let even = (a & HALVES) + (b & HALVES) + (c & HALVES) + (d & HALVES) + ROUNDING;
    let odd = (a >> 8 & HALVES) + (b >> 8 & HALVES) + (c >> 8 & HALVES) + (d >> 8 & HALVES);
    (even >> 2 & HALVES) | (((odd + ROUNDING) >> 2 & HALVES) << 8)
}

/// The mean of four sRGB pixels: linear for colour, alpha as it is.
pub(super) fn mean_srgb(samples: [u32; 4]) -> u32 {
    if samples[1..] == [samples[0]; 3] {
        return samples[0];
    }
    let table = &*LINEAR_FROM_SRGB;
    let channel = |shift: u32| {
        let [a, b, c, d] = samples.map(|sample| table[(sample >> shift & 0xFF) as usize]);
        u32::from(srgb_from_linear((a + b + c + d) * 0.25)) << shift
    };
    channel(0) | channel(8) | channel(16) | mean_unorm(samples) & 0xFF00_0000
}

#[cfg(test)]
mod tests {
    use super::mean_unorm;

    #[test]
    fn each_channel_is_rounded_alone() {
        let samples = [0xFF00_01FE, 0xFF01_02FF, 0xFF00_02FF, 0xFF00_02FD];
        // Sums 1020, 1, 7, 1017: over four, with halves up, 255, 0, 2, 254.
        assert_eq!(mean_unorm(samples), 0xFF00_02FE);
        let mut state = 1_u32;
        for _ in 0..10_000 {
            let samples = [0; 4].map(|_: u32| {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                state ^ state >> 16
            });
            let mean = mean_unorm(samples).to_le_bytes();
            for (channel, mean) in mean.into_iter().enumerate() {
                let sum: u32 = samples
                    .iter()
                    .map(|sample| u32::from(sample.to_le_bytes()[channel]))
                    .sum();
                assert_eq!(u32::from(mean), (sum + 2) / 4);
            }
        }
    }
}
