//! The kinds of primitives, whatever the topology.

use estampe_types::state::PrimitiveTopology;

/// A kind of primitives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PrimitiveKind {
    Points,
    Lines,
    Triangles,
}

/// The kind of primitives that a topology makes.
pub(crate) fn kind_of(topology: PrimitiveTopology) -> PrimitiveKind {
    use PrimitiveTopology as T;
    match topology {
        T::PointList => PrimitiveKind::Points,
        T::LineList | T::LineStrip | T::LineLoop | T::LineListAdjacency | T::LineStripAdjacency => {
            PrimitiveKind::Lines
        }
        T::TriangleList
        | T::TriangleStrip
        | T::TriangleFan
        | T::TriangleListAdjacency
        | T::TriangleStripAdjacency
        // What patches become is drawn by another pipeline.
        | T::PatchList => PrimitiveKind::Triangles,
    }
}
