//! EXT_meshopt_compression: compressed buffer views.

use super::buffers::Buffers;
use super::document::MeshoptView;
use crate::AssetError;

/// A compressed view.
pub(super) struct Compressed<'a> {
    bytes: &'a [u8],
    length: u64,
}

impl<'a> Compressed<'a> {
    /// Finds the compressed bytes. `pointer` is the place of the extension.
    pub(super) fn new(
        view: &MeshoptView,
        buffers: &'a Buffers<'_>,
        pointer: &str,
    ) -> Result<Self, AssetError> {
        let bytes = buffers.range(view.buffer, view.byte_offset, view.byte_length, pointer)?;
        let length = (view.count.0 as u64).saturating_mul(view.byte_stride.0 as u64);
        Ok(Self { bytes, length })
    }

    /// Number of bytes after decoding.
    pub(super) fn decoded_length(&self) -> u64 {
        self.length
    }

    /// The decoded bytes.
    pub(super) fn decode(&self) -> Result<Vec<u8>, AssetError> {
        Err(AssetError::unsupported(
            format!("{} bytes are compressed", self.bytes.len()),
            "export the file again without EXT_meshopt_compression",
        ))
    }
}
