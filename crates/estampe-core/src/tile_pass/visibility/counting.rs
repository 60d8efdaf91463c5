//! Triangles that are tested by depth, do not store it, and change stencil values: shadow volumes.
//!
//! Their packets are compared with the [ranges](PacketRanges) of stored depths before they are
//! covered. Of the packets in which all of a triangle fails the depth test, stencil values change
//! without a depth.
//!
//! [`PacketRanges`]: crate::per_sample::packet_ranges::PacketRanges

use super::ONLY_WIDE;
use super::rasterize::{Rasterizer, blocks_of};
use super::writer::{VisibilityTriangle, VisibilityWriter};
use crate::bounds::primitives::TrianglePacket;
use crate::fragment::interpolate::DepthPlane;
use crate::per_sample::packet_ranges::PacketQuery;
use crate::per_sample::stencil::FaceLanes;
use crate::raster::triangle::TileTriangle;
use estampe_simd::{Lane, Lanes, dispatch};

impl<const N: usize> Rasterizer<'_, '_, '_, N> {
    /// Large triangles of a packet, in order. Of those in `lanes`, which these are among, the first
    /// one's id is `first`.
    pub(super) fn counting(
        &mut self,
        packet: &TrianglePacket,
        large: u16,
        (lanes, first): (u16, u32),
    ) {
        if large != 0 {
            dispatch!(@wide self.work.level, s => self.counting_lanes(s, packet, large, (lanes, first)),
                scalar => unreachable!("{ONLY_WIDE}"));
        }
    }

    #[inline(always)]
    fn counting_lanes<S: Lanes>(
        &mut self,
        s: S,
        packet: &TrianglePacket,
        large: u16,
        (lanes, first): (u16, u32),
    ) {
        let Some(test) = &self.work.plan.tests.stencil else {
            return;
        };
        let faces = [test.back().lanes(s), test.front().lanes(s)];
        for lane in Lane::all_of(large) {
            let Some(covering) = self.covering(packet, lane) else {
                continue;
            };
            let front = packet.front & lane.bit() != 0;
            let triangle = VisibilityTriangle {
                plane: DepthPlane::of_lane(packet, lane.get()),
                id: first + (lanes & (lane.bit() - 1)).count_ones(),
                front,
            };
            self.cover_counting(s, &triangle, &covering);
            self.write_counting(s, &triangle, &faces[usize::from(front)]);
        }
    }

    /// Covers a triangle: what is tested, and what is known to fail the depth test.
    #[inline(always)]
    fn cover_counting<S: Lanes>(
        &mut self,
        s: S,
        triangle: &VisibilityTriangle,
        covering: &TileTriangle<N>,
    ) {
        let ranges = &mut self.scratch.hiz.packets;
        ranges.refresh(covering.blocks(), self.samples.count(), self.job.depth);
        let look = self.hiz_query(triangle.plane, triangle.front);
        let query = PacketQuery::new(s, &look, &self.scratch.hiz.packets);
        let visibility = &mut self.scratch.visibility;
        let lists = [&mut visibility.list, &mut visibility.failing];
        let [list, failing] = lists;
        list.clear();
        failing.clear();
        covering.cover_classes(s, &query, [&mut *list, &mut *failing]);
        if !self.work.is_whole {
            list.clip(&self.work.rect);
            failing.clip(&self.work.rect);
        }
    }

    #[inline(always)]
    fn write_counting<S: Lanes>(
        &mut self,
        s: S,
        triangle: &VisibilityTriangle,
        face: &FaceLanes<S>,
    ) {
        let plan = self.work.plan;
        let visibility = &mut self.scratch.visibility;
        let (list, failing) = (visibility.list.items(), visibility.failing.items());
        self.scratch.statistics.packets_failing_depth += failing.len() as u64;
        let counts = plan.query.is_some().then_some(&mut self.passed);
        let target = (&plan.tests, self.samples, self.work.shape);
        let buffer = &mut visibility.buffer;
        let mut single = std::mem::take(&mut buffer.single);
        let mut writer = VisibilityWriter::new(target, self.storage, self.job, buffer, counts);
        writer.failing(s, face, failing);
        if !list.is_empty() {
            if writer.has_ids() {
                let touched = blocks_of(0, list.iter().map(|item| item.packet));
                single.write_out(self.work.level, touched, &mut writer);
            }
            writer.triangle(self.work.level, triangle, 0, list, true);
        }
        visibility.buffer.single = single;
    }
}
