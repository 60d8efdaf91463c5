//! Decoding of sixteen texels at once, for every format except integers.

use crate::texel::Corners;
use estampe_format::{TexelCodec, half, shared_exponent, small_float, srgb};
use estampe_simd::{Bytes, Lanes, SimdBase, SimdCvtFloat, f32x16, i32x16, u32x16};
use estampe_types::state::CompareFunction;
use estampe_types::{Real, SampleType, TexelEncoding, TextureFormat};

/// The kind of formats that share the general code.
pub(super) const OTHERS: u8 = 0;
/// Four unorm bytes.
pub(super) const RGBA8: u8 = 1;
/// Four unorm bytes with sRGB colours.
pub(super) const RGBA8_SRGB: u8 = 2;
/// Four half floats.
pub(super) const RGBA16F: u8 = 3;
/// One unorm byte.
pub(super) const R8: u8 = 4;

/// One float, or one depth that is a float.
pub(super) const FLOAT: u8 = 5;

/// A format that packet code decodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct PacketFormat {
    encoding: TexelEncoding,
    is_srgb: bool,
    /// The number of channels that are stored.
    pub(super) components: usize,
    /// Words of a texel: 1, 2 or 4.
    pub(super) words: i32,
}

impl PacketFormat {
    /// `None` for integers and stencil, which the scalar code reads lane by lane.
    pub(crate) fn new(stored: TextureFormat, codec: &TexelCodec) -> Option<Self> {
        let is_number = matches!(codec.sample_type(), SampleType::Float | SampleType::Depth);
        is_number.then_some(Self {
            encoding: stored.encoding(),
            is_srgb: stored.is_srgb(),
            components: stored.components(),
            words: i32::try_from(codec.words()).unwrap_or(1),
        })
    }

    /// The kind of the format: one with specialised code, or [`OTHERS`].
    pub(super) fn kind(self) -> u8 {
        match (self.encoding, self.components) {
            (TexelEncoding::Unorm8, 4) if self.is_srgb => RGBA8_SRGB,
            (TexelEncoding::Unorm8, 4) => RGBA8,
            (TexelEncoding::Float16, 4) => RGBA16F,
            (TexelEncoding::Unorm8, 1) => R8,
            _ => OTHERS,
        }
    }

    /// Returns true if `packet/bytes.rs` samples the format.
    pub(crate) fn is_of_bytes(self) -> bool {
        matches!(self.kind(), RGBA8 | RGBA8_SRGB | R8)
    }

    /// Returns true if texels are one unorm byte.
    pub(crate) fn is_one_byte(self) -> bool {
        self.kind() == R8
    }

    /// Returns true if texels are words of four unorm bytes, the last of which is alpha.
    pub(crate) fn is_of_four_bytes(self) -> bool {
        matches!(self.kind(), RGBA8 | RGBA8_SRGB)
    }

    /// Returns true if texels are one float: [`FLOAT`].
    pub(super) fn is_one_float(self) -> bool {
        let is_float = matches!(
            self.encoding,
            TexelEncoding::Float32 | TexelEncoding::Depth32
        );
        is_float && self.components == 1 && self.words == 1
    }

    /// Returns true if the format is a fixed-point depth.
    pub(super) fn is_fixed_depth(self) -> bool {
        matches!(
            self.encoding,
            TexelEncoding::Depth16 | TexelEncoding::Depth24
        )
    }

    /// Decodes the channels of texels from their words, in units; channels that the format does not
    /// store are unspecified. Loops have a constant length, so that channels stay in registers.
    #[inline(always)]
    pub(super) fn units<S: Lanes, const C: usize, const KIND: u8>(
        self,
        s: S,
        words: &[u32x16<S>; 4],
        units: &mut [f32x16<S>; C],
    ) {
        match KIND {
            RGBA8 | R8 => bytes(s, words[0], units),
            RGBA8_SRGB => {
                for (k, unit) in (0..).zip(units) {
                    *unit = if k < 3 {
                        srgb::decode_lanes(s, bits(s, words[0] >> (8 * k), 8))
                    } else {
                        number(words[0] >> 24)
                    };
                }
            }
            RGBA16F => {
                for (k, unit) in units.iter_mut().enumerate() {
                    *unit = half::decode_lanes(s, words[k / 2 % 4] >> [0, 16][k % 2]);
                }
            }
            FLOAT => units[0] = words[0].bitcast(),
            _ => self.units_of_others(s, words, units),
        }
    }

