//! The memory of the tile that a worker draws next, brought to the cache while it draws another.
//!
//! A pass begins a tile by clearing it, or by reading what it holds, and the memory of an image
//! lies beyond the caches: stores that miss them wait for one another. So a few lines of the next
//! tile are prefetched for each step of the work on the tile at hand.

use super::{TileJob, TilePass};
use crate::attachment::TileRows;
use estampe_simd::{LANES, Lanes};

/// The lines of the next tile that are not prefetched yet.
#[derive(Debug, Default)]
pub(crate) struct NextTile<'a> {
    color: &'a [[u32; LANES]],
    depth: &'a [[f32; LANES]],
    rows: RowLines<'a>,
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
            rows: RowLines::new(&job.rows),
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
        if self.rows.left > 0 {
            self.rows.step(s, lines);
        }
    }

    /// The lines that are not prefetched yet, of colours, depths or rows, whichever are most.
    #[inline(always)]
    pub(super) fn len(&self) -> usize {
        self.color.len().max(self.depth.len()).max(self.rows.left)
    }
}

/// The lines of images in row order that the tile is stored to.
#[derive(Debug, Default)]
struct RowLines<'a> {
    /// What is left of a row,
    row: &'a [u32],
    /// the rows of the same image after it,
    rows: &'a [&'a mut [u32]],
    /// and the images after that.
    images: &'a [TileRows<'a>],
    /// How many lines there are.
    left: usize,
}

impl<'a> RowLines<'a> {
    fn new(images: &'a [TileRows<'a>]) -> Self {
        let rows = images.iter().flat_map(|image| &image.rows);
        Self {
            images,
            left: rows.map(|row| row.len().div_ceil(LANES)).sum(),
            ..Self::default()
        }
    }

    // A function of its own: few passes have rows, and the loops over layers must stay small.
    #[inline(never)]
    fn step<S: Lanes>(&mut self, s: S, lines: usize) {
        let lines = lines.min(self.left);
        self.left -= lines;
        for _ in 0..lines {
            while self.row.is_empty() {
                if let Some((row, others)) = self.rows.split_first() {
                    (self.row, self.rows) = (row, others);
                } else if let Some((image, others)) = self.images.split_first() {
                    (self.rows, self.images) = (&image.rows, others);
                } else {
                    return;
                }
            }
            s.prefetch(&self.row[0]);
            self.row = self.row.get(LANES..).unwrap_or_default();
        }
    }
}
