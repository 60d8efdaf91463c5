//! Primitive assembly (A1): which elements make primitive `p`.
//!
//! *In* a topology and a count of elements · *Out* element numbers, of triangles the provoking one
//! first · *Spec* WebGPU §Primitive assembly; Vulkan §Primitive Topologies for fans and adjacency.

use crate::pipeline::primitive_kind::PrimitiveKind;
use crate::pipeline::primitive_kind::kind_of;
use estampe_simd::LANES;
use estampe_types::state::{PrimitiveTopology, ProvokingVertex};
use estampe_types::{BufferData, IndexFormat};

/// Returns the number of primitives that `elements` elements make. An incomplete last one is
/// dropped.
pub(crate) fn primitive_count(topology: PrimitiveTopology, elements: u32) -> u32 {
    use PrimitiveTopology as T;
    match topology {
        T::PointList => elements,
        T::LineList => elements / 2,
        T::LineStrip => elements.saturating_sub(1),
        T::LineLoop => {
            if elements < 2 {
                0
            } else {
                elements
            }
        }
        T::TriangleList => elements / 3,
        T::TriangleStrip | T::TriangleFan => elements.saturating_sub(2),
        T::LineListAdjacency => elements / 4,
        T::LineStripAdjacency => elements.saturating_sub(3),
        T::TriangleListAdjacency => elements / 6,
        T::TriangleStripAdjacency => (elements / 2).saturating_sub(2),
        // Patches become primitives before assembly.
        T::PatchList => 0,
    }
}

/// The elements of primitive `p`. The first of a triangle is the provoking one; the third of a line
/// repeats the provoking one, and so do unused places of a point.
#[inline(always)]
pub(crate) fn corners_of(
    topology: PrimitiveTopology,
    provoking: ProvokingVertex,
    p: u32,
    elements: u32,
) -> [u32; 3] {
    let corners = elements_of(topology, p, elements);
    match provoking {
        ProvokingVertex::First => corners,
        ProvokingVertex::Last => by_last(topology, p, corners),
    }
}

/// Rotates a triangle's corners so that the last provoking vertex comes first (in a fan, vertex p +
/// 2), and repeats a line's last vertex in the third place. (Vulkan §Flat Shading, the table of
/// provoking vertices.)
#[inline(never)]
fn by_last(topology: PrimitiveTopology, p: u32, [a, b, c]: [u32; 3]) -> [u32; 3] {
    use PrimitiveTopology as T;
    match (kind_of(topology), topology) {
        (PrimitiveKind::Points, _) => [a, b, c],
        (PrimitiveKind::Lines, _) => [a, b, b],
        (_, T::TriangleFan) => [b, c, a],
        // Turned ones have their last vertex in the middle.
        (_, T::TriangleStrip | T::TriangleStripAdjacency) if p % 2 == 1 => [b, c, a],
        _ => [c, a, b],
    }
}

/// The elements of primitive `p` where the first vertex provokes.
#[inline(always)]
pub(crate) fn elements_of(topology: PrimitiveTopology, p: u32, elements: u32) -> [u32; 3] {
    use PrimitiveTopology as T;
    match topology {
        T::PointList | T::PatchList => [p; 3],
        T::LineList => [p * 2, p * 2 + 1, p * 2],
        T::LineStrip => [p, p + 1, p],
        T::LineLoop => [p, if p + 1 == elements { 0 } else { p + 1 }, p],
        T::TriangleList => [p * 3, p * 3 + 1, p * 3 + 2],
        // Every other triangle is turned, so that all face the same way.
        T::TriangleStrip => [p, p + 1 + (p & 1), p + 2 - (p & 1)],
        T::TriangleFan => [p + 1, p + 2, 0],
        // Without a geometry shader the neighbours are left out.
        T::LineListAdjacency => [p * 4 + 1, p * 4 + 2, p * 4 + 1],
        T::LineStripAdjacency => [p + 1, p + 2, p + 1],
        T::TriangleListAdjacency => [p * 6, p * 6 + 2, p * 6 + 4],
        T::TriangleStripAdjacency => {
            let first = p * 2;
            [first, first + 2 + 2 * (p & 1), first + 4 - 2 * (p & 1)]
        }
    }
}

/// The state by which elements become vertices of a sub-draw.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ElementSource<'a> {
    pub(crate) topology: PrimitiveTopology,
    pub(crate) provoking: ProvokingVertex,
    /// The sub-draw's vertices of each primitive of an instance, where indices may restart
    /// primitives.
    pub(crate) restarted: Option<&'a [[u32; 3]]>,
    /// Elements of one instance.
    pub(crate) elements: u32,
    /// The index buffer; without one, or where indices are sparse, element `i` is vertex `i`.
    pub(crate) indices: Option<(&'a BufferData, IndexFormat)>,
    /// The first element in the index buffer.
    pub(crate) first_element: u32,
    /// Taken from an index (after the base vertex was added) to give the sub-draw's vertex.
    pub(crate) first_vertex: u32,
    pub(crate) base_vertex: i32,
}

