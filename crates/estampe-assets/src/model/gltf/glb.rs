//! The container of `.glb` files: a header of 12 bytes, and chunks.
//!
//! ```text
//! 0        4        8        12       16       20
//! | "glTF" |      2 | length | length | "JSON" | text … | length | "BIN\0" | bytes … |
//! ```
//!
//! Numbers are u32, little-endian. The first length is that of the file, those of chunks are of
//! their contents, which are padded to multiples of four bytes.
//!
//! Source: glTF 2.0 specification, §4 "GLB File Format".

use crate::model::load::Context;
use crate::{AssetError, Location};

/// The first bytes of the container.
pub(in crate::model) const MAGIC: &[u8] = b"glTF";

const HEADER_BYTES: usize = 12;
const CHUNK_HEADER_BYTES: usize = 8;
const JSON: [u8; 4] = *b"JSON";
const BIN: [u8; 4] = *b"BIN\0";

/// The parts of a file.
#[derive(Debug, Clone, Copy)]
pub(super) struct Container<'a> {
    pub(super) json: &'a [u8],
    /// Offset of `json` in the file.
    pub(super) json_offset: usize,
    /// The binary chunk.
    pub(super) bin: Option<&'a [u8]>,
}

/// The parts of a `.glb` file, or of a `.gltf` file, which is JSON alone.
pub(super) fn split<'a>(
    bytes: &'a [u8],
    context: &mut Context<'_>,
) -> Result<Container<'a>, AssetError> {
    if !bytes.starts_with(MAGIC) {
        let json = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        return Ok(Container {
            json,
            json_offset: bytes.len() - json.len(),
            bin: None,
        });
    }
    let [version, length] = [4, 8].map(|at| u32_at(bytes, at));
    let (Some(version), Some(length)) = (version, length) else {
        return Err(truncated(bytes.len(), "the header of a GLB file"));
    };
    if version != 2 {
        return Err(AssetError::unsupported(
            format!("version {version} of the GLB format is not read, version 2 is"),
            "convert the file to glTF 2.0",
        )
        .at(Location::Byte(4)));
    }
    if length > bytes.len() {
        let what = format!("the file; its header states {length} bytes");
        return Err(truncated(bytes.len(), &what));
    }
    if length < bytes.len() {
        context
            .warnings
            .add(context.name, Location::Byte(length as u64), || {
                format!("{} bytes after the end are ignored", bytes.len() - length)
            });
    }
    read_chunks(&bytes[..length], context)
}

fn read_chunks<'a>(
    bytes: &'a [u8],
    context: &mut Context<'_>,
) -> Result<Container<'a>, AssetError> {
    let mut json = None;
    let mut bin = None;
    let mut at = HEADER_BYTES;
    while at < bytes.len() {
        let start = at + CHUNK_HEADER_BYTES;
        let Some(length) = u32_at(bytes, at).filter(|_| start <= bytes.len()) else {
            return Err(truncated(bytes.len(), "the header of a chunk"));
        };
        let kind: [u8; 4] = std::array::from_fn(|i| bytes[at + 4 + i]);
        let Some(chunk) = bytes[start..].get(..length) else {
            let what = format!("a chunk, which states {length} bytes");
            return Err(truncated(at, &what));
        };
        if length % 4 != 0 {
            context
                .warnings
                .add(context.name, Location::Byte(at as u64), || {
                    format!("the chunk's length of {length} bytes is not a multiple of 4")
                });
        }
        match kind {
            JSON if json.is_none() => json = Some((chunk, start)),
            // Other chunks belong to extensions.
            _ if json.is_none() => break,
            BIN if bin.is_none() => bin = Some(chunk),
            _ => {}
        }
        at = start + length;
    }
    let Some((json, json_offset)) = json else {
        return Err(
            AssetError::malformed("the first chunk is not JSON", "export the file again")
                .at(Location::Byte(HEADER_BYTES as u64)),
        );
    };
    Ok(Container {
        json,
        json_offset,
        bin,
    })
}

fn u32_at(bytes: &[u8], at: usize) -> Option<usize> {
    let word = u32::from_le_bytes(*bytes.get(at..)?.first_chunk()?);
    usize::try_from(word).ok()
}

fn truncated(at: usize, what: &str) -> AssetError {
    AssetError::malformed(
        format!("the file ends within {what}"),
        "download or export it again",
    )
    .at(Location::Byte(at as u64))
}
