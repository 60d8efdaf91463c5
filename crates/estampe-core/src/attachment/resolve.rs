//! Resolving: the samples of each pixel become their mean, in storage order.
//!
//! Both images are made of the same packets in the same order: packet i of the destination is the
//! mean of the samples' lines of packet i. So the work is one pass over memory, cut anywhere: by
//! tiles while a pass has them in the cache, or all of it afterwards.

use super::texels::ColorTexels;
use crate::layout::texel_words;
use crate::pipeline::color_target::MAX_WORDS;
use estampe_format::srgb::{self, LINEAR_FROM_SRGB};
use estampe_format::{AttachmentCodec, PacketCodec, with_codec};
use estampe_simd::{LANES, Lanes, Level, SimdBase, dispatch, f32x16, outline, u32x16};
use estampe_types::{TexelEncoding, TextureFormat};

/// Packets of one job: a 64×64 block.
const JOB_PACKETS: usize = 256;

/// Words of a packet's texels, at most.
pub(super) const MAX_PACKET: usize = LANES * MAX_WORDS;

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
    /// Cuts the resolving of one image into jobs. The images have the same width, height and
    /// format, and the destination has one sample.
    pub(crate) fn of_image(
        from: &'a ColorTexels,
        into: &'a mut ColorTexels,
    ) -> impl Iterator<Item = Self> {
        let (format, count) = (from.format, from.size.samples as usize);
        let elements = JOB_PACKETS * LANES * texel_words(format);
        let samples = from.words.chunks(elements * count);
        let pixels = into.words_mut().chunks_mut(elements);
        samples.zip(pixels).map(move |(samples, pixels)| Self {
            samples,
            pixels,
            format,
            count,
        })
    }

    /// Resolves the lines of a tile.
    pub(crate) fn of_tile(
        samples: &'a [u32],
        pixels: &'a mut [u32],
        format: TextureFormat,
        count: usize,
    ) -> Self {
        Self {
            samples,
            pixels,
            format,
            count,
        }
    }

    /// Resolves the job's packets.
    pub(crate) fn run(&mut self, level: Level) {
        let mean = Mean::new(self.format, self.count);
        let elements = LANES * texel_words(self.format);
        dispatch!(level, s => {
            let samples = self.samples.chunks_exact(elements * self.count);
            for (samples, pixels) in samples.zip(self.pixels.chunks_exact_mut(elements)) {
                mean.write(s, samples, pixels);
            }
        });
    }
}

/// The method by which the samples of a texel are averaged, chosen by the format. See
/// `docs/NUMERICS.md`, *Resolve*.
#[derive(Debug, Clone, Copy)]
pub(super) enum Mean {
    /// Of 8-bit unorm channels, sums of integers.
    Unorm8 {
        /// log₂ of the samples of a pixel.
        samples_log2: u32,
    },
    /// Of four 8-bit channels, three of which are sRGB, and four samples.
    FourSrgb,
    /// Of any format.
    Any {
        /// The codec that reads and writes texels.
        codec: AttachmentCodec,
        /// Samples of a pixel.
        samples: usize,
    },
}

impl Mean {
    /// Of so many samples: 1, 2, 4, 8 or 16.
    pub(super) fn new(format: TextureFormat, samples: usize) -> Self {
        let is_unorm8 = format.encoding() == TexelEncoding::Unorm8;
        match (is_unorm8, format.is_srgb(), samples) {
            (true, false, _) => Self::Unorm8 {
                samples_log2: samples.ilog2(),
            },
            (true, true, 4) => Self::FourSrgb,
            _ => Self::Any {
                codec: AttachmentCodec::new(format),
                samples,
            },
        }
    }

    /// Writes the mean of a packet's samples.
    #[inline(always)]
    pub(super) fn write<S: Lanes>(&self, s: S, samples: &[u32], pixels: &mut [u32]) {
        match self {
            Self::Unorm8 { samples_log2 } => {
                mean_unorm(s, samples, *samples_log2).store_slice(&mut pixels[..LANES]);
            }
            Self::FourSrgb => mean_srgb(s, samples, pixels),
            Self::Any {
                codec,
                samples: count,
            } => {
                let words = mean_words(*codec, samples, *count);
                pixels.copy_from_slice(&words.as_flattened()[..pixels.len()]);
            }
        }
    }
}

/// The words of a packet's texels: the means of its samples, which follow each other. Of integers
/// the first sample counts.
#[inline(never)]
pub(super) fn mean_words(
    codec: AttachmentCodec,
    samples: &[u32],
    count: usize,
) -> [[u32; LANES]; MAX_WORDS] {
    let (texels, words) = (samples.as_chunks().0, codec.words());
    if codec.is_integer() {
        let mut first = [[0; LANES]; MAX_WORDS];
        first[..words].copy_from_slice(&texels[..words]);
        return first;
    }
    dispatch!(Level::best(), s => with_codec!(codec, codec => {
        outline!(s, mean_of(s, codec, texels, count))
    }))
}

#[inline(always)]
fn mean_of<S: Lanes, C: PacketCodec<S>>(
    s: S,
    codec: C,
    texels: &[[u32; LANES]],
    count: usize,
) -> [[u32; LANES]; MAX_WORDS] {
    let mut sums = [<f32x16<S> as SimdBase<S>>::splat(s, 0.0); 4];
    for texel in texels.chunks_exact(C::WORDS).take(count) {
        let mut words = [<u32x16<S> as SimdBase<S>>::splat(s, 0); MAX_WORDS];
        for (word, stored) in words.iter_mut().zip(texel) {
            *word = u32x16::load_array_ref(s, stored);
        }
        let units = codec.units(s, words);
        for (sum, units) in sums.iter_mut().zip(&units) {
            *sum += *units;
        }
    }
    let inverse_count = 1.0 / count as f32;
    for sum in &mut sums {
        *sum *= inverse_count;
    }
    let mut means = [[0; LANES]; MAX_WORDS];
    let words = codec.encode_units(s, sums);
    for (mean, word) in means.iter_mut().zip(&words) {
        *mean = word.to_array();
    }
    means
}

