//! Four unorm bytes, R or B first, R, G and B perhaps encoded as sRGB.

use super::PacketCodec;
use crate::normalized::{code_of_positive, encode_unorm_lanes, saturate_lanes};
use crate::srgb;
use estampe_simd::{Bytes, Lanes, SimdBase, SimdCvtFloat, f32x16, i32x16, u32x16};
use estampe_types::TextureFormat;

/// `Rgba8Unorm` and `Bgra8Unorm`, which cost the same.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rgba8 {
    shifts: Shifts,
}

/// `Rgba8UnormSrgb` and `Bgra8UnormSrgb`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rgba8Srgb {
    shifts: Shifts,
}

/// The lowest bits of R and B in a texel: 0 and 16, or 16 and 0. A vector shift by a variable
/// number of bits is as fast as one by a constant, so the two orders need no branch.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Shifts {
    red: u32,
    blue: u32,
}

const UNIT: f32 = 1.0 / 255.0;

impl Rgba8 {
    /// The codec of one of the two formats.
    pub(super) fn new(format: TextureFormat) -> Self {
        let shifts = Shifts::new(format);
        Self { shifts }
    }
}

impl Rgba8Srgb {
    /// The codec of one of the two formats.
    pub(super) fn new(format: TextureFormat) -> Self {
        let shifts = Shifts::new(format);
        Self { shifts }
    }
}

impl Shifts {
    fn new(format: TextureFormat) -> Self {
        match format.is_bgra() {
            true => Self { red: 16, blue: 0 },
            false => Self { red: 0, blue: 16 },
        }
    }

    /// Packs codes, 0..=255.
    #[inline(always)]
    fn pack<S: Lanes>(self, s: S, [r, g, b, a]: [u32x16<S>; 4]) -> [u32x16<S>; 4] {
        let zero = <u32x16<S> as SimdBase<S>>::splat(s, 0);
        let word = (r << self.red) | (g << 8) | (b << self.blue) | (a << 24);
        [word, zero, zero, zero]
    }

    /// The codes of words.
    #[inline(always)]
    fn unpack<S: Lanes>(self, s: S, word: u32x16<S>) -> [u32x16<S>; 4] {
        let byte = <u32x16<S> as SimdBase<S>>::splat(s, 0xFF);
        [
            (word >> self.red) & byte,
            (word >> 8) & byte,
            (word >> self.blue) & byte,
            word >> 24,
        ]
    }
}

impl<S: Lanes> PacketCodec<S> for Rgba8 {
    const WORDS: usize = 1;

    #[inline(always)]
    fn decode(self, s: S, words: [u32x16<S>; 4]) -> [f32x16<S>; 4] {
        let [r, g, b, a] = self.units(s, words);
        [r * UNIT, g * UNIT, b * UNIT, a * UNIT]
    }

    #[inline(always)]
    fn encode(self, s: S, [r, g, b, a]: [f32x16<S>; 4]) -> [u32x16<S>; 4] {
        let [r, g, b, a] = [
            encode_unorm_lanes(s, r, 255.0),
            encode_unorm_lanes(s, g, 255.0),
            encode_unorm_lanes(s, b, 255.0),
            encode_unorm_lanes(s, a, 255.0),
        ];
        self.shifts
            .pack(s, [r.bitcast(), g.bitcast(), b.bitcast(), a.bitcast()])
    }

    #[inline(always)]
    fn units(self, s: S, words: [u32x16<S>; 4]) -> [f32x16<S>; 4] {
        let [r, g, b, a] = self.shifts.unpack(s, words[0]);
        [float(r), float(g), float(b), float(a)]
    }

    #[inline(always)]
    fn encode_units(self, s: S, [r, g, b, a]: [f32x16<S>; 4]) -> [u32x16<S>; 4] {
        let codes = [nearest(r), nearest(g), nearest(b), nearest(a)];
        self.shifts.pack(s, codes)
    }
}

impl Rgba8Srgb {
    /// Packs linear R, G and B, and the codes of A.
    #[inline(always)]
    fn pack<S: Lanes>(self, s: S, [r, g, b]: [f32x16<S>; 3], a: u32x16<S>) -> [u32x16<S>; 4] {
        let codes = [
            srgb::encode_lanes(s, saturate_lanes(s, r)),
            srgb::encode_lanes(s, saturate_lanes(s, g)),
            srgb::encode_lanes(s, saturate_lanes(s, b)),
            a,
        ];
        self.shifts.pack(s, codes)
    }
}

impl<S: Lanes> PacketCodec<S> for Rgba8Srgb {
    const WORDS: usize = 1;

    #[inline(always)]
    fn decode(self, s: S, words: [u32x16<S>; 4]) -> [f32x16<S>; 4] {
        let [r, g, b, a] = self.units(s, words);
        [r, g, b, a * UNIT]
    }

    #[inline(always)]
    fn encode(self, s: S, [r, g, b, a]: [f32x16<S>; 4]) -> [u32x16<S>; 4] {
        let alpha = encode_unorm_lanes(s, a, 255.0);
        self.pack(s, [r, g, b], alpha.bitcast())
    }

    #[inline(always)]
    fn units(self, s: S, words: [u32x16<S>; 4]) -> [f32x16<S>; 4] {
        let [r, g, b, a] = self.shifts.unpack(s, words[0]);
        [
            srgb::decode_lanes(s, r),
            srgb::decode_lanes(s, g),
            srgb::decode_lanes(s, b),
            float(a),
        ]
    }

    #[inline(always)]
    fn encode_units(self, s: S, [r, g, b, a]: [f32x16<S>; 4]) -> [u32x16<S>; 4] {
        self.pack(s, [r, g, b], nearest(a))
    }
}

#[inline(always)]
fn float<S: Lanes>(code: u32x16<S>) -> f32x16<S> {
    let signed: i32x16<S> = code.bitcast();
    f32x16::float_from(signed)
}

#[inline(always)]
fn nearest<S: Lanes>(unit: f32x16<S>) -> u32x16<S> {
    code_of_positive(unit).bitcast()
}