    #[inline(always)]
    fn units_of_others<S: Lanes, const C: usize>(
        self,
        s: S,
        words: &[u32x16<S>; 4],
        all: &mut [f32x16<S>; C],
    ) {
        use TexelEncoding as E;
        let units = all.iter_mut();
        let pair = |k: usize| words[k / 2 % 4] >> [0, 16][k % 2];
        let most = |value: f32| <f32x16<S> as SimdBase<S>>::splat(s, value);
        match self.encoding {
            E::Float32 | E::Depth32 => {
                for (unit, word) in units.zip(words) {
                    *unit = word.bitcast();
                }
            }
            E::Float16 => {
                for (k, unit) in units.enumerate() {
                    *unit = half::decode_lanes(s, pair(k));
                }
            }
            E::Unorm16 => {
                for (k, unit) in units.enumerate() {
                    *unit = number(bits(s, pair(k), 16));
                }
            }
            E::Snorm16 => {
                for (k, unit) in units.enumerate() {
                    *unit = s.max_f32(signed(pair(k) << 16, 16), most(-32_767.0));
                }
            }
            E::Snorm8 => {
                for (k, unit) in (0..).zip(units) {
                    *unit = s.max_f32(signed(words[0] << (24 - 8 * k), 24), most(-127.0));
                }
            }
            E::Unorm10_2 => {
                for (k, unit) in (0..).zip(units) {
                    let code = bits(s, words[0] >> (10 * k), 10);
                    *unit = number(if k < 3 { code } else { words[0] >> 30 });
                }
            }
            E::Ufloat11_10 => {
                for (k, unit) in (0..).zip(units) {
                    *unit = if k < 2 {
                        small_float::decode_lanes::<S, 6>(s, bits(s, words[0] >> (11 * k), 11))
                    } else {
                        small_float::decode_lanes::<S, 5>(s, words[0] >> 22)
                    };
                }
            }
            E::SharedExponent => {
                for (unit, channel) in units.zip(shared_exponent::decode_lanes(s, words[0])) {
                    *unit = channel;
                }
            }
            E::Depth16 => all[0] = number(bits(s, words[0], 16)) / 65_535.0,
            E::Depth24 => all[0] = number(bits(s, words[0], 24)) / 16_777_215.0,
            _ => {
                for (k, unit) in (0..).zip(units) {
                    let code = bits(s, words[0] >> (8 * k), 8);
                    *unit = if self.is_srgb && k < 3 {
                        srgb::decode_lanes(s, code)
                    } else {
                        number(code)
                    };
                }
            }
        }
    }
}

/// The weighted mean of the lowest bytes of four texels, in units.
#[inline(always)]
pub(super) fn red_mean<S: Lanes>(
    s: S,
    corners: Corners<i32x16<S>>,
    x: f32x16<S>,
    y: f32x16<S>,
) -> f32x16<S> {
    let byte = |word: i32x16<S>| number(bits(s, word.bitcast(), 8));
    let ([a, b], [c, d]) = (corners.upper, corners.lower);
    let [a, b, c, d] = [byte(a), byte(b), byte(c), byte(d)];
    let upper = a + (b - a) * x;
    let lower = c + (d - c) * x;
    upper + (lower - upper) * y
}

/// The weighted mean of the four bytes of a square, in units.
#[inline(always)]
pub(super) fn mean_of_square<S: Lanes>(
    s: S,
    word: u32x16<S>,
    x: f32x16<S>,
    y: f32x16<S>,
) -> f32x16<S> {
    let [a, b] = [number(bits(s, word, 8)), number(bits(s, word >> 8, 8))];
    let [c, d] = [number(bits(s, word >> 16, 8)), number(word >> 24)];
    let upper = a + (b - a) * x;
    let lower = c + (d - c) * x;
    upper + (lower - upper) * y
}

/// Decodes four bytes, in units.
#[inline(always)]
fn bytes<S: Lanes, const C: usize>(s: S, word: u32x16<S>, units: &mut [f32x16<S>; C]) {
    for (k, unit) in (0..).zip(units) {
        *unit = number(bits(s, word >> (8 * k), 8));
    }
}

/// The lowest `count` bits.
#[inline(always)]
fn bits<S: Lanes>(s: S, word: u32x16<S>, count: u32) -> u32x16<S> {
    word & <u32x16<S> as SimdBase<S>>::splat(s, u32::MAX >> (32 - count))
}

/// Converts integers below 2³¹ to floats.
#[inline(always)]
fn number<S: Lanes>(code: u32x16<S>) -> f32x16<S> {
    let signed: i32x16<S> = code.bitcast();
    f32x16::float_from(signed)
}

/// Converts the bits above the lowest `unused` ones to floats, as signed integers.
#[inline(always)]
fn signed<S: Lanes>(top: u32x16<S>, unused: u32) -> f32x16<S> {
    let signed: i32x16<S> = top.bitcast();
    f32x16::float_from(signed >> unused)
}

/// 1 where a comparison passes, else 0.
#[inline(always)]
pub(super) fn passes<R: Real>(function: CompareFunction, reference: R, texel: R) -> R {
    let mask = match function {
        CompareFunction::Never => reference.splat_mask(false),
        CompareFunction::Less => reference.lt(texel),
        CompareFunction::Equal => reference.eq(texel),
        CompareFunction::LessEqual => reference.le(texel),
        CompareFunction::Greater => reference.gt(texel),
        CompareFunction::NotEqual => !reference.eq(texel),
        CompareFunction::GreaterEqual => reference.ge(texel),
        CompareFunction::Always => reference.splat_mask(true),
    };
    R::select(mask, reference.splat(1.0), reference.splat(0.0))
}
