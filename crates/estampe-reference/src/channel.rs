//! Encoding and decoding of one channel of a texel.
//!
//! A *code* is a channel's encoded value: the bits that are stored. In · Out: the numbers that
//! shaders write · codes. Precision: f32 in the order of NUMERICS.md, *Formats*.

use crate::arithmetic::{clamp, max, min};
use crate::small_float::{half_code, half_value, unsigned_code, unsigned_value};
use crate::srgb;
use estampe_types::{TexelEncoding, TextureFormat};

/// The encoding of a channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Channel {
    /// The format lacks the channel: stores are ignored, loads give this number.
    Missing(u8),
    /// Unsigned normalised, of this many bits: 0 to 1.
    Unorm(u32),
    /// sRGB in 8 bits: 0 to 1.
    Srgb,
    /// Signed normalised, two's complement of this many bits: −1 to 1.
    Snorm(u32),
    /// An unsigned integer of this many bits.
    Uint(u32),
    /// A signed integer, two's complement of this many bits.
    Sint(u32),
    /// A 16-bit float.
    Half,
    /// An unsigned float with 5 bits of exponent and this many bits of mantissa.
    SmallFloat(u32),
    /// A 32-bit float.
    Float,
}

/// The channels R, G, B, A of a renderable format. Of a format that is not renderable, all are
/// missing.
#[must_use]
pub fn channels(format: TextureFormat) -> [Channel; 4] {
    use TexelEncoding as E;
    let present = if format.is_renderable() {
        format.components()
    } else {
        0
    };
    let (encoding, is_srgb) = (format.encoding(), format.is_srgb());
    std::array::from_fn(|index| {
        let is_alpha = index == 3;
        if index >= present {
            return Channel::Missing(u8::from(is_alpha));
        }
        match encoding {
            E::Unorm8 if is_srgb && !is_alpha => Channel::Srgb,
            E::Unorm8 => Channel::Unorm(8),
            E::Unorm16 => Channel::Unorm(16),
            E::Unorm10_2 => Channel::Unorm(if is_alpha { 2 } else { 10 }),
            E::Snorm8 => Channel::Snorm(8),
            E::Snorm16 => Channel::Snorm(16),
            E::Uint8 => Channel::Uint(8),
            E::Uint16 => Channel::Uint(16),
            E::Uint32 => Channel::Uint(32),
            E::Uint10_2 => Channel::Uint(if is_alpha { 2 } else { 10 }),
            E::Sint8 => Channel::Sint(8),
            E::Sint16 => Channel::Sint(16),
            E::Sint32 => Channel::Sint(32),
            E::Float16 => Channel::Half,
            E::Ufloat11_10 => Channel::SmallFloat(if index == 2 { 5 } else { 6 }),
            E::Float32 => Channel::Float,
            _ => Channel::Missing(u8::from(is_alpha)),
        }
    })
}

impl Channel {
    /// The number of bits of a code; 0 for a missing channel.
    #[must_use]
    pub fn bits(self) -> u32 {
        match self {
            Self::Missing(_) => 0,
            Self::Unorm(bits) | Self::Snorm(bits) | Self::Uint(bits) | Self::Sint(bits) => bits,
            Self::Srgb => 8,
            Self::Half => 16,
            Self::SmallFloat(mantissa) => 5 + mantissa,
            Self::Float => 32,
        }
    }

    /// The lowest [`bits`](Self::bits) bits of a code.
    #[must_use]
    pub fn cut(self, code: u32) -> u32 {
        let above = 32 - self.bits();
        code.checked_shl(above).map_or(0, |high| high >> above)
    }

    /// A colour channel limited to the range of the format, as blending does with its inputs: 0..=1
    /// for unorm and sRGB, −1..=1 for snorm, unchanged otherwise. NaN becomes 0 where there is a
    /// range.
    #[must_use]
    pub fn confine(self, value: f32) -> f32 {
        let or_zero = |value: f32| if value.is_nan() { 0.0 } else { value };
        match self {
            Self::Unorm(_) | Self::Srgb => clamp(or_zero(value), 0.0, 1.0),
            Self::Snorm(_) => clamp(or_zero(value), -1.0, 1.0),
            _ => value,
        }
    }

