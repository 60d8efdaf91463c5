//! Triangles that wait until sixteen of them fill a packet.

use estampe_simd::{LANES, Lane, Lanes, Packing, SimdBase, f32x16, u32x16};

/// Triangles that wait for their packet to be full: at most fifteen, and sixteen that join them.
#[derive(Debug)]
#[repr(C, align(64))]
pub(super) struct Waiting {
    /// The vertices in sorted order, as [`VertexRef`](crate::bounds::primitives::VertexRef)s.
    pub(super) vertex: [[u32; 2 * LANES]; 3],
    /// The number of the sub-draw's first vertex in the batch; 0 of triangles made by clipping.
    pub(super) first_vertex: [u32; 2 * LANES],
    /// The provoking vertex, which is never one made by clipping; with [`FRONT`] if the triangle
    /// faces the viewer.
    pub(super) provoking: [u32; 2 * LANES],
    /// Doubled area in sorted order, rounded.
    pub(super) doubled_area: [f32; 2 * LANES],
    pub(super) len: usize,
}

/// The bit of a provoking vertex that tells triangles that face the viewer.
pub(super) const FRONT: u32 = 1 << 31;

impl Default for Waiting {
    fn default() -> Self {
        Self {
            vertex: [[0; 2 * LANES]; 3],
            first_vertex: [0; 2 * LANES],
            provoking: [0; 2 * LANES],
            doubled_area: [1.0; 2 * LANES],
            len: 0,
        }
    }
}

impl Waiting {
    /// Adds the lanes in `kept`, in order.
    #[inline(always)]
    pub(super) fn append<S: Lanes>(
        &mut self,
        s: S,
        ([a, b, c], first_vertex): ([u32x16<S>; 3], u32x16<S>),
        provoking: u32x16<S>,
        area: f32x16<S>,
        kept: u16,
    ) {
        let at = self.len;
        self.len += kept.count_ones() as usize;
        let [to_a, to_b, to_c] = &mut self.vertex;
        if <S::u32s as SimdBase<S>>::LEN >= LANES / 2 {
            // Sixteen values are written; what is beyond the kept lanes is garbage until
            // overwritten.
            let packing = Packing::new(s, kept);
            let lists = [
                to_a,
                to_b,
                to_c,
                &mut self.first_vertex,
                &mut self.provoking,
            ];
            for (list, values) in lists.into_iter().zip([a, b, c, first_vertex, provoking]) {
                let Some(to) = list.get_mut(at..).and_then(<[_]>::first_chunk_mut) else {
                    unreachable!("there is room for sixteen more");
                };
                packing.store(s, values, to);
            }
            if let Some(to) = self.doubled_area[at..].first_chunk_mut() {
                packing.store_f32(s, area, to);
            }
            return;
        }
        let (a, b, c) = (a.to_array(), b.to_array(), c.to_array());
        let (provoking, area) = (provoking.to_array(), area.to_array());
        let first_vertex = first_vertex.to_array();
        for (to, lane) in (at..).zip(Lane::all_of(kept)) {
            to_a[to] = lane.of(&a);
            to_b[to] = lane.of(&b);
            to_c[to] = lane.of(&c);
            self.first_vertex[to] = lane.of(&first_vertex);
            self.provoking[to] = lane.of(&provoking);
            self.doubled_area[to] = lane.of(&area);
        }
    }

    /// Moves what waits beyond the first packet to its place.
    pub(super) fn drop_first(&mut self, len: usize) {
        self.len -= len;
        if self.len == 0 {
            return;
        }
        for values in &mut self.vertex {
            values.copy_within(LANES.., 0);
        }
        self.first_vertex.copy_within(LANES.., 0);
        self.provoking.copy_within(LANES.., 0);
        self.doubled_area.copy_within(LANES.., 0);
    }
}

/// The lanes of the packet that is next.
#[inline(always)]
pub(super) fn first_half<T>(values: &[T; 2 * LANES]) -> &[T; LANES] {
    values
        .first_chunk()
        .unwrap_or_else(|| unreachable!("32 lanes have a first half"))
}
