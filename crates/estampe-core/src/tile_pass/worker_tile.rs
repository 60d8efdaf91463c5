//! Attachments of which a worker draws one tile in memory of its own: those that only a pass needs,
//! and those of several samples, which go to memory when the tile is drawn.
//!
//! Samples are four times the pixels, and mostly nobody reads them soon: drawn where they lie, they
//! would be read from memory before they are cleared (`msaa4` and `foliage` took a tenth longer).

use super::{MAX_TARGETS, TileJob};
use crate::attachment::RenderTarget;
use crate::commands::Discards;
use crate::layout::texel_words;
use estampe_simd::{LANES, Stream, bits_of, bits_of_mut};
use estampe_types::Lines;

/// One tile of attachments that a pass clears first. It stays in a core's second-level cache.
#[derive(Debug, Default)]
pub(super) struct WorkerTile {
    colors: [Lines<u32>; MAX_TARGETS],
    depth: Lines<f32>,
    stencil: Lines<u8>,
}

/// The elements of a tile of those attachments that are drawn in workers.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct TileWords {
    colors: [usize; MAX_TARGETS],
    depth: usize,
    stencil: usize,
}

impl TileWords {
    /// Those of some attachments.
    pub(crate) fn of(target: &RenderTarget, in_workers: Discards) -> Self {
        let samples = target.grid().tile_pixels() * target.samples() as usize;
        let mut words = Self::default();
        let formats = target.color_formats().iter().enumerate();
        for (index, format) in formats.filter(|(index, _)| in_workers.colors >> index & 1 == 1) {
            words.colors[index] = samples * texel_words(*format);
        }
        if in_workers.depth_stencil {
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

    /// A tile's job with this memory in place of some attachments, and the shares of these.
    pub(super) fn job<'a, 'b: 'a>(
        &'a mut self,
        (in_workers, words): (Discards, &TileWords),
        mut job: TileJob<'b>,
    ) -> (TileJob<'a>, TileImages<'b>) {
        let mut images = TileImages::default();
        for (number, image) in images.colors.iter_mut().enumerate() {
            if in_workers.colors >> number & 1 == 1 {
                *image = std::mem::take(&mut job.colors[number]);
            }
        }
        if in_workers.depth_stencil {
            images.depth = std::mem::take(&mut job.depth);
            images.stencil = std::mem::take(&mut job.stencil);
        }
        let mut job: TileJob<'a> = job;
        for (number, memory) in self.colors.iter_mut().enumerate() {
            if in_workers.colors >> number & 1 == 1 {
                job.colors[number] = memory[..words.colors[number]].as_chunks_mut().0;
            }
        }
        if in_workers.depth_stencil {
            job.depth = self.depth[..words.depth].as_chunks_mut().0;
            job.stencil = self.stencil[..words.stencil].as_chunks_mut().0;
        }
        (job, images)
    }
}

/// One tile's share of the attachments in whose place a worker's memory is.
#[derive(Debug, Default)]
pub(super) struct TileImages<'a> {
    colors: [&'a mut [[u32; LANES]]; MAX_TARGETS],
    depth: &'a mut [[f32; LANES]],
    stencil: &'a mut [[u8; LANES]],
}

/// Stores a tile that was drawn in a worker's memory to some of its attachments.
pub(super) fn store<'a>(
    tile: &TileJob<'_>,
    images: TileImages<'a>,
    (streams, stream): (Discards, &mut Stream<'a>),
) {
    let colors = tile.colors.iter().zip(images.colors);
    for (number, (from, to)) in colors.enumerate() {
        if streams.colors >> number & 1 == 1 && !to.is_empty() {
            stream.copy(from, to);
        }
    }
    if streams.depth_stencil {
        let from = bits_of(tile.depth.as_flattened());
        let to = bits_of_mut(images.depth.as_flattened_mut());
        stream.copy(from.as_chunks().0, to.as_chunks_mut().0);
        images.stencil.copy_from_slice(tile.stencil);
    }
}

/// Makes memory for at least so many elements, whose values do not matter.
fn grow<T: Copy + Default>(memory: &mut Lines<T>, len: usize) -> Option<()> {
    if memory.len() < len {
        *memory = Lines::zeros(len)?;
    }
    Some(())
}
