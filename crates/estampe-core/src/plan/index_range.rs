//! The elements of a draw: how many there are, where they may be cut, and the range of vertices
//! that they name.

use super::index_extremes::KnownExtremes;
use crate::commands::Draw;
use crate::geometry::assembly::vertex_index;
use crate::geometry::restart::RestartSource;
use crate::schedule::Executor;
use estampe_types::IndexFormat;
use estampe_types::state::PrimitiveTopology;

/// Elements of a fan, loop or stippled strip at most: what is beyond is not drawn. Memory for a
/// draw is bounded by it.
pub(super) const MAX_WHOLE_ELEMENTS: u32 = 1 << 24;

/// The largest ratio of a draw's range of indices to its number of elements; beyond it, vertices
/// are shaded once for each element.
const SPARSE_FACTOR: u64 = 4;

/// The vertices of one instance of a sub-draw.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct IndexRange {
    /// The first vertex index.
    pub(super) first: u32,
    pub(super) count: u32,
    /// The vertex index of each element in place of the range, where the range is sparse.
    pub(super) sparse: Option<Vec<u32>>,
}

/// A draw's elements, if its indices may restart primitives.
pub(super) fn restart_source<'a>(draw: &Draw<'a>) -> Option<RestartSource<'a>> {
    let state = &draw.pipeline.descriptor().primitive;
    let (buffer, format) = draw.indices.filter(|_| state.primitive_restart)?;
    let count = draw.elements.end.saturating_sub(draw.elements.start);
    Some(RestartSource {
        topology: state.topology,
        provoking: state.provoking_vertex,
        buffer,
        format,
        base_vertex: draw.base_vertex,
        elements: [draw.elements.start, count],
    })
}

/// Replaces the vertex indices of listed primitives by numbers in the range that is returned.
pub(super) fn list_vertices(corners: &mut [[u32; 3]]) -> IndexRange {
    let all = corners.as_flattened_mut();
    let (Some(&least), Some(&greatest)) = (all.iter().min(), all.iter().max()) else {
        return IndexRange::dense(0, 0);
    };
    if let Some(range) = IndexRange::if_dense([least, greatest], all.len() as u64) {
        all.iter_mut().for_each(|vertex| *vertex -= least);
        return range;
    }
    let sparse: Vec<u32> = all.to_vec();
    for (number, vertex) in (0..).zip(all) {
        *vertex = number;
    }
    IndexRange::listed(sparse)
}

impl IndexRange {
    fn dense(first: u32, count: u32) -> Self {
        Self {
            first,
            count,
            sparse: None,
        }
    }

    /// The range from the least to the greatest of some indices, unless it is sparse.
    fn if_dense([least, greatest]: [u32; 2], indices: u64) -> Option<Self> {
        let span = u64::from(greatest - least) + 1;
        let is_dense = span <= indices * SPARSE_FACTOR;
        let count = u32::try_from(span).ok().filter(|_| is_dense)?;
        Some(Self::dense(least, count))
    }

    fn listed(sparse: Vec<u32>) -> Self {
        debug_assert!(
            u32::try_from(sparse.len()).is_ok(),
            "a draw's elements are 32-bit numbers"
        );
        Self {
            first: 0,
            count: u32::try_from(sparse.len()).unwrap_or(u32::MAX),
            sparse: Some(sparse),
        }
    }
}

/// The number of elements of a draw. Fans, loops and stippled strips cannot be cut into sub-draws,
/// so they end at [`MAX_WHOLE_ELEMENTS`].
pub(super) fn element_count(draw: &Draw<'_>) -> u32 {
    let count = draw.elements.end.saturating_sub(draw.elements.start);
    if is_splittable(draw) {
        count
    } else {
        count.min(MAX_WHOLE_ELEMENTS)
    }
}

/// Elements of a primitive at most.
const PRIMITIVE_ELEMENTS: u32 = 6;

