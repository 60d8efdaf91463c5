//! Texels of every renderable format: words in memory, codes of channels, and numbers.
//!
//! ```text
//!     words ──unpack──▶ codes ──decode──▶ numbers        a packet of sixteen texels, channel by channel
//!           ◀──pack────       ◀─encode──
//! ```
//!
//! A code is a channel's bits, or of a signed channel its value. Write masks and logic operations work on codes,
//! blending on numbers. *Spec* `docs/NUMERICS.md`, *Formats*.

use super::small_float::{float_of_half, float_of_unsigned, half_of, unsigned_of};
use crate::raster::general::MAX_SAMPLES;
use estampe_simd::LANES;
use estampe_types::srgb::{LINEAR_FROM_SRGB, srgb_from_linear};
use estampe_types::{SampleType, TexelEncoding, TextureFormat};

/// The most words of a texel.
pub(crate) const MAX_WORDS: usize = 4;

/// Sixteen texels' channels.
pub(crate) type Codes = [[u32; LANES]; 4];
/// Sixteen texels' numbers.
pub(crate) type Numbers = [[f32; LANES]; 4];

/// How texels of a format are read and written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct TexelCodec {
    encoding: TexelEncoding,
    components: usize,
    is_srgb: bool,
    is_bgra: bool,
    sample_type: SampleType,
    /// Words in an attachment.
    pub(crate) words: usize,
}

/// How one channel is encoded.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Channel {
    Unorm { most: f32 },
    Snorm { most: f32 },
    Uint { most: u32 },
    Sint { bits: u32 },
    Half,
    Float,
    Unsigned6,
    Unsigned5,
    Srgb,
}

impl TexelCodec {
    pub(crate) fn new(format: TextureFormat) -> Self {
        Self {
            encoding: format.encoding(),
            components: format.components(),
            is_srgb: format.is_srgb(),
            is_bgra: format.is_bgra(),
            sample_type: format.sample_type(),
            words: crate::layout::texel_words(format),
        }
    }

    /// Whether channels are integers, whose bits shaders give.
    pub(crate) fn is_integer(&self) -> bool {
        self.sample_type != SampleType::Float
    }

    /// Whether logic operations apply: not to floats, nor to sRGB.
    pub(crate) fn has_logic(&self) -> bool {
        use TexelEncoding as E;
        !self.is_srgb && !matches!(self.encoding, E::Float16 | E::Float32 | E::Ufloat11_10)
    }

    /// The range that colours are confined to before blending: that of normalised channels.
    pub(crate) fn range(&self) -> Option<[f32; 2]> {
        use TexelEncoding as E;
        match self.encoding {
            E::Unorm8 | E::Unorm16 | E::Unorm10_2 => Some([0.0, 1.0]),
            E::Snorm8 | E::Snorm16 => Some([-1.0, 1.0]),
            _ => None,
        }
    }

    /// The bits of a channel that mean something.
    pub(crate) fn bits(&self, channel: usize) -> u32 {
        use TexelEncoding as E;
        match self.encoding {
            E::Unorm8 | E::Snorm8 | E::Uint8 | E::Sint8 => 8,
            E::Unorm16 | E::Snorm16 | E::Uint16 | E::Sint16 | E::Float16 => 16,
            E::Unorm10_2 | E::Uint10_2 if channel == 3 => 2,
            E::Unorm10_2 | E::Uint10_2 => 10,
            E::Ufloat11_10 if channel == 2 => 10,
            E::Ufloat11_10 => 11,
            _ => 32,
        }
    }

    /// Where a channel begins: word and bit.
    fn place(&self, channel: usize) -> (usize, u32) {
        use TexelEncoding as E;
        let from = match self.encoding {
            E::Unorm10_2 | E::Uint10_2 => [0, 10, 20, 30][channel],
            E::Ufloat11_10 => [0, 11, 22, 32][channel],
            // B, G, R, A.
            _ if self.is_bgra => [16, 8, 0, 24][channel],
            _ => [0, 1, 2, 3][channel] * self.bits(channel),
        };
        (from as usize / 32, from % 32)
    }

