//! Primitive assembly: from positions in the vertex stream to points, lines and triangles.
//!
//! In · Out: a topology and a number of vertices · primitives as positions in the vertex stream.
//! Spec: docs/PIPELINE.md row A1. The order within strips and fans is Vulkan's, with the provoking
//! vertex first. With the first-vertex convention that is:
//!
//! ```text
//! strip   0───2───4        triangle 0 = (0, 1, 2)     triangle 1 = (1, 3, 2): turned
//!          ╲ ╱ ╲ ╱         triangle 2 = (2, 3, 4)
//!           1───3
//!
//! fan     2───3            triangle 0 = (1, 2, 0)     triangle 1 = (2, 3, 0)
//!         │ ╲ │
//!         1───0
//! ```
//!
//! With the last-vertex convention (Vulkan's table of provoking vertices,
//! `VK_EXT_provoking_vertex`) a triangle's corners are rotated, which keeps the winding, until the
//! provoking vertex is first: (2, 0, 1), (3, 2, 1), (4, 2, 3) of the strip, (2, 0, 1), (3, 0, 2) of
//! the fan. Lines keep their direction.

use estampe_types::state::{PrimitiveTopology, ProvokingVertex};
use std::ops::Range;

/// A primitive whose corners are positions in the vertex stream. The first corner of a triangle is
/// its provoking vertex.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Primitive {
    /// One vertex.
    Point(u32),
    /// From the first position to the second.
    Line([u32; 2]),
    /// The corners in this winding.
    Triangle([u32; 3]),
}

/// The primitives of `count` vertices, in order. Vertices that do not complete a primitive are
/// dropped; a line loop needs two vertices.
pub fn primitives(topology: PrimitiveTopology, count: u32) -> impl Iterator<Item = Primitive> {
    use PrimitiveTopology as T;
    let number = match topology {
        T::PointList => count,
        T::LineList => count / 2,
        T::LineStrip => count.saturating_sub(1),
        T::LineLoop if count < 2 => 0,
        T::LineLoop => count,
        T::TriangleList => count / 3,
        T::TriangleStrip | T::TriangleFan => count.saturating_sub(2),
        T::LineListAdjacency => count / 4,
        T::LineStripAdjacency => count.saturating_sub(3),
        T::TriangleListAdjacency => count / 6,
        T::TriangleStripAdjacency => (count / 2).saturating_sub(2),
        // Patches become primitives in `tessellation`.
        T::PatchList => 0,
    };
    (0..number).map(move |i| match topology {
        T::PointList | T::PatchList => Primitive::Point(i),
        T::LineList => Primitive::Line([2 * i, 2 * i + 1]),
        T::LineStrip => Primitive::Line([i, i + 1]),
        T::LineLoop if i == count - 1 => Primitive::Line([i, 0]),
        T::LineLoop => Primitive::Line([i, i + 1]),
        T::TriangleList => Primitive::Triangle([3 * i, 3 * i + 1, 3 * i + 2]),
        T::TriangleStrip if i % 2 == 1 => Primitive::Triangle([i, i + 2, i + 1]),
        T::TriangleStrip => Primitive::Triangle([i, i + 1, i + 2]),
        T::TriangleFan => Primitive::Triangle([i + 1, i + 2, 0]),
        T::LineListAdjacency => Primitive::Line([4 * i + 1, 4 * i + 2]),
        T::LineStripAdjacency => Primitive::Line([i + 1, i + 2]),
        T::TriangleListAdjacency => Primitive::Triangle([6 * i, 6 * i + 2, 6 * i + 4]),
        T::TriangleStripAdjacency if i % 2 == 1 => {
            Primitive::Triangle([2 * i, 2 * i + 4, 2 * i + 2])
        }
        T::TriangleStripAdjacency => Primitive::Triangle([2 * i, 2 * i + 2, 2 * i + 4]),
    })
}

/// The corners of a triangle, rotated so that its provoking vertex is first; `index` is the
/// triangle's number in the topology.
#[must_use]
pub fn turned(
    topology: PrimitiveTopology,
    mode: ProvokingVertex,
    index: usize,
    [a, b, c]: [u32; 3],
) -> [u32; 3] {
    use PrimitiveTopology as T;
    if mode == ProvokingVertex::First {
        return [a, b, c];
    }
    match topology {
        // The fan's centre vertex is last in (1, 2, 0).
        T::TriangleFan => [b, c, a],
        T::TriangleStrip | T::TriangleStripAdjacency if index % 2 == 1 => [b, c, a],
        _ => [c, a, b],
    }
}

/// The ranges of positions below `count` that are separated by positions for which `is_restart`
/// holds.
#[must_use]
pub fn runs(count: u32, is_restart: impl Fn(u32) -> bool) -> Vec<Range<u32>> {
    let mut runs = Vec::new();
    let mut start = 0;
    for position in 0..count {
        if is_restart(position) {
            runs.push(start..position);
            start = position + 1;
        }
    }
    runs.push(start..count);
    runs
}
