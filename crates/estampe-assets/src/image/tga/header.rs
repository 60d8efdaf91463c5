//! The checked 18-byte header of a TGA file.

use crate::AssetError;
use crate::image::fault::{malformed, unsupported};

/// Length of the header in bytes.
pub(super) const HEADER_LEN: usize = 18;

/// Contents of a stored texel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TexelKind {
    /// An index into the colour map.
    Mapped,
    /// Blue, green, red and optionally alpha.
    TrueColor,
    /// Brightness and optionally alpha.
    Grey,
}

/// Index range and entry width of the colour map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct ColorMap {
    /// The index of the first stored entry.
    pub(super) first: u16,
    /// The number of stored entries.
    pub(super) len: u16,
    /// Bits of an entry: 15, 16, 24 or 32.
    pub(super) entry_bits: u8,
}

/// A valid header: every combination that parses can be decoded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Header {
    /// Length of the image ID after the header, in bytes.
    pub(super) id_len: u8,
    /// The colour map, which true-colour and grey files may carry too.
    pub(super) color_map: Option<ColorMap>,
    /// Contents of a texel.
    pub(super) kind: TexelKind,
    /// True if the texels are run-length encoded.
    pub(super) is_rle: bool,
    /// Width in texels, at least 1.
    pub(super) width: u16,
    /// Height in texels, at least 1.
    pub(super) height: u16,
    /// Bits of a stored texel.
    pub(super) depth_bits: u8,
    /// Number of attribute (alpha) bits per texel, by the file.
    pub(super) alpha_bits: u8,
    /// True if the first texel of a row is its rightmost.
    pub(super) right_to_left: bool,
    /// True if the first row is the topmost.
    pub(super) top_to_bottom: bool,
    /// 1, or 2 or 4 if rows are stored interleaved (0, 2, 4 … 1, 3, 5 …).
    pub(super) row_step: u8,
}

impl Header {
    /// Reads the header.
    ///
    /// # Errors
    /// `Malformed` if it is truncated or contradicts itself, `Unsupported` for types and depths
    /// that the format allows and no program writes.
    pub(super) fn parse(bytes: &[u8]) -> Result<Self, AssetError> {
        let Some(h) = bytes.first_chunk::<HEADER_LEN>() else {
            return Err(malformed(
                bytes.len(),
                "the file ends within the TGA header",
            ));
        };
        let u16_at = |at: usize| u16::from_le_bytes([h[at], h[at + 1]]);

        let (kind, is_rle) = match h[2] {
            1 => (TexelKind::Mapped, false),
            2 => (TexelKind::TrueColor, false),
            3 => (TexelKind::Grey, false),
            9 => (TexelKind::Mapped, true),
            10 => (TexelKind::TrueColor, true),
            11 => (TexelKind::Grey, true),
            other => return Err(unsupported(format!("TGA image type {other}"))),
        };
        let color_map = match h[1] {
            0 => None,
            1 => Some(ColorMap {
                first: u16_at(3),
                len: u16_at(5),
                entry_bits: h[7],
            }),
            other => return Err(unsupported(format!("TGA colour map type {other}"))),
        };
        let row_step = match h[17] >> 6 {
            0 => 1,
            1 => 2,
            2 => 4,
            _ => return Err(malformed(17, "the descriptor names a reserved row order")),
        };
        let header = Self {
            id_len: h[0],
            color_map,
            kind,
            is_rle,
            width: u16_at(12),
            height: u16_at(14),
            depth_bits: h[16],
            alpha_bits: h[17] & 0b1111,
            right_to_left: h[17] & 0b1_0000 != 0,
            top_to_bottom: h[17] & 0b10_0000 != 0,
            row_step,
        };
        header.check()?;
        Ok(header)
    }

    /// Checks the rules that connect fields.
    fn check(&self) -> Result<(), AssetError> {
        if self.width == 0 || self.height == 0 {
            return Err(malformed(
                12,
                format!("a TGA image of {} × {} texels", self.width, self.height),
            ));
        }
        let depth_is_known = match self.kind {
            TexelKind::Mapped => matches!(self.depth_bits, 8 | 15 | 16),
            TexelKind::Grey => matches!(self.depth_bits, 8 | 16),
            TexelKind::TrueColor => matches!(self.depth_bits, 15 | 16 | 24 | 32),
        };
        if !depth_is_known {
            return Err(unsupported(format!(
                "{} bits per texel in a TGA image of type {:?}",
                self.depth_bits, self.kind
            )));
        }
        match (self.kind, self.color_map) {
            (TexelKind::Mapped, None) => Err(malformed(
                1,
                "a colour-mapped TGA image without a colour map",
            )),
            (TexelKind::Mapped, Some(map)) if !matches!(map.entry_bits, 15 | 16 | 24 | 32) => Err(
                unsupported(format!("TGA colour map entries of {} bits", map.entry_bits)),
            ),
            _ => Ok(()),
        }
    }

    /// Bytes of a stored texel; 15 bits take two.
    pub(super) fn texel_len(&self) -> usize {
        usize::from(self.depth_bits).div_ceil(8)
    }
}
