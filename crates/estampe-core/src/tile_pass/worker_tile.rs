//! Attachments that only a pass needs: one tile of them, in the memory of a worker.

use super::{MAX_TARGETS, TileJob};
use crate::attachment::RenderTarget;
use crate::commands::Discards;
use crate::layout::texel_words;
use estampe_types::Lines;

/// One tile of the attachments that a pass clears first and discards last. It stays in a core's
/// second-level cache; an image of four samples would be written to memory and read by nobody.
#[derive(Debug, Default)]
pub(super) struct WorkerTile {
    colors: [Lines<u32>; MAX_TARGETS],
    depth: Lines<f32>,
    stencil: Lines<u8>,
}

/// The elements of a tile of those attachments that a pass discards.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct TileWords {
    colors: [usize; MAX_TARGETS],
    depth: usize,
    stencil: usize,
}

impl TileWords {
    /// None of the attachments that are not discarded.
    pub(crate) fn of(target: &RenderTarget, discards: Discards) -> Self {
        let samples = target.grid().tile_pixels() * target.samples() as usize;
        let mut words = Self::default();
        let formats = target.color_formats().iter().enumerate();
        for (index, format) in formats.filter(|(index, _)| discards.colors >> index & 1 == 1) {
            words.colors[index] = samples * texel_words(*format);
        }
        if discards.depth_stencil {
            words.depth = if target.has_depth() { samples } else { 0 };
            words.stencil = if target.has_stencil() { samples } else { 0 };
        }
        words
    }

    /// As many as both have, of each attachment.
    pub(crate) fn with(self, other: Self) -> Self {
        let mut colors = self.colors;
        for (words, other) in colors.iter_mut().zip(other.colors) {
            *words = other.max(*words);
        }
        Self {
            colors,
            depth: self.depth.max(other.depth),
            stencil: self.stencil.max(other.stencil),
        }
    }

    /// The memory that they take.
    pub(crate) fn bytes(&self) -> u64 {
        let words = self.colors.iter().sum::<usize>() + self.depth;
        (words * 4 + self.stencil) as u64
    }
}

impl WorkerTile {
    /// Takes memory, whose values do not matter, where that of the passes before is too small;
    /// `None` if it is short.
    pub(super) fn make_room(&mut self, words: &TileWords) -> Option<()> {
        for (memory, len) in self.colors.iter_mut().zip(words.colors) {
            grow(memory, len)?;
        }
        grow(&mut self.depth, words.depth)?;
        grow(&mut self.stencil, words.stencil)
    }

    /// A tile's job with this memory in place of the attachments that the pass discards.
    pub(super) fn job<'a, 'b: 'a>(
        &'a mut self,
        (discards, words): (Discards, &TileWords),
        job: &mut TileJob<'b>,
    ) -> TileJob<'a> {
        let mut job: TileJob<'a> = std::mem::take(job);
        for (index, (memory, image)) in self.colors.iter_mut().zip(&mut job.colors).enumerate() {
            if discards.colors >> index & 1 == 1 {
                *image = memory[..words.colors[index]].as_chunks_mut().0;
            }
        }
        if discards.depth_stencil {
            job.depth = self.depth[..words.depth].as_chunks_mut().0;
            job.stencil = self.stencil[..words.stencil].as_chunks_mut().0;
        }
        job
    }
}

/// Makes memory for at least so many elements, whose values do not matter.
fn grow<T: Copy + Default>(memory: &mut Lines<T>, len: usize) -> Option<()> {
    if memory.len() < len {
        *memory = Lines::zeros(len)?;
    }
    Some(())
}
