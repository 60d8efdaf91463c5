//! Packets whose lanes are pixels, or quads, of several triangles, anywhere in the tile.
//!
//! What packets that show several triangles hold of each was noted: its quads; or, if fragments
//! need no quads, its pixels. Of four samples, two triangles may show at one pixel, so a packet of
//! 4×4 pixels has more than sixteen fragments where triangles meet.
//!
//! The triangles of a packet of geometry are taken together: their planes are made in lanes, and
//! their fragments fill packets, of which each lane permutes the planes of its triangle. Triangle
//! by triangle, each had its planes by itself, and each began anew in the middle of a packet.

use super::{NONE, Resolver, ShadingGroup};
use crate::bounds::primitives::TrianglePacket;
use crate::depth_format::clamp_depth;
use crate::fragment::cross_triangle::{Row, bits_of_row};
use crate::fragment::fill::{lanes_between, masks_of};
use crate::fragment::interpolate::VaryingSource;
use crate::fragment::interpolate::WindowPixels;
use crate::fragment::quad::QUAD;
use crate::fragment::queue::{PixelPacket, replace};
use crate::raster::pixel_list::Pixels;
use crate::tile_pass::fragments::Fragments;
use crate::tile_pass::visibility::VisibilityScratch;
use crate::tile_pass::{TileScratch, varyings_of};
use estampe_simd::{LANES, Lanes, SimdBase, SimdCvtFloat, f32x16, i32x16, u32x16};
use std::ops::Range;

/// A packet of triangles, and what is noted of them.
pub(super) struct NotedTriangles<'a> {
    pub(super) triangles: &'a TrianglePacket,
    pub(super) source: VaryingSource<'a>,
    /// True if quads are noted, not pixels.
    pub(super) are_quads: bool,
}

impl<const N: usize> Resolver<'_, '_, '_, N> {
    /// Queues what was noted of a group's triangles, packet by packet.
    #[inline(always)]
    pub(super) fn noted<S: Lanes>(&mut self, s: S, group: &ShadingGroup, are_quads: bool) {
        let mut ids = group.ids.clone();
        while let Some((range, lanes)) = self.next_noted(&mut ids, are_quads) {
            let first = self.scratch.visibility.buffer.triangles[range.start as usize];
            let chunk = &self.pass.chunks[first.chunk as usize];
            let plan = &self.pass.plans[first.sub_draw as usize];
            let noted = NotedTriangles {
                triangles: &chunk.triangles[first.packet as usize],
                source: varyings_of(chunk, plan),
                are_quads,
            };
            let planes = &mut self.scratch.visibility.resolve.cross;
            planes.set(s, noted.triangles, lanes, &noted.source);
            self.list(s, range, &noted);
        }
    }

    /// The ids of the next triangles of one packet and sub-draw of which something is noted, and
    /// their lanes; takes them out.
    #[inline(always)]
    fn next_noted(&self, ids: &mut Range<u32>, are_quads: bool) -> Option<(Range<u32>, u16)> {
        let VisibilityScratch {
            buffer, resolve, ..
        } = &self.scratch.visibility;
        let last = match are_quads {
            true => resolve.quads.last(),
            false => resolve.parts.last(),
        };
        let last = last.get(..ids.end as usize).unwrap_or_default();
        let is_noted = |id: usize| last.get(id).is_some_and(|last| *last != NONE);
        let mut id = ids.start as usize;
        while id < last.len() && !is_noted(id) {
            id += 1;
        }
        let first = *buffer.triangles.get(..last.len())?.get(id)?;
        let (begin, mut lanes) = (id, 0);
        while let Some(triangle) = buffer.triangles[..last.len()].get(id)
            && triangle.shares_packet_with(&first)
        {
            lanes |= u16::from(is_noted(id)) << triangle.lane;
            id += 1;
        }
        #[expect(clippy::cast_possible_truncation, reason = "ids have 31 bits")]
        let (begin, end) = (begin as u32, id as u32);
        ids.start = end;
        Some((begin..end, lanes))
    }

    /// Lists what is noted of triangles whose planes are set, and queues it.
    #[inline(always)]
    fn list<S: Lanes>(&mut self, s: S, ids: Range<u32>, noted: &NotedTriangles<'_>) {
        for id in ids {
            let VisibilityScratch {
                buffer, resolve, ..
            } = &mut self.scratch.visibility;
            let lane = buffer.triangles[id as usize].lane;
            let mut next = match noted.are_quads {
                true => resolve.quads.begin(id),
                false => resolve.parts.begin(id),
            };
            while next != NONE {
                let resolve = &mut self.scratch.visibility.resolve;
                if noted.are_quads {
                    let (quad, rest) = resolve.quads.quad(next);
                    next = rest;
                    resolve.fragments.add_quad(s, lane, quad);
                } else {
                    let (covered, rest) = resolve.parts.part(next);
                    next = rest;
                    resolve.fragments.add_packet(s, lane, covered);
                }
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
        let statistics = &mut self.scratch.statistics;
        match noted.are_quads {
            true => statistics.quads_across_triangles += (count / QUAD) as u64,
            false => statistics.fragments_by_pixels += count as u64,
        }
        let mut next = 0;
        while next < count {
            let used = self.scratch.queue.open_pixels();
            if used == 0 && self.scratch.queue.is_full() {
                self.flush();
            }
            let end = LANES.min(used + count - next);
            self.push_sixteen(s, noted, next, [used, end]);
            next += end - used;
        }
        self.scratch.visibility.resolve.fragments.clear();
    }

    /// Queues listed fragments from one on, in the lanes of a packet from one on up to another.
    #[inline(always)]
    fn push_sixteen<S: Lanes>(
        &mut self,
        s: S,
        noted: &NotedTriangles<'_>,
        first: usize,
        [used, end]: [usize; 2],
    ) {
        let TileScratch {
            queue, visibility, ..
        } = &mut *self.scratch;
        let resolve = &visibility.resolve;
        let [pixels, places, samples] = resolve.fragments.sixteen(first, used);
        let lanes = lanes_between(used, end);
        let row = Row {
            pixels: Pixels(u32x16::load_array_ref(s, pixels)),
            lanes,
            is_open: used != 0,
        };
        let triangles = noted.triangles;
        // Two triangles at one pixel have different samples, in whatever order.
        let packet = PixelPacket {
            places,
            are_quads: noted.are_quads,
            masks: masks_of(s, samples, lanes, noted.are_quads),
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
        let planes = &resolve.cross;
        planes.varyings(s, row, &noted.source, distances, inputs.varyings);
        if let Some([to_x, to_y, to_z, to_w]) = inputs.position {
            let set = inputs.lanes;
            replace(s, to_x, set, x);
            replace(s, to_y, set, y);
            let depth = triangles.z.at(s, lane, distances);
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