impl ElementSource<'_> {
    /// The sub-draw's vertices of an instance's primitives from `first` on, as many as `out` holds
    /// and at most sixteen; `base` is added to them.
    #[inline(always)]
    pub(crate) fn assemble(&self, first: u32, base: u32, out: &mut [[u32; 3]]) {
        if let Some(restarted) = self.restarted {
            let from = &restarted[first as usize..][..out.len()];
            for (vertices, from) in out.iter_mut().zip(from) {
                *vertices = from.map(|vertex| vertex.wrapping_add(base));
            }
            return;
        }
        let base_of_indices = base
            .wrapping_add_signed(self.base_vertex)
            .wrapping_sub(self.first_vertex);
        if let Some(out) = out.first_chunk_mut::<LANES>()
            && let Some(indices) = self.listed_indices(first)
        {
            for (vertex, index) in out.as_flattened_mut().iter_mut().zip(indices) {
                *vertex = index.wrapping_add(base_of_indices);
            }
            return;
        }
        if let Some(indices) = self.indices_of_lines(first, out.len()) {
            for ([a, b, provoking], [from, to]) in out.iter_mut().zip(indices) {
                *a = from.wrapping_add(base_of_indices);
                *b = to.wrapping_add(base_of_indices);
                *provoking = *a;
            }
            return;
        }
        // Vertices of an array that went through memory would be stored one by one and loaded in
        // pairs, which waits for the stores.
        match self.provoking {
            ProvokingVertex::First => {
                for (p, vertices) in (first..).zip(out) {
                    let [a, b, c] = elements_of(self.topology, p, self.elements);
                    vertices[0] = self.vertex_of(a).wrapping_add(base);
                    vertices[1] = self.vertex_of(b).wrapping_add(base);
                    vertices[2] = self.vertex_of(c).wrapping_add(base);
                }
            }
            ProvokingVertex::Last => {
                for (p, vertices) in (first..).zip(out) {
                    let corners = corners_of(self.topology, self.provoking, p, self.elements);
                    *vertices = corners.map(|corner| self.vertex_of(corner).wrapping_add(base));
                }
            }
        }
    }

    /// The indices of sixteen triangles of a list, if that is what is drawn, its first vertices
    /// provoke, and the index buffer holds all of them.
    #[inline(always)]
    fn listed_indices(&self, first: u32) -> Option<[u32; 3 * LANES]> {
        let (PrimitiveTopology::TriangleList, ProvokingVertex::First, Some((buffer, format))) =
            (self.topology, self.provoking, self.indices)
        else {
            return None;
        };
        let at = self.first_element as usize + first as usize * 3;
        match format {
            IndexFormat::Uint32 => buffer.words().get(at..)?.first_chunk().copied(),
            IndexFormat::Uint16 => {
                let words = buffer.words().get(at / 2..)?;
                let indices = halves(words.first_chunk::<{ 3 * LANES / 2 }>()?);
                if at.is_multiple_of(2) {
                    return Some(indices);
                }
                // One further on: the first index comes off, and another is appended.
                let mut shifted = [words.get(3 * LANES / 2)? & 0xFFFF; 3 * LANES];
                shifted[..3 * LANES - 1].copy_from_slice(&indices[1..]);
                Some(shifted)
            }
            IndexFormat::Uint8 => None,
        }
    }

    /// The indices of so many lines of a list, if that is what is drawn, its first vertices
    /// provoke, and the index buffer holds all of them as words.
    #[inline(always)]
    fn indices_of_lines(&self, first: u32, count: usize) -> Option<&[[u32; 2]]> {
        let (
            PrimitiveTopology::LineList,
            ProvokingVertex::First,
            Some((buffer, IndexFormat::Uint32)),
        ) = (self.topology, self.provoking, self.indices)
        else {
            return None;
        };
        let at = self.first_element as usize + first as usize * 2;
        buffer.words().get(at..)?.as_chunks().0.get(..count)
    }

    #[inline(always)]
    fn vertex_of(&self, element: u32) -> u32 {
        match self.indices {
            None => element,
            Some((buffer, format)) => {
                let at = self.first_element as usize + element as usize;
                vertex_index(buffer, format, at, self.base_vertex).wrapping_sub(self.first_vertex)
            }
        }
    }
}

/// The vertex that an index names. Bytes beyond the buffer's end are zero, also those that an index
/// there lacks: the last of a buffer's words is filled up with zeros.
#[inline(always)]
pub(crate) fn vertex_index(
    buffer: &BufferData,
    format: IndexFormat,
    at: usize,
    base_vertex: i32,
) -> u32 {
    raw_index(buffer, format, at).wrapping_add_signed(base_vertex)
}

/// An element of an index buffer.
#[inline(always)]
pub(crate) fn raw_index(buffer: &BufferData, format: IndexFormat, at: usize) -> u32 {
    let word = |at: usize| buffer.words().get(at).copied().unwrap_or_default();
    match format {
        IndexFormat::Uint32 => word(at),
        IndexFormat::Uint16 => word(at / 2) >> (at % 2 * 16) & 0xFFFF,
        IndexFormat::Uint8 => u32::from(buffer.byte(at)),
    }
}

