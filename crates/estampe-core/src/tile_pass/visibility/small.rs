//! Small triangles of the visibility pass: covered sixteen at a time, their pixels listed for each
//! sample, and the list tested pixel by pixel.

use super::ONLY_WIDE;
use super::buffer::{TILE_SAMPLES, TILE_SAMPLES_OF_FOUR, most_lines};
use super::rasterize::Rasterizer;
use super::writer::VisibilityWriter;
use crate::bounds::primitives::TrianglePacket;
use crate::raster::pixel_list::{PixelList, lane_of};
use estampe_simd::{LANES, Lane, Lanes, dispatch};
use std::hint::select_unpredictable;

/// The ids of small triangles' samples.
pub(super) trait Numbering {
    /// The id of a pixel if it shows its lane's triangle.
    fn id_of(&self, lane: usize) -> u32;
    /// Notes whether a pixel of the list shows its triangle.
    fn note(&mut self, pixel: u32, is_shown: bool);
}

/// Each lane's triangle has one id.
struct ByTriangle {
    ids: [u32; LANES],
}

impl ByTriangle {
    /// All lanes of an entry, and its first triangle's id.
    #[inline(always)]
    fn new((lanes, first): (u16, u32)) -> Self {
        let mut ids = [first; LANES];
        for (lane, id) in ids.iter_mut().enumerate() {
            *id += (lanes & ((1 << lane) - 1)).count_ones();
        }
        Self { ids }
    }
}

impl Numbering for ByTriangle {
    #[inline(always)]
    fn id_of(&self, lane: usize) -> u32 {
        self.ids[lane % LANES]
    }

    #[inline(always)]
    fn note(&mut self, _pixel: u32, _is_shown: bool) {}
}

impl<const N: usize> Rasterizer<'_, '_, '_, N> {
    /// Small triangles of a packet; `entry` is all of its lanes and their first id.
    pub(super) fn small(&mut self, packet: &TrianglePacket, lanes: u16, entry: (u16, u32)) {
        // Small triangles are found where a pixel has one sample, or four.
        if const { N <= 4 } && lanes != 0 {
            dispatch!(@wide self.work.level, s => self.small_lanes(s, packet, lanes, entry),
                scalar => unreachable!("{ONLY_WIDE}"));
        }
    }

    #[inline(always)]
    fn small_lanes<S: Lanes>(
        &mut self,
        s: S,
        packet: &TrianglePacket,
        lanes: u16,
        entry: (u16, u32),
    ) {
        let plan = self.work.plan;
        let visibility = &mut self.scratch.visibility;
        let (small, list) = (&visibility.small, &mut visibility.pixels);
        let mut single = std::mem::take(&mut visibility.buffer.single);
        let counts = plan.query.is_some().then_some(&mut self.passed);
        let target = (&plan.tests, self.samples, self.work.shape);
        let buffer = &mut visibility.buffer;
        let mut writer = VisibilityWriter::new(target, self.storage, self.job, buffer, counts);
        single.write_out(self.work.level, u16::MAX, &mut writer);
        let mut blocks = 0;
        for sample in 0..self.samples.count() {
            small.list(s, sample, lanes, list);
            small.locate(s, packet, (plan.tests.stored, self.samples, sample), list);
            self.scratch.statistics.small_triangle_pixels += list.len() as u64;
            blocks |= if self.crosses_triangles {
                let mut numbering = visibility.cross.begin();
                let blocks = writer.pixels(s, list, packet.front, &mut numbering);
                let end = numbering.end();
                // Varyings of triangles that are hidden are read in vain: noting which these are,
                // pixel by pixel, takes longer.
                visibility.cross.end(end, lanes);
                blocks
            } else {
                writer.pixels(s, list, packet.front, &mut ByTriangle::new(entry))
            };
        }
        if self.notes_packets && !self.crosses_triangles {
            let (packets, counts) = small.packets(s, lanes);
            let numbering = ByTriangle::new(entry);
            for lane in Lane::all_of(lanes) {
                let of_lane = (lane.of(&packets).to_le_bytes(), lane.of(&counts));
                let id = numbering.id_of(lane.get());
                visibility.buffer.touched.add_small(id, of_lane);
            }
        }
        visibility.buffer.single = single;
        if plan.tests.writes_depth() {
            self.scratch.hiz.invalidate(blocks);
        }
        if self.crosses_triangles {
            self.shade_cross_triangle(s, packet);
        }
    }
}

