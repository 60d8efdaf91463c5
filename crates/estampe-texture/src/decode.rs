//! Stored texels as numbers: one texel's words, one match.
//!
//! Filtering works in *units*: codes for unorm and snorm, which are multiplied by 1/(2ⁿ − 1) at the very end, and
//! numbers for everything else. Integers are their bits. See `docs/NUMERICS.md`, *Textures*.

use estampe_types::srgb::LINEAR_FROM_SRGB;
use estampe_types::{SampleType, TexelEncoding, TextureAspect, TextureFormat};

/// Reads texels of one stored format.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Decoder {
    encoding: TexelEncoding,
    components: usize,
    is_srgb: bool,
    /// Whether stencil is read beside depth.
    reads_stencil: bool,
    /// Words of a texel.
    pub(crate) words: usize,
    /// What units are multiplied by at the end.
    pub(crate) scale: [f32; 4],
    /// What a sample is: of integers, bits.
    pub(crate) sample_type: SampleType,
}

impl Decoder {
    /// For a format that texels are stored as, not one of blocks.
    pub(crate) fn new(stored: TextureFormat, aspect: TextureAspect) -> Self {
        use TexelEncoding as E;
        let encoding = stored.encoding();
        let unit = match encoding {
            E::Unorm8 => 1.0 / 255.0,
            E::Snorm8 => 1.0 / 127.0,
            E::Unorm16 => 1.0 / 65535.0,
            E::Snorm16 => 1.0 / 32767.0,
            E::Unorm10_2 => 1.0 / 1023.0,
            _ => 1.0,
        };
        let mut scale = [unit; 4];
        if encoding == E::Unorm10_2 {
            scale[3] = 1.0 / 3.0;
        }
        if stored.is_srgb() {
            scale[..3].fill(1.0);
        }
        let components = stored.components();
        scale[components..].fill(1.0);
        let reads_stencil = aspect == TextureAspect::Stencil && stored.has_depth();
        let sample_type = if reads_stencil {
            SampleType::Uint
        } else {
            stored.sample_type()
        };
        Self {
            encoding,
            components,
            is_srgb: stored.is_srgb(),
            reads_stencil,
            words: stored.block_bytes().div_ceil(4) as usize,
            scale,
            sample_type,
        }
    }

    /// Whether samples are integers.
    pub(crate) fn is_integer(&self) -> bool {
        matches!(self.sample_type, SampleType::Uint | SampleType::Sint)
    }

    /// 0 or 1 of a channel, in units: what borders are made of.
    pub(crate) fn of_border(&self, channel: usize, is_one: bool) -> f32 {
        if channel >= self.components {
            return self.missing()[channel];
        }
        match (is_one, self.is_integer()) {
            (false, _) => 0.0,
            (true, true) => f32::from_bits(1),
            (true, false) => (1.0 / self.scale[channel]).round(),
        }
    }

    /// What channels that the format lacks read as.
    fn missing(&self) -> [f32; 4] {
        let one = if self.is_integer() {
            f32::from_bits(1)
        } else {
            1.0
        };
        [0.0, 0.0, 0.0, one]
    }

