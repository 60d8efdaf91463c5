//! Fragments of small triangles, shaded at once: lane `i` of a packet is a fragment of triangle
//! `i`.
//!
//! For shaders without derivatives. Fragments are shaded as they become visible, before the run is
//! resolved; their texels wait beside the attachment, under ids of their own.

use super::ONLY_WIDE;
use super::buffer::SHADED;
use super::rasterize::Rasterizer;
use super::small::Numbering;
use crate::bounds::primitives::TrianglePacket;
use crate::fragment::cross_triangle::{CrossFragments, CrossPlanes};
use crate::per_sample::color_writer::ColorWriter;
use crate::raster::small::PIXELS;
use crate::tile_pass::{TileScratch, TileWork};
use estampe_simd::{LANES, Lanes, SimdBase, dispatch, f32x16};

/// Memory of fragments that are shaded before the run is resolved.
#[derive(Debug, Default)]
pub(super) struct CrossTriangleScratch {
    planes: CrossPlanes,
    fragments: Box<CrossFragments>,
    /// The number of packets shaded or queued in the run.
    packets: u32,
    /// Texels of shaded packets: by packet, word, lane.
    texels: Vec<[u32; LANES]>,
}

/// Ids by the fragments' places in packets.
pub(super) struct ByFragment<'a> {
    fragments: &'a mut CrossFragments,
    /// The id of the first packet's first lane.
    first: u32,
}

impl Numbering for ByFragment<'_> {
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "a lane is below 16")]
    fn first_of(&mut self, lane: usize) -> u32 {
        self.first + lane as u32
    }

    #[inline(always)]
    fn next(&mut self, lane: usize, pixel: usize, id: u32) -> u32 {
        let packet = ((id - self.first) / 16) as usize;
        self.fragments.push(lane, packet, pixel);
        id + 16
    }
}

impl CrossTriangleScratch {
    /// Begins the fragments of a packet of triangles.
    pub(super) fn begin(&mut self) -> ByFragment<'_> {
        self.fragments.count = 0;
        ByFragment {
            first: SHADED | (self.packets * 16),
            fragments: &mut self.fragments,
        }
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
    pub(super) fn shade_cross_triangle(&mut self, packet: &TrianglePacket) {
        // Small triangles are drawn with one sample.
        if const { N == 1 } && self.scratch.visibility.cross.fragments.count != 0 {
            dispatch!(@wide self.work.level, s => self.queue_cross_triangle(s, packet),
                scalar => unreachable!("{ONLY_WIDE}"));
        }
    }

    #[inline(always)]
    fn queue_cross_triangle<S: Lanes>(&mut self, s: S, packet: &TrianglePacket) {
        let source = self.work.varyings();
        let cross = &mut self.scratch.visibility.cross;
        // Every lane that has fragments has one in the first packet.
        cross
            .planes
            .set(s, packet, cross.fragments.lanes[0], &source);
        let count = cross.fragments.count;
        cross.packets += u32::try_from(count).unwrap_or_default();
        for number in 0..count {
            if self.scratch.queue.is_full() {
                self.flush_cross_triangle();
            }
            let TileScratch {
                queue, visibility, ..
            } = &mut *self.scratch;
            let (small, cross) = (&visibility.small, &mut visibility.cross);
            // Exact, as in the coverage.
            let [x, y] = cross.fragments.steps(s, number);
            let x = f32x16::load_array_ref(s, &small.from_x) + x;
            let y = f32x16::load_array_ref(s, &small.from_y) + y;
            let lanes = cross.fragments.lanes[number % PIXELS];
            let out = queue.push_across_triangles(lanes, packet.front);
            cross.planes.varyings(s, packet, source.modes, [x, y], out);
        }
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
        statistics.fragments_shaded += queue.shade(level, plan.pipeline, plan.bindings);
        let texels = &mut visibility.cross.texels;
        let target = &plan.pipeline.color_targets()[0];
        let writer = ColorWriter {
            target,
            index: target.output,
            constant: plan.blend_constant,
        };
        writer.encode_batch(level, &queue.batch(), texels);
        queue.clear();
    }
}
