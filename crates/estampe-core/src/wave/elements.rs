//! The elements of a draw: how many, where they may be cut, and which vertices they name.

use super::{MAX_WHOLE_ELEMENTS, SPARSE_FACTOR};
use crate::commands::Draw;
use crate::geometry::assembly::vertex_index;
use crate::geometry::restart::RestartSource;
use crate::schedule::Executor;
use estampe_types::state::PrimitiveTopology;

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

/// Numbers the vertices of listed primitives: as a range that holds all of them, from its first one on, or one by
/// one where that range is sparse.
pub(super) fn list_vertices(corners: &mut [[u32; 3]]) -> (u32, u32, Option<Vec<u32>>) {
    let all = corners.as_flattened_mut();
    let (Some(&least), Some(&greatest)) = (all.iter().min(), all.iter().max()) else {
        return (0, 0, None);
    };
    let count = all.len() as u64;
    let span = u64::from(greatest - least) + 1;
    if span <= count * SPARSE_FACTOR {
        all.iter_mut().for_each(|vertex| *vertex -= least);
        return (least, u32::try_from(span).unwrap_or(u32::MAX), None);
    }
    let sparse: Vec<u32> = all.to_vec();
    for (number, vertex) in (0..).zip(all) {
        *vertex = number;
    }
    let count = u32::try_from(sparse.len()).unwrap_or(u32::MAX);
    (0, count, Some(sparse))
}

/// How many elements a draw has. Fans, loops and stippled strips cannot be cut into items, so that they end at
/// [`MAX_WHOLE_ELEMENTS`].
pub(super) fn element_count(draw: &Draw<'_>) -> u32 {
    let count = draw.elements.end.saturating_sub(draw.elements.start);
    if is_splittable(draw) {
        count
    } else {
        count.min(MAX_WHOLE_ELEMENTS)
    }
}

/// Whether a run of a draw's primitives is a run of elements of the same topology, drawn like any other.
pub(super) fn is_splittable(draw: &Draw<'_>) -> bool {
    let topology = draw.pipeline.descriptor().primitive.topology;
    !matches!(
        topology,
        PrimitiveTopology::TriangleFan | PrimitiveTopology::LineLoop
    ) && !is_stippled_strip(draw)
}

/// Whether each line of a topology goes on where the one before ended.
pub(crate) fn is_line_strip(topology: PrimitiveTopology) -> bool {
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

/// The elements (first, count) of `count` primitives from `first` on. `ITEM_PRIMITIVES` is even, so a
/// strip's parts begin on triangles that are not turned.
pub(super) fn part_of(topology: PrimitiveTopology, first: u32, count: u32, whole: u32) -> [u32; 2] {
    use PrimitiveTopology as T;
    let [each, more] = match topology {
        T::PointList => [1, 0],
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

/// The range of vertices that elements name (first, count), or a list of them if the range is sparse.
pub(super) fn vertex_range(
    executor: &Executor,
    draw: &Draw<'_>,
    first: u32,
    count: u32,
) -> (u32, u32, Option<Vec<u32>>) {
    let Some((buffer, format)) = draw.indices else {
        return (first, count, None);
    };
    let index = |element: u32| {
        let at = first as usize + element as usize;
        vertex_index(buffer, format, at, draw.base_vertex)
    };
    let (from, to) = (first as usize, first as usize + count as usize);
    let words = buffer.words().get(from..to);
    let words = words.filter(|_| format == estampe_types::IndexFormat::Uint32);
    // The common case in a form that becomes SIMD code.
    let of_words = words.and_then(|words| {
        let (least, greatest) = extremes(executor, words)?;
        let base = draw.base_vertex;
        Some((
            least.checked_add_signed(base)?,
            greatest.checked_add_signed(base)?,
        ))
    });
    let (least, greatest) = of_words.unwrap_or_else(|| {
        let wider =
            |(least, greatest): (u32, u32), index: u32| (least.min(index), greatest.max(index));
        (0..count).map(index).fold((u32::MAX, 0), wider)
    });
    if count == 0 {
        return (0, 0, None);
    }
    let span = u64::from(greatest - least) + 1;
    if span <= u64::from(count) * SPARSE_FACTOR {
        return (least, u32::try_from(span).unwrap_or(u32::MAX), None);
    }
    (0, count, Some((0..count).map(index).collect()))
}

/// Indices that one worker looks through at a time.
const INDEX_CHUNK: usize = 1 << 16;

/// The least and the greatest of some indices. A million triangles have 12 MB of them, which one thread
/// alone reads no faster than memory gives them to it.
fn extremes(executor: &Executor, words: &[u32]) -> Option<(u32, u32)> {
    let of_part = |words: &[u32]| {
        let (mut least, mut greatest) = (u32::MAX, 0);
        for &word in words {
            least = least.min(word);
            greatest = greatest.max(word);
        }
        (least, greatest)
    };
    if words.is_empty() {
        return None;
    }
    if words.len() <= INDEX_CHUNK {
        return Some(of_part(words));
    }
    let mut parts: [(&[u32], (u32, u32)); 64] = [(&[], (u32::MAX, 0)); 64];
    let each = words.len().div_ceil(parts.len());
    let mut used = 0;
    for (part, words) in parts.iter_mut().zip(words.chunks(each)) {
        part.0 = words;
        used += 1;
    }
    executor.for_each_alone(&mut parts[..used], |(words, found)| *found = of_part(words));
    let wider = |a: (u32, u32), b: (u32, u32)| (a.0.min(b.0), a.1.max(b.1));
    parts.iter().map(|part| part.1).reduce(wider)
}
