//! The checked headers and the palette of a bitmap file.

use crate::AssetError;
use crate::image::channel::Channel;
use crate::image::fault::{malformed, unsupported};

/// Offset of the second header.
const SECOND_HEADER: usize = 14;

/// Storage of the texels.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Texels {
    /// Indices of 1, 4 or 8 bits, the first in the highest bits of a byte.
    Mapped { bits: u8, palette: Vec<[u8; 4]> },
    /// Runs of indices of 4 or 8 bits.
    Runs { bits: u8, palette: Vec<[u8; 4]> },
    /// Words of 16, 24 or 32 bits with channels in the order R, G, B, A.
    Words {
        len_bytes: usize,
        channels: [Channel; 4],
    },
}

/// A valid header: every combination that parses can be decoded.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Header {
    /// Width in texels, at least 1.
    pub(super) width: u32,
    /// Height in texels, at least 1.
    pub(super) height: u32,
    /// True if the first row is the topmost.
    pub(super) is_top_down: bool,
    /// Storage of the texels.
    pub(super) texels: Texels,
    /// Offset of the first row.
    pub(super) texels_start: usize,
}

/// The fields of the second header that every version has.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fields {
    /// Length of the second header in bytes.
    len: usize,
    /// Width, height; a negative height means rows from the top.
    width: i64,
    height: i64,
    bits: u16,
    compression: u32,
    colors: u32,
}

impl Fields {
    /// Reads the fields; those behind the end of a short second header are 0.
    pub(super) fn parse(bytes: &[u8]) -> Result<Self, AssetError> {
        let len = word(bytes, SECOND_HEADER)?;
        let len = match len {
            12 | 16..=124 if len % 4 == 0 => len as usize,
            _ => {
                return Err(unsupported(format!(
                    "a BMP with a second header of {len} bytes"
                )));
            }
        };
        if len == 12 {
            return Ok(Self {
                len,
                width: i64::from(half(bytes, 18)?),
                height: i64::from(half(bytes, 20)?),
                bits: half(bytes, 24)?,
                compression: 0,
                colors: 0,
            });
        }
        let optional = |at: usize| match at + 4 > SECOND_HEADER + len {
            true => Ok(0),
            false => word(bytes, at),
        };
        Ok(Self {
            len,
            width: i64::from(word(bytes, 18)?.cast_signed()),
            height: i64::from(word(bytes, 22)?.cast_signed()),
            bits: half(bytes, 28)?,
            compression: optional(30)?,
            colors: optional(46)?,
        })
    }

    /// Width and height, at least 1.
    pub(super) fn size(&self) -> Result<(u32, u32), AssetError> {
        let side = |pixels: i64| u32::try_from(pixels).ok().filter(|&side| side > 0);
        match (side(self.width), side(self.height.abs())) {
            (Some(width), Some(height)) => Ok((width, height)),
            _ => Err(malformed(
                18,
                format!("a BMP image of {} × {} texels", self.width, self.height),
            )),
        }
    }

