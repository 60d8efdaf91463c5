//! Primitives whose fragments need no quads: pixels fill packets one by one.
//!
//! A packet that the primitive covers whole is queued as it is. The pixels of all others are
//! listed, and fill packets sixteen by sixteen, the last of which stays open for the pixels of
//! primitives that follow. Order is kept: a pixel that the open packet holds, or one of the whole
//! packets behind it, closes it.

use super::{InOrder, InOrderScratch};
use crate::fragment::fill::{lanes_between, masks_of};
use crate::fragment::interpolate::{PixelInterpolant, WindowPixels};
use crate::fragment::queue::{PixelPacket, PrimitivePacket};
use crate::tile_pass::fragments::Fragments;
use estampe_simd::{LANES, Lanes, SimdBase, u32x16};

impl<const N: usize> InOrder<'_, '_, '_, '_, N> {
    /// Queues a primitive's list.
    #[inline(always)]
    pub(super) fn queue_dense<S: Lanes>(
        &mut self,
        s: S,
        interpolant: &impl PixelInterpolant<S>,
        front: bool,
    ) {
        self.scratch.in_order.fragments.clear();
        for at in 0..self.scratch.in_order.list.items().len() {
            let covered = self.scratch.in_order.list.items()[at];
            let any = covered.any();
            if any == u16::MAX && !self.is_shown() {
                let packet = PrimitivePacket {
                    alive: covered,
                    covered: covered.masks,
                    pixel: self.pixel_of(covered.packet),
                    front,
                    sample: None,
                };
                self.queue_packet(s, interpolant, &packet);
                self.scratch.in_order.last_packet.add_whole(covered.packet);
                continue;
            }
            let fragments = &mut self.scratch.in_order.fragments;
            fragments.add_packet(s, 0, &covered);
            if fragments.len() > Fragments::MOST - LANES {
                self.fill_packets(s, interpolant, front);
            }
        }
        if self.scratch.in_order.fragments.len() != 0 {
            self.fill_packets(s, interpolant, front);
        }
    }

    /// Fills packets with the listed fragments, and empties the list.
    #[inline(always)]
    fn fill_packets<S: Lanes>(
        &mut self,
        s: S,
        interpolant: &impl PixelInterpolant<S>,
        front: bool,
    ) {
        let tile = [self.work.shape.x, self.work.shape.y];
        let is_shown = self.is_shown();
        self.scratch.in_order.fragments.end();
        let count = self.scratch.in_order.fragments.len();
        let mut next = 0;
        while next < count {
            let used = self.scratch.queue.open_pixels();
            if used == 0 && self.scratch.queue.is_full() {
                self.flush();
            }
            let InOrderScratch {
                fragments,
                last_packet,
                ..
            } = &mut self.scratch.in_order;
            let [_, places, samples] = fragments.sixteen(next, used);
            let end = LANES.min(used + count - next);
            let wanted = lanes_between(used, end);
            // Which fragment a pixel shows is found before they are shaded.
            let first_again = match (is_shown, used) {
                (true, _) => LANES,
                (false, 0) => last_packet.begin_with(s, (places, wanted), end < LANES),
                (false, _) => last_packet.add(places, wanted),
            };
            let end = end.min(first_again);
            if end <= used {
                self.scratch.queue.close_pixels();
                continue;
            }
            let lanes = lanes_between(used, end);
            let packet = PixelPacket {
                places,
                are_quads: false,
                masks: masks_of(s, samples, lanes),
                front: if front { lanes } else { 0 },
            };
            let pixels = WindowPixels::of_places(s, u32x16::load_array_ref(s, places), tile);
            let queue = &mut self.scratch.queue;
            queue.push_pixels_of(s, interpolant, (&packet, lanes), pixels);
            if first_again < LANES {
                queue.close_pixels();
            }
            if is_shown {
                let (plan, places) = (self.work.plan, *places);
                let shown = (&places, lanes);
                self.scratch.show_pixels(plan, self.job, shown, used == 0);
            }
            next += end - used;
        }
        self.scratch.in_order.fragments.clear();
    }
}
