//! The runs of a tile that come next, in submission order.

use super::{TilePass, varyings_of};
use crate::bounds::bins::BinEntry;
use crate::bounds::chunk::{Chunk, Packets, RunsOfTile};
use crate::bounds::chunk_index::ChunksOfTile;
use crate::fragment::interpolate::VaryingSource;
use crate::tile_path::TilePath;

/// The runs of a tile from one on.
#[derive(Debug, Clone)]
pub(super) struct UpcomingRuns<'a> {
    pass: &'a TilePass<'a>,
    tile: u32,
    /// The numbers of the chunks after that of the last run.
    chunks: ChunksOfTile<'a>,
    /// That chunk, and its runs that are left.
    of_chunk: Option<(&'a Chunk, RunsOfTile<'a>)>,
}

/// A run that comes.
#[derive(Debug, Clone)]
pub(super) struct UpcomingRun<'a> {
    pub(super) packets: Packets<'a>,
    /// The entries that were not taken yet.
    entries: &'a [BinEntry],
    pub(super) path: TilePath,
    pub(super) source: VaryingSource<'a>,
}

impl UpcomingRun<'_> {
    /// Takes the next entry.
    #[inline(always)]
    pub(super) fn next_entry(&mut self) -> Option<BinEntry> {
        let (first, rest) = self.entries.split_first()?;
        self.entries = rest;
        Some(*first)
    }
}

impl<'a> UpcomingRuns<'a> {
    /// All runs of a tile.
    pub(super) fn new(pass: &'a TilePass<'a>, tile: u32) -> Self {
        Self {
            pass,
            tile,
            chunks: pass.chunk_index.of_tile(tile),
            of_chunk: None,
        }
    }

    /// The next run on a path that is asked for; none at the end.
    #[inline(never)]
    pub(super) fn next(&mut self, is_wanted: fn(TilePath) -> bool) -> Option<UpcomingRun<'a>> {
        let pass = self.pass;
        loop {
            if let Some((chunk, runs)) = &mut self.of_chunk
                && let Some((sub_draw, entries)) = runs.next()
            {
                let plan = &pass.plans[sub_draw as usize];
                if is_wanted(plan.path) {
                    return Some(UpcomingRun {
                        packets: pass.packets.of(chunk),
                        entries,
                        path: plan.path,
                        source: varyings_of(chunk, plan),
                    });
                }
                continue;
            }
            let chunk = &pass.chunks[self.chunks.next()? as usize];
            self.of_chunk = Some((chunk, chunk.runs_of_tile(self.tile)));
        }
    }
}
