//! Pieces: what an amplified draw is drawn as.

use estampe_types::BufferData;

/// Records of vertices and the indices of primitives, for the pipeline that passes them through.
#[derive(Debug)]
pub(crate) struct Piece {
    /// The vertex buffer.
    pub(crate) vertices: BufferData,
    /// The index buffer, 32 bits each.
    pub(crate) indices: BufferData,
    pub(crate) index_count: u32,
    /// The layer of the target.
    pub(crate) layer: u32,
    /// The number of the draw's viewport.
    pub(crate) viewport: u32,
}

impl Piece {
    /// A piece of the first layer and viewport.
    pub(super) fn new(records: Vec<u32>, indices: Vec<u32>) -> Self {
        Self::of_buffer(BufferData::from_words(records), indices)
    }

    /// A piece of vertices that others may share.
    pub(super) fn of_buffer(vertices: BufferData, indices: Vec<u32>) -> Self {
        debug_assert!(u32::try_from(indices.len()).is_ok(), "units are small");
        Self {
            vertices,
            index_count: u32::try_from(indices.len()).unwrap_or(u32::MAX),
            indices: BufferData::from_words(indices),
            layer: 0,
            viewport: 0,
        }
    }

    /// Words of memory.
    pub(crate) fn words(&self) -> usize {
        self.vertices.words().len() + self.indices.words().len()
    }
}