    fn channel(&self, channel: usize) -> Channel {
        use TexelEncoding as E;
        let most = ((1_u64 << self.bits(channel)) - 1) as f32;
        match self.encoding {
            E::Unorm8 if self.is_srgb && channel < 3 => Channel::Srgb,
            E::Unorm8 | E::Unorm16 | E::Unorm10_2 => Channel::Unorm { most },
            E::Snorm8 => Channel::Snorm { most: 127.0 },
            E::Snorm16 => Channel::Snorm { most: 32_767.0 },
            E::Uint8 | E::Uint16 | E::Uint32 | E::Uint10_2 => Channel::Uint {
                most: u32::MAX >> (32 - self.bits(channel)),
            },
            E::Sint8 | E::Sint16 | E::Sint32 => Channel::Sint {
                bits: self.bits(channel),
            },
            E::Float16 => Channel::Half,
            E::Ufloat11_10 if channel == 2 => Channel::Unsigned5,
            E::Ufloat11_10 => Channel::Unsigned6,
            _ => Channel::Float,
        }
    }

    /// The words of sixteen texels as an attachment has them.
    #[inline(always)]
    pub(crate) fn words_of(&self, texels: &[u32]) -> [[u32; LANES]; MAX_WORDS] {
        let mut words = [[0; LANES]; MAX_WORDS];
        for (to, from) in words.iter_mut().zip(texels.as_chunks().0) {
            *to = *from;
        }
        words
    }

    /// Words to codes; codes of signed channels are extended to 32 bits. Channels that the format lacks are 0.
    #[inline(always)]
    pub(crate) fn unpack(&self, words: &[[u32; LANES]; MAX_WORDS]) -> Codes {
        let mut codes = [[0; LANES]; 4];
        for (channel, codes) in codes.iter_mut().enumerate().take(self.components) {
            let (word, shift) = self.place(channel);
            let unused = 32 - self.bits(channel);
            let is_signed = matches!(
                self.channel(channel),
                Channel::Snorm { .. } | Channel::Sint { .. }
            );
            for (code, word) in codes.iter_mut().zip(&words[word % MAX_WORDS]) {
                let top = (word >> shift) << unused;
                *code = if is_signed {
                    (top.cast_signed() >> unused).cast_unsigned()
                } else {
                    top >> unused
                };
            }
        }
        codes
    }

    /// Codes to words.
    #[inline(always)]
    pub(crate) fn pack(&self, codes: &Codes) -> [[u32; LANES]; MAX_WORDS] {
        let mut words = [[0; LANES]; MAX_WORDS];
        for (channel, codes) in codes.iter().enumerate().take(self.components) {
            let (word, shift) = self.place(channel);
            let mask = u32::MAX >> (32 - self.bits(channel));
            for (word, code) in words[word % MAX_WORDS].iter_mut().zip(codes) {
                *word |= (code & mask) << shift;
            }
        }
        words
    }

    /// Codes to numbers; of integer formats, the codes as bits. Colours that the format lacks are 0, alpha 1.
    #[inline(always)]
    pub(crate) fn decode(&self, codes: &Codes) -> Numbers {
        let mut numbers = [[0.0; LANES], [0.0; LANES], [0.0; LANES], [1.0; LANES]];
        for (channel, (numbers, codes)) in numbers
            .iter_mut()
            .zip(codes)
            .enumerate()
            .take(self.components)
        {
            match self.channel(channel) {
                Channel::Unorm { most } => each(numbers, codes, |code| code as f32 * (1.0 / most)),
                Channel::Snorm { most } => each(numbers, codes, |code| {
                    let value = code.cast_signed() as f32 * (1.0 / most);
                    if value > -1.0 { value } else { -1.0 }
                }),
                Channel::Uint { .. } | Channel::Sint { .. } | Channel::Float => {
                    each(numbers, codes, f32::from_bits);
                }
                Channel::Half => each(numbers, codes, float_of_half),
                Channel::Unsigned6 => each(numbers, codes, float_of_unsigned::<6>),
                Channel::Unsigned5 => each(numbers, codes, float_of_unsigned::<5>),
                Channel::Srgb => each(numbers, codes, |code| {
                    LINEAR_FROM_SRGB[(code & 0xFF) as usize]
                }),
            }
        }
        numbers
    }

