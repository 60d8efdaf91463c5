//! The memory of the tile that a worker draws next, brought to the cache while it draws another.
//!
//! A pass begins a tile by clearing it, or by reading what it holds, and the memory of an image
//! lies beyond the caches: stores that miss them wait for one another. So a few lines of the next
//! tile are prefetched for each step of the work on the tile at hand.

use super::{TileJobs, TilePass};
use crate::attachment::{RowsPlace, TileLines};
use estampe_simd::{LANES, Lanes, outline};

/// The lines of the next tile that are not prefetched yet.
#[derive(Debug, Default)]
pub(crate) struct NextTile<'a> {
    color: &'a [[u32; LANES]],
    depth: &'a [[f32; LANES]],
    rows: RowLines<'a>,
}

impl<'a> NextTile<'a> {
    /// The first of the tiles that are left: its first colours and its depths, but for those that
    /// the pass keeps in a worker's memory.
    pub(super) fn of(pass: &TilePass<'a>, left: &'a TileJobs<'_>) -> Self {
        let Some(tile) = left.first_tile() else {
            return Self::default();
        };
        let in_workers = pass.in_workers;
        Self {
            color: if in_workers.colors & 1 == 0 {
                left.first_colors()
            } else {
                &[]
            },
            depth: if in_workers.depth_stencil {
                &[]
            } else {
                left.first_depths()
            },
            rows: RowLines::new(pass.rows, pass.grid.tile_origin(tile)),
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
    /// Those of the image at hand, from the next row on.
    lines: TileLines,
    /// The next line of a row, and how many are left of it.
    row: (usize, usize),
    /// The images after that, and the tile's place in them.
    images: &'a [RowsPlace],
    origin: (u32, u32),
    /// How many lines there are.
    left: usize,
}

impl<'a> RowLines<'a> {
    fn new(images: &'a [RowsPlace], origin: (u32, u32)) -> Self {
        let lines = images.iter().map(|image| image.lines_of_tile(origin));
        Self {
            images,
            origin,
            left: lines.map(|lines| lines.rows * lines.of_row).sum(),
            ..Self::default()
        }
    }

    // Out of line: few passes have rows, and the loops over layers must stay small.
    #[inline(always)]
    fn step<S: Lanes>(&mut self, s: S, lines: usize) {
        outline!(s, {
            let lines = lines.min(self.left);
            self.left -= lines;
            for _ in 0..lines {
                let Some(address) = self.next_line() else {
                    return;
                };
                s.prefetch_address(address);
            }
        })
    }

    /// The address of the next line.
    #[inline(always)]
    fn next_line(&mut self) -> Option<usize> {
        while self.row.1 == 0 {
            if self.lines.rows > 0 {
                self.row = (self.lines.address, self.lines.of_row);
                self.lines.address += self.lines.row_bytes;
                self.lines.rows -= 1;
            } else {
                let (image, others) = self.images.split_first()?;
                (self.lines, self.images) = (image.lines_of_tile(self.origin), others);
            }
        }
        let (address, left) = self.row;
        self.row = (address + LINE_BYTES, left - 1);
        Some(address)
    }
}

/// Bytes of a cache line.
const LINE_BYTES: usize = 64;
