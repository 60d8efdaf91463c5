//! Attachments that only a pass needs: one tile of them, in the memory of a worker.

use super::{MAX_TARGETS, TileJob, TilePass};
use estampe_types::Lines;

/// One tile of the attachments that a pass clears first and discards last. It stays in a core's
/// second-level cache; an image of four samples would be written to memory and read by nobody.
#[derive(Debug, Default)]
pub(super) struct WorkerTile {
    colors: [Lines<u32>; MAX_TARGETS],
    depth: Lines<f32>,
    stencil: Lines<u8>,
}

impl WorkerTile {
    /// A tile's job with this memory in place of the attachments that the pass discards; `None` if
    /// memory is short.
    pub(super) fn job<'a, 'b: 'a>(
        &'a mut self,
        pass: &TilePass<'_>,
        job: &mut TileJob<'b>,
    ) -> Option<TileJob<'a>> {
        let discards = pass.discards;
        for (index, (memory, image)) in self.colors.iter_mut().zip(&job.colors).enumerate() {
            if discards.colors >> index & 1 == 1 {
                resize(memory, image.as_flattened().len())?;
            }
        }
        if discards.depth_stencil {
            resize(&mut self.depth, job.depth.as_flattened().len())?;
            resize(&mut self.stencil, job.stencil.as_flattened().len())?;
        }
        let mut job: TileJob<'a> = std::mem::take(job);
        for (index, (memory, image)) in self.colors.iter_mut().zip(&mut job.colors).enumerate() {
            if discards.colors >> index & 1 == 1 {
                *image = memory.as_chunks_mut().0;
            }
        }
        if discards.depth_stencil {
            job.depth = self.depth.as_chunks_mut().0;
            job.stencil = self.stencil.as_chunks_mut().0;
        }
        Some(job)
    }
}

/// Makes memory for so many elements, whose values do not matter.
fn resize<T: Copy + Default>(memory: &mut Lines<T>, len: usize) -> Option<()> {
    if memory.len() != len {
        *memory = Lines::zeros(len)?;
    }
    Some(())
}