impl<const N: usize> VisibilityWriter<'_, N> {
    /// Adds one sample of the listed pixels, in order. Gives the blocks that may have been touched,
    /// one bit each.
    #[inline(always)]
    fn pixels<S: Lanes>(
        &mut self,
        s: S,
        list: &PixelList,
        front: u16,
        numbering: &mut impl Numbering,
    ) -> u16 {
        let is_large = self.depth.len() == most_lines(N);
        if !self.tests_less_alone() || self.passed.is_some() || !is_large {
            return self.pixels_of_any_test(list, front, numbering);
        }
        match (const { N == 1 }, self.has_ids()) {
            (true, true) => self.nearer_pixels::<TILE_SAMPLES>(list, numbering),
            (true, false) => self.nearer_depths::<TILE_SAMPLES>(list),
            (false, true) => self.nearer_pixels::<TILE_SAMPLES_OF_FOUR>(list, numbering),
            (false, false) => self.nearer_depths::<TILE_SAMPLES_OF_FOUR>(list),
        }
        list.blocks(s, (256 * N).ilog2())
    }

    /// Adds the listed pixels that are nearer than what is stored. There is no branch on the
    /// result, which nobody can predict. Most pixels share their packet with the one before: bits
    /// of a packet would wait for each other, where each pixel has a byte.
    #[inline(always)]
    fn nearer_pixels<const SAMPLES: usize>(
        &mut self,
        list: &PixelList,
        numbering: &mut impl Numbering,
    ) {
        let depth = self.depth.as_flattened_mut().first_chunk_mut();
        let ids = self.ids.as_flattened_mut().first_chunk_mut();
        let (depth, ids): (Option<&mut [f32; SAMPLES]>, Option<&mut [u32; SAMPLES]>) = (depth, ids);
        let (Some(depth), Some(ids)) = (depth, ids) else {
            debug_assert!(N > 4, "a tile of 64×64 pixels");
            return;
        };
        let shown = self.shown.begin::<SAMPLES>();
        for (pixel, at, new) in list.iter() {
            let at = at % SAMPLES;
            let old = depth[at];
            let passes = new < old;
            depth[at] = if passes { new } else { old };
            let id = numbering.id_of(lane_of(pixel));
            ids[at] = select_unpredictable(passes, id, ids[at]);
            shown[at] |= u8::from(passes);
            numbering.note(pixel, passes);
        }
    }

    /// Stores the depths of the listed pixels that are nearer, of fragments without colours.
    #[inline(always)]
    fn nearer_depths<const SAMPLES: usize>(&mut self, list: &PixelList) {
        let depth = self.depth.as_flattened_mut().first_chunk_mut();
        let depth: Option<&mut [f32; SAMPLES]> = depth;
        let Some(depth) = depth else {
            debug_assert!(N > 4, "a tile of 64×64 pixels");
            return;
        };
        for (_, at, new) in list.iter() {
            let stored = &mut depth[at % SAMPLES];
            *stored = if new < *stored { new } else { *stored };
        }
    }

    /// Adds the listed pixels that pass the draw's tests.
    #[inline(always)]
    fn pixels_of_any_test(
        &mut self,
        list: &PixelList,
        front: u16,
        numbering: &mut impl Numbering,
    ) -> u16 {
        let (depth, ids) = (self.depth.as_flattened_mut(), self.ids.as_flattened_mut());
        let stencil = self.stencil.as_flattened_mut();
        let unresolved = self.unresolved.as_flattened_mut();
        let mut blocks = 0;
        for (pixel, at, new) in list.iter() {
            let lane = lane_of(pixel);
            let stored = (depth.get_mut(at), stencil.get_mut(at));
            if !self.tests.run_one(new, front >> lane & 1 == 1, stored) {
                continue;
            }
            if let Some(count) = &mut self.passed {
                **count += 1;
            }
            blocks |= 1u16 << (at / (256 * N) % 16);
            if let Some(of_pixel) = ids.get_mut(at) {
                *of_pixel = numbering.id_of(lane);
                unresolved[at / LANES] |= 1 << (at % LANES);
                numbering.note(pixel, true);
            }
        }
        blocks
    }
}
