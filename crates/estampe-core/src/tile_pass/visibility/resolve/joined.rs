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
//! Only where a pixel has one sample: the samples of an edge that are left over would take another
//! packet at each place, and quads of several places share theirs.

use super::Resolver;
use crate::fragment::queue::CAPACITY;
use crate::raster::Covered;
use estampe_simd::Lanes;

/// The slots of the queue that hold fragments of the packet at hand, and their lanes.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Slots {
    slots: [(u8, u16); CAPACITY],
    len: usize,
}

impl<const N: usize> Resolver<'_, '_, '_, N> {
    /// Queues a triangle's part of a packet in slots of the same packet that have its lanes free,
    /// then in a new one.
    #[inline(always)]
    pub(super) fn join<S: Lanes>(
        &mut self,
        s: S,
        id: u32,
        covered: &Covered<N>,
        slots: &mut Slots,
    ) {
        let visible = self.visible(s, id);
        let mut left = *covered;
        for at in 0..slots.len {
            let (slot, used) = slots.slots[at];
            let mut part = left;
            part.masks = part.masks.map(|mask| mask & !used);
            let lanes = part.any();
            if lanes == 0 {
                continue;
            }
            slots.slots[at].1 |= lanes;
            self.push(s, visible, &part, Some(usize::from(slot)));
            self.scratch.statistics.packets_joined += 1;
            left.masks = left.masks.map(|mask| mask & used);
            if left.any() == 0 {
                return;
            }
        }
        if self.scratch.queue.is_full() {
            self.flush();
            slots.len = 0;
        }
        self.push(s, visible, &left, None);
        #[expect(clippy::cast_possible_truncation, reason = "below CAPACITY")]
        let slot = self.scratch.queue.last_slot() as u8;
        slots.slots[slots.len % CAPACITY] = (slot, left.any());
        slots.len += 1;
    }
}