    /// Numbers to codes; of integer formats the numbers' bits, confined to the channel's range.
    #[inline(always)]
    pub(crate) fn encode(&self, numbers: &Numbers) -> Codes {
        let mut codes = [[0; LANES]; 4];
        for (channel, (codes, numbers)) in codes
            .iter_mut()
            .zip(numbers)
            .enumerate()
            .take(self.components)
        {
            match self.channel(channel) {
                Channel::Unorm { most } => each(codes, numbers, |value| unorm(value, most)),
                Channel::Snorm { most } => each(codes, numbers, |value| snorm(value, most)),
                Channel::Uint { most } => each(codes, numbers, |value| value.to_bits().min(most)),
                Channel::Sint { bits } => {
                    let (least, most) = (i32::MIN >> (32 - bits), i32::MAX >> (32 - bits));
                    each(codes, numbers, |value| {
                        value
                            .to_bits()
                            .cast_signed()
                            .clamp(least, most)
                            .cast_unsigned()
                    });
                }
                Channel::Float => each(codes, numbers, |value| {
                    if value.is_nan() {
                        0x7FC0_0000
                    } else {
                        value.to_bits()
                    }
                }),
                Channel::Half => each(codes, numbers, half_of),
                Channel::Unsigned6 => each(codes, numbers, unsigned_of::<6>),
                Channel::Unsigned5 => each(codes, numbers, unsigned_of::<5>),
                Channel::Srgb => each(codes, numbers, |value| u32::from(srgb_from_linear(value))),
            }
        }
        codes
    }

    /// What stands for several samples of sixteen pixels: the means of normalised channels' codes, of other numbers
    /// the code of their mean, and of integers the first one. See `docs/NUMERICS.md`, *Resolve*.
    pub(crate) fn mean(&self, samples: &[Codes]) -> Codes {
        let Some(first) = samples.first() else {
            return [[0; LANES]; 4];
        };
        let inverse_count = 1.0 / samples.len() as f32;
        let mut decoded = [[[0.0; LANES]; 4]; MAX_SAMPLES];
        for (numbers, codes) in decoded.iter_mut().zip(samples) {
            *numbers = self.decode(codes);
        }
        let mut means = [[0.0; LANES]; 4];
        for (channel, means) in means.iter_mut().enumerate() {
            let kind = self.channel(channel);
            for (lane, mean) in means.iter_mut().enumerate() {
                let mut sum = 0.0;
                for (codes, numbers) in samples.iter().zip(&decoded) {
                    let code = codes[channel][lane];
                    sum += match kind {
                        Channel::Unorm { .. } => code as f32,
                        Channel::Snorm { most } => (code.cast_signed() as f32).max(-most),
                        _ => numbers[channel][lane],
                    };
                }
                *mean = sum * inverse_count;
            }
        }
        let encoded = self.encode(&means);
        let mut codes = *first;
        for (channel, codes) in codes.iter_mut().enumerate().take(self.components) {
            match self.channel(channel) {
                Channel::Unorm { .. } | Channel::Snorm { .. } => {
                    each(codes, &means[channel], |mean| nearest(mean).cast_unsigned());
                }
                Channel::Uint { .. } | Channel::Sint { .. } => {}
                _ => *codes = encoded[channel],
            }
        }
        codes
    }

    /// The words of one colour that a pass clears to: floats by way of f32, integers truncated and confined.
    pub(crate) fn clear_words(&self, rgba: [f64; 4]) -> [u32; MAX_WORDS] {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "the conversion saturates, NaN is 0"
        )]
        let number = |channel: usize| match self.sample_type {
            SampleType::Uint => f32::from_bits(rgba[channel] as u32),
            SampleType::Sint => f32::from_bits((rgba[channel] as i32).cast_unsigned()),
            _ => rgba[channel] as f32,
        };
        let numbers = [0, 1, 2, 3].map(|channel| [number(channel); LANES]);
        self.pack(&self.encode(&numbers)).map(|lanes| lanes[0])
    }
}

/// Sets each lane by a function of the other's.
#[inline(always)]
fn each<A, B: Copy>(to: &mut [A; LANES], from: &[B; LANES], of: impl Fn(B) -> A) {
    for (to, from) in to.iter_mut().zip(from) {
        *to = of(*from);
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "0..=most; the cast takes the floor of what is not negative"
)]
#[inline(always)]
fn unorm(value: f32, most: f32) -> u32 {
    let positive = if value > 0.0 { value } else { 0.0 };
    let confined = if positive < 1.0 { positive } else { 1.0 };
    (confined * most + 0.5) as u32
}

#[inline(always)]
fn snorm(value: f32, most: f32) -> u32 {
    // NaN is 0.
    let value = if value.is_nan() { 0.0 } else { value };
    let above = if value > -1.0 { value } else { -1.0 };
    let confined = if above < 1.0 { above } else { 1.0 };
    nearest(confined * most).cast_unsigned()
}

/// floor(x + ½).
#[expect(clippy::cast_possible_truncation, reason = "codes are small")]
#[inline(always)]
fn nearest(value: f32) -> i32 {
    (value + 0.5).floor() as i32
}
