//! The checked header of a KTX 2.0 file.

use super::format::TexelLayout;
use crate::AssetError;
use crate::image::fault::{malformed, unsupported};
use std::fmt;

/// Length of the header, in bytes.
const HEADER_LEN: usize = 80;
/// Length of a level's entry in the index.
const LEVEL_LEN: usize = 24;
/// The most levels: those of a side of 2³² − 1.
const MAX_LEVELS: u32 = 32;

/// A valid header: every format that parses can be decoded.
#[derive(Debug, Clone)]
pub(super) struct Header {
    pub(super) size: (u32, u32),
    pub(super) texels: TexelLayout,
    pub(super) scheme: Scheme,
    /// True if the colours are multiplied by alpha.
    pub(super) is_premultiplied: bool,
    pub(super) orientation: Orientation,
    /// The source of each channel.
    pub(super) swizzle: [ChannelSource; 4],
    /// The levels, at least one, the largest first.
    pub(super) levels: Vec<Level>,
}

/// The supercompression of levels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Scheme {
    None,
    Zstandard,
    Zlib,
}

/// The place of a level in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Level {
    pub(super) offset: u64,
    pub(super) len: u64,
    /// Where its entry in the index is.
    pub(super) entry: usize,
}

/// Directions of rows and columns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Orientation {
    pub(super) is_mirrored: bool,
    pub(super) is_upside_down: bool,
}

/// The source of a channel of the result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ChannelSource {
    Channel(usize),
    Zero,
    One,
}

impl ChannelSource {
    const IDENTITY: [Self; 4] = [
        Self::Channel(0),
        Self::Channel(1),
        Self::Channel(2),
        Self::Channel(3),
    ];
}

/// Width and height, at least 1.
pub(super) fn size(bytes: &[u8]) -> Result<(u32, u32), AssetError> {
    let (width, height) = (word(bytes, 20)?, word(bytes, 24)?);
    if width == 0 {
        return Err(malformed(20, "a KTX2 texture without columns"));
    }
    if height == 0 {
        return Err(unsupported("a KTX2 texture of one dimension"));
    }
    Ok((width, height))
}

impl Header {
    pub(super) fn parse(bytes: &[u8]) -> Result<Self, AssetError> {
        let size = size(bytes)?;
        let [format, depth, layers, faces, levels, scheme] =
            [12, 28, 32, 36, 40, 44].map(|at| word(bytes, at));
        let (format, levels) = (format?, levels?);
        if depth? != 0 {
            return Err(unsupported("a KTX2 texture of three dimensions"));
        }
        match faces? {
            1 => {}
            6 => return Err(unsupported("a KTX2 cube map")),
            faces => return Err(malformed(36, format!("a KTX2 texture of {faces} faces"))),
        }
        if layers? > 1 {
            return Err(unsupported("a KTX2 array of textures"));
        }
        if levels > MAX_LEVELS {
            return Err(malformed(40, format!("a KTX2 texture of {levels} levels")));
        }
        // The last word of the header, which is not used here.
        word(bytes, HEADER_LEN - 4)?;

        let descriptor = Descriptor::read(bytes)?;
        if let Some(basis) = BasisUniversal::of(bytes) {
            return Err(AssetError::unsupported(
                format!("a KTX2 texture of {basis} cannot be read"),
                BasisUniversal::ADVICE,
            ));
        }
        let scheme = match scheme? {
            0 => Scheme::None,
            // Basis Universal's, which was refused.
            1 => return Err(unsupported("KTX2 supercompression BasisLZ")),
            2 => Scheme::Zstandard,
            3 => Scheme::Zlib,
            other => return Err(unsupported(format!("KTX2 supercompression {other}"))),
        };
        if format == 0 {
            let model = descriptor.color_model;
            return Err(unsupported(format!(
                "a KTX2 texture of colour model {model}"
            )));
        }
        let texels = TexelLayout::of_vulkan(format)
            .ok_or_else(|| unsupported(format!("a KTX2 texture of VkFormat {format}")))?;
        let levels = { 0..levels.max(1) as usize }.map(|level| {
            let entry = HEADER_LEN + level * LEVEL_LEN;
            Ok(Level {
                offset: double_word(bytes, entry)?,
                len: double_word(bytes, entry + 8)?,
                entry,
            })
        });
        let levels = levels.collect::<Result<_, AssetError>>()?;
        let values = Values::find(bytes)?;
        Ok(Self {
            size,
            texels,
            scheme,
            is_premultiplied: descriptor.is_premultiplied,
            orientation: Orientation {
                is_mirrored: values.orientation.first() == Some(&b'l'),
                is_upside_down: values.orientation.get(1) == Some(&b'u'),
            },
            swizzle: swizzle(values.swizzle).unwrap_or(ChannelSource::IDENTITY),
            levels,
        })
    }
}

