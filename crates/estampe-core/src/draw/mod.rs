//! The page on which the pipeline reads: what a draw is, and the order in which its stages run.

mod geometry;
mod tiles;
mod vertex_runs;

use crate::attachment::RenderTarget;
use crate::bounds::bin_limits::{BinLimits, BinSizes};
use crate::bounds::chunk::{Chunk, ChunkSlabs};
use crate::bounds::chunk_index::ChunkIndex;
use crate::bounds::tile_costs::TileCosts;
use crate::commands::{Discards, Draw, RenderPass};
use crate::geometry::chunk::ChunkScratch;
use crate::geometry::shaded_vertices::ShadedVertices;
use crate::geometry::shading::ShadingScratch;
use crate::plan::chunk_plan::ChunkPlan;
use crate::plan::draw_batch::DrawBatch;
use crate::plan::draw_cursor::DrawCursor;
use crate::plan::pass_check::{DrawNeeds, RenderPassError};
use crate::plan::tile_plan::{TilePlan, TileState};
use crate::profile::JobTimings;
use crate::raster::MAX_SAMPLES;
use crate::schedule::{Awake, Executor, ThreadError, ThreadPool};
use crate::segments::Segments;
use crate::statistics::Statistics;
use crate::tile_pass::{Clear, TileShares};
use estampe_simd::Level;
use geometry::ChunkJob;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;
use tiles::{TileAttachments, TileWorkers};

/// The resources that draws need besides their data: threads, a SIMD level, and memory that is
/// reused.
#[derive(Debug)]
pub struct Context {
    level: Level,
    executor: Executor,
    /// The calling thread, for passes whose shaders store in an order that can be seen.
    alone: Executor,
    bin_limits: BinLimits,
    /// Memory that no pass uses now: one for each pass that was drawn beside others.
    memory: Mutex<Vec<Memory>>,
}

/// Memory of a pass, kept for the next one: a frame like the one before allocates nothing.
#[derive(Debug, Default)]
pub(crate) struct Memory {
    lists: Lists,
    vertices: ShadedVertices,
    chunk_plan: ChunkPlan,
    chunks: Vec<Chunk>,
    chunk_slabs: ChunkSlabs,
    chunk_index: ChunkIndex,
    tile_costs: TileCosts,
    shading: Vec<Mutex<ShadingScratch>>,
    chunk_scratch: Vec<Mutex<ChunkScratch>>,
    tiles_1: TileWorkers<1>,
    tiles_4: TileWorkers<4>,
    tiles_many: TileWorkers<MAX_SAMPLES>,
}

impl Memory {
    /// Begins the chunks of a batch, which so many threads draw in so many tiles.
    fn begin_chunks(&mut self, tiles: usize, threads: usize) -> BatchChunks {
        self.chunk_index.begin(tiles);
        self.chunk_slabs.clear();
        self.tile_costs.begin(tiles, threads);
        BatchChunks::default()
    }

    /// Memory for so many workers.
    fn new(workers: usize) -> Self {
        let mut memory = Self {
            tiles_1: TileWorkers::new(workers),
            tiles_4: TileWorkers::new(workers),
            tiles_many: TileWorkers::new(workers),
            ..Self::default()
        };
        memory.shading.resize_with(workers, Mutex::default);
        memory.chunk_scratch.resize_with(workers, Mutex::default);
        memory
    }
}

/// A pass that is being drawn.
#[derive(Debug)]
struct Drawing<'a> {
    pass: &'a RenderPass<'a>,
    /// What is cleared before the next batch.
    clear: Clear,
    target: &'a mut RenderTarget,
}

/// The chunks of a batch that were made since tiles were drawn.
#[derive(Debug, Clone, Copy, Default)]
struct BatchChunks {
    count: usize,
    bins: BinSizes,
}

/// Lists whose elements borrow from a pass, empty between passes: see [`recycled`](crate::recycle::recycled).
#[derive(Debug, Default)]
struct Lists {
    batch: DrawBatch<'static>,
    /// Batches that threads cut parts of many draws into.
    parts: Vec<DrawBatch<'static>>,
    chunk_jobs: Vec<ChunkJob<'static>>,
    tile_states: Vec<TileState<'static>>,
    plans: Segments<TilePlan<'static>>,
    tile_shares: TileShares<'static>,
}

impl Context {
    /// A context of `threads` threads (0: one for each processor) at a SIMD level.
    ///
    /// # Errors
    /// [`ThreadError`] when the system gives no threads.
    pub fn new(threads: usize, level: Level) -> Result<Self, ThreadError> {
        Ok(Self::on(Executor::new(threads)?, level))
    }

    /// A context of the threads of a pool, and of whoever draws, at a SIMD level.
    #[must_use]
    pub fn on_pool(pool: Arc<ThreadPool>, level: Level) -> Self {
        Self::on(Executor::on_pool(pool), level)
    }

