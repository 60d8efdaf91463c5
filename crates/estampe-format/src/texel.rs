//! One texel of any format that is not compressed.
//!
//! ```text
//!     words ──units──▶ units ──finish──▶ numbers        (decode does both)
//!           ◀────────────encode────────
//! ```
//!
//! Textures are filtered, and samples resolved, in *units*: the codes of unorm and snorm channels,
//! which are multiplied by 1/most at the very end, and the numbers of all other channels. See
//! `docs/NUMERICS.md`, *Textures*.

use crate::depth::FixedDepth;
use crate::layout::{self, ChannelPlace};
use crate::{float32, half, integer, normalized, shared_exponent, small_float, srgb};
use estampe_types::{SampleType, TexelEncoding, TextureAspect, TextureFormat};

/// Reads and writes texels of one format.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TexelCodec {
    encoding: Encoding,
    places: [ChannelPlace; 4],
    components: usize,
    words: usize,
    scale: [f32; 4],
    sample_type: SampleType,
}

/// The encoding of all channels of a texel.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Encoding {
    Unorm,
    Snorm,
    Srgb,
    Half,
    SmallFloat,
    SharedExponent,
    Float32,
    Uint,
    Sint,
    Depth(FixedDepth),
    FloatDepth,
    Compressed,
}

impl TexelCodec {
    /// The codec of a format's colour or depth; of formats with stencil alone, of that. Texels of
    /// compressed formats read as zeros and are written as zeros.
    #[must_use]
    pub fn new(format: TextureFormat) -> Self {
        use TexelEncoding as E;
        let encoding = match format.encoding() {
            _ if format.is_srgb() => Encoding::Srgb,
            E::Unorm8 | E::Unorm16 | E::Unorm10_2 => Encoding::Unorm,
            E::Snorm8 | E::Snorm16 => Encoding::Snorm,
            E::Uint8 | E::Uint16 | E::Uint32 | E::Uint10_2 | E::Stencil => Encoding::Uint,
            E::Sint8 | E::Sint16 | E::Sint32 => Encoding::Sint,
            E::Float16 => Encoding::Half,
            E::Ufloat11_10 => Encoding::SmallFloat,
            E::SharedExponent => Encoding::SharedExponent,
            E::Float32 => Encoding::Float32,
            E::Depth32 => Encoding::FloatDepth,
            _ => FixedDepth::new(format).map_or(Encoding::Compressed, Encoding::Depth),
        };
        let encoding = if format.is_compressed() {
            Encoding::Compressed
        } else {
            encoding
        };
        let places = layout::channels(format);
        let mut scale = [1.0; 4];
        for (channel, scale) in scale.iter_mut().enumerate().take(format.components()) {
            let bits = places[channel].bits;
            *scale = match encoding {
                Encoding::Unorm => 1.0 / most(bits),
                Encoding::Srgb if channel == 3 => 1.0 / most(bits),
                Encoding::Snorm => 1.0 / most(bits - 1),
                _ => 1.0,
            };
        }
        Self {
            encoding,
            places,
            components: format.components(),
            words: layout::words(format),
            scale,
            sample_type: format.sample_type(),
        }
    }

    /// The codec of one aspect of a format: that of its stencil where that is asked for beside
    /// depth, else [`new`](Self::new)'s.
    #[must_use]
    pub fn of_aspect(format: TextureFormat, aspect: TextureAspect) -> Self {
        if aspect != TextureAspect::Stencil || !format.has_depth() {
            return Self::new(format);
        }
        let mut places = [ChannelPlace::default(); 4];
        places[0] = layout::stencil(format);
        Self {
            encoding: Encoding::Uint,
            places,
            components: 1,
            words: layout::words(format),
            scale: [1.0; 4],
            sample_type: SampleType::Uint,
        }
    }

    /// Words of 32 bits of a texel, 1, 2 or 4; a smaller texel lies in the low bits of one.
    #[must_use]
    pub fn words(&self) -> usize {
        self.words
    }

    /// Channels that are stored, 1..=4.
    #[must_use]
    pub fn components(&self) -> usize {
        self.components
    }

    /// The number of a unit of each channel.
    #[must_use]
    pub fn scale(&self) -> [f32; 4] {
        self.scale
    }

    /// The type of the values that shaders read: numbers, or the bits of integers.
    #[must_use]
    pub fn sample_type(&self) -> SampleType {
        self.sample_type
    }

    /// Returns true if shaders read integers.
    #[must_use]
    pub fn is_integer(&self) -> bool {
        matches!(self.sample_type, SampleType::Uint | SampleType::Sint)
    }

