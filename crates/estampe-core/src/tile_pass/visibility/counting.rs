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
use crate::per_sample::packet_ranges::{Margin, PacketQuery};
use crate::per_sample::stencil::FaceLanes;
use crate::raster::triangle::TileTriangle;
use crate::tile_pass::TileWork;
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
        let margin = Margin::of(&self.work.plan.tests);
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
            let face = &faces[usize::from(front)];
            self.count_failing(s, &triangle, &covering, (face, margin));
            self.write_counting(&triangle);
        }
    }

    /// Covers a triangle: counts where it is known to fail the depth test, and lists what is
    /// tested.
    #[inline(always)]
    fn count_failing<S: Lanes>(
        &mut self,
        s: S,
        triangle: &VisibilityTriangle,
        covering: &TileTriangle<N>,
        (face, margin): (&FaceLanes<S>, Margin),
    ) {
        let ranges = &mut self.scratch.hiz.packets;
        ranges.refresh(covering.blocks(), self.samples.count(), self.job.depth);
        let look = self.hiz_query(triangle.plane, triangle.front);
        let query = PacketQuery::new(s, &look, &self.scratch.hiz.packets, margin);
        let list = &mut self.scratch.visibility.list;
        list.clear();
        let TileWork {
            plan,
            rect,
            is_whole,
            ..
        } = self.work;
        let (depth, stencil) = (&*self.job.depth, &mut *self.job.stencil);
        let (samples, mut packets) = (self.samples.count(), 0);
        let steps = covering.cover_first(s, &query, list);
        if const { N == 1 } && *is_whole && plan.tests.failing_counts(face) {
            steps.cover_second(
                s,
                covering,
                list,
                #[inline(always)]
                |item| {
                    packets += u64::from(item.masks[0] != 0);
                    if let Some(stencil) = stencil.get_mut(usize::from(item.packet)) {
                        face.count_failing(s, item.masks[0], stencil);
                    }
                },
            );
        } else {
            steps.cover_second(
                s,
                covering,
                list,
                #[inline(always)]
                |mut item| {
                    if !is_whole {
                        item.clip(rect);
                    }
                    packets += u64::from(item.any() != 0);
                    let lines = usize::from(item.packet) * samples..;
                    for (line, &lanes) in lines.zip(&item.masks).take(samples) {
                        if let Some(stencil) = stencil.get_mut(line) {
                            let stored = (depth.get(line), stencil);
                            plan.tests.run_failing(s, lanes, face, stored);
                        }
                    }
                },
            );
        }
        if !is_whole {
            list.clip(rect);
        }
        self.scratch.statistics.packets_failing_depth += packets;
    }

    /// Tests what is listed.
    #[inline(always)]
    fn write_counting(&mut self, triangle: &VisibilityTriangle) {
        if self.scratch.visibility.list.items().is_empty() {
            return;
        }
        let plan = self.work.plan;
        let visibility = &mut self.scratch.visibility;
        let list = visibility.list.items();
        let counts = plan.query.is_some().then_some(&mut self.passed);
        let target = (&plan.tests, self.samples, self.work.shape);
        let buffer = &mut visibility.buffer;
        let mut single = std::mem::take(&mut buffer.single);
        let mut writer = VisibilityWriter::new(target, self.storage, self.job, buffer, counts);
        if writer.has_ids() {
            let touched = blocks_of(0, list.iter().map(|item| item.packet));
            single.write_out(self.work.level, touched, &mut writer);
        }
        writer.triangle(self.work.level, triangle, 0, list, true);
        visibility.buffer.single = single;
    }
}