    /// A context that draws on the calling thread alone and measures what each job takes: see
    /// [`Context::take_timings`]. It divides work into jobs as for this many threads.
    #[must_use]
    pub fn profiling(threads: usize, level: Level) -> Self {
        Self::on(Executor::profiling(threads), level)
    }

    /// The context with so little memory for bins that small pictures meet its limits: for tests.
    #[doc(hidden)]
    #[must_use]
    pub fn with_small_bins(self) -> Self {
        let bin_limits = BinLimits::SMALL;
        Self { bin_limits, ..self }
    }

    fn on(executor: Executor, level: Level) -> Self {
        let memory = Mutex::new(vec![Memory::new(executor.threads())]);
        Self {
            level,
            executor,
            alone: Executor::alone(),
            bin_limits: BinLimits::DEFAULT,
            memory,
        }
    }

    /// Returns the time of each job since the last call, and clears it; empty unless the context
    /// was made for [profiling](Context::profiling).
    #[must_use]
    pub fn take_timings(&self) -> Vec<JobTimings> {
        self.executor.take_timings()
    }

    /// The SIMD level that kernels run at.
    #[must_use]
    pub fn level(&self) -> Level {
        self.level
    }

    /// Returns the number of threads that draw.
    #[must_use]
    pub fn threads(&self) -> usize {
        self.executor.threads()
    }

    /// Wakes the threads that draw, and keeps them awake while the value lives: for work of several
    /// steps, before it is prepared. Does nothing where they have other work, or too few
    /// processors.
    #[must_use]
    pub fn awake(&self) -> Awake {
        self.executor.awake()
    }

    /// The number of threads that run jobs at the same time: one where jobs are measured.
    #[must_use]
    pub fn concurrent_threads(&self) -> usize {
        self.executor.concurrent_threads()
    }

    /// Runs `work` for every item, on the threads that draw.
    pub fn for_each<T: Send>(&self, items: &mut [T], work: impl Fn(&mut T) + Sync) {
        self.executor.for_each_alone(items, work);
    }

    /// Draws a pass. Buffers that a draw lacks read as zeros.
    ///
    /// # Errors
    /// [`RenderPassError`] if a draw does not fit the target; nothing is drawn or cleared then. If
    /// the pass is [cancelled](RenderPassError::Cancelled), or
    /// [memory is short](RenderPassError::OutOfMemory), the target holds a part of it.
    pub fn render(
        &self,
        target: &mut RenderTarget,
        pass: &RenderPass<'_>,
    ) -> Result<Statistics, RenderPassError> {
        let needs = pass.check(&target.shape())?;
        self.render_layers(std::slice::from_mut(target), pass, needs)
    }

    /// Draws a pass whose draws were [checked](crate::DrawChecker), which said what they need, into
    /// the layers of a target, which have one shape. Draws without a geometry shader that selects a
    /// layer are drawn into the first.
    ///
    /// # Errors
    /// As [`Context::render`], but for draws that do not fit: what they draw is not defined.
    pub fn render_layers(
        &self,
        layers: &mut [RenderTarget],
        pass: &RenderPass<'_>,
        needs: DrawNeeds,
    ) -> Result<Statistics, RenderPassError> {
        for target in layers.iter() {
            pass.check_loads(&target.shape())?;
            debug_assert!(
                pass.check(&target.shape()).is_ok(),
                "draws that were checked"
            );
        }
        let kept = || self.memory.lock().unwrap_or_else(PoisonError::into_inner);
        let memory = kept().pop();
        let mut memory = memory.unwrap_or_else(|| Memory::new(self.executor.threads()));
        let drawn = match layers {
            [target] if !needs.amplification => {
                let executor = self.executor_for(needs.one_thread);
                self.render_checked(executor, target, pass, &mut memory)
            }
            layers => self.render_amplified(layers, pass, &mut memory),
        };
        kept().push(memory);
        drawn
    }

