//! Small triangles of the visibility pass: covered sixteen at a time, tested pixel by pixel.

use super::rasterize::Rasterizer;
use super::writer::VisibilityWriter;
use crate::bounds::primitives::TrianglePacket;
use crate::raster::small::{PIXELS, SmallTriangles};
use estampe_simd::LANES;

/// The ids of small triangles' samples.
pub(super) trait Numbering {
    /// The id of a lane's first sample.
    fn first_of(&mut self, lane: usize) -> u32;
    /// Notes that a pixel of the lane's box has the id, and gives the lane's next.
    fn next(&mut self, lane: usize, pixel: usize, id: u32) -> u32;
}

/// Each lane's triangle has one id.
struct ByTriangle {
    /// All lanes of the entry, and its first triangle's id.
    lanes: u16,
    first: u32,
}

impl Numbering for ByTriangle {
    #[inline(always)]
    fn first_of(&mut self, lane: usize) -> u32 {
        self.first + (self.lanes & ((1 << lane) - 1)).count_ones()
    }

    #[inline(always)]
    fn next(&mut self, _lane: usize, _pixel: usize, id: u32) -> u32 {
        id
    }
}

impl<const N: usize> Rasterizer<'_, '_, '_, N> {
    /// Small triangles of a packet; `entry` is all of its lanes and their first id.
    pub(super) fn small(&mut self, packet: &TrianglePacket, lanes: u16, entry: (u16, u32)) {
        // Small triangles are found where a pixel has one sample.
        if const { N != 1 } || lanes == 0 {
            return;
        }
        let (plan, level) = (self.work.plan, self.work.level);
        let visibility = &mut self.scratch.visibility;
        let mut single = std::mem::take(&mut visibility.buffer.single);
        let counts = plan.query.is_some().then_some(&mut self.passed);
        let target = (&plan.tests, self.samples, self.work.shape);
        let buffer = &mut visibility.buffer;
        let mut writer = VisibilityWriter::new(target, self.storage, self.job, buffer, counts);
        single.write_out(level, u16::MAX, &mut writer);
        let small = &visibility.small;
        let (all, first) = entry;
        let blocks = if self.crosses_triangles {
            let mut numbering = visibility.cross.begin();
            writer.small(small, lanes, packet.front, &mut numbering)
        } else {
            let mut numbering = ByTriangle { lanes: all, first };
            writer.small(small, lanes, packet.front, &mut numbering)
        };
        visibility.buffer.single = single;
        if plan.tests.writes_depth() {
            self.scratch.hiz.invalidate(blocks);
        }
        if self.crosses_triangles {
            self.shade_cross_triangle(packet);
        }
    }
}

impl<const N: usize> VisibilityWriter<'_, N> {
    /// Adds small triangles of one packet, pixel by pixel in the order of lanes; one sample a
    /// pixel. Gives the blocks that were touched, one bit each.
    fn small(
        &mut self,
        small: &SmallTriangles,
        lanes: u16,
        front: u16,
        numbering: &mut impl Numbering,
    ) -> u16 {
        if self.tests_less_alone() && self.passed.is_none() {
            self.small_pixels::<true>(small, lanes, front, numbering)
        } else {
            self.small_pixels::<false>(small, lanes, front, numbering)
        }
    }

    #[inline(always)]
    fn small_pixels<const LESS: bool>(
        &mut self,
        small: &SmallTriangles,
        lanes: u16,
        front: u16,
        numbering: &mut impl Numbering,
    ) -> u16 {
        let (depth, ids) = (self.depth.as_flattened_mut(), self.ids.as_flattened_mut());
        let stencil = self.stencil.as_flattened_mut();
        let (mut blocks, mut lanes) = (0, lanes);
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize % LANES;
            lanes &= lanes - 1;
            let mut id = numbering.first_of(lane);
            let mut pixels = small.pixels_of(lane);
            while pixels != 0 {
                let pixel = pixels.trailing_zeros() as usize % PIXELS;
                pixels &= pixels - 1;
                let at = small.place_of(pixel, lane);
                let new = small.depth[pixel][lane];
                if LESS {
                    let stored = &mut depth[at];
                    if new >= *stored {
                        continue;
                    }
                    *stored = new;
                } else {
                    let is_front = front >> lane & 1 == 1;
                    let stored = (depth.get_mut(at), stencil.get_mut(at));
                    if !self.tests.run_one(new, is_front, stored) {
                        continue;
                    }
                    if let Some(count) = &mut self.passed {
                        **count += 1;
                    }
                }
                blocks |= 1u16 << ((at >> 8) & 15);
                if let Some(of_pixel) = ids.get_mut(at) {
                    *of_pixel = id;
                    self.unresolved[at / LANES][0] |= 1 << (at % LANES);
                    id = numbering.next(lane, pixel, id);
                }
            }
        }
        blocks
    }
}
