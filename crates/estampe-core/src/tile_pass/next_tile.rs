//! The memory of the tile that a worker draws next, brought to the cache while it draws another.
//!
//! A pass begins a tile by clearing it, or by reading what it holds, and the memory of an image
//! lies beyond the caches: stores that miss them wait for one another. So a few lines of the next
//! tile are prefetched for each step of the work on the tile at hand.

use super::{TileJob, TilePass};
use estampe_simd::{LANES, Lanes};

/// The lines of the next tile that are not prefetched yet.
#[derive(Debug, Default)]
pub(crate) struct NextTile<'a> {
    color: &'a [[u32; LANES]],
    depth: &'a [[f32; LANES]],
}

impl<'a> NextTile<'a> {
    /// The tile of a job: its first colours and its depths, but for those that the pass keeps in a
    /// worker's memory.
    pub(super) fn new(pass: &TilePass<'_>, job: &'a TileJob<'_>) -> Self {
        let discards = pass.discards;
        Self {
            color: if discards.colors & 1 == 0 {
                &*job.colors[0]
            } else {
                &[]
            },
            depth: if discards.depth_stencil {
                &[]
            } else {
                &*job.depth
            },
        }
    }

    /// Prefetches up to so many lines of colours, and as many of depths.
    #[inline(always)]
    pub(super) fn step<S: Lanes>(&mut self, s: S, lines: usize) {
        let (now, later) = self.color.split_at(lines.min(self.color.len()));
        self.color = later;
        now.iter().for_each(|line| s.prefetch(line));
        let (now, later) = self.depth.split_at(lines.min(self.depth.len()));
        self.depth = later;
        now.iter().for_each(|line| s.prefetch(line));
    }

    /// The lines that are not prefetched yet, of colours or depths, whichever are more.
    #[inline(always)]
    pub(super) fn len(&self) -> usize {
        self.color.len().max(self.depth.len())
    }
}
