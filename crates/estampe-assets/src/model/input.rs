//! The bytes of a model and where they come from: memory, a file or a stream.

use super::ModelFormat;
use super::encoding::utf8_from_utf16;
use super::resources::Resources;
use crate::{AssetError, Limits, read_bytes};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// The bytes of a model and where they come from.
#[derive(Clone, Copy)]
pub struct ModelInput<'a> {
    /// The file.
    pub bytes: &'a [u8],
    /// Its format.
    pub format: ModelFormat,
    /// Its name in messages.
    pub name: &'a str,
    /// The source of its side files.
    pub resources: &'a dyn Resources,
}

impl std::fmt::Debug for ModelInput<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { format, name, .. } = self;
        write!(f, "ModelInput({name}, {format:?})")
    }
}

/// A model that is not kept in memory once it is parsed.
pub struct ModelSource<'a> {
    /// The file.
    pub bytes: SourceBytes<'a>,
    /// Its format.
    pub format: ModelFormat,
    /// Its name in messages.
    pub name: &'a str,
    /// The source of its side files.
    pub resources: &'a dyn Resources,
}

impl std::fmt::Debug for ModelSource<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { format, name, .. } = self;
        write!(f, "ModelSource({name}, {format:?})")
    }
}

/// The bytes of a [`ModelSource`].
pub enum SourceBytes<'a> {
    /// All bytes: they are dropped as soon as they are parsed.
    Memory(Vec<u8>),
    /// A stream of about so many bytes, if that is known. OBJ is parsed while it is read, and never
    /// in memory as a whole; other formats are read first.
    Stream(&'a mut (dyn Read + Send), Option<u64>),
}

impl std::fmt::Debug for SourceBytes<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Memory(bytes) => write!(f, "{} bytes", bytes.len()),
            Self::Stream(_, Some(len)) => write!(f, "a stream of {len} bytes"),
            Self::Stream(_, None) => f.write_str("a stream"),
        }
    }
}

/// The bytes of the model itself, up to the limit. The user named it, so it may be a pipe.
pub(super) fn read_file(path: &Path, limits: &Limits) -> Result<Vec<u8>, AssetError> {
    let failed = |error: std::io::Error| of_stream(&error, limits);
    let metadata = std::fs::metadata(path).map_err(failed)?;
    if metadata.is_dir() {
        return Err(AssetError::io(
            "this is a folder",
            "name a model file in it",
        ));
    }
    Limits::check("bytes", metadata.len(), limits.max_file_bytes)?;
    let file = File::open(path).map_err(failed)?;
    read_bytes(file, metadata.len(), limits).map_err(failed)
}

pub(super) fn check_length(bytes: &[u8], limits: &Limits) -> Result<(), AssetError> {
    Limits::check("bytes", bytes.len() as u64, limits.max_file_bytes)
}

/// The error of [`read_bytes`] and [`read_stream`](crate::read_stream).
pub(super) fn of_stream(error: &std::io::Error, limits: &Limits) -> AssetError {
    let failed = || AssetError::io(error.to_string(), "check the path and its permissions");
    match error.kind() {
        std::io::ErrorKind::FileTooLarge => {
            let more = limits.max_file_bytes.saturating_add(1);
            let checked = Limits::check("bytes", more, limits.max_file_bytes);
            checked.err().unwrap_or_else(failed)
        }
        _ => failed(),
    }
}

/// The text of a file in UTF-16, in the formats that are text. What begins as UTF-16 may be a
/// binary STL, whose first 80 bytes are free.
pub(super) fn decoded_text(format: ModelFormat, bytes: &[u8]) -> Option<Vec<u8>> {
    match format {
        ModelFormat::Obj | ModelFormat::Off | ModelFormat::Ply => utf8_from_utf16(bytes),
        ModelFormat::Stl => {
            let count = bytes.get(80..84).and_then(|count| count.first_chunk());
            let whole = count.map(|&count| 84 + 50 * u64::from(u32::from_le_bytes(count)));
            let is_binary = whole == Some(bytes.len() as u64);
            { (!is_binary).then_some(bytes) }.and_then(utf8_from_utf16)
        }
        // JSON is UTF-8, and 3MF decodes its parts.
        ModelFormat::Gltf | ModelFormat::ThreeMf => None,
    }
}
