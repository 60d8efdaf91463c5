//! The tile side of a pass: every tile consumes the chunks in order.

use super::{BatchChunks, Context, Memory, out_of_memory};
use crate::attachment::{RenderTarget, RowsPlace};
use crate::bounds::chunk::Chunk;
use crate::bounds::pixel_rect::PixelRect;
use crate::commands::{Discards, OcclusionQueries};
use crate::plan::draw_batch::DrawBatch;
use crate::plan::pass_check::RenderPassError;
use crate::plan::tile_plan::TargetFacts;
use crate::raster::MAX_SAMPLES;
use crate::recycle::recycled;
use crate::schedule::{Executor, lock};
use crate::statistics::Statistics;
use crate::tile_pass::{
    self, Clear, MAX_TARGETS, TileJobs, TilePass, TileQueue, TileScratch, TileShares, TileStores,
    TileWords,
};
use estampe_simd::Stream;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// The most bytes of a tile that a worker draws in memory of its own before it is stored: they stay
/// in the second-level cache, mostly.
const MOST_STREAMED: u64 = 512 << 10;

/// The images that tiles are drawn into.
#[derive(Debug)]
pub(super) struct TileAttachments<'a> {
    pub(super) target: &'a mut RenderTarget,
    /// What is cleared first.
    pub(super) clear: &'a Clear,
    /// True if nothing is drawn into them afterwards.
    pub(super) is_last: bool,
    /// Those that nothing was drawn into before, and that nobody needs afterwards.
    pub(super) discards: Discards,
    /// Those of several samples that nothing was drawn into before, and that are stored when each
    /// tile is drawn, if workers have room for them.
    pub(super) streams: Discards,
}

impl Context {
    /// The tile side: every tile consumes the chunks in order.
    pub(super) fn draw_tiles(
        &self,
        executor: &Executor,
        (attachments, occlusion_queries): (TileAttachments<'_>, Option<&OcclusionQueries>),
        (batch, made): (&DrawBatch<'_>, BatchChunks),
        memory: &mut Memory,
    ) -> Result<Statistics, RenderPassError> {
        let TileAttachments {
            target,
            clear,
            is_last,
            discards,
            mut streams,
        } = attachments;
        let mut words = TileWords::of(target, discards.with(streams));
        if !Stream::has_instructions(self.level) || words.bytes() > MOST_STREAMED {
            streams = Discards::default();
            words = TileWords::of(target, discards);
        }
        // First of all: where memory is short, no image is taken to be drawn or resolved.
        match target.samples() {
            1 if !self.level.is_scalar() => memory.tiles_1.make_room(executor, words),
            4 if !self.level.is_scalar() => memory.tiles_4.make_room(executor, words),
            _ => memory.tiles_many.make_room(executor, words),
        }?;
        let mut resolved = [None; MAX_TARGETS];
        for resolve in target.resolves.iter_mut().filter(|_| is_last) {
            resolved[resolve.color] = Some(resolve.into.format());
            resolve.is_done = true;
        }
        for rows in target.rows.iter_mut().filter(|_| is_last) {
            rows.is_done = rows.words_mut().is_some();
        }
        memory.chunk_index.build();
        let facts = TargetFacts {
            level: self.level,
            samples: target.samples() as usize,
            depth_format: target.depth_format(),
            has_depth: target.has_depth(),
            has_queries: occlusion_queries.is_some(),
        };
        let mut states = recycled(std::mem::take(&mut memory.lists.tile_states));
        batch.tile_states(&facts, &mut states);
        let mut plans = std::mem::take(&mut memory.lists.plans).recycled();
        batch.tile_plans(executor, (&states, &memory.vertices), &mut plans);
        let (grid, size) = (target.grid(), target.size);
        let keeps_depths = is_last && !discards.depth_stencil;
        let (mut jobs, stores) = TileJobs::of_target(target, keeps_depths);
        let places: Vec<RowsPlace> = stores.rows.iter().map(|rows| rows.place).collect();
        let workers = Workers {
            executor,
            tiles_1: &memory.tiles_1,
            tiles_4: &memory.tiles_4,
            tiles_many: &memory.tiles_many,
        };
        let pass = TilePass {
            level: self.level,
            grid,
            target: PixelRect::of_target(None, size.width, size.height),
            plans: &plans,
            chunks: &[],
            packets: memory.chunk_slabs.packets(),
            chunk_index: &memory.chunk_index,
            clear: *clear,
            samples: facts.samples,
            occlusion_queries,
            in_workers: discards.with(streams),
            streams,
            worker_words: &words,
            resolved,
            rows: &places,
        };
        let chunks = &mut memory.chunks[..made.count];
        let mut statistics = Statistics::default();
        let tiles_of_band = self.bin_limits.tiles_of_band(made.bins.waiting);
        if tiles_of_band < usize::MAX {
            while jobs.left() > 0 {
                let band = jobs.take_first(tiles_of_band);
                sort_band(executor, chunks, &band);
                let pass = TilePass { chunks, ..pass };
                statistics += workers.draw(&pass, &stores, TileQueue::Stored(band));
                statistics.bands_of_tiles += 1;
            }
        } else if let Some(order) = memory.tile_costs.dearest_first() {
            let pass = TilePass { chunks, ..pass };
            let mut shares = TileShares::new(jobs, std::mem::take(&mut memory.lists.tile_shares));
            let queue = TileQueue::Ordered(order, &mut shares);
            statistics += workers.draw(&pass, &stores, queue);
            statistics.tiles_by_cost += order.len() as u64;
            memory.lists.tile_shares = shares.recycled();
        } else {
            let pass = TilePass { chunks, ..pass };
            statistics += workers.draw(&pass, &stores, TileQueue::Stored(jobs));
        }
        if grid != size.grid() {
            statistics.tiles_for_threads += grid.tiles() as u64;
        }
        memory.lists.plans = plans.recycled();
        memory.lists.tile_states = recycled(states);
        Ok(statistics)
    }
}

/// Sorts what waits of a band of tiles.
fn sort_band(executor: &Executor, chunks: &mut [Chunk], band: &TileJobs<'_>) {
    let tiles = band.tiles();
    executor.for_each_alone(chunks, |chunk| {
        if chunk.bins.waits() {
            chunk.bins.sort_band(&tiles);
        }
    });
}

/// The workers that draw tiles.
struct Workers<'a> {
    executor: &'a Executor,
    tiles_1: &'a TileWorkers<1>,
    tiles_4: &'a TileWorkers<4>,
    tiles_many: &'a TileWorkers<MAX_SAMPLES>,
}

impl Workers<'_> {
    /// Draws tiles; gives what was counted.
    fn draw(
        &self,
        pass: &TilePass<'_>,
        stores: &TileStores<'_>,
        tiles: TileQueue<'_, '_>,
    ) -> Statistics {
        let (executor, is_scalar) = (self.executor, pass.level.is_scalar());
        match pass.samples {
            1 if !is_scalar => self.tiles_1.draw(executor, (pass, stores), tiles),
            4 if !is_scalar => self.tiles_4.draw(executor, (pass, stores), tiles),
            _ => self.tiles_many.draw(executor, (pass, stores), tiles),
        }
    }
}

