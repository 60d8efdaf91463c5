//! Decoding of one stored texel or colour map entry to RGBA.

use super::footer::AttributesType;
use crate::image::channel::unmultiplied;

/// Storage format of a colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TexelFormat {
    /// One byte of brightness.
    Grey8,
    /// Brightness, alpha.
    GreyAlpha16,
    /// Little-endian `ARRRRRGG GGGBBBBB`; the top bit is alpha if the file says so, else unused.
    Rgb5A1,
    /// B, G, R.
    Bgr24,
    /// B, G, R, A.
    Bgra32,
}

impl TexelFormat {
    /// The format of a colour of `bits`, if there is one.
    pub(super) fn of_color(bits: u8) -> Option<Self> {
        match bits {
            15 | 16 => Some(Self::Rgb5A1),
            24 => Some(Self::Bgr24),
            32 => Some(Self::Bgra32),
            _ => None,
        }
    }

    /// Bytes of a texel.
    pub(super) fn len_bytes(self) -> usize {
        match self {
            Self::Grey8 => 1,
            Self::GreyAlpha16 | Self::Rgb5A1 => 2,
            Self::Bgr24 => 3,
            Self::Bgra32 => 4,
        }
    }

    /// RGBA of a texel; `bytes` has this format's length.
    #[inline]
    pub(super) fn rgba(self, bytes: &[u8], alpha_use: AlphaUse) -> [u8; 4] {
        let (rgb, alpha) = match (self, bytes) {
            (Self::Grey8, &[grey]) => ([grey; 3], 255),
            (Self::GreyAlpha16, &[grey, alpha]) => ([grey; 3], alpha),
            (Self::Rgb5A1, &[low, high]) => {
                let word = u16::from_le_bytes([low, high]);
                let rgb = [word >> 10, word >> 5, word].map(unorm8_from_unorm5);
                (rgb, if high & 0x80 == 0 { 0 } else { 255 })
            }
            (Self::Bgr24, &[blue, green, red]) => ([red, green, blue], 255),
            (Self::Bgra32, &[blue, green, red, alpha]) => ([red, green, blue], alpha),
            _ => unreachable!("the caller slices texels by `len_bytes`"),
        };
        match alpha_use {
            AlphaUse::Opaque => [rgb[0], rgb[1], rgb[2], 255],
            AlphaUse::Straight => [rgb[0], rgb[1], rgb[2], alpha],
            AlphaUse::Premultiplied => {
                let [red, green, blue] = rgb.map(|c| unmultiplied(c, alpha));
                [red, green, blue, alpha]
            }
        }
    }
}

/// Use of a file's alpha.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum AlphaUse {
    /// None: every texel is opaque.
    Opaque,
    /// Straight alpha.
    Straight,
    /// Premultiplied alpha.
    Premultiplied,
}

impl AlphaUse {
    /// Decides from the extension area if there is one, else from the descriptor.
    ///
    /// The top bit of a 16-bit colour is alpha only if the extension area says so: it was the
    /// overlay bit of a frame grabber, files set it at random, and every reference decoder of the
    /// conformance suite shows such a file opaque in spite of its descriptor.
    pub(super) fn decide(
        format: TexelFormat,
        descriptor_bits: u8,
        attributes: Option<AttributesType>,
    ) -> Self {
        match (format, attributes) {
            (TexelFormat::Grey8 | TexelFormat::Bgr24, _) => Self::Opaque,
            (_, Some(AttributesType::Meaningless)) => Self::Opaque,
            (_, Some(AttributesType::Alpha)) => Self::Straight,
            (_, Some(AttributesType::PremultipliedAlpha)) => Self::Premultiplied,
            (TexelFormat::Rgb5A1, None) => Self::Opaque,
            (TexelFormat::GreyAlpha16 | TexelFormat::Bgra32, None) if descriptor_bits == 0 => {
                Self::Opaque
            }
            (TexelFormat::GreyAlpha16 | TexelFormat::Bgra32, None) => Self::Straight,
        }
    }
}

/// The low 5 bits of `word` as 8 bits: round(v · 255 / 31).
#[expect(
    clippy::cast_possible_truncation,
    reason = "at most (31·255 + 15) / 31 = 255"
)]
fn unorm8_from_unorm5(word: u16) -> u8 {
    (((word & 31) * 255 + 15) / 31) as u8
}