/// The number of a draw's elements that can be visible, at most [`element_count`].
///
/// Elements beyond the index buffer's end are all the same vertex, so triangles and lines between
/// them have no extent, whatever the shader does. A draw of 2³² indices over a small buffer thus
/// ends at once. Points are kept, because they are drawn, over one another. Line loops are kept
/// because the last line closes the loop, and draws with primitive restart because their primitives
/// are not counted before assembly.
pub(super) fn visible_elements(draw: &Draw<'_>) -> u32 {
    let count = element_count(draw);
    let state = &draw.pipeline.descriptor().primitive;
    let is_counted = match state.topology {
        PrimitiveTopology::PointList | PrimitiveTopology::LineLoop => false,
        _ => !state.primitive_restart,
    };
    let Some((buffer, format)) = draw.indices.filter(|_| is_counted) else {
        return count;
    };
    let index_bytes = match format {
        IndexFormat::Uint8 => 1,
        IndexFormat::Uint16 => 2,
        IndexFormat::Uint32 => 4,
    };
    let stored = buffer.len_bytes().div_ceil(index_bytes);
    let stored = u32::try_from(stored).unwrap_or(u32::MAX);
    let left = stored.saturating_sub(draw.elements.start);
    // A primitive with one element in the buffer is kept whole.
    count.min(left.saturating_add(PRIMITIVE_ELEMENTS))
}

/// Returns true if a run of a draw's primitives is a run of elements of the same topology that can
/// be drawn like any other.
pub(super) fn is_splittable(draw: &Draw<'_>) -> bool {
    let topology = draw.pipeline.descriptor().primitive.topology;
    !matches!(
        topology,
        PrimitiveTopology::TriangleFan | PrimitiveTopology::LineLoop
    ) && !is_stippled_strip(draw)
}

/// Returns true if each line of a topology begins at the end of the line before it.
pub(super) fn is_line_strip(topology: PrimitiveTopology) -> bool {
    matches!(
        topology,
        PrimitiveTopology::LineStrip
            | PrimitiveTopology::LineLoop
            | PrimitiveTopology::LineStripAdjacency
    )
}

pub(super) fn is_stippled_strip(draw: &Draw<'_>) -> bool {
    let state = &draw.pipeline.descriptor().primitive;
    state.line.stipple.is_some() && is_line_strip(state.topology)
}

/// The elements (first, count) of `count` primitives from `first` on. Draws are cut at even
/// primitives, so that a strip's parts begin on triangles that are not turned.
pub(super) fn part_of(topology: PrimitiveTopology, first: u32, count: u32, whole: u32) -> [u32; 2] {
    use PrimitiveTopology as T;
    let [each, more] = match topology {
        T::PointList | T::PatchList => [1, 0],
        T::LineList => [2, 0],
        T::LineStrip => [1, 1],
        T::TriangleList => [3, 0],
        T::TriangleStrip => [1, 2],
        T::LineListAdjacency => [4, 0],
        T::LineStripAdjacency => [1, 3],
        T::TriangleListAdjacency => [6, 0],
        T::TriangleStripAdjacency => [2, 4],
        T::LineLoop | T::TriangleFan => return [0, whole],
    };
    [first * each, count * each + more]
}

/// The vertices that `count` elements from `first` on name.
pub(super) fn vertex_range(
    (executor, known): (&Executor, &mut KnownExtremes),
    draw: &Draw<'_>,
    first: u32,
    count: u32,
) -> IndexRange {
    let Some((buffer, format)) = draw.indices else {
        return IndexRange::dense(first, count);
    };
    if count == 0 {
        return IndexRange::dense(0, 0);
    }
    let index = |element: u32| {
        let at = first as usize + element as usize;
        vertex_index(buffer, format, at, draw.base_vertex)
    };
    let base = draw.base_vertex;
    let of_buffer = known.in_buffer(executor, buffer, format, [first, count]);
    let of_buffer = of_buffer.and_then(|[least, greatest]| {
        // A sum that wraps around changes the order.
        Some([
            least.checked_add_signed(base)?,
            greatest.checked_add_signed(base)?,
        ])
    });
    let extremes = of_buffer.unwrap_or_else(|| {
        let wider =
            |[least, greatest]: [u32; 2], index: u32| [least.min(index), greatest.max(index)];
        (0..count).map(index).fold([u32::MAX, 0], wider)
    });
    IndexRange::if_dense(extremes, u64::from(count))
        .unwrap_or_else(|| IndexRange::listed((0..count).map(index).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sparse_range_becomes_a_list() {
        let mut corners = [[10, 11, 12], [12, 11, 13]];
        assert_eq!(list_vertices(&mut corners), IndexRange::dense(10, 4));
        assert_eq!(corners, [[0, 1, 2], [2, 1, 3]]);
        let mut corners = [[7, u32::MAX, 0]];
        assert_eq!(
            list_vertices(&mut corners),
            IndexRange::listed(vec![7, u32::MAX, 0])
        );
        assert_eq!(corners, [[0, 1, 2]]);
    }
}