    /// The rest of the header, with the palette.
    pub(super) fn header(&self, bytes: &[u8]) -> Result<Header, AssetError> {
        let (width, height) = self.size()?;
        let masks_start = SECOND_HEADER + self.len;
        // Longer second headers contain the masks.
        let masks_behind = match (self.compression, self.len) {
            (3, 40) => 3,
            (6, 40) => 4,
            _ => 0,
        };
        let palette_start = masks_start + 4 * masks_behind;
        let stated_start = word(bytes, 10)? as usize;
        let palette = || self.palette(bytes, palette_start, stated_start);
        let refuse = || {
            unsupported(format!(
                "a BMP with {} bits per texel and compression {}",
                self.bits, self.compression
            ))
        };
        let texels = match (self.bits, self.compression) {
            (1, 0) => Texels::Mapped {
                bits: 1,
                palette: palette()?,
            },
            (4, 0) => Texels::Mapped {
                bits: 4,
                palette: palette()?,
            },
            (8, 0) => Texels::Mapped {
                bits: 8,
                palette: palette()?,
            },
            (8, 1) => Texels::Runs {
                bits: 8,
                palette: palette()?,
            },
            (4, 2) => Texels::Runs {
                bits: 4,
                palette: palette()?,
            },
            (16, 0) => words(2, [0x7c00, 0x3e0, 0x1f, 0])?,
            (24, 0) => words(3, [0xff_0000, 0xff00, 0xff, 0])?,
            (32, 0) => words(4, [0xff_0000, 0xff00, 0xff, 0])?,
            // Of OS/2's header of 64 bytes, compression 3 is a code for fax machines.
            (16 | 32, 3 | 6) if self.len != 64 => {
                let masks = self.masks(bytes, masks_behind)?;
                words(usize::from(self.bits / 8), masks)?
            }
            _ => return Err(refuse()),
        };
        let texels_start = match stated_start {
            0 => {
                let palette_len = match &texels {
                    Texels::Mapped { palette, .. } | Texels::Runs { palette, .. } => palette.len(),
                    Texels::Words { .. } => 0,
                };
                palette_start + palette_len * self.color_len()
            }
            stated => stated,
        };
        Ok(Header {
            width,
            height,
            is_top_down: self.height < 0,
            texels,
            texels_start,
        })
    }

    /// The masks of R, G, B and A.
    fn masks(&self, bytes: &[u8], behind: usize) -> Result<[u32; 4], AssetError> {
        let start = SECOND_HEADER + 40;
        let has_alpha = behind == 4 || self.len >= 56;
        let mask = |at: usize| word(bytes, start + 4 * at);
        let alpha = if has_alpha { mask(3)? } else { 0 };
        Ok([mask(0)?, mask(1)?, mask(2)?, alpha])
    }

    /// Bytes of a palette's colour.
    fn color_len(&self) -> usize {
        if self.len == 12 { 3 } else { 4 }
    }

    /// The colours between the headers and the texels, at most as many as indices can name.
    fn palette(
        &self,
        bytes: &[u8],
        start: usize,
        texels_start: usize,
    ) -> Result<Vec<[u8; 4]>, AssetError> {
        let most = 1_usize << self.bits;
        let mut count = match self.colors as usize {
            0 => most,
            colors => colors.min(most),
        };
        if texels_start > start {
            count = count.min((texels_start - start) / self.color_len());
        }
        let end = start + count * self.color_len();
        let Some(stored) = bytes.get(start..end) else {
            return Err(malformed(
                bytes.len(),
                "the file ends within the BMP palette",
            ));
        };
        let colors = stored.chunks_exact(self.color_len());
        Ok(colors.map(|bgr| [bgr[2], bgr[1], bgr[0], 255]).collect())
    }
}

/// Words with the channels of `masks`.
fn words(len_bytes: usize, masks: [u32; 4]) -> Result<Texels, AssetError> {
    let mut channels = [None; 4];
    for (channel, mask) in channels.iter_mut().zip(masks) {
        *channel = Channel::of_mask(mask);
    }
    let [Some(red), Some(green), Some(blue), Some(alpha)] = channels else {
        return Err(malformed(
            SECOND_HEADER + 40,
            format!("the bit masks {masks:x?} of the BMP have gaps"),
        ));
    };
    Ok(Texels::Words {
        len_bytes,
        channels: [red, green, blue, alpha],
    })
}

fn half(bytes: &[u8], at: usize) -> Result<u16, AssetError> {
    let found = bytes.get(at..).and_then(<[u8]>::first_chunk);
    found
        .map(|&le| u16::from_le_bytes(le))
        .ok_or_else(|| ends(bytes))
}

fn word(bytes: &[u8], at: usize) -> Result<u32, AssetError> {
    let found = bytes.get(at..).and_then(<[u8]>::first_chunk);
    found
        .map(|&le| u32::from_le_bytes(le))
        .ok_or_else(|| ends(bytes))
}

fn ends(bytes: &[u8]) -> AssetError {
    malformed(bytes.len(), "the file ends within the BMP header")
}
