//! Packets whose lanes are pixels, or quads, of several triangles, anywhere in the tile.
//!
//! If fragments need no quads, what packets that show several triangles hold of each was noted: its
//! pixels. Of four samples, two triangles may show at one pixel, so a packet of 4×4 pixels has more
//! than sixteen fragments where triangles meet.
//!
//! The triangles of a packet of geometry are taken together: their planes are made in lanes, and
//! their fragments fill packets, of which each lane permutes the planes of its triangle. Triangle
//! by triangle, each had its planes by itself, and each began anew in the middle of a packet.

use super::{NONE, Resolver, ShadingGroup};
use crate::bounds::primitives::TrianglePacket;
use crate::depth_format::clamp_depth;
use crate::fragment::cross_fragments::{Row, bits_of_row};
use crate::fragment::fill::{lanes_between, masks_of};
use crate::fragment::interpolate::VaryingSource;
use crate::fragment::interpolate::WindowPixels;
use crate::fragment::queue::{PixelPacket, replace};
use crate::raster::pixel_list::Pixels;
use crate::tile_pass::fragments::Fragments;
use crate::tile_pass::visibility::VisibilityScratch;
use crate::tile_pass::{TileScratch, varyings_of};
use estampe_simd::{LANES, Lanes, SimdBase, SimdCvtFloat, f32x16, i32x16, u32x16};
use std::ops::Range;

/// A packet of triangles, and what is read of their vertices.
pub(super) struct NotedTriangles<'a> {
    pub(super) triangles: &'a TrianglePacket,
    pub(super) source: VaryingSource<'a>,
}

/// Fragments of some lanes of a packet.
pub(super) struct PushedLanes<'a, S: Lanes, const N: usize> {
    /// Which of the triangles' pixels they are; where they are in the tile.
    pub(super) pixels: Pixels<S>,
    pub(super) places: &'a [u32; LANES],
    /// By sample, those that are covered.
    pub(super) masks: [u16; N],
    /// True if they are quads.
    pub(super) are_quads: bool,
}

impl<'a, const N: usize> Resolver<'a, '_, '_, N> {
    /// Queues the parts that were noted of a group's triangles, packet by packet.
    #[inline(always)]
    pub(super) fn noted_parts<S: Lanes>(&mut self, s: S, group: &ShadingGroup) {
        let mut ids = group.ids.clone();
        loop {
            let parts = &self.scratch.visibility.resolve.parts;
            let Some((of_packet, lanes)) = self.next_noted(&mut ids, |id| parts.begin(id) != NONE)
            else {
                break;
            };
            let noted = self.noted_triangles(of_packet.start);
            let planes = &mut self.scratch.visibility.resolve.cross;
            planes.set(s, noted.triangles, lanes, &noted.source);
            self.list_parts(s, of_packet, &noted);
        }
    }

