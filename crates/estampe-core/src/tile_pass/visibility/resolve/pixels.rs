//! Packets whose lanes are pixels of several triangles, anywhere in the tile, of shaders that need
//! no quads.
//!
//! Of several samples, two triangles may show at one pixel, so a packet of 4×4 pixels has more than
//! sixteen fragments where triangles meet. So each triangle's pixels in such packets are listed,
//! and fill packets together with those of the next triangles: no lane is a helper, and none is
//! empty.

use super::{NONE, Resolver};
use crate::fragment::interpolate::WindowPixels;
use crate::fragment::place::Place;
use crate::fragment::queue::PixelPacket;
use crate::tile_pass::TileScratch;
use crate::tile_pass::fragments::{Fragments, lanes_between, masks_of};
use estampe_simd::{LANES, Lanes, SimdBase, u32x16};

impl<const N: usize> Resolver<'_, '_, '_, N> {
    /// Queues the parts that were noted, triangle by triangle.
    #[inline(always)]
    pub(super) fn pixels<S: Lanes>(&mut self, s: S) {
        for at in 0..self.scratch.visibility.resolve.parts.triangles().len() {
            let id = self.scratch.visibility.resolve.parts.triangles()[at];
            let visible = self.visible(s, id);
            let mut next = self.scratch.visibility.resolve.parts.begin(id);
            while next != NONE {
                let resolve = &mut self.scratch.visibility.resolve;
                let (covered, rest) = resolve.parts.part(next);
                next = rest;
                resolve.fragments.add_packet(s, covered);
                let is_full = resolve.fragments.len() > Fragments::MOST - LANES;
                if is_full || next == NONE {
                    self.fill_packets(s, visible);
                }
            }
        }
    }

    /// Fills packets with the listed pixels of a triangle, and empties the list.
    #[inline(always)]
    fn fill_packets<S: Lanes>(&mut self, s: S, visible: usize) {
        self.scratch.visibility.resolve.fragments.end();
        let count = self.scratch.visibility.resolve.fragments.len();
        self.scratch.statistics.fragments_by_pixels += count as u64;
        let mut next = 0;
        while next < count {
            let used = self.scratch.queue.open_pixels();
            if used == 0 && self.scratch.queue.is_full() {
                self.flush();
            }
            let TileScratch {
                queue, visibility, ..
            } = &mut *self.scratch;
            let resolve = &visibility.resolve;
            let [_, places, samples] = resolve.fragments.sixteen(next, used);
            let end = LANES.min(used + count - next);
            let lanes = lanes_between(used, end);
            let (triangle, front) = resolve.interpolant(visible, self.plan);
            // Two triangles at one pixel have different samples, in whatever order.
            let packet = PixelPacket {
                place: Place::of_pixels(places),
                masks: masks_of(s, samples, lanes),
                front: if front { lanes } else { 0 },
            };
            let pixels = WindowPixels::of_places(s, u32x16::load_array_ref(s, places), self.origin);
            queue.push_pixels_of(s, &triangle, (&packet, lanes), pixels);
            next += end - used;
        }
        self.scratch.visibility.resolve.fragments.clear();
    }
}