/// The means of sixteen pixels' samples in unorm channels of 8 bits, rounded to the nearest code:
/// floor(sum/n + ½) in integers, two channels at a time in halves of 16 bits. Sixteen samples sum
/// up to 4,088 at most.
#[inline(always)]
fn mean_unorm<S: Lanes>(s: S, samples: &[u32], samples_log2: u32) -> u32x16<S> {
    outline!(s, {
        let halves = u32x16::splat(s, 0x00FF_00FF);
        let rounding = u32x16::splat(s, ((1 << samples_log2) >> 1) * 0x0001_0001);
        let (mut even, mut odd) = (rounding, rounding);
        for sample in samples.as_chunks::<LANES>().0 {
            let sample = u32x16::load_array_ref(s, sample);
            even += sample & halves;
            odd += (sample >> 8) & halves;
        }
        ((even >> samples_log2) & halves) | (((odd >> samples_log2) & halves) << 8)
    })
}

/// The means of sixteen pixels' four samples in sRGB: linear for colour, alpha as it is. Most
/// packets lie inside a primitive, and their samples are equal.
#[inline(always)]
fn mean_srgb<S: Lanes>(s: S, samples: &[u32], pixels: &mut [u32]) {
    outline!(s, {
        let (a, b) = (&samples[..LANES], &samples[LANES..][..LANES]);
        let (c, d) = (
            &samples[2 * LANES..][..LANES],
            &samples[3 * LANES..][..LANES],
        );
        let first = u32x16::from_slice(s, a);
        let unlike = (first ^ u32x16::from_slice(s, b))
            | (first ^ u32x16::from_slice(s, c))
            | (first ^ u32x16::from_slice(s, d));
        let is_equal = unlike.simd_eq(u32x16::splat(s, 0));
        if s.bits_of_mask(is_equal) == u16::MAX {
            first.store_slice(&mut pixels[..LANES]);
            return;
        }
        let alpha = mean_unorm(s, samples, 2) & u32x16::splat(s, 0xFF00_0000);
        alpha.store_slice(&mut pixels[..LANES]);
        for (lane, pixel) in pixels.iter_mut().enumerate() {
            *pixel |= mean_srgb_colors([a[lane], b[lane], c[lane], d[lane]]);
        }
    })
}

/// The mean of four sRGB pixels' colours, without alpha.
#[inline(never)]
fn mean_srgb_colors(samples: [u32; 4]) -> u32 {
    if samples[1..] == [samples[0]; 3] {
        return samples[0] & 0x00FF_FFFF;
    }
    let table = &*LINEAR_FROM_SRGB;
    let channel = |shift: u32| {
        let [a, b, c, d] = samples.map(|sample| table[(sample >> shift & 0xFF) as usize]);
        u32::from(srgb::encode((a + b + c + d) * 0.25)) << shift
    };
    channel(0) | channel(8) | channel(16)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pseudo-random words, the first sample of some packets repeated in the others.
    fn samples(count: usize, words: usize) -> Vec<u32> {
        let mut state = 1_u32;
        let elements = LANES * words;
        let mut samples = Vec::new();
        for packet in 0..200 {
            let first: Vec<u32> = (0..elements * count)
                .map(|_| {
                    state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    state ^ state >> 16
                })
                .collect();
            if packet % 3 == 0 {
                samples.extend(first[..elements].repeat(count));
            } else {
                samples.extend(first);
            }
        }
        samples
    }

    #[test]
    fn each_channel_is_rounded_alone() {
        let samples = [0xFF00_01FE, 0xFF01_02FF, 0xFF00_02FF, 0xFF00_02FD];
        let samples: Vec<u32> = samples.iter().flat_map(|&word| [word; LANES]).collect();
        for level in Level::all_available() {
            let mut pixels = [0; LANES];
            dispatch!(level, s => mean_unorm(s, &samples, 2).store_slice(&mut pixels));
            // Sums 1020, 1, 7, 1017: over four, with halves up, 255, 0, 2, 254.
            assert_eq!(pixels, [0xFF00_02FE; LANES]);
        }
    }

    /// The fast forms give the bits of the definition, which is the codec's.
    #[test]
    fn means_are_the_codecs() {
        for &format in TextureFormat::ALL.iter().filter(|f| f.is_renderable()) {
            let codec = AttachmentCodec::new(format);
            let elements = LANES * codec.words();
            for count in [1, 2, 4, 8, 16] {
                // Small formats leave the upper bits of their word empty.
                let used = u32::MAX >> (32 - format.block_bytes().min(4) * 8);
                let samples: Vec<u32> = samples(count, codec.words())
                    .iter()
                    .map(|w| w & used)
                    .collect();
                let mean = Mean::new(format, count);
                for level in Level::all_available() {
                    for packet in samples.chunks_exact(elements * count) {
                        let mut pixels = [0; MAX_PACKET];
                        let pixels = &mut pixels[..elements];
                        dispatch!(level, s => mean.write(s, packet, pixels));
                        let expected = mean_words(codec, packet, count);
                        assert_eq!(
                            pixels,
                            &expected.as_flattened()[..elements],
                            "{}",
                            format.name()
                        );
                    }
                }
            }
        }
    }
}
