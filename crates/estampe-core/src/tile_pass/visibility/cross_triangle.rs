//! Fragments of small triangles, shaded at once: the lanes of a packet are fragments of any
//! triangles of a run.
//!
//! For shaders without derivatives. Fragments are shaded as they become visible, before the run is
//! resolved; their texels wait beside the attachment, under ids of their own.

use super::buffer::SHADED;
use super::rasterize::Rasterizer;
use super::small::Numbering;
use crate::bounds::primitives::TrianglePacket;
use crate::fragment::cross_fragments::{CrossFragments, bits_of_row};
use crate::fragment::cross_triangle::CrossPlanes;
use crate::fragment::queue::FragmentQueue;
use crate::per_sample::color_writer::ColorWriter;
use crate::plan::tile_plan::TilePlan;
use crate::tile_pass::{TileScratch, TileWork};
use estampe_simd::{LANES, Lanes, Level};

/// Memory of fragments that are shaded before the run is resolved.
#[derive(Debug, Default)]
pub(super) struct CrossTriangleScratch {
    planes: CrossPlanes,
    fragments: Box<CrossFragments>,
    /// The number of packets shaded or queued in the run.
    packets: u32,
    /// The number of fragments in the packet that was queued last, if it is not full.
    open: usize,
    /// Texels of shaded packets: by packet, word, lane.
    texels: Vec<[u32; LANES]>,
}

/// Ids by the fragments' places in packets.
pub(super) struct ByFragment<'a> {
    /// The fragments' pixels.
    pixels: &'a mut [u32; CrossFragments::ROOM],
    /// The next fragment's place among them.
    next: usize,
    /// The id of the first place.
    first: u32,
}

impl Numbering for ByFragment<'_> {
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "at most 1024 + 15")]
    fn id_of(&self, _lane: usize) -> u32 {
        self.first + self.next as u32
    }

    #[inline(always)]
    fn note(&mut self, pixel: u32, is_shown: bool) {
        // Written in any case; the next one takes its place.
        if let Some(place) = self.pixels.get_mut(self.next) {
            *place = pixel;
        }
        self.next += usize::from(is_shown);
    }
}

impl ByFragment<'_> {
    /// The place behind the last fragment.
    #[inline(always)]
    pub(super) fn end(self) -> usize {
        self.next
    }
}

impl CrossTriangleScratch {
    /// Begins the fragments of a packet of triangles.
    #[inline(always)]
    pub(super) fn begin(&mut self) -> ByFragment<'_> {
        let first_packet = self.packets - u32::from(self.open != 0);
        ByFragment {
            pixels: self.fragments.begin(self.open),
            next: self.open,
            first: SHADED | (first_packet * 16),
        }
    }

    /// Ends the fragments of a packet of triangles, which are of those in `lanes`.
    #[inline(always)]
    pub(super) fn end(&mut self, end: usize, lanes: u16) {
        self.fragments.end(end, lanes);
    }

    /// Begins a packet of fragments that are numbered by their lanes.
    #[inline(always)]
    pub(super) fn begin_packet(&mut self) {
        debug_assert_eq!(self.open, 0, "a packet of triangles is filled first");
        self.packets += 1;
    }

    /// The id of the first lane of the packet that was begun last.
    #[inline(always)]
    pub(super) fn first_id_of_last(&self) -> u32 {
        SHADED | (self.packets.wrapping_sub(1) * 16)
    }

    /// Shades the queued packets and keeps their texels. Returns how many fragments that were.
    pub(super) fn shade<const N: usize>(
        &mut self,
        queue: &mut FragmentQueue<N>,
        plan: &TilePlan<'_>,
        level: Level,
    ) -> u64 {
        let fragments = queue.shade(level, plan.pipeline, plan.bindings);
        let target = &plan.pipeline.color_targets()[0];
        let writer = ColorWriter {
            target,
            index: target.output,
            constant: plan.blend_constant,
        };
        writer.encode_batch(level, &queue.batch(), &mut self.texels);
        queue.clear();
        fragments
    }

    /// Returns the approximate number of texels that wait for the resolve.
    pub(super) fn texels(&self) -> usize {
        self.texels.len() * LANES
    }

    /// The texels of shaded fragments: by packet, word, lane.
    pub(super) fn words(&self) -> &[u32] {
        self.texels.as_flattened()
    }

    /// Ends the run.
    pub(super) fn clear(&mut self) {
        self.texels.clear();
        self.packets = 0;
    }
}

impl<const N: usize> Rasterizer<'_, '_, '_, N> {
    /// Queues the fragments of a packet of small triangles.
    #[inline(always)]
    pub(super) fn shade_cross_triangle<S: Lanes>(&mut self, s: S, packet: &TrianglePacket) {
        let cross = &mut self.scratch.visibility.cross;
        let Some(source) = self.varyings else {
            return;
        };
        if cross.fragments.is_empty() {
            return;
        }
        let lanes = cross.fragments.lanes;
        cross.planes.set(s, packet, lanes, &source);
        for number in 0..cross.fragments.rows() {
            let row = self.scratch.visibility.cross.fragments.row(s, number);
            if !row.is_open {
                if self.scratch.queue.is_full() {
                    self.flush_cross_triangle();
                }
                self.scratch.visibility.cross.packets += 1;
            }
            let TileScratch {
                queue, visibility, ..
            } = &mut *self.scratch;
            let (small, cross) = (&visibility.small, &visibility.cross);
            let front = bits_of_row(s, packet.front, row);
            let out = if row.is_open {
                queue.join_across_triangles(row.lanes, front)
            } else {
                queue.push_across_triangles(row.lanes, front)
            };
            // Exact, as in the coverage.
            let distances = small.distances(s, row.pixels, row.order(s));
            cross.planes.varyings(s, row, &source, distances, out);
        }
        let cross = &mut self.scratch.visibility.cross;
        cross.open = cross.fragments.open();
    }

    /// Shades the queued packets and keeps their texels.
    pub(super) fn flush_cross_triangle(&mut self) {
        let TileScratch {
            queue,
            visibility,
            statistics,
            ..
        } = &mut *self.scratch;
        if queue.is_empty() || !self.crosses_triangles {
            return;
        }
        let TileWork { level, plan, .. } = *self.work;
        visibility.cross.open = 0;
        let queued = queue.queued().count() as u64;
        let fragments = visibility.cross.shade(queue, plan, level);
        statistics.fragments_shaded += fragments;
        let [all, packets] = &mut statistics.fragments_across_triangles;
        *all += fragments;
        *packets += queued;
    }
}