    /// The values of channels that the format lacks: 0, 0, 0 and 1. The 1 is an integer if the
    /// format stores integers.
    #[must_use]
    pub fn missing(&self) -> [f32; 4] {
        let one = if self.is_integer() {
            f32::from_bits(1)
        } else {
            1.0
        };
        [0.0, 0.0, 0.0, one]
    }

    /// A texel in units, of integers their bits; words that are not there count as 0.
    #[inline]
    #[must_use]
    pub fn units(&self, texel: &[u32]) -> [f32; 4] {
        let mut words = [0; 4];
        for (to, from) in words.iter_mut().zip(texel) {
            *to = *from;
        }
        let mut units = self.missing();
        let codes = self.places.map(|place| place.read(words));
        let signed =
            |channel: usize| integer::sign_extended(codes[channel], self.places[channel].bits);
        let channels = &mut units[..self.components];
        match self.encoding {
            Encoding::Unorm => each(channels, |k| codes[k] as f32),
            Encoding::Snorm => each(channels, |k| {
                let least = -integer_most(self.places[k].bits - 1);
                signed(k).max(least) as f32
            }),
            Encoding::Srgb => each(channels, |k| match k {
                3 => codes[3] as f32,
                _ => srgb::LINEAR_FROM_SRGB[(codes[k] & 0xFF) as usize],
            }),
            Encoding::Half => each(channels, |k| half::decode(codes[k])),
            Encoding::SmallFloat => each(channels, |k| match k {
                2 => small_float::decode::<5>(codes[2]),
                _ => small_float::decode::<6>(codes[k]),
            }),
            Encoding::SharedExponent => {
                units[..3].copy_from_slice(&shared_exponent::decode(words[0]));
            }
            Encoding::Uint | Encoding::Float32 | Encoding::FloatDepth => {
                each(channels, |k| f32::from_bits(codes[k]));
            }
            Encoding::Sint => each(channels, |k| f32::from_bits(signed(k).cast_unsigned())),
            Encoding::Depth(depth) => each(channels, |_| depth.decode(codes[0])),
            Encoding::Compressed => each(channels, |_| 0.0),
        }
        units
    }

    /// Units as what a shader gets.
    #[inline]
    #[must_use]
    pub fn finish(&self, units: [f32; 4]) -> [f32; 4] {
        if self.is_integer() {
            return units;
        }
        let [r, g, b, a] = units;
        let scale = self.scale;
        [r * scale[0], g * scale[1], b * scale[2], a * scale[3]]
    }

    /// A texel as a render target's is decoded: numbers, snorm at least −1; of integers their bits.
    #[inline]
    #[must_use]
    pub fn decode(&self, texel: &[u32]) -> [f32; 4] {
        self.finish(self.units(texel))
    }

    /// A texel's words from what a shader gives: numbers, of integer formats their bits. Formats of
    /// depth and stencil give zeros: neither shaders nor filters write them.
    #[must_use]
    pub fn encode(&self, value: [f32; 4]) -> [u32; 4] {
        let mut words = [0; 4];
        for channel in 0..self.components {
            let (place, x) = (self.places[channel], value[channel]);
            let code = match self.encoding {
                Encoding::Srgb if channel < 3 => u32::from(srgb::encode(x)),
                Encoding::Unorm | Encoding::Srgb => {
                    normalized::encode_unorm(x, most(place.bits)).cast_unsigned()
                }
                Encoding::Snorm => {
                    normalized::encode_snorm(x, most(place.bits - 1)).cast_unsigned()
                }
                Encoding::Half => half::encode(x),
                Encoding::SmallFloat if channel == 2 => small_float::encode::<5>(x),
                Encoding::SmallFloat => small_float::encode::<6>(x),
                Encoding::Float32 => float32::encode(x),
                Encoding::Uint => integer::encode_uint(x.to_bits(), place.bits),
                Encoding::Sint => {
                    integer::encode_sint(x.to_bits().cast_signed(), place.bits).cast_unsigned()
                }
                Encoding::SharedExponent => {
                    let [r, g, b, _] = value;
                    return [shared_exponent::encode([r, g, b]), 0, 0, 0];
                }
                Encoding::Depth(_) | Encoding::FloatDepth | Encoding::Compressed => 0,
            };
            place.write(&mut words, code);
        }
        words
    }
}

/// 2ⁿ − 1 of n bits, 0..=16.
fn integer_most(bits: u32) -> i32 {
    (1 << bits) - 1
}

/// 2ⁿ − 1 of n bits, 0..=16.
fn most(bits: u32) -> f32 {
    integer_most(bits) as f32
}

#[inline(always)]
fn each(channels: &mut [f32], unit: impl Fn(usize) -> f32) {
    for (channel, to) in channels.iter_mut().enumerate() {
        *to = unit(channel);
    }
}
