//! Triangles of one colour that share sides and make a [convex polygon](ConvexPolygon), which is
//! covered in place of them, and [gathered](super::solid).
//!
//! Their varyings are compared at the vertices, so that no planes are made.

use super::solid::SolidInputs;
use super::{InOrder, InOrderScratch};
use crate::bounds::primitives::PackedTriangle;
use crate::plan::tile_plan::TilePlan;
use crate::raster::convex::ConvexPolygon;
use estampe_simd::{Lanes, dispatch};
use estampe_types::state::ConservativeMode;

/// The triangles that wait to be covered.
#[derive(Debug, Default)]
pub(super) struct Fan<const N: usize> {
    polygon: ConvexPolygon<N>,
    triangles: u64,
    shown: SolidInputs,
}

/// Returns true if the triangles of a draw that gathers those of one colour may be covered
/// together: nothing is asked of their samples but whether they are covered.
pub(super) fn joins_triangles(plan: &TilePlan<'_>) -> bool {
    let key = plan.pipeline.key();
    plan.all_smooth
        && plan.tests.is_empty()
        && plan.query.is_none()
        && plan.cut_samples.is_none()
        && key.sample_mask.is_none()
        && plan.pipeline.descriptor().primitive.conservative == ConservativeMode::Disabled
}

impl<const N: usize> InOrder<'_, '_, '_, '_, N> {
    /// Takes a triangle of one colour, to be covered with those before or after it; false if its
    /// varyings are not the same everywhere.
    #[inline(always)]
    pub(super) fn join_fan(&mut self, triangle: &PackedTriangle) -> bool {
        if !self.joins_triangles || !triangle.has_equal_w() {
            return false;
        }
        let [first, second, third] = triangle.vertex.map(
            #[inline(always)]
            |vertex| self.source.of(vertex),
        );
        if !are_constant([first, second, third]) {
            return false;
        }
        let (corners, front) = (triangle.clockwise_corners(), triangle.is_front());
        let fan = &mut self.scratch.in_order.fan;
        if fan.shown.are(first, front) && fan.polygon.add(corners) {
            fan.triangles += 1;
            return true;
        }
        self.end_fan();
        let fan = &mut self.scratch.in_order.fan;
        fan.polygon.begin(corners);
        fan.triangles = 1;
        fan.shown.set(first, front);
        true
    }

    /// Gathers the triangles that wait, before something else is covered.
    #[inline(always)]
    pub(super) fn end_fan(&mut self) {
        if !self.scratch.in_order.fan.polygon.is_empty() {
            self.gather_fan();
        }
    }

    #[inline(never)]
    fn gather_fan(&mut self) {
        if const { N <= 4 } {
            dispatch!(@wide self.work.level, s => self.gather_fan_lanes(s),
                scalar => unreachable!("the scalar level draws triangles one by one"));
        }
    }

    #[inline(always)]
    fn gather_fan_lanes<S: Lanes>(&mut self, s: S) {
        let (shape, rect) = (self.work.shape, &self.work.rect);
        let InOrderScratch {
            list, clip, fan, ..
        } = &mut self.scratch.in_order;
        list.clear();
        let is_cut = fan.polygon.cover(s, shape, rect, list);
        if is_cut && !self.work.is_whole {
            list.clip_to(clip.of(rect));
        }
        fan.polygon.clear();
        let is_visible = !list.items().is_empty();
        let (shown, triangles) = (std::mem::take(&mut fan.shown), fan.triangles);
        if triangles > 1 {
            self.scratch.statistics.triangles_gathered += triangles - 1;
            self.scratch.statistics.triangles_in_fans += triangles;
        }
        if is_visible {
            self.gather(&shown.varyings, shown.front);
        }
        self.scratch.in_order.fan.shown = shown;
    }
}

/// Returns true if the planes through three vertices' varyings neither rise nor fall, and are not
/// at −0: interpolation gives the first vertex's bits everywhere.
#[inline(always)]
fn are_constant([first, second, third]: [&[f32]; 3]) -> bool {
    let others = second.iter().zip(third);
    first.iter().zip(others).fold(true, |all, (a, (b, c))| {
        // Not of infinities and NaN, whose differences are NaN.
        all & (b - a == 0.0) & (c - a == 0.0) & (a.to_bits() != (-0.0_f32).to_bits())
    })
}
