//! Fragments of triangles whose packets were noted when they were covered: listed triangle by
//! triangle, to fill packets with those of other triangles and places. So are packets that they
//! cover whole: to make the planes of a triangle by itself is worth it where it covers many.

use super::pixels::NotedTriangles;
use super::{Resolver, ShadingGroup};
use crate::raster::Covered;
use crate::tile_pass::fragments::Fragments;
use estampe_simd::{LANES, Lanes};

impl<const N: usize> Resolver<'_, '_, '_, N> {
    /// Queues the pixels that show a group's triangles, of those whose packets were noted.
    #[inline(always)]
    pub(super) fn touched<S: Lanes>(&mut self, s: S, group: &ShadingGroup) {
        let touched = std::mem::take(&mut self.scratch.visibility.buffer.touched);
        let mut number = touched.from(group.ids.start);
        while let Some((id, _)) = touched.before(number, group.ids.end) {
            let first = self.scratch.visibility.buffer.triangles[id as usize];
            let noted = self.noted_triangles(id);
            // The triangles of the same packet, all that are shown.
            let mut lanes = 0;
            while let Some((id, packets)) = touched.before(number, group.ids.end) {
                let triangle = self.scratch.visibility.buffer.triangles[id as usize];
                if !triangle.shares_packet_with(&first) {
                    break;
                }
                for &packet in packets {
                    let is_shown = self.list_shown(s, (id, triangle.lane), packet);
                    lanes |= u16::from(is_shown) << triangle.lane;
                    let fragments = &self.scratch.visibility.resolve.fragments;
                    if fragments.len() > Fragments::MOST - LANES {
                        self.queue_listed(s, &noted, std::mem::take(&mut lanes));
                    }
                }
                number += 1;
            }
            self.queue_listed(s, &noted, lanes);
        }
        self.scratch.visibility.buffer.touched = touched;
    }

    /// Lists the pixels of a packet that show a triangle, and takes them out. Returns true if there
    /// are some.
    #[inline(always)]
    fn list_shown<S: Lanes>(&mut self, s: S, (id, lane): (u32, u8), packet: u8) -> bool {
        let number = usize::from(packet);
        let buffer = &self.scratch.visibility.buffer;
        let unresolved = buffer.unresolved[number];
        let mut masks = [0; N];
        for (sample, mask) in masks.iter_mut().enumerate().take(self.samples.count()) {
            *mask = self.lanes_of(s, self.line_of(number, sample), id) & unresolved[sample];
        }
        let covered = Covered {
            packet: u16::from(packet),
            masks,
        };
        // The ids of a block that shows one triangle are not those that are stored.
        if covered.any() == 0 || buffer.single.of_packet(number).is_some() {
            return false;
        }
        let visibility = &mut self.scratch.visibility;
        for (unresolved, mask) in visibility.buffer.unresolved[number].iter_mut().zip(masks) {
            *unresolved &= !mask;
        }
        visibility.resolve.fragments.add_packet(s, lane, &covered);
        true
    }

    /// Queues the listed pixels, which are of some lanes' triangles.
    #[inline(always)]
    fn queue_listed<S: Lanes>(&mut self, s: S, noted: &NotedTriangles<'_>, lanes: u16) {
        if lanes != 0 {
            let listed = self.scratch.visibility.resolve.fragments.len();
            self.scratch.statistics.fragments_by_triangle += listed as u64;
            let planes = &mut self.scratch.visibility.resolve.cross;
            planes.set(s, noted.triangles, lanes, &noted.source);
            self.fill_packets(s, noted);
        }
    }
}
