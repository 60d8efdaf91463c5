//! Detection of a model's format.

use super::{gltf, off, threemf};
use std::path::Path;

/// Formats of models.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ModelFormat {
    /// glTF 2.0: JSON with its files (`.gltf`), or in one file (`.glb`).
    Gltf,
    /// Wavefront OBJ, with its MTL material libraries.
    Obj,
    /// Stereolithography, binary or ASCII.
    Stl,
    /// The Stanford polygon format, ASCII or binary.
    Ply,
    /// The Object File Format of Geomview, as text.
    Off,
    /// The 3D Manufacturing Format, a package of XML and images.
    ThreeMf,
}

impl ModelFormat {
    /// The format of the path's extension, in upper or lower case.
    #[must_use]
    pub fn from_extension(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?;
        [
            (Self::Gltf, "gltf"),
            (Self::Gltf, "glb"),
            (Self::Obj, "obj"),
            (Self::Stl, "stl"),
            (Self::Ply, "ply"),
            (Self::Off, "off"),
            (Self::ThreeMf, "3mf"),
        ]
        .into_iter()
        .find(|(_, name)| extension.eq_ignore_ascii_case(name))
        .map(|(format, _)| format)
    }

    /// The format by content, for input without a name.
    ///
    /// GLB, PLY and OFF have magic words, glTF is a JSON object with an `asset`, 3MF is a ZIP
    /// archive with the parts of a package, and binary STL has a length that must fit its triangle
    /// count; ASCII STL and OBJ are recognised by their first statements.
    #[must_use]
    pub fn from_content(bytes: &[u8]) -> Option<Self> {
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        if is_gltf(bytes) {
            return Some(Self::Gltf);
        }
        if threemf::is_3mf(bytes) {
            return Some(Self::ThreeMf);
        }
        if is_ply(bytes) {
            return Some(Self::Ply);
        }
        if off::is_off(bytes) {
            return Some(Self::Off);
        }
        if binary_stl_length(bytes) == Some(bytes.len() as u64) {
            return Some(Self::Stl);
        }
        first_statements(bytes)
    }

    /// The common name, for messages.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Gltf => "glTF",
            Self::Obj => "OBJ",
            Self::Stl => "STL",
            Self::Ply => "PLY",
            Self::Off => "OFF",
            Self::ThreeMf => "3MF",
        }
    }
}

/// True for GLB's magic word, and for a JSON object with a key `asset` near its start or its end:
/// some exporters write it last.
fn is_gltf(bytes: &[u8]) -> bool {
    const EXAMINED_BYTES: usize = 64 * 1024;
    if bytes.starts_with(gltf::MAGIC) {
        return true;
    }
    let has_key = |part: &[u8]| part.windows(7).any(|word| word == b"\"asset\"");
    let head = &bytes[..bytes.len().min(EXAMINED_BYTES)];
    let tail = &bytes[bytes.len().saturating_sub(EXAMINED_BYTES)..];
    head.trim_ascii_start().starts_with(b"{") && (has_key(head) || has_key(tail))
}

/// True if the bytes start with PLY's magic word on a separate line.
pub(super) fn is_ply(bytes: &[u8]) -> bool {
    bytes.starts_with(b"ply")
        && bytes
            .get(3)
            .is_none_or(|&byte| matches!(byte, b'\n' | b'\r' | b' ' | b'\t'))
}

/// The length of a binary STL with this header: 84 + 50 n.
pub(super) fn binary_stl_length(bytes: &[u8]) -> Option<u64> {
    let count = u32::from_le_bytes(*bytes.get(80..)?.first_chunk()?);
    Some(84 + 50 * u64::from(count))
}

/// The format of the first line whose keyword is known.
fn first_statements(bytes: &[u8]) -> Option<ModelFormat> {
    const EXAMINED_BYTES: usize = 64 * 1024;
    let head = &bytes[..bytes.len().min(EXAMINED_BYTES)];
    let lines = head.split(|&byte| byte == b'\n' || byte == b'\r');
    for line in lines {
        let mut words = line
            .split(u8::is_ascii_whitespace)
            .filter(|word| !word.is_empty());
        let Some(keyword) = words.next() else {
            continue;
        };
        match keyword {
            b"v" | b"vt" | b"vn" | b"vp" | b"f" | b"o" | b"g" | b"s" | b"mtllib" | b"usemtl" => {
                return Some(ModelFormat::Obj);
            }
            word if word.eq_ignore_ascii_case(b"solid") || word.eq_ignore_ascii_case(b"facet") => {
                return Some(ModelFormat::Stl);
            }
            _ => {}
        }
    }
    None
}
