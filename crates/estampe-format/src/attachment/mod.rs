//! Sixteen texels of a renderable format, as an attachment stores them.
//!
//! An attachment stores the texels of a packet word by word: [`PacketCodec::WORDS`] arrays of
//! sixteen u32. A texel below four bytes takes one word all the same, in its low bits; the other
//! bits are 0.
//!
//! An [`AttachmentCodec`] is made once for a target. Before the loops over its packets,
//! [`with_codec!`](crate::with_codec) turns it into a value of one of ten types, for each of which
//! those loops are compiled:
//!
//! | type | formats |
//! |---|---|
//! | [`Rgba8`] | `Rgba8Unorm`, `Bgra8Unorm` |
//! | [`Rgba8Srgb`] | the same with sRGB |
//! | [`Normalized<1>`](Normalized), `<2>` | every other unorm and snorm format |
//! | [`Half<1>`](Half), `<2>` | 16-bit floats |
//! | [`Rg11B10`] | unsigned floats of 11 and 10 bits |
//! | [`Bits<1>`](Bits), `<2>`, `<4>` | 32-bit floats and integers, whose codes are the numbers' bits |
//!
//! Few types that are told apart by fields, not one for each format: everything that is generic
//! over them is compiled for each, at every SIMD level.

mod bits;
mod float;
mod normalized;
mod rgba8;

pub use bits::Bits;
pub use float::{Half, Rg11B10};
pub use normalized::Normalized;
pub use rgba8::{Rgba8, Rgba8Srgb};

use crate::layout;
use crate::texel::TexelCodec;
use estampe_simd::{Lanes, f32x16, u32x16};
use estampe_types::{SampleType, TexelEncoding, TextureFormat};

/// A codec for packets of sixteen texels in an attachment's format.
pub trait PacketCodec<S: Lanes>: Copy {
    /// Words of 32 bits of a texel: 1, 2 or 4.
    const WORDS: usize;

    /// The numbers of sixteen texels: R, G, B, A; linear where the format is sRGB, bits where it
    /// holds integers. Channels that the format lacks are 0, 0, 0 and 1. Only the first `WORDS`
    /// words are read.
    fn decode(self, s: S, words: [u32x16<S>; 4]) -> [f32x16<S>; 4];

    /// The texels of sixteen colours, confined and rounded; words from `WORDS` on are 0.
    fn encode(self, s: S, color: [f32x16<S>; 4]) -> [u32x16<S>; 4];

    /// The values that a resolve adds up: the codes of normalised channels (snorm codes are at
    /// least −most) and the numbers of all other channels.
    #[inline(always)]
    fn units(self, s: S, words: [u32x16<S>; 4]) -> [f32x16<S>; 4] {
        self.decode(s, words)
    }

    /// The texels of means of [`units`](Self::units): ⌊mean + ½⌋ of codes. (Integers are not
    /// averaged: of several samples the first counts.)
    #[inline(always)]
    fn encode_units(self, s: S, means: [f32x16<S>; 4]) -> [u32x16<S>; 4] {
        self.encode(s, means)
    }
}

/// The codec of an attachment, and what the operations on its texels depend on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AttachmentCodec {
    format: TextureFormat,
    family: Family,
}

/// A [`PacketCodec`] whose type is known at run time: what [`with_codec!`](crate::with_codec)
/// matches.
#[derive(Debug, Clone, Copy, PartialEq)]
#[expect(missing_docs, reason = "each variant holds the type of its name")]
pub enum Family {
    Rgba8(Rgba8),
    Rgba8Srgb(Rgba8Srgb),
    Normalized1(Normalized<1>),
    Normalized2(Normalized<2>),
    Half1(Half<1>),
    Half2(Half<2>),
    Rg11B10(Rg11B10),
    Bits1(Bits<1>),
    Bits2(Bits<2>),
    Bits4(Bits<4>),
}

