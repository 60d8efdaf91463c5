//! Buffers, views of them, and accessors.

use super::{Index, Text};
use serde::Deserialize;

/// Bytes from a file, a data URI or the binary chunk.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Buffer<'a> {
    #[serde(borrow)]
    pub(crate) uri: Option<Text<'a>>,
    pub(crate) byte_length: Index,
}

/// A range of a buffer.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct BufferView {
    pub(crate) buffer: Index,
    #[serde(default)]
    pub(crate) byte_offset: Index,
    pub(crate) byte_length: Index,
    pub(crate) byte_stride: Option<Index>,
    #[serde(default)]
    pub(crate) extensions: BufferViewExtensions,
}

/// Extensions of a buffer view.
#[derive(Debug, Default, Deserialize)]
pub(crate) struct BufferViewExtensions {
    #[serde(rename = "EXT_meshopt_compression")]
    pub(crate) meshopt: Option<Box<MeshoptView>>,
}

/// EXT_meshopt_compression: the compressed bytes from which a view is made.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct MeshoptView {
    pub(crate) buffer: Index,
    #[serde(default)]
    pub(crate) byte_offset: Index,
    pub(crate) byte_length: Index,
    pub(crate) byte_stride: Index,
    pub(crate) count: Index,
    pub(crate) mode: String,
    pub(crate) filter: Option<String>,
}

/// Typed elements in a buffer view.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Accessor {
    pub(crate) buffer_view: Option<Index>,
    #[serde(default)]
    pub(crate) byte_offset: Index,
    pub(crate) component_type: Index,
    #[serde(default)]
    pub(crate) normalized: bool,
    pub(crate) count: Index,
    #[serde(rename = "type")]
    pub(crate) kind: String,
    pub(crate) sparse: Option<Box<Sparse>>,
}

/// Elements that replace some of an accessor's.
#[derive(Debug, Deserialize)]
pub(crate) struct Sparse {
    pub(crate) count: Index,
    pub(crate) indices: SparseIndices,
    pub(crate) values: SparseValues,
}

/// The numbers of the replaced elements, in increasing order.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct SparseIndices {
    pub(crate) buffer_view: Index,
    #[serde(default)]
    pub(crate) byte_offset: Index,
    pub(crate) component_type: Index,
}

/// The new elements.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct SparseValues {
    pub(crate) buffer_view: Index,
    #[serde(default)]
    pub(crate) byte_offset: Index,
}
