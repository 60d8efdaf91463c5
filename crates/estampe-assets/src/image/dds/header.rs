//! The checked headers of a DDS file.

use super::blocks::BlockFormat;
use crate::AssetError;
use crate::image::channel::Channel;
use crate::image::fault::{malformed, unsupported};

/// Length of the first header with its signature.
const HEADER_LEN: usize = 128;
/// Length of the second header.
const DX10_LEN: usize = 20;

/// Storage of the texels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Texels {
    /// Blocks of 4 × 4 texels.
    Blocks(BlockFormat),
    /// Words of 1 to 4 bytes with channels in the order R, G, B, A.
    Words {
        len_bytes: usize,
        channels: [Channel; 4],
    },
}

/// A valid header: every format that parses can be decoded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Header {
    pub(super) texels: Texels,
    /// True if the colours are multiplied by alpha.
    pub(super) is_premultiplied: bool,
    /// Offset of the first mip level.
    pub(super) texels_start: usize,
    /// Stored mip levels, at least 1.
    pub(super) level_count: u32,
}

/// Width and height, at least 1.
pub(super) fn size(bytes: &[u8]) -> Result<(u32, u32), AssetError> {
    let (height, width) = (word(bytes, 12)?, word(bytes, 16)?);
    if width == 0 || height == 0 {
        return Err(malformed(12, format!("a DDS of {width} × {height} texels")));
    }
    Ok((width, height))
}

impl Header {
    /// Reads what [`size`] leaves out.
    pub(super) fn parse(bytes: &[u8]) -> Result<Self, AssetError> {
        const CUBE_MAP: u32 = 0x200;
        const VOLUME: u32 = 0x20_0000;
        const MIP_LEVELS: u32 = 0x2_0000;
        let shape = word(bytes, 112)?;
        // The last word of the header is not used, and must be there.
        word(bytes, HEADER_LEN - 4)?;
        if shape & (CUBE_MAP | VOLUME) != 0 {
            return Err(unsupported("a DDS that is a cube map or a volume"));
        }
        let level_count = match word(bytes, 8)? & MIP_LEVELS {
            0 => 1,
            _ => word(bytes, 28)?.max(1),
        };
        let (flags, code) = (word(bytes, 80)?, word(bytes, 84)?.to_le_bytes());
        if flags & 4 == 0 {
            let texels = masked(bytes, flags)?;
            return Ok(Self {
                texels,
                is_premultiplied: false,
                texels_start: HEADER_LEN,
                level_count,
            });
        }
        if &code == b"DX10" {
            return Self::parse_dx10(bytes, level_count);
        }
        let format = match &code {
            b"DXT1" => BlockFormat::Bc1,
            b"DXT2" | b"DXT3" => BlockFormat::Bc2,
            b"DXT4" | b"DXT5" => BlockFormat::Bc3,
            b"ATI1" | b"BC4U" => BlockFormat::Bc4,
            b"BC4S" => BlockFormat::Bc4Signed,
            b"ATI2" | b"BC5U" => BlockFormat::Bc5,
            b"BC5S" => BlockFormat::Bc5Signed,
            other => {
                let code = other.escape_ascii();
                return Err(unsupported(format!("a DDS with the code `{code}`")));
            }
        };
        Ok(Self {
            texels: Texels::Blocks(format),
            is_premultiplied: matches!(&code, b"DXT2" | b"DXT4"),
            texels_start: HEADER_LEN,
            level_count,
        })
    }

    /// Reads the second header.
    fn parse_dx10(bytes: &[u8], level_count: u32) -> Result<Self, AssetError> {
        const TEXTURE_2D: u32 = 3;
        const CUBE_MAP: u32 = 4;
        const PREMULTIPLIED: u32 = 2;
        let [format, dimension, flags, layers, alpha] =
            [0, 4, 8, 12, 16].map(|at| word(bytes, HEADER_LEN + at));
        let (format, layers) = (format?, layers?);
        let alpha = alpha?;
        if dimension? != TEXTURE_2D || flags? & CUBE_MAP != 0 || layers > 1 {
            return Err(unsupported(
                "a DDS that is not one 2D texture (layers, a cube map, a volume)",
            ));
        }
        // Numbers of DXGI_FORMAT; of each format without a type, with numbers from 0 to 1, as sRGB.
        let rgba = [0xff, 0xff00, 0xff_0000, 0xff00_0000];
        let bgra = [0xff_0000, 0xff00, 0xff, 0xff00_0000];
        let bgrx = [0xff_0000, 0xff00, 0xff, 0];
        let texels = match format {
            70..=72 => Texels::Blocks(BlockFormat::Bc1),
            73..=75 => Texels::Blocks(BlockFormat::Bc2),
            76..=78 => Texels::Blocks(BlockFormat::Bc3),
            79 | 80 => Texels::Blocks(BlockFormat::Bc4),
            81 => Texels::Blocks(BlockFormat::Bc4Signed),
            82 | 83 => Texels::Blocks(BlockFormat::Bc5),
            84 => Texels::Blocks(BlockFormat::Bc5Signed),
            97..=99 => Texels::Blocks(BlockFormat::Bc7),
            27..=29 => words(4, rgba)?,
            87 | 90 | 91 => words(4, bgra)?,
            88 | 92 | 93 => words(4, bgrx)?,
            60 | 61 => words(1, [0xff, 0xff, 0xff, 0])?,
            other => return Err(unsupported(format!("a DDS of DXGI format {other}"))),
        };
        Ok(Self {
            texels,
            is_premultiplied: alpha & 7 == PREMULTIPLIED,
            texels_start: HEADER_LEN + DX10_LEN,
            level_count,
        })
    }
}

/// Words whose channels the first header describes.
fn masked(bytes: &[u8], flags: u32) -> Result<Texels, AssetError> {
    const ALPHA: u32 = 1;
    const COLORS: u32 = 0x40;
    const LUMINANCE: u32 = 0x2_0000;
    let bits = word(bytes, 88)?;
    let mask = |channel: usize| word(bytes, 92 + 4 * channel);
    let red = mask(0)?;
    let alpha = if flags & ALPHA == 0 { 0 } else { mask(3)? };
    let masks = match flags {
        _ if flags & COLORS != 0 => [red, mask(1)?, mask(2)?, alpha],
        _ if flags & LUMINANCE != 0 => [red, red, red, alpha],
        _ => {
            return Err(unsupported(format!(
                "a DDS with pixel format flags {flags:#x}"
            )));
        }
    };
    match bits {
        8 | 16 | 24 | 32 => words(bits as usize / 8, masks),
        _ => Err(unsupported(format!("a DDS of {bits} bits per texel"))),
    }
}

fn words(len_bytes: usize, masks: [u32; 4]) -> Result<Texels, AssetError> {
    match masks.map(Channel::of_mask) {
        [Some(red), Some(green), Some(blue), Some(alpha)] => Ok(Texels::Words {
            len_bytes,
            channels: [red, green, blue, alpha],
        }),
        _ => Err(malformed(
            92,
            format!("the bit masks {masks:x?} of the DDS have gaps"),
        )),
    }
}

fn word(bytes: &[u8], at: usize) -> Result<u32, AssetError> {
    let found = bytes.get(at..).and_then(<[u8]>::first_chunk);
    found
        .map(|&le| u32::from_le_bytes(le))
        .ok_or_else(|| malformed(bytes.len(), "the file ends within the DDS header"))
}
