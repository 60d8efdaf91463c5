//! Quads of packets that show several triangles: they fill packets, four at a time.

use super::ids::ids_of;
use super::pixels::{NotedTriangles, PushedLanes};
use super::{ALL_QUADS, Resolver, ShadingGroup, quads_of};
use crate::fragment::fill::lanes_between;
use crate::fragment::quad::{QUAD, QUADS};
use crate::raster::pixel_list::Pixels;
use crate::raster::small::PIXELS;
use crate::tile_pass::visibility::VisibilityScratch;
use estampe_simd::{LANES, Lanes, SimdBase};
use std::ops::Range;

impl<const N: usize> Resolver<'_, '_, '_, N> {
    /// The triangle of the group that a packet shows in all of its quads, and no other. Otherwise
    /// lists the quads of its triangles, which share packets with those of other places.
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "a tile has 256 packets")]
    pub(super) fn list_quads<S: Lanes>(
        &mut self,
        s: S,
        packet: usize,
        masks: [u16; N],
    ) -> Option<u32> {
        if masks == [0; N] {
            return None;
        }
        let shown = masks[0];
        let line = self.line_of(packet, 0);
        let id = self.first_id(packet, &masks);
        if quads_of(shown) == ALL_QUADS && self.lanes_of(s, line, id) & shown == shown {
            return Some(id);
        }
        let VisibilityScratch {
            buffer, resolve, ..
        } = &mut self.scratch.visibility;
        let ids = &ids_of(self.storage, self.job, &buffer.ids)[line];
        resolve.quads.add_all(s, packet as u32, (ids, shown));
        None
    }

    /// Queues the listed quads of a group, packet by packet of its triangles.
    #[inline(always)]
    pub(super) fn listed_quads<S: Lanes>(&mut self, s: S, group: &ShadingGroup) {
        let visibility = &mut self.scratch.visibility;
        let quads = &mut visibility.resolve.quads;
        quads.sort(group.ids.clone(), &visibility.buffer.triangles);
        let mut ids = group.ids.clone();
        loop {
            let visibility = &self.scratch.visibility;
            let quads = &visibility.resolve.quads;
            let has_quads = |id: u32| quads.end_before(id) != quads.end_before(id + 1);
            let Some((of_packet, lanes)) = self.next_noted(&mut ids, has_quads) else {
                break;
            };
            let listed = quads.end_before(of_packet.start)..quads.end_before(of_packet.end);
            let noted = self.noted_triangles(of_packet.start);
            let planes = &mut self.scratch.visibility.resolve.cross;
            planes.set(s, noted.triangles, lanes, &noted.source);
            self.fill_with_quads(s, &noted, listed);
        }
    }

    /// Fills packets with sorted quads.
    #[inline(always)]
    fn fill_with_quads<S: Lanes>(
        &mut self,
        s: S,
        noted: &NotedTriangles<'_>,
        Range { mut start, end }: Range<usize>,
    ) {
        self.scratch.statistics.quads_across_triangles += (end - start) as u64;
        while start < end {
            let used = self.scratch.queue.open_pixels() / QUAD;
            if used == 0 && self.scratch.queue.is_full() {
                self.flush();
            }
            let until = QUADS.min(used + end - start);
            let quads = &self.scratch.visibility.resolve.quads;
            let four = quads.four(s, start, [used, until]);
            let mut places = [0; LANES];
            four.places.store_array(&mut places);
            let pushed = PushedLanes {
                pixels: Pixels(four.lane << PIXELS.ilog2()),
                places: &places,
                masks: four.masks,
                are_quads: true,
            };
            let lanes = lanes_between(used * QUAD, until * QUAD);
            self.push_lanes(s, noted, lanes, &pushed);
            start += until - used;
        }
    }
}