/// The 16-bit halves of words, the low one of each first.
#[inline(always)]
fn halves(words: &[u32; 3 * LANES / 2]) -> [u32; 3 * LANES] {
    let mut halves = [0; 3 * LANES];
    for (pair, word) in halves.as_chunks_mut::<2>().0.iter_mut().zip(words) {
        *pair = [word & 0xFFFF, word >> 16];
    }
    halves
}

#[cfg(test)]
mod tests {
    use super::*;
    use PrimitiveTopology as T;

    #[test]
    fn sixteen_triangles_are_assembled_like_one() {
        let bytes: Vec<u8> = (0..240u32).map(|at| (at * 37 % 251) as u8).collect();
        let buffer = BufferData::from_bytes(&bytes);
        for format in [IndexFormat::Uint32, IndexFormat::Uint16, IndexFormat::Uint8] {
            for first_element in [0, 1, 6, 9, 71, 72] {
                let source = ElementSource {
                    topology: T::TriangleList,
                    provoking: ProvokingVertex::First,
                    restarted: None,
                    elements: 60,
                    indices: Some((&buffer, format)),
                    first_element,
                    first_vertex: 3,
                    base_vertex: -1,
                };
                for first in [0, 1, 4] {
                    let mut together = [[0; 3]; LANES];
                    source.assemble(first, 5, &mut together);
                    for (p, together) in (first..).zip(together) {
                        let mut alone = [[0; 3]];
                        source.assemble(p, 5, &mut alone);
                        assert_eq!(alone[0], together, "{format:?} {first_element} {p}");
                        let index = raw_index(&buffer, format, (first_element + p * 3) as usize);
                        assert_eq!(alone[0][0], index.wrapping_add(5 - 1 - 3));
                    }
                }
            }
        }
    }

    #[test]
    fn incomplete_primitives_are_dropped() {
        let counts = |topology| [0, 1, 2, 3, 4, 5].map(|n| primitive_count(topology, n));
        assert_eq!(counts(T::LineList), [0, 0, 1, 1, 2, 2]);
        assert_eq!(counts(T::LineStrip), [0, 0, 1, 2, 3, 4]);
        assert_eq!(counts(T::LineLoop), [0, 0, 2, 3, 4, 5]);
        assert_eq!(counts(T::TriangleList), [0, 0, 0, 1, 1, 1]);
        assert_eq!(counts(T::TriangleStrip), [0, 0, 0, 1, 2, 3]);
        assert_eq!(counts(T::TriangleFan), [0, 0, 0, 1, 2, 3]);
    }

    #[test]
    fn strips_and_fans_keep_their_winding() {
        assert_eq!(elements_of(T::TriangleStrip, 0, 9), [0, 1, 2]);
        assert_eq!(elements_of(T::TriangleStrip, 1, 9), [1, 3, 2]);
        assert_eq!(elements_of(T::TriangleStrip, 2, 9), [2, 3, 4]);
        assert_eq!(elements_of(T::TriangleFan, 3, 9), [4, 5, 0]);
        assert_eq!(elements_of(T::LineLoop, 8, 9)[..2], [8, 0]);
    }

    #[test]
    fn the_last_vertex_provokes_without_turning_a_triangle() {
        let last = |topology, p| corners_of(topology, ProvokingVertex::Last, p, 20);
        assert_eq!(last(T::TriangleList, 1), [5, 3, 4]);
        assert_eq!(last(T::TriangleStrip, 2), [4, 2, 3]);
        assert_eq!(last(T::TriangleStrip, 3), [5, 4, 3]);
        assert_eq!(last(T::TriangleFan, 3), [5, 0, 4]);
        assert_eq!(last(T::TriangleListAdjacency, 1), [10, 6, 8]);
        assert_eq!(last(T::TriangleStripAdjacency, 1), [6, 4, 2]);
        assert_eq!(last(T::LineStrip, 3), [3, 4, 4]);
        assert_eq!(last(T::LineLoop, 19), [19, 0, 0]);
        assert_eq!(last(T::LineListAdjacency, 1), [5, 6, 6]);
    }

    #[test]
    fn indices_of_every_width_read_zero_bytes_beyond_the_end() {
        let buffer = BufferData::from_bytes(&[1, 0, 2, 0, 3, 0]);
        let read = |format, at| vertex_index(&buffer, format, at, 0);
        assert_eq!(
            [0, 1, 2, 3].map(|at| read(IndexFormat::Uint16, at)),
            [1, 2, 3, 0]
        );
        assert_eq!(
            [4, 5, 6, usize::MAX].map(|at| read(IndexFormat::Uint8, at)),
            [3, 0, 0, 0]
        );
        assert_eq!(
            [0, 1, 2].map(|at| read(IndexFormat::Uint32, at)),
            [0x0002_0001, 3, 0]
        );
        assert_eq!(vertex_index(&buffer, IndexFormat::Uint16, 0, -2), u32::MAX);
    }
}