    /// The packet of a triangle.
    #[inline(always)]
    pub(super) fn noted_triangles(&self, id: u32) -> NotedTriangles<'a> {
        let triangle = self.scratch.visibility.buffer.triangles[id as usize];
        let chunk = &self.pass.chunks[triangle.chunk as usize];
        let plan = &self.pass.plans[triangle.sub_draw as usize];
        NotedTriangles {
            triangles: &self.pass.packets.of(chunk).triangles[triangle.packet as usize],
            source: varyings_of(chunk, plan),
        }
    }

    /// The ids of the next triangles of one packet and sub-draw of which something is noted, and
    /// their lanes; takes them out.
    #[inline(always)]
    pub(super) fn next_noted(
        &self,
        ids: &mut Range<u32>,
        is_noted: impl Fn(u32) -> bool,
    ) -> Option<(Range<u32>, u16)> {
        let triangles = &self.scratch.visibility.buffer.triangles;
        while ids.start < ids.end && !is_noted(ids.start) {
            ids.start += 1;
        }
        let begin = ids.start;
        let of_group = triangles.get(begin as usize..ids.end as usize)?;
        let first = of_group.first()?;
        let mut lanes = 0;
        for triangle in of_group {
            if !triangle.shares_packet_with(first) {
                break;
            }
            lanes |= u16::from(is_noted(ids.start)) << triangle.lane;
            ids.start += 1;
        }
        Some((begin..ids.start, lanes))
    }

    /// Lists the parts of triangles whose planes are set, and queues them.
    #[inline(always)]
    fn list_parts<S: Lanes>(&mut self, s: S, ids: Range<u32>, noted: &NotedTriangles<'_>) {
        for id in ids {
            let VisibilityScratch {
                buffer, resolve, ..
            } = &mut self.scratch.visibility;
            let lane = buffer.triangles[id as usize].lane;
            let mut next = resolve.parts.begin(id);
            while next != NONE {
                let resolve = &mut self.scratch.visibility.resolve;
                let (covered, rest) = resolve.parts.part(next);
                next = rest;
                resolve.fragments.add_packet(s, lane, covered);
                if resolve.fragments.len() > Fragments::MOST - LANES {
                    self.fill_packets(s, noted);
                }
            }
        }
        self.fill_packets(s, noted);
    }

    /// Fills packets with the listed fragments, and empties the list.
    #[inline(always)]
    pub(super) fn fill_packets<S: Lanes>(&mut self, s: S, noted: &NotedTriangles<'_>) {
        let count = self.scratch.visibility.resolve.fragments.len();
        if count == 0 {
            return;
        }
        self.scratch.visibility.resolve.fragments.end();
        self.scratch.statistics.fragments_by_pixels += count as u64;
        let mut next = 0;
        while next < count {
            let used = self.scratch.queue.open_pixels();
            if used == 0 && self.scratch.queue.is_full() {
                self.flush();
            }
            let end = LANES.min(used + count - next);
            let fragments = &self.scratch.visibility.resolve.fragments;
            let [pixels, places, samples] = fragments.sixteen(next, used);
            let (places, lanes) = (*places, lanes_between(used, end));
            let pushed = PushedLanes {
                pixels: Pixels(u32x16::load_array_ref(s, pixels)),
                places: &places,
                // Two triangles at one pixel have different samples, in whatever order.
                masks: masks_of(s, samples, lanes),
                are_quads: false,
            };
            self.push_lanes(s, noted, lanes, &pushed);
            next += end - used;
        }
        self.scratch.visibility.resolve.fragments.clear();
    }

    /// Queues fragments of triangles whose planes are set.
    #[inline(always)]
    pub(super) fn push_lanes<S: Lanes>(
        &mut self,
        s: S,
        noted: &NotedTriangles<'_>,
        lanes: u16,
        pushed: &PushedLanes<'_, S, N>,
    ) {
        let TileScratch {
            queue, visibility, ..
        } = &mut *self.scratch;
        let (triangles, places) = (noted.triangles, pushed.places);
        let row = Row {
            pixels: pushed.pixels,
            lanes,
            is_open: lanes & 1 == 0,
        };
        let packet = PixelPacket {
            places,
            are_quads: pushed.are_quads,
            masks: pushed.masks,
            front: bits_of_row(s, triangles.front, row),
        };
        let inputs = queue.push_pixels(&packet, lanes);
        let pixels = WindowPixels::of_places(s, u32x16::load_array_ref(s, places), self.origin);
        let [x, y] = pixels.coordinates([0.5; 2]);
        let lane = row.pixels.lane();
        // Exact, as all distances from origins of planes.
        let distances = [
            x - origin_of(s, &triangles.x[0], lane),
            y - origin_of(s, &triangles.y[0], lane),
        ];
        let planes = &visibility.resolve.cross;
        planes.varyings(s, row, &noted.source, distances, inputs.varyings);
        if let Some([to_x, to_y, to_z, to_w]) = inputs.position {
            let set = inputs.lanes;
            replace(s, to_x, set, x);
            replace(s, to_y, set, y);
            let depth = triangles.z.of_lanes(s, lane).at(distances);
            replace(s, to_z, set, clamp_depth(s, depth, inputs.depth_range));
            let inverse_w = planes.inverse_w(s, row, triangles, distances);
            replace(s, to_w, set, inverse_w);
        }
    }
}

/// The coordinate, in pixels, of the vertices of the lanes' triangles.
#[inline(always)]
fn origin_of<S: Lanes>(s: S, of: &[i32; LANES], lane: u32x16<S>) -> f32x16<S> {
    let subpixels = f32x16::float_from(i32x16::load_array_ref(s, of));
    s.permute_f32(subpixels * (1.0 / 256.0), lane)
}
