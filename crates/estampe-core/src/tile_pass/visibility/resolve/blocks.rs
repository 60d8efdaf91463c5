//! Blocks of 16×16 pixels that show one triangle, queued at once.

use super::Resolver;
use crate::fragment::queue::TriangleBlock;
use crate::raster::packet_origin;
use crate::tile_pass::TileScratch;
use crate::tile_pass::visibility::ONLY_WIDE;
use estampe_simd::{Lanes, dispatch};

impl<const N: usize> Resolver<'_, '_, '_, N> {
    /// Queues all packets of a block, given the first one, that shows a triangle at every sample.
    /// False if that cannot be done at once.
    #[inline(always)]
    pub(super) fn queue_block(&mut self, id: u32, packet: u16) -> bool {
        if const { N > 4 } || !self.scratch.queue.takes_blocks() {
            return false;
        }
        let visible = self.visible(id);
        if !self.scratch.queue.has_room_for_block() {
            self.flush();
        }
        self.push_visible_block(visible, packet);
        true
    }

    #[inline(never)]
    fn push_visible_block(&mut self, visible: usize, packet: u16) {
        dispatch!(@wide self.pass.level, s => self.push_block(s, visible, packet),
            scalar => unreachable!("{ONLY_WIDE}"));
    }

    #[inline(always)]
    fn push_block<S: Lanes>(&mut self, s: S, visible: usize, packet: u16) {
        let (x, y) = packet_origin(u32::from(packet));
        let TileScratch {
            queue,
            visibility,
            statistics,
            ..
        } = &mut *self.scratch;
        let (triangle, front) = visibility.resolve.interpolant(visible, self.plan);
        let block = TriangleBlock {
            packet,
            pixel: [self.origin[0] + x, self.origin[1] + y],
            masks: self.samples.whole(),
            front,
        };
        queue.push_block(s, &triangle, &block);
        statistics.blocks_queued += 1;
    }
}
