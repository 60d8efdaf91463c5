//! Unorm and snorm formats of any widths, in one word or two.

use super::PacketCodec;
use crate::layout;
use crate::normalized::{code_of_positive, encode_snorm_lanes, encode_unorm_lanes};
use estampe_simd::{Bytes, Lanes, SimdBase, SimdCvtFloat, f32x16, i32x16, u32x16};
use estampe_types::{TexelEncoding, TextureFormat};

/// Unorm and snorm formats but those of [`Rgba8`](super::Rgba8), with texels of `WORDS` words, 1 or
/// 2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Normalized<const WORDS: usize> {
    channels: [Channel; 4],
    components: usize,
    is_signed: bool,
}

/// One channel in its word; of one that the format lacks, zeros.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Channel {
    /// Its lowest bit.
    shift: u32,
    /// The number of bits of the word above the channel's highest bit.
    above: u32,
    /// The number of bits of the word that do not belong to the channel.
    unused: u32,
    /// Its bits, at the low end.
    mask: u32,
    /// The greatest code.
    most: f32,
    /// 1/most.
    unit: f32,
}

impl<const WORDS: usize> Normalized<WORDS> {
    /// The codec of a format with texels of `WORDS` words.
    pub(super) fn new(format: TextureFormat) -> Self {
        use TexelEncoding as E;
        let is_signed = matches!(format.encoding(), E::Snorm8 | E::Snorm16);
        let mut channels = [Channel::default(); 4];
        let places = layout::channels(format);
        for (channel, place) in channels.iter_mut().zip(places).take(format.components()) {
            let unused = 32 - place.bits;
            let mask = u32::MAX >> unused;
            let most = if is_signed { mask >> 1 } else { mask } as f32;
            *channel = Channel {
                shift: place.shift,
                above: unused - place.shift,
                unused,
                mask,
                most,
                unit: 1.0 / most,
            };
        }
        Self {
            channels,
            components: format.components(),
            is_signed,
        }
    }

    /// The word of a channel: all are in the first, or two in each of two.
    #[inline(always)]
    fn word_of(channel: usize) -> usize {
        channel * WORDS / 4
    }

    /// Packs the codes that `code` gives for the format's channels.
    #[inline(always)]
    fn pack<S: Lanes>(
        self,
        s: S,
        values: [f32x16<S>; 4],
        code: impl Fn(f32x16<S>, Channel) -> i32x16<S>,
    ) -> [u32x16<S>; 4] {
        let splat = |value| <u32x16<S> as SimdBase<S>>::splat(s, value);
        let mut words = [splat(0); 4];
        for (k, &value) in values.iter().enumerate() {
            if k < self.components {
                let channel = self.channels[k];
                let bits: u32x16<S> = code(value, channel).bitcast();
                let word = &mut words[Self::word_of(k)];
                *word |= (bits & splat(channel.mask)) << channel.shift;
            }
        }
        words
    }

    /// Numbers that `number` makes of the codes of the format's channels; those of others are (0,
    /// 0, 0, 1).
    #[inline(always)]
    fn unpack<S: Lanes>(
        self,
        s: S,
        words: [u32x16<S>; 4],
        number: impl Fn(f32x16<S>, Channel) -> f32x16<S>,
    ) -> [f32x16<S>; 4] {
        let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
        let mut numbers = [splat(0.0), splat(0.0), splat(0.0), splat(1.0)];
        for (k, to) in numbers.iter_mut().enumerate() {
            if k < self.components {
                let channel = self.channels[k];
                let top = words[Self::word_of(k)] << channel.above;
                let code: i32x16<S> = if self.is_signed {
                    let top: i32x16<S> = top.bitcast();
                    top >> channel.unused
                } else {
                    (top >> channel.unused).bitcast()
                };
                *to = number(f32x16::float_from(code), channel);
            }
        }
        numbers
    }
}

impl<S: Lanes, const WORDS: usize> PacketCodec<S> for Normalized<WORDS> {
    const WORDS: usize = WORDS;

    #[inline(always)]
    fn decode(self, s: S, words: [u32x16<S>; 4]) -> [f32x16<S>; 4] {
        let least = <f32x16<S> as SimdBase<S>>::splat(s, -1.0);
        // No unorm number is below −1.
        self.unpack(
            s,
            words,
            #[inline(always)]
            |code, channel| s.max_f32(code * channel.unit, least),
        )
    }

    #[inline(always)]
    fn encode(self, s: S, color: [f32x16<S>; 4]) -> [u32x16<S>; 4] {
        if self.is_signed {
            self.pack(
                s,
                color,
                #[inline(always)]
                |x, channel| encode_snorm_lanes(s, x, channel.most),
            )
        } else {
            self.pack(
                s,
                color,
                #[inline(always)]
                |x, channel| encode_unorm_lanes(s, x, channel.most),
            )
        }
    }

    #[inline(always)]
    fn units(self, s: S, words: [u32x16<S>; 4]) -> [f32x16<S>; 4] {
        // No unorm code is below −most.
        self.unpack(
            s,
            words,
            #[inline(always)]
            |code, channel| s.max_f32(code, <f32x16<S> as SimdBase<S>>::splat(s, -channel.most)),
        )
    }

    #[inline(always)]
    fn encode_units(self, s: S, means: [f32x16<S>; 4]) -> [u32x16<S>; 4] {
        if self.is_signed {
            self.pack(
                s,
                means,
                #[inline(always)]
                |mean, _| s.round_to_i32(mean),
            )
        } else {
            self.pack(
                s,
                means,
                #[inline(always)]
                |mean, _| code_of_positive(mean),
            )
        }
    }
}