/// The kinds of Basis Universal, whose texels are made by transcoders.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum BasisUniversal {
    Etc1s,
    Uastc,
    UastcHdr,
}

impl BasisUniversal {
    /// The advice of errors.
    pub(crate) const ADVICE: &str = "transcode it to a format of GPUs (`ktx transcode --target bc7 \
                                     IN.ktx2 OUT.ktx2`), or save it as PNG";

    /// The kind of a KTX2 file; `None` of others and of files without a whole header.
    pub(crate) fn of(bytes: &[u8]) -> Option<Self> {
        const BASIS_LZ: u32 = 1;
        if !bytes.starts_with(super::SIGNATURE) {
            return None;
        }
        let (format, scheme) = (word(bytes, 12).ok()?, word(bytes, 44).ok()?);
        let model = Descriptor::read(bytes).ok()?.color_model;
        match (format, model, scheme) {
            (0, 163, _) | (_, _, BASIS_LZ) => Some(Self::Etc1s),
            (0, 166, _) => Some(Self::Uastc),
            (0, 167 | 168, _) => Some(Self::UastcHdr),
            _ => None,
        }
    }
}

impl fmt::Display for BasisUniversal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Etc1s => "Basis Universal (ETC1S)",
            Self::Uastc => "Basis Universal (UASTC)",
            Self::UastcHdr => "Basis Universal (UASTC HDR)",
        })
    }
}

/// The data format descriptor (Khronos Data Format Specification), of which little is read: the
/// format says most.
struct Descriptor {
    color_model: u32,
    is_premultiplied: bool,
}

impl Descriptor {
    fn read(bytes: &[u8]) -> Result<Self, AssetError> {
        const ALPHA_PREMULTIPLIED: u32 = 1;
        let (offset, len) = (word(bytes, 48)? as usize, word(bytes, 52)?);
        if len == 0 {
            return Ok(Self {
                color_model: 0,
                is_premultiplied: false,
            });
        }
        // The total length, then the first block: vendor and type, version and length, and this.
        let word = word(bytes, offset.saturating_add(12))?;
        Ok(Self {
            color_model: word & 255,
            is_premultiplied: word >> 24 & ALPHA_PREMULTIPLIED != 0,
        })
    }
}

/// The values that are read, of their keys.
#[derive(Default)]
struct Values<'b> {
    orientation: &'b [u8],
    swizzle: &'b [u8],
}

impl<'b> Values<'b> {
    fn find(bytes: &'b [u8]) -> Result<Self, AssetError> {
        let (start, len) = (word(bytes, 56)? as usize, word(bytes, 60)? as usize);
        let end = start.saturating_add(len);
        let mut found = Self::default();
        let mut at = start;
        while at < end {
            let len = word(bytes, at)? as usize;
            let Some(pair) = bytes.get(at + 4..(at + 4).saturating_add(len).min(end)) else {
                return Err(ends_within(bytes));
            };
            if let Some(value) = pair.strip_prefix(b"KTXorientation\0") {
                found.orientation = value;
            } else if let Some(value) = pair.strip_prefix(b"KTXswizzle\0") {
                found.swizzle = value;
            }
            // Filled up to a multiple of four bytes.
            at = (at + 4).saturating_add(len).next_multiple_of(4);
        }
        Ok(found)
    }
}

fn swizzle(text: &[u8]) -> Option<[ChannelSource; 4]> {
    let mut sources = ChannelSource::IDENTITY;
    for (source, letter) in sources.iter_mut().zip(text.first_chunk::<4>()?) {
        *source = match letter {
            b'r' => ChannelSource::Channel(0),
            b'g' => ChannelSource::Channel(1),
            b'b' => ChannelSource::Channel(2),
            b'a' => ChannelSource::Channel(3),
            b'0' => ChannelSource::Zero,
            b'1' => ChannelSource::One,
            _ => return None,
        };
    }
    Some(sources)
}

fn word(bytes: &[u8], at: usize) -> Result<u32, AssetError> {
    let found = bytes.get(at..).and_then(<[u8]>::first_chunk);
    found
        .map(|&le| u32::from_le_bytes(le))
        .ok_or_else(|| ends_within(bytes))
}

fn double_word(bytes: &[u8], at: usize) -> Result<u64, AssetError> {
    let found = bytes.get(at..).and_then(<[u8]>::first_chunk);
    found
        .map(|&le| u64::from_le_bytes(le))
        .ok_or_else(|| ends_within(bytes))
}

fn ends_within(bytes: &[u8]) -> AssetError {
    malformed(bytes.len(), "the file ends within the KTX2 header")
}