    /// Draws a pass of plain draws that was checked.
    pub(crate) fn render_checked(
        &self,
        executor: &Executor,
        target: &mut RenderTarget,
        pass: &RenderPass<'_>,
        memory: &mut Memory,
    ) -> Result<Statistics, RenderPassError> {
        let mut statistics = Statistics::default();
        for resolve in &mut target.resolves {
            resolve.is_done = false;
        }
        for rows in &mut target.rows {
            rows.is_done = false;
        }
        target.divide_for(executor.threads(), pass.draws.has_few_elements());
        let parts = std::mem::take(&mut memory.lists.parts);
        let parts = parts.into_iter().map(DrawBatch::recycled).collect();
        let mut cursor = DrawCursor::new(pass.draws, self.level, parts);
        let mut batch = std::mem::take(&mut memory.lists.batch).recycled();
        let mut drawing = Drawing {
            pass,
            clear: Clear::new(target, pass),
            target,
        };
        let mut is_cancelled = false;
        loop {
            let (start, drawn_before) = (Instant::now(), statistics.raster);
            batch.clear();
            let tiles = drawing.target.grid().tiles();
            let mut chunks = memory.begin_chunks(tiles, executor.threads());
            while chunks.bins.spans < self.bin_limits.spans
                && let Some(group) = cursor.next_group(executor, drawing.target, &mut batch)
            {
                is_cancelled = pass.control.is_cancelled();
                if is_cancelled {
                    break;
                }
                self.shade_vertices(executor, (&batch, group), memory);
                statistics.groups_of_geometry += 1;
                statistics +=
                    self.build_group(executor, &mut drawing, (&batch, &mut chunks), memory)?;
            }
            if batch.sub_draws.is_empty() {
                if drawing.clear.is_done() {
                    break;
                }
                is_cancelled = pass.control.is_cancelled();
            }
            if is_cancelled {
                break;
            }
            let drawn = statistics.raster.saturating_sub(drawn_before);
            statistics.geometry += start.elapsed().saturating_sub(drawn);
            let is_last = cursor.is_at_end();
            statistics +=
                self.draw_batch(executor, &mut drawing, (&batch, chunks, is_last), memory)?;
            statistics.vertices_shaded += batch.shaded as u64;
            statistics.primitives_in += batch.invisible_primitives;
            statistics.primitives_culled += batch.invisible_primitives;
            pass.control
                .report(pass.draws.len() - cursor.draws_left(), pass.draws.len());
        }
        memory.lists.batch = batch.recycled();
        let parts = cursor.into_memory().into_iter();
        memory.lists.parts = parts.map(DrawBatch::recycled).collect();
        if is_cancelled {
            return Err(RenderPassError::Cancelled);
        }
        Ok(statistics)
    }

    /// Makes the chunks that are planned, and draws them whenever the bins are full.
    fn build_group(
        &self,
        executor: &Executor,
        drawing: &mut Drawing<'_>,
        (batch, chunks): (&DrawBatch<'_>, &mut BatchChunks),
        memory: &mut Memory,
    ) -> Result<Statistics, RenderPassError> {
        let mut statistics = Statistics::default();
        let (grid, samples) = (drawing.target.grid(), drawing.target.samples() as usize);
        // As many primitives at a time as cannot take more than the memory of a batch.
        let primitives = self.bin_limits.spans / grid.most_spans();
        let all = memory.chunk_plan.len();
        let mut planned = 0..0;
        while planned.end < all {
            if chunks.bins.spans >= self.bin_limits.spans {
                if drawing.pass.control.is_cancelled() {
                    return Err(RenderPassError::Cancelled);
                }
                statistics +=
                    self.draw_batch(executor, drawing, (batch, *chunks, false), memory)?;
                *chunks = memory.begin_chunks(grid.tiles(), executor.threads());
            }
            planned = planned.end..memory.chunk_plan.end_of_some(planned.end, primitives);
            let places = (planned.clone(), chunks.count);
            let built = self.build_chunks(executor, batch, samples, places, memory);
            chunks.count += planned.len();
            chunks.bins += built.bins;
            statistics += built.statistics;
        }
        Ok(statistics)
    }

    /// Draws the chunks of a batch so far; `is_last` says that nothing is drawn after them.
    fn draw_batch(
        &self,
        executor: &Executor,
        drawing: &mut Drawing<'_>,
        (batch, chunks, is_last): (&DrawBatch<'_>, BatchChunks, bool),
        memory: &mut Memory,
    ) -> Result<Statistics, RenderPassError> {
        let start = Instant::now();
        let Drawing {
            pass,
            clear,
            target,
        } = drawing;
        // What a batch before has drawn is in the images: nothing is cleared then.
        let discards = if is_last {
            clear.cleared(pass.discards, target)
        } else {
            Discards::default()
        };
        let taken = target.take_memory(discards);
        let given = taken.map_err(out_of_memory)?;
        let streams = match is_last && target.samples() > 1 {
            true => clear.cleared(Discards::ALL, target).without(discards),
            false => Discards::default(),
        };
        let attachments = TileAttachments {
            target,
            clear,
            is_last,
            discards,
            streams,
        };
        let queries = pass.occlusion_queries;
        let mut statistics =
            self.draw_tiles(executor, (attachments, queries), (batch, chunks), memory)?;
        statistics.batches += 1;
        statistics.images_given_memory += given;
        statistics.raster += start.elapsed();
        *clear = Clear::default();
        Ok(statistics)
    }

    /// The threads.
    pub(crate) fn executor(&self) -> &Executor {
        &self.executor
    }

    /// The threads that may draw draws.
    pub(crate) fn executor_of(&self, draws: &[Draw<'_>]) -> &Executor {
        let stores_in_order = |draw: &Draw<'_>| draw.pipeline.key().stores_in_order;
        self.executor_for(draws.iter().any(stores_in_order))
    }

    fn executor_for(&self, one_thread: bool) -> &Executor {
        if one_thread {
            &self.alone
        } else {
            &self.executor
        }
    }
}

fn out_of_memory(bytes: u64) -> RenderPassError {
    RenderPassError::OutOfMemory { bytes }
}
