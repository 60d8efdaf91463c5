//! Triangles that are drawn alone, and rectangles of two of them: coverage, early tests, planes.

use super::{InOrder, InOrderScratch};
use crate::bounds::primitives::Triangle;
use crate::fragment::interpolate::{DepthPlane, TriangleInterpolant, VaryingPlanes, set_planes};
use crate::per_sample::hiz::{BlockClasses, HizQuery};
use crate::raster::conservative::ConservativeTriangle;
use crate::raster::triangle::TileTriangle;
use crate::tile_pass::{HIZ_PACKETS, TileWork};
use estampe_simd::Lanes;
use estampe_types::state::ConservativeMode;

impl<const N: usize> InOrder<'_, '_, '_, '_, N> {
    /// Draws a triangle alone, or the rectangle of which it is half: `is_box`. Its planes are those
    /// of a lane of the batch, or made now.
    #[inline(always)]
    pub(super) fn triangle<S: Lanes>(
        &mut self,
        s: S,
        triangle: &Triangle,
        (is_box, planes_of): (bool, Option<usize>),
    ) {
        let (plan, front) = (self.work.plan, triangle.front);
        let plane = DepthPlane::new(triangle);
        let blends_blocks = self.blends_blocks && triangle.equal_w;
        let coverage = if is_box {
            self.cover_box(triangle, &plane)
        } else {
            self.cover(s, triangle, &plane, blends_blocks)
        };
        let Some(coverage) = coverage else {
            return;
        };
        if self.stores_in_order {
            self.scratch.in_order.list.sort();
        }
        let interpolant = TriangleInterpolant {
            origin: plane.origin,
            z: plane.z,
            iw: triangle.iw,
            equal_w: triangle.equal_w,
            planes: VaryingPlanes::default(),
            modes: self.source.modes,
            gradients: self.source.gradients,
            all_smooth: plan.all_smooth,
        };
        // Moved out for the calls, because the interpolant borrows them.
        let mut planes = std::mem::take(&mut self.planes);
        if let Some(test) = &plan.alpha_test {
            self.set_planes(s, triangle, planes_of, &mut planes);
            let with_planes = TriangleInterpolant {
                planes: VaryingPlanes::new(&planes),
                ..interpolant
            };
            if !self.test_alpha_of_triangle(test, &with_planes) {
                self.planes = planes;
                return;
            }
        }
        let is_visible = self.test_early(s, &interpolant, front);
        if !is_visible && coverage.whole == 0 {
            self.planes = planes;
            return;
        }
        if plan.alpha_test.is_none() {
            self.set_planes(s, triangle, planes_of, &mut planes);
        }
        let interpolant = TriangleInterpolant {
            planes: VaryingPlanes::new(&planes),
            ..interpolant
        };
        if self.gathers {
            if interpolant.is_constant() {
                self.gather(interpolant.planes.origins(), front);
                self.planes = planes;
                return;
            }
            self.end_solid();
        }
        // Layers are of one sample only.
        if const { N == 1 } && coverage.whole != 0 {
            self.add_layer(&interpolant, coverage);
        } else {
            self.queue_triangle(&interpolant, front);
        }
        self.planes = planes;
    }

    /// Sets a triangle's planes: those of a lane of the batch, or new ones.
    #[inline(always)]
    fn set_planes<S: Lanes>(
        &mut self,
        s: S,
        triangle: &Triangle,
        planes_of: Option<usize>,
        planes: &mut [f32],
    ) {
        if let Some(lane) = planes_of {
            let of_batch = &self.scratch.in_order.small.planes;
            of_batch.copy_lane(lane, self.source.modes, planes);
            self.scratch.statistics.planes_in_lanes += 1;
        } else {
            let all_smooth = self.work.plan.all_smooth;
            set_planes(s, planes, triangle, &self.source, all_smooth);
        }
    }

    /// Lists the packets that a triangle covers, less those that hierarchical z rejects. `None` if
    /// it covers nothing.
    #[inline(always)]
    fn cover<S: Lanes>(
        &mut self,
        s: S,
        triangle: &Triangle,
        plane: &DepthPlane,
        blends_blocks: bool,
    ) -> Option<WholeBlocks> {
        let TileWork {
            shape,
            rect,
            is_whole,
            blocks,
            ..
        } = *self.work;
        let list = &mut self.scratch.in_order.list;
        list.clear();
        if self.conservative != ConservativeMode::Disabled {
            let mode = self.conservative;
            ConservativeTriangle::new(triangle, shape, &rect, mode).cover(list);
            return Some(WholeBlocks::default());
        }
        let polygon = TileTriangle::<N>::new(triangle, shape, &rect, self.samples)?;
        let classes = self.classify(plane, polygon.packets())?;
        let blocks = if blends_blocks { blocks } else { 0 };
        let InOrderScratch { list, clip, .. } = &mut self.scratch.in_order;
        let whole = polygon.cover(s, shape, classes.hidden, blocks, list);
        if !is_whole && !polygon.is_inside() {
            list.clip_to(clip.of(&rect));
        }
        Some(WholeBlocks {
            whole,
            certain: classes.certain,
        })
    }

    /// What hierarchical z says of a primitive whose box touches so many packets of the tile;
    /// `None` if it is hidden everywhere.
    #[inline(always)]
    pub(super) fn classify(&mut self, plane: &DepthPlane, packets: i32) -> Option<BlockClasses> {
        if !self.uses_hiz || packets <= HIZ_PACKETS {
            return Some(BlockClasses::of_all(0, 0));
        }
        let look = HizQuery {
            tests: &self.work.plan.tests,
            plane: *plane,
            tile: self.work.shape,
            samples: self.samples,
            passes_in_vain: false,
        };
        let (level, depth) = (self.work.level, &*self.job.depth);
        let classes = self.scratch.hiz.classify(level, &look, false, depth);
        (classes.hidden != u16::MAX).then_some(classes)
    }
}

/// Blocks of 16×16 pixels that a triangle covers whole, one bit each.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct WholeBlocks {
    pub(super) whole: u16,
    /// Blocks in which every sample passes the depth test.
    pub(super) certain: u16,
}
