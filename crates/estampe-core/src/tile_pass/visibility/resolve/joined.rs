//! Packets whose lanes are shaded for different triangles, of shaders that need no quads.
//!
//! A packet of 4×4 pixels is shaded once for all triangles that it shows: each is interpolated in
//! all lanes, and kept in its own. Nothing is shaded that is not shown.
//!
//! ```text
//!    a a b b
//!    a a b b   one packet; by quads, two of each triangle, with 8 of 24 lanes for helpers
//!    a c c b
//!    c c c c
//! ```
//!
//! Only where a pixel has one sample: of several, those of an edge that are left over would take
//! another packet at each place. Four samples go [by pixels](super::pixels).

use super::Resolver;
use crate::raster::Covered;
use estampe_simd::Lanes;

impl<const N: usize> Resolver<'_, '_, '_, N> {
    /// Queues a triangle's part of a packet: in the slot of the packet's other triangles, if there
    /// is one, else in a new one. Their lanes are disjoint, as a pixel has one sample.
    #[inline(always)]
    pub(super) fn join<S: Lanes>(
        &mut self,
        s: S,
        id: u32,
        covered: &Covered<N>,
        slot: &mut Option<usize>,
    ) {
        let visible = self.visible(s, id);
        if slot.is_some() {
            self.push(s, visible, covered, *slot);
            self.scratch.statistics.packets_joined += 1;
            return;
        }
        if self.scratch.queue.is_full() {
            self.flush();
        }
        self.push(s, visible, covered, None);
        *slot = Some(self.scratch.queue.last_slot());
    }
}
