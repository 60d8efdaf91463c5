//! Formats whose codes are the bits of a shader's numbers: 32-bit floats, and integers of any
//! width.

use super::PacketCodec;
use crate::{float32, integer, layout};
use estampe_simd::{Bytes, Lanes, SimdBase, f32x16, i32x16, u32x16};
use estampe_types::{SampleType, TextureFormat};

/// 32-bit floats and integers with texels of `WORDS` words, 1, 2 or 4.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bits<const WORDS: usize> {
    kind: SampleType,
    components: usize,
    /// Bits and lowest bit of each channel.
    bits: [u32; 4],
    shifts: [u32; 4],
}

impl<const WORDS: usize> Bits<WORDS> {
    /// The codec of a format with texels of `WORDS` words.
    pub(super) fn new(format: TextureFormat) -> Self {
        let places = layout::channels(format);
        Self {
            kind: format.sample_type(),
            components: format.components(),
            bits: places.map(|place| place.bits),
            shifts: places.map(|place| place.shift),
        }
    }

    /// The word of a channel: each has one, or all share them evenly.
    #[inline(always)]
    fn word_of(self, channel: usize) -> usize {
        match WORDS {
            1 => 0,
            2 if self.components == 4 => channel / 2,
            _ => channel,
        }
    }

    /// Sixteen codes of a channel.
    #[inline(always)]
    fn code<S: Lanes>(self, s: S, value: f32x16<S>, bits: u32) -> u32x16<S> {
        match self.kind {
            SampleType::Uint => integer::encode_uint_lanes(s, value.bitcast(), bits),
            SampleType::Sint => {
                let code: u32x16<S> =
                    integer::encode_sint_lanes(s, value.bitcast(), bits).bitcast();
                code & <u32x16<S> as SimdBase<S>>::splat(s, u32::MAX >> (32 - bits))
            }
            _ => float32::encode_lanes(s, value),
        }
    }
}

impl<S: Lanes, const WORDS: usize> PacketCodec<S> for Bits<WORDS> {
    const WORDS: usize = WORDS;

    #[inline(always)]
    fn decode(self, s: S, words: [u32x16<S>; 4]) -> [f32x16<S>; 4] {
        let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
        let one = match self.kind {
            SampleType::Uint | SampleType::Sint => f32::from_bits(1),
            _ => 1.0,
        };
        let mut numbers = [splat(0.0), splat(0.0), splat(0.0), splat(one)];
        for (k, to) in numbers.iter_mut().enumerate() {
            if k < self.components {
                let unused = 32 - self.bits[k];
                let top = words[self.word_of(k)] << (unused - self.shifts[k]);
                *to = if self.kind == SampleType::Sint {
                    let top: i32x16<S> = top.bitcast();
                    (top >> unused).bitcast()
                } else {
                    (top >> unused).bitcast()
                };
            }
        }
        numbers
    }

    #[inline(always)]
    fn encode(self, s: S, color: [f32x16<S>; 4]) -> [u32x16<S>; 4] {
        let mut words = [<u32x16<S> as SimdBase<S>>::splat(s, 0); 4];
        for (k, &value) in color.iter().enumerate() {
            if k < self.components {
                let word = &mut words[self.word_of(k)];
                *word |= self.code(s, value, self.bits[k]) << self.shifts[k];
            }
        }
        words
    }
}
