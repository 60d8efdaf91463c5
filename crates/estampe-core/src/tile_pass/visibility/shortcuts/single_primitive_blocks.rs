//! Blocks of 16×16 pixels that show one triangle at every sample.
//!
//! *In* triangles that are known to pass the depth test in whole blocks · *Out* the triangle of
//! each such block.
//!
//! Of a large triangle neither depths need be read nor ids written, to be read again when it is
//! shaded: one id stands for the block. Only when another triangle is drawn into the block too are
//! the ids written out.

use crate::tile_pass::visibility::writer::VisibilityWriter;
use estampe_simd::{LANES, Level};

/// The triangle of each block that shows one triangle.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::tile_pass::visibility) struct SinglePrimitiveBlocks {
    /// The blocks that do, one bit each.
    blocks: u16,
    ids: [u32; LANES],
}

impl SinglePrimitiveBlocks {
    /// The triangle that the block of a packet shows.
    #[inline(always)]
    pub(in crate::tile_pass::visibility) fn of_packet(&self, packet: usize) -> Option<u32> {
        let block = packet / LANES % LANES;
        (self.blocks >> block & 1 == 1).then_some(self.ids[block])
    }

    /// Notes that blocks show one triangle.
    pub(in crate::tile_pass::visibility) fn set(&mut self, blocks: u16, id: u32) {
        self.blocks |= blocks;
        for (block, of_block) in self.ids.iter_mut().enumerate() {
            if blocks >> block & 1 == 1 {
                *of_block = id;
            }
        }
    }

    /// Writes the ids of those of some blocks that show one triangle, because another triangle is
    /// about to be drawn there; a triangle without colours leaves them.
    pub(in crate::tile_pass::visibility) fn write_out<const N: usize>(
        &mut self,
        level: Level,
        blocks: u16,
        writer: &mut VisibilityWriter<'_, N>,
    ) {
        let blocks = self.blocks & blocks;
        if blocks != 0 && writer.has_ids() {
            self.blocks &= !blocks;
            writer.write_ids(level, blocks, &self.ids);
        }
    }
}
