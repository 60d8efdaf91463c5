//! Lines and points that are drawn alone: coverage, then the stages that triangles share.

use super::{InOrder, InOrderScratch};
use crate::bounds::lines::LinePrimitive;
use crate::bounds::primitives::PointPrimitive;
use crate::fragment::interpolate::{LineInterpolant, LineOrPoint, PointInterpolant};
use crate::raster::{line, point};
use crate::tile_pass::TileWork;
use estampe_simd::Lanes;

impl<const N: usize> InOrder<'_, '_, '_, '_, N> {
    /// Draws a line alone. Such lines and points enter the SIMD level one by one: they are few, and
    /// their code is kept out of the loop over triangles.
    pub(super) fn line(&mut self, line: LinePrimitive) {
        let TileWork { shape, rect, .. } = self.work;
        let list = &mut self.scratch.in_order.list;
        list.clear();
        let style = self.work.plan.line_style;
        if style.plain_rectangle().is_none() {
            line::cover(&line, style, *shape, rect, list);
        }
        let interpolant = LineInterpolant::new(line, style, self.source);
        if style.is_smooth() {
            self.smooth = Some(interpolant);
        }
        let interpolant = LineOrPoint::Line(interpolant);
        self.enter_covered(&interpolant, line.front);
        if style.is_smooth() {
            // Alpha is scaled by the coverage of this line alone.
            self.flush();
            self.smooth = None;
        }
    }

    pub(super) fn point(&mut self, point: &PointPrimitive) {
        let TileWork { shape, rect, .. } = self.work;
        let list = &mut self.scratch.in_order.list;
        list.clear();
        let is_round = self.work.plan.pipeline.descriptor().primitive.round_points;
        point::cover(point, is_round, *shape, rect, list);
        let interpolant = PointInterpolant {
            point,
            source: self.source,
        };
        let interpolant = LineOrPoint::Point(interpolant);
        self.enter_covered(&interpolant, point.front);
    }

    fn enter_covered(&mut self, interpolant: &LineOrPoint<'_>, front: bool) {
        dispatch_samples!(N, self.work.level, s => {
            self.cover_rectangle(s, interpolant);
            self.covered(s, interpolant, front);
        });
    }

    /// Lists the packets that a line covers, if it is a rectangle and nothing else.
    #[inline(always)]
    fn cover_rectangle<S: Lanes>(&mut self, s: S, interpolant: &LineOrPoint<'_>) {
        let TileWork {
            shape,
            rect,
            is_whole,
            plan,
            ..
        } = self.work;
        if let LineOrPoint::Line(line) = interpolant
            && let Some(width) = plan.line_style.plain_rectangle()
        {
            let InOrderScratch { list, clip, .. } = &mut self.scratch.in_order;
            line::cover_rectangle(s, (line.primitive(), width), *shape, rect, list);
            if !is_whole {
                list.clip_to(clip.of(rect));
            }
        }
    }
}