impl AttachmentCodec {
    /// The codec of a renderable format.
    ///
    /// # Panics
    /// If the format is [not renderable](TextureFormat::is_renderable).
    #[must_use]
    pub fn new(format: TextureFormat) -> Self {
        use TexelEncoding as E;
        assert!(
            format.is_renderable(),
            "{} is not renderable",
            format.name()
        );
        let family = match (format.encoding(), layout::words(format)) {
            (E::Unorm8, _) if format.is_srgb() => Family::Rgba8Srgb(Rgba8Srgb::new(format)),
            (E::Unorm8, _) if format.components() == 4 => Family::Rgba8(Rgba8::new(format)),
            (E::Unorm8 | E::Unorm16 | E::Unorm10_2 | E::Snorm8 | E::Snorm16, 1) => {
                Family::Normalized1(Normalized::new(format))
            }
            (E::Unorm16 | E::Snorm16, _) => Family::Normalized2(Normalized::new(format)),
            (E::Float16, 1) => Family::Half1(Half::new(format)),
            (E::Float16, _) => Family::Half2(Half::new(format)),
            (E::Ufloat11_10, _) => Family::Rg11B10(Rg11B10),
            (_, 1) => Family::Bits1(Bits::new(format)),
            (_, 2) => Family::Bits2(Bits::new(format)),
            _ => Family::Bits4(Bits::new(format)),
        };
        Self { format, family }
    }

    /// The format's codec, for [`with_codec!`](crate::with_codec).
    #[must_use]
    pub fn family(&self) -> Family {
        self.family
    }

    /// The format.
    #[must_use]
    pub fn format(&self) -> TextureFormat {
        self.format
    }

    /// Words of 32 bits of a texel: 1, 2 or 4.
    #[must_use]
    pub fn words(&self) -> usize {
        layout::words(self.format)
    }

    /// Returns true if the channels are integers, of which shaders output the bits.
    #[must_use]
    pub fn is_integer(&self) -> bool {
        self.format.sample_type() != SampleType::Float
    }

    /// Returns true if R, G and B are encoded as sRGB.
    #[must_use]
    pub fn is_srgb(&self) -> bool {
        self.format.is_srgb()
    }

    /// Returns true if logic operations apply. They apply to neither float nor sRGB formats.
    #[must_use]
    pub fn has_logic_operations(&self) -> bool {
        use TexelEncoding as E;
        !self.is_srgb()
            && !matches!(
                self.format.encoding(),
                E::Float16 | E::Float32 | E::Ufloat11_10
            )
    }

    /// The range to which a fragment's colours are confined before blending: that of normalised
    /// channels.
    #[must_use]
    pub fn range(&self) -> Option<[f32; 2]> {
        use TexelEncoding as E;
        match self.format.encoding() {
            E::Unorm8 | E::Unorm16 | E::Unorm10_2 => Some([0.0, 1.0]),
            E::Snorm8 | E::Snorm16 => Some([-1.0, 1.0]),
            _ => None,
        }
    }

    /// The bits of a texel's words that a channel (R, G, B, A: 0 to 3) occupies; none of a channel
    /// that the format lacks. Write masks choose among them, and a logic operation on codes is one
    /// on the words, inside these bits.
    #[must_use]
    pub fn channel_bits(&self, channel: usize) -> [u32; 4] {
        let mut bits = [0; 4];
        if let Some(place) = layout::channels(self.format).get(channel) {
            bits[place.word] = place.mask();
        }
        bits
    }

    /// The words of one colour to which a pass clears: numbers by way of f32, integers truncated
    /// and confined.
    #[must_use]
    pub fn clear_words(&self, rgba: [f64; 4]) -> [u32; 4] {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "the conversion saturates, NaN is 0"
        )]
        let number = |value: f64| match self.format.sample_type() {
            SampleType::Uint => f32::from_bits(value as u32),
            SampleType::Sint => f32::from_bits((value as i32).cast_unsigned()),
            _ => value as f32,
        };
        TexelCodec::new(self.format).encode(rgba.map(number))
    }
}

/// Evaluates an expression with the codec of an [`AttachmentCodec`], whose type implements
/// [`PacketCodec<S>`](PacketCodec) for every `S`.
///
/// `with_codec!(codec, c => draw(s, c, packets))` matches once, outside the loop over packets in
/// `draw`.
#[macro_export]
macro_rules! with_codec {
    ($codec:expr, $name:ident => $expression:expr) => {
        match $crate::AttachmentCodec::family(&$codec) {
            $crate::attachment::Family::Rgba8($name) => $expression,
            $crate::attachment::Family::Rgba8Srgb($name) => $expression,
            $crate::attachment::Family::Normalized1($name) => $expression,
            $crate::attachment::Family::Normalized2($name) => $expression,
            $crate::attachment::Family::Half1($name) => $expression,
            $crate::attachment::Family::Half2($name) => $expression,
            $crate::attachment::Family::Rg11B10($name) => $expression,
            $crate::attachment::Family::Bits1($name) => $expression,
            $crate::attachment::Family::Bits2($name) => $expression,
            $crate::attachment::Family::Bits4($name) => $expression,
        }
    };
}