    /// The code of a number. For an integer channel `value` holds the integer as bits.
    #[must_use]
    pub fn encode(self, value: f32) -> u32 {
        match self {
            Self::Missing(_) => 0,
            Self::Unorm(bits) => {
                let scaled = self.confine(value) * greatest(bits) + 0.5;
                whole(scaled).cast_unsigned()
            }
            Self::Srgb => u32::from(srgb::code(value)),
            Self::Snorm(bits) => {
                let scaled = self.confine(value) * greatest(bits - 1);
                self.cut(whole(scaled.round_ties_even()).cast_unsigned())
            }
            Self::Uint(bits) => value.to_bits().min(u32::MAX >> (32 - bits)),
            Self::Sint(bits) => {
                let highest = i32::MAX >> (32 - bits);
                let confined = value.to_bits().cast_signed().clamp(-highest - 1, highest);
                self.cut(confined.cast_unsigned())
            }
            Self::Half => half_code(value),
            Self::SmallFloat(mantissa) => unsigned_code(value, mantissa),
            Self::Float if value.is_nan() => 0x7FC0_0000,
            Self::Float => value.to_bits(),
        }
    }

    /// The number that a code stands for; 0 for integer channels, which have none.
    #[must_use]
    pub fn decode(self, code: u32) -> f32 {
        match self {
            Self::Missing(value) => f32::from(value),
            Self::Unorm(bits) => code as f32 * (1.0 / greatest(bits)),
            Self::Srgb => srgb::linear(code),
            Self::Snorm(bits) => {
                let factor = 1.0 / greatest(bits - 1);
                max(self.signed(code) as f32 * factor, -1.0)
            }
            Self::Uint(_) | Self::Sint(_) => 0.0,
            Self::Half => half_value(code),
            Self::SmallFloat(mantissa) => unsigned_value(code, mantissa),
            Self::Float => f32::from_bits(code),
        }
    }

    /// The code that a clear to `value` stores. For integer channels `value` is truncated to an
    /// integer.
    #[must_use]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "`as` truncates and saturates, as NUMERICS.md says"
    )]
    pub fn clear_code(self, value: f64) -> u32 {
        match self {
            Self::Uint(_) => self.encode(f32::from_bits(value as u32)),
            Self::Sint(_) => self.encode(f32::from_bits((value as i32).cast_unsigned())),
            _ => self.encode(value as f32),
        }
    }

    /// The resolved code of one pixel's samples.
    pub fn resolve(self, samples: impl ExactSizeIterator<Item = u32>) -> u32 {
        let inverse_count = 1.0 / samples.len() as f32;
        let mut samples = samples;
        let mut mean_of = |value: &dyn Fn(u32) -> f32| {
            let sum = samples.by_ref().fold(0.0, |sum, code| sum + value(code));
            sum * inverse_count
        };
        match self {
            Self::Missing(_) => 0,
            Self::Uint(_) | Self::Sint(_) => samples.next().unwrap_or_default(),
            Self::Unorm(_) => {
                let mean = mean_of(&|code| code as f32);
                whole(mean + 0.5).cast_unsigned()
            }
            Self::Snorm(bits) => {
                let least = -greatest(bits - 1);
                let mean = mean_of(&|code| max(self.signed(code) as f32, least));
                self.cut(whole(mean.round_ties_even()).cast_unsigned())
            }
            _ => {
                let mean = mean_of(&|code| self.decode(code));
                self.encode(mean)
            }
        }
    }

    /// The signed integer of a code in two's complement.
    fn signed(self, code: u32) -> i32 {
        let above = 32 - self.bits();
        (code << above).cast_signed() >> above
    }
}

/// A depth rounded to the attachment's format: to the nearest multiple of 1/(2ⁿ − 1), ties to even,
/// in unorm formats; unchanged in float formats.
#[must_use]
pub fn quantised_depth(format: TextureFormat, depth: f32) -> f32 {
    let steps = match format.encoding() {
        TexelEncoding::Depth16 => greatest(16),
        TexelEncoding::Depth24 => greatest(24),
        _ => return depth,
    };
    (depth * steps).round_ties_even() / steps
}

/// The depth that a clear stores: clamped to 0..=1 and rounded to the format; NaN gives 0.
#[must_use]
pub fn clear_depth(format: TextureFormat, depth: f32) -> f32 {
    quantised_depth(format, min(max(depth, 0.0), 1.0))
}

/// The depth that an attachment of floats holds where a texel is loaded: clamped to 0..=1; −0,
/// which passes can store, stays; NaN gives 0.
#[must_use]
pub fn loaded_depth(depth: f32) -> f32 {
    if depth >= 0.0 { min(depth, 1.0) } else { 0.0 }
}

/// 2ⁿ − 1, exactly.
fn greatest(bits: u32) -> f32 {
    (u32::MAX >> (32 - bits)) as f32
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "at most 65536 in magnitude"
)]
fn whole(value: f32) -> i32 {
    value.floor() as i32
}