/// Memory of the workers that draw tiles of `N` samples.
#[derive(Debug, Default)]
pub(super) struct TileWorkers<const N: usize> {
    /// Made by a worker when it first draws tiles of so many samples.
    scratch: Vec<Mutex<Option<Box<TileScratch<N>>>>>,
    /// What each has room for of a tile that a pass discards.
    room: TileWords,
}

impl<const N: usize> TileWorkers<N> {
    pub(super) fn new(workers: usize) -> Self {
        let mut scratch = Vec::new();
        scratch.resize_with(workers, Mutex::default);
        Self {
            scratch,
            room: TileWords::default(),
        }
    }

    /// Takes memory of each worker for so much of a tile, if the passes before needed less.
    fn make_room(&mut self, executor: &Executor, words: TileWords) -> Result<(), RenderPassError> {
        let room = self.room.with(words);
        if room == self.room {
            return Ok(());
        }
        let is_short = AtomicBool::new(false);
        executor.for_each_alone(&mut self.scratch, |worker| {
            let worker = worker.get_mut().unwrap_or_else(PoisonError::into_inner);
            let made = worker.get_or_insert_default().make_room(&room);
            is_short.fetch_or(made.is_none(), Ordering::Relaxed);
        });
        if is_short.into_inner() {
            return Err(out_of_memory(room.bytes()));
        }
        self.room = room;
        Ok(())
    }

    /// Draws all tiles; gives what was counted.
    fn draw(
        &self,
        executor: &Executor,
        pass: (&TilePass<'_>, &TileStores<'_>),
        tiles: TileQueue<'_, '_>,
    ) -> Statistics {
        let statistics = Mutex::new(Statistics::default());
        executor.for_each_worker(tiles, &self.scratch, |next, scratch| {
            let scratch = scratch.get_or_insert_default();
            while let Some(tiles) = next() {
                tile_pass::draw(pass, tiles, scratch);
            }
            *lock(&statistics) += scratch.end_pass();
        });
        let statistics = lock(&statistics);
        *statistics
    }
}
