//! Formats of 16-bit floats, and of unsigned floats of 11 and 10 bits.

use super::PacketCodec;
use crate::{half, small_float};
use estampe_simd::{Lanes, SimdBase, f32x16, u32x16};
use estampe_types::TextureFormat;

/// Formats of 16-bit floats with texels of `WORDS` words: one or two channels in one, four in two.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Half<const WORDS: usize> {
    components: usize,
}

impl<const WORDS: usize> Half<WORDS> {
    /// The codec of a format with texels of `WORDS` words.
    pub(super) fn new(format: TextureFormat) -> Self {
        let components = format.components();
        Self { components }
    }
}

impl<S: Lanes, const WORDS: usize> PacketCodec<S> for Half<WORDS> {
    const WORDS: usize = WORDS;

    #[inline(always)]
    fn decode(self, s: S, words: [u32x16<S>; 4]) -> [f32x16<S>; 4] {
        let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
        // Of R16Float the upper half of the word is 0, which is G's number, too.
        let [red, green] = half::decode_pair(s, words[0]);
        if WORDS == 2 {
            let [blue, alpha] = half::decode_pair(s, words[1]);
            return [red, green, blue, alpha];
        }
        [red, green, splat(0.0), splat(1.0)]
    }

    #[inline(always)]
    fn encode(self, s: S, [r, g, b, a]: [f32x16<S>; 4]) -> [u32x16<S>; 4] {
        let zero = <u32x16<S> as SimdBase<S>>::splat(s, 0);
        if WORDS == 2 {
            let [first, second] = [half::encode_pair(s, [r, g]), half::encode_pair(s, [b, a])];
            return [first, second, zero, zero];
        }
        let first = if self.components == 2 {
            half::encode_pair(s, [r, g])
        } else {
            half::encode_lanes(s, r)
        };
        [first, zero, zero, zero]
    }
}

/// `Rg11B10Ufloat`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rg11B10;

impl<S: Lanes> PacketCodec<S> for Rg11B10 {
    const WORDS: usize = 1;

    #[inline(always)]
    fn decode(self, s: S, words: [u32x16<S>; 4]) -> [f32x16<S>; 4] {
        let mask = <u32x16<S> as SimdBase<S>>::splat(s, 0x7FF);
        let word = words[0];
        [
            small_float::decode_lanes::<S, 6>(s, word & mask),
            small_float::decode_lanes::<S, 6>(s, (word >> 11) & mask),
            small_float::decode_lanes::<S, 5>(s, word >> 22),
            <f32x16<S> as SimdBase<S>>::splat(s, 1.0),
        ]
    }

    #[inline(always)]
    fn encode(self, s: S, [r, g, b, _]: [f32x16<S>; 4]) -> [u32x16<S>; 4] {
        let zero = <u32x16<S> as SimdBase<S>>::splat(s, 0);
        let r = small_float::encode_lanes::<S, 6>(s, r);
        let g = small_float::encode_lanes::<S, 6>(s, g);
        let b = small_float::encode_lanes::<S, 5>(s, b);
        [r | (g << 11) | (b << 22), zero, zero, zero]
    }
}
