//! Decoding of one texel of any format.
//!
//! In · Out: the words of a stored texel · channels in *units* and the factor of a unit. Units are
//! codes for unorm and snorm, the number otherwise, and the bits of integers. Spec: NUMERICS.md,
//! *Textures*.

use crate::srgb;
use estampe_types::{SampleType, TexelEncoding, TextureAspect, TextureFormat};

/// A decoder for the texels of a stored format.
#[derive(Debug, Clone, Copy)]
pub struct TexelReader {
    /// The format in which the texels are stored.
    pub format: TextureFormat,
    /// The aspect of a depth-stencil format that is read.
    pub aspect: TextureAspect,
}

impl TexelReader {
    /// Returns true if the channels are integers.
    #[must_use]
    pub fn is_integer(&self) -> bool {
        let kind = self.format.sample_type();
        matches!(kind, SampleType::Uint | SampleType::Sint)
            || self.aspect == TextureAspect::Stencil && self.format.has_stencil()
    }

    /// The factor that turns each channel's units into values.
    #[must_use]
    pub fn factors(&self) -> [f32; 4] {
        use TexelEncoding as E;
        std::array::from_fn(|k| {
            if k >= self.format.components() || (self.format.is_srgb() && k < 3) {
                return 1.0;
            }
            match self.format.encoding() {
                E::Unorm8 => 1.0 / 255.0,
                E::Snorm8 => 1.0 / 127.0,
                E::Unorm16 => 1.0 / 65535.0,
                E::Snorm16 => 1.0 / 32767.0,
                E::Unorm10_2 if k == 3 => 1.0 / 3.0,
                E::Unorm10_2 => 1.0 / 1023.0,
                _ => 1.0,
            }
        })
    }

    /// The number 1 in a channel's units; for integers, the bits of the integer 1.
    #[must_use]
    pub fn one(&self, channel: usize) -> f32 {
        use TexelEncoding as E;
        if self.is_integer() {
            return f32::from_bits(1);
        }
        if channel >= self.format.components() || (self.format.is_srgb() && channel < 3) {
            return 1.0;
        }
        match self.format.encoding() {
            E::Unorm8 => 255.0,
            E::Snorm8 => 127.0,
            E::Unorm16 => 65535.0,
            E::Snorm16 => 32767.0,
            E::Unorm10_2 if channel == 3 => 3.0,
            E::Unorm10_2 => 1023.0,
            _ => 1.0,
        }
    }

    /// The four channels of a texel, in units.
    #[must_use]
    pub fn units(&self, words: &[u32]) -> [f32; 4] {
        std::array::from_fn(|channel| {
            if channel < self.format.components() {
                self.channel(words, channel)
            } else if channel == 3 {
                self.one(3)
            } else {
                0.0
            }
        })
    }

    fn channel(&self, words: &[u32], channel: usize) -> f32 {
        use TexelEncoding as E;
        // At most 32 bits, from bit `first` on; no field crosses a word boundary.
        let field = |first: usize, count: u32| {
            let word = words.get(first / 32).copied().unwrap_or_default();
            let shifted = u64::from(word) >> (first % 32);
            u32::try_from(shifted & ((1 << count) - 1)).expect("at most 32 bits")
        };
        let whole = |bits: u32| field(channel * bits as usize, bits);
        let signed = |bits: u32| {
            let code = i64::from(whole(bits));
            let wrapped = if code >= 1 << (bits - 1) {
                code - (1 << bits)
            } else {
                code
            };
            i32::try_from(wrapped).expect("in two's complement")
        };
        let bits_of = |integer: i32| f32::from_bits(integer.cast_unsigned());
        let ten_two = |channel: usize| field(channel * 10, if channel == 3 { 2 } else { 10 });
        let wants_stencil = self.aspect == TextureAspect::Stencil;
        match self.format.encoding() {
            E::Unorm8 if self.format.is_srgb() && channel < 3 => srgb::linear(whole(8)),
            E::Unorm8 => whole(8) as f32,
            E::Unorm16 => whole(16) as f32,
            E::Snorm8 => Ord::max(signed(8), -127) as f32,
            E::Snorm16 => Ord::max(signed(16), -32767) as f32,
            E::Uint8 => f32::from_bits(whole(8)),
            E::Uint16 => f32::from_bits(whole(16)),
            E::Sint8 => bits_of(signed(8)),
            E::Sint16 => bits_of(signed(16)),
            E::Uint32 | E::Sint32 | E::Float32 => f32::from_bits(whole(32)),
            E::Float16 => small_float(whole(16), 10, true),
            E::Unorm10_2 => ten_two(channel) as f32,
            E::Uint10_2 => f32::from_bits(ten_two(channel)),
            E::Ufloat11_10 if channel == 2 => small_float(field(22, 10), 5, false),
            E::Ufloat11_10 => small_float(field(channel * 11, 11), 6, false),
            E::SharedExponent => {
                let mantissa = f64::from(field(channel * 9, 9));
                narrow(mantissa * power_of_two(field(27, 5).cast_signed() - 24))
            }
            E::Stencil => f32::from_bits(field(0, 8)),
            E::Depth16 => field(0, 16) as f32 / 65535.0,
            E::Depth24 if wants_stencil => f32::from_bits(field(24, 8)),
            E::Depth24 => field(0, 24) as f32 / 16_777_215.0,
            E::Depth32 if wants_stencil => f32::from_bits(field(32, 8)),
            E::Depth32 => f32::from_bits(field(0, 32)),
            _ => 0.0,
        }
    }
}

/// A float with 5 bits of exponent, decoded exactly in f64.
fn small_float(code: u32, mantissa_bits: u32, is_signed: bool) -> f32 {
    let mantissa = code & ((1 << mantissa_bits) - 1);
    let exponent = (code >> mantissa_bits & 31).cast_signed();
    let is_negative = is_signed && code >> (mantissa_bits + 5) == 1;
    let fraction = f64::from(mantissa) / f64::from(1_u32 << mantissa_bits);
    let magnitude = match (exponent, mantissa) {
        (31, 0) => f64::INFINITY,
        (31, _) => f64::NAN,
        (0, _) => fraction * power_of_two(-14),
        _ => (1.0 + fraction) * power_of_two(exponent - 15),
    };
    narrow(if is_negative { -magnitude } else { magnitude })
}

fn power_of_two(exponent: i32) -> f64 {
    2.0_f64.powi(exponent)
}

#[expect(clippy::cast_possible_truncation, reason = "f32 has these numbers")]
fn narrow(exact: f64) -> f32 {
    exact as f32
}