    /// A texel in units; words that are missing count as 0.
    #[inline]
    pub(crate) fn unit(&self, texel: &[u32]) -> [f32; 4] {
        use TexelEncoding as E;
        let word = |at: usize| texel.get(at).copied().unwrap_or_default();
        let mut unit = self.missing();
        let channels = &mut unit[..self.components];
        match self.encoding {
            E::Unorm8 if self.is_srgb => {
                let [r, g, b, a] = word(0).to_le_bytes();
                let linear = |code: u8| LINEAR_FROM_SRGB[usize::from(code)];
                return [linear(r), linear(g), linear(b), f32::from(a)];
            }
            E::Unorm8 => each(channels, |k| byte(word(0), k) as f32),
            E::Snorm8 => each(channels, |k| {
                (sign_extended(byte(word(0), k), 8)).max(-127) as f32
            }),
            E::Uint8 => each(channels, |k| f32::from_bits(byte(word(0), k))),
            E::Sint8 => each(channels, |k| bits_of(sign_extended(byte(word(0), k), 8))),
            E::Unorm16 => each(channels, |k| half_word(word(k / 2), k) as f32),
            E::Snorm16 => each(channels, |k| {
                sign_extended(half_word(word(k / 2), k), 16).max(-32767) as f32
            }),
            E::Uint16 => each(channels, |k| f32::from_bits(half_word(word(k / 2), k))),
            E::Sint16 => each(channels, |k| {
                bits_of(sign_extended(half_word(word(k / 2), k), 16))
            }),
            E::Float16 => each(channels, |k| float_of(half_word(word(k / 2), k), 10)),
            E::Uint32 | E::Sint32 | E::Float32 => each(channels, |k| f32::from_bits(word(k))),
            E::Unorm10_2 => return ten_ten_ten_two(word(0)).map(|code| code as f32),
            E::Uint10_2 => return ten_ten_ten_two(word(0)).map(f32::from_bits),
            E::Ufloat11_10 => {
                let word = word(0);
                channels[0] = float_of((word & 0x7FF) << 4, 10);
                channels[1] = float_of((word >> 11 & 0x7FF) << 4, 10);
                channels[2] = float_of((word >> 22) << 5, 10);
            }
            E::SharedExponent => {
                let exponent = (word(0) >> 27) as i32 - 15 - 9;
                let factor = f32::from_bits(((exponent + 127) << 23).cast_unsigned());
                each(channels, |k| (word(0) >> (9 * k) & 0x1FF) as f32 * factor);
            }
            E::Stencil => channels[0] = f32::from_bits(word(0) & 0xFF),
            E::Depth16 => channels[0] = (word(0) & 0xFFFF) as f32 / 65535.0,
            E::Depth24 if self.reads_stencil => channels[0] = f32::from_bits(word(0) >> 24),
            E::Depth24 => channels[0] = (word(0) & 0xFF_FFFF) as f32 / 16_777_215.0,
            E::Depth32 if self.reads_stencil => channels[0] = f32::from_bits(word(1) & 0xFF),
            E::Depth32 => channels[0] = f32::from_bits(word(0)),
            // Blocks are decoded when a texture is made.
            _ => {}
        }
        unit
    }

    /// Units as what a shader gets.
    #[inline]
    pub(crate) fn finish(&self, unit: [f32; 4]) -> [f32; 4] {
        if self.is_integer() {
            return unit;
        }
        [
            unit[0] * self.scale[0],
            unit[1] * self.scale[1],
            unit[2] * self.scale[2],
            unit[3] * self.scale[3],
        ]
    }
}

#[inline(always)]
fn each(channels: &mut [f32], value: impl Fn(usize) -> f32) {
    for (k, channel) in channels.iter_mut().enumerate() {
        *channel = value(k);
    }
}

#[inline(always)]
fn byte(word: u32, k: usize) -> u32 {
    word >> (8 * k) & 0xFF
}

/// The lower half for even channels, the upper one for odd ones.
#[inline(always)]
fn half_word(word: u32, k: usize) -> u32 {
    word >> (16 * (k & 1)) & 0xFFFF
}

#[inline(always)]
fn sign_extended(code: u32, bits: u32) -> i32 {
    (code << (32 - bits)).cast_signed() >> (32 - bits)
}

#[inline(always)]
fn bits_of(integer: i32) -> f32 {
    f32::from_bits(integer.cast_unsigned())
}

fn ten_ten_ten_two(word: u32) -> [u32; 4] {
    [
        word & 0x3FF,
        word >> 10 & 0x3FF,
        word >> 20 & 0x3FF,
        word >> 30,
    ]
}

/// The number of a sign, five bits of exponent and `mantissa` bits.
#[inline]
fn float_of(code: u32, mantissa: u32) -> f32 {
    let (sign, magnitude) = ((code & 0x8000) << 16, code & 0x7FFF);
    let shifted = magnitude << (23 - mantissa);
    let bits = if magnitude >> mantissa == 31 {
        // Infinity, or a NaN that keeps its payload and becomes quiet.
        let quiet = u32::from(shifted & 0x007F_FFFF != 0) << 22;
        shifted | 0x7F80_0000 | quiet
    } else if magnitude >> mantissa == 0 {
        // c·2⁻²⁴ exactly: denormals of the small format are normal here.
        return f32::from_bits(sign | (magnitude as f32 * (1.0 / 16_777_216.0)).to_bits());
    } else {
        shifted + ((127 - 15) << 23)
    };
    f32::from_bits(sign | bits)
}
