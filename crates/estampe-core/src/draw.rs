//! The page on which the pipeline reads: what a draw is, and the order in which its stages run.

use crate::attachment::RenderTarget;
use crate::attachment::resolve::ResolveJob;
use crate::commands::{LoadOp, OcclusionQueries, RenderPass};
use crate::geometry::assembly::ElementSource;
use crate::geometry::binning::BinState;
use crate::geometry::chunk::{ChunkScratch, ChunkWork, process};
use crate::geometry::cull::CullState;
use crate::geometry::line_style::{LineRun, LineStyle};
use crate::geometry::shading::{ShadedVertices, ShadingScratch, shade};
use crate::layout::texel_words;
use crate::per_sample::texel::TexelCodec;
use crate::raster::general::sample_range;
use crate::recording::Phase;
use crate::schedule::{Executor, ThreadError};
use crate::statistics::Statistics;
use crate::tile_pass::{self, AnyTileScratch, Clear, TileItem, TileJob, TilePass, TileScratch};
use crate::tiles::{Chunk, ChunkIndex};
use crate::wave::{Item, VertexJob, Waves, is_line_strip};
use estampe_simd::Level;
use estampe_types::DepthTexture;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

/// What draws need besides their data: threads, a SIMD level, and memory that is used again.
#[derive(Debug)]
pub struct Context {
    level: Level,
    executor: Executor,
    memory: Mutex<Memory>,
}

/// Memory of a pass, kept for the next one: a frame like the one before allocates nothing.
#[derive(Debug, Default)]
struct Memory {
    lists: Lists,
    vertices: ShadedVertices,
    chunks: Vec<Chunk>,
    chunk_index: ChunkIndex,
    shading: Vec<Mutex<ShadingScratch>>,
    chunk_scratch: Vec<Mutex<ChunkScratch>>,
    tiles_1: Vec<Mutex<TileScratch<1>>>,
    tiles_4: Vec<Mutex<TileScratch<4>>>,
    tiles_any: Vec<Mutex<AnyTileScratch>>,
}

/// Lists whose elements borrow from a pass, empty between passes: see [`recycled`].
#[derive(Debug, Default)]
struct Lists {
    items: Vec<Item<'static>>,
    vertex_jobs: Vec<VertexJob<'static>>,
    chunk_jobs: Vec<ChunkJob<'static>>,
    tile_items: Vec<TileItem<'static>>,
    tile_jobs: Vec<TileJob<'static>>,
}

/// An empty list in the memory of another one, whose elements differ in a lifetime alone. (The standard
/// library collects in place where sizes agree; if it did not, this would only be slower.)
fn recycled<A, B>(mut list: Vec<A>) -> Vec<B> {
    list.clear();
    let none = |_| unreachable!("the list was cleared");
    list.into_iter().map(none).collect()
}

/// The primitives of a chunk.
#[derive(Debug)]
struct ChunkJob<'a> {
    chunk: &'a mut Chunk,
    item: usize,
    primitives: [u32; 2],
}

impl Context {
    /// A context of `threads` threads (0: one for each processor) at a SIMD level.
    ///
    /// # Errors
    /// [`ThreadError`] when the system gives no threads.
    pub fn new(threads: usize, level: Level) -> Result<Self, ThreadError> {
        Ok(Self::on(Executor::new(threads)?, level))
    }

    /// A context that draws on the calling thread alone and notes what each job took: see
    /// [`Context::take_phases`].
    #[must_use]
    pub fn recording(level: Level) -> Self {
        Self::on(Executor::recording(), level)
    }

    fn on(executor: Executor, level: Level) -> Self {
        let mut memory = Memory::default();
        let workers = executor.threads();
        memory.shading.resize_with(workers, Mutex::default);
        memory.chunk_scratch.resize_with(workers, Mutex::default);
        memory.tiles_1.resize_with(workers, Mutex::default);
        memory.tiles_4.resize_with(workers, Mutex::default);
        memory.tiles_any.resize_with(workers, Mutex::default);
        Self {
            level,
            executor,
            memory: Mutex::new(memory),
        }
    }

    /// What each job took since the last call; nothing unless the context is one that
    /// [records](Context::recording).
    #[must_use]
    pub fn take_phases(&self) -> Vec<Phase> {
        self.executor.take_phases()
    }

    /// The SIMD level that kernels run at.
    #[must_use]
    pub fn level(&self) -> Level {
        self.level
    }

    /// How many threads draw.
    #[must_use]
    pub fn threads(&self) -> usize {
        self.executor.threads()
    }

    /// Draws a pass. It cannot fail: what a draw lacks reads as zeros, and a draw whose pipeline does
    /// not fit the target (samples, formats, depth), or whose viewport is not finite, draws nothing.
    pub fn render(&self, target: &mut RenderTarget, pass: &RenderPass<'_>) -> Statistics {
        let mut memory = self.memory.lock().unwrap_or_else(PoisonError::into_inner);
        let memory = &mut *memory;
        let mut statistics = Statistics::default();
        let mut waves = Waves::new(pass.draws);
        let mut items = recycled(std::mem::take(&mut memory.lists.items));
        let mut clear = Clear::new(target, pass);
        loop {
            let start = Instant::now();
            let more = waves.next_wave(&self.executor, target, &mut items);
            if !more && clear.is_done() {
                break;
            }
            self.shade_vertices(&items, memory);
            let chunks = self.build_chunks(target, &items, memory);
            statistics.geometry += start.elapsed();
            let start = Instant::now();
            statistics += self.draw_tiles(
                target,
                &items,
                chunks,
                (&clear, pass.occlusion_queries),
                memory,
            );
            statistics.raster += start.elapsed();
            let shaded = items.iter().map(Item::total_vertices).sum::<usize>();
            statistics.vertices_shaded += shaded as u64;
            clear = Clear::default();
        }
        memory.lists.items = recycled(items);
        statistics
    }

    /// Writes the mean of each pixel's samples to a target of one sample, of the same size and with the
    /// same colour formats. Targets that do not fit together are left alone.
    pub fn resolve(&self, from: &RenderTarget, into: &mut RenderTarget) {
        let mut jobs = ResolveJob::all(from, into);
        let memory = self.memory.lock().unwrap_or_else(PoisonError::into_inner);
        self.executor
            .for_each(&mut jobs, &memory.chunk_scratch, |job, _| job.run());
    }

    /// The target's depth as a texture, without a copy; `None` without depth or with several samples.
    pub fn depth_texture(&self, target: &mut RenderTarget) -> Option<DepthTexture> {
        let memory = self.memory.lock().unwrap_or_else(PoisonError::into_inner);
        target.depth_texture(|jobs| {
            self.executor
                .for_each(jobs, &memory.chunk_scratch, |job, _| job.run());
        })
    }

    /// Geometry, first half: every vertex of the wave is shaded once.
    fn shade_vertices(&self, items: &[Item<'_>], memory: &mut Memory) {
        memory.vertices.resize_for(items);
        let mut jobs = recycled(std::mem::take(&mut memory.lists.vertex_jobs));
        memory.vertices.split(items, VERTEX_CHUNK, &mut jobs);
        self.executor
            .for_each(&mut jobs, &memory.shading, |job, scratch| {
                let item = &items[job.item];
                let source = item.vertex_source();
                let pipeline = item.draw.pipeline;
                let out = (&mut job.out, scratch);
                shade(
                    self.level,
                    pipeline,
                    &source,
                    &item.transform,
                    job.first,
                    out,
                );
            });
        memory.lists.vertex_jobs = recycled(jobs);
    }

    /// Geometry, second half: primitives are assembled, culled, clipped, set up and binned, in chunks
    /// whose borders do not depend on the number of threads.
    fn build_chunks(
        &self,
        target: &RenderTarget,
        items: &[Item<'_>],
        memory: &mut Memory,
    ) -> usize {
        let total = |item: &Item<'_>| u32::try_from(item.total_primitives()).unwrap_or(u32::MAX);
        let count = |item: &Item<'_>| total(item).div_ceil(item.chunk_primitives()) as usize;
        let used = items.iter().map(count).sum();
        if memory.chunks.len() < used {
            memory.chunks.resize_with(used, Chunk::default);
        }
        let mut jobs: Vec<ChunkJob<'_>> = recycled(std::mem::take(&mut memory.lists.chunk_jobs));
        let mut chunks = memory.chunks.iter_mut();
        for (item, total) in items.iter().map(total).enumerate() {
            let size = items[item].chunk_primitives();
            let starts = (0..total).step_by(size as usize);
            jobs.extend(starts.zip(&mut chunks).map(|(from, chunk)| ChunkJob {
                chunk,
                item,
                primitives: [from, from.saturating_add(size).min(total)],
            }));
        }
        let (grid, vertices) = (target.grid(), &memory.vertices);
        let samples = target.samples() as usize;
        self.executor
            .for_each(&mut jobs, &memory.chunk_scratch, |job, scratch| {
                let item = &items[job.item];
                let state = &item.draw.pipeline.descriptor().primitive;
                let sample_range = sample_range(samples, state.conservative);
                let is_listed = item.sparse.is_some() || item.restarted.is_some();
                let indices = item.draw.indices.filter(|_| !is_listed);
                let work = ChunkWork {
                    elements: ElementSource {
                        topology: state.topology,
                        provoking: state.provoking_vertex,
                        restarted: item.restarted.as_deref(),
                        elements: item.elements[1],
                        indices,
                        first_element: item.elements[0],
                        first_vertex: item.first_vertex,
                        base_vertex: item.draw.base_vertex,
                    },
                    vertices: vertices.of_item(item),
                    source: &item.vertex_source(),
                    pipeline: item.draw.pipeline,
                    transform: &item.transform,
                    cull: CullState {
                        rect: item.rect,
                        facing: item.facing,
                        sample_range,
                    },
                    bins: BinState {
                        grid,
                        rect: item.rect,
                        sample_range,
                    },
                    polygon_mode: state.polygon_mode,
                    depth_bias: item.depth_bias,
                    lines: LineRun {
                        style: LineStyle::new(&state.line),
                        is_strip: is_line_strip(state.topology),
                        restarts: &item.line_restarts,
                    },
                    instance_vertices: item.vertices,
                    instance_primitives: item.primitives,
                    primitives: job.primitives,
                };
                job.chunk.reset(job.item);
                process(self.level, &work, job.chunk, scratch);
            });
        memory.lists.chunk_jobs = recycled(jobs);
        used
    }

    /// The tile side: every tile consumes the chunks in order.
    fn draw_tiles(
        &self,
        target: &mut RenderTarget,
        items: &[Item<'_>],
        chunks: usize,
        (clear, occlusion_queries): (&Clear, Option<&OcclusionQueries>),
        memory: &mut Memory,
    ) -> Statistics {
        let chunks = &memory.chunks[..chunks];
        memory.chunk_index.build(target.grid().tiles(), chunks);
        let mut tile_items = recycled(std::mem::take(&mut memory.lists.tile_items));
        tile_items.extend(items.iter().map(|item| {
            memory
                .vertices
                .tile_item(item, target, occlusion_queries.is_some())
        }));
        let pass = TilePass {
            level: self.level,
            grid: target.grid(),
            items: &tile_items,
            chunks,
            chunk_index: &memory.chunk_index,
            clear: *clear,
            samples: target.samples() as usize,
            occlusion_queries,
        };
        let samples = target.samples();
        let mut jobs = recycled(std::mem::take(&mut memory.lists.tile_jobs));
        tile_jobs(target, &mut jobs);
        let mut statistics = Statistics::default();
        if !matches!(samples, 1 | 4) {
            self.executor
                .for_each(&mut jobs, &memory.tiles_any, |job, scratch| {
                    tile_pass::draw_any(&pass, job, scratch);
                });
            for worker in &mut memory.tiles_any {
                let worker = worker.get_mut().unwrap_or_else(PoisonError::into_inner);
                statistics += std::mem::take(&mut worker.statistics);
            }
        } else if samples == 1 {
            self.executor
                .for_each(&mut jobs, &memory.tiles_1, |job, scratch| {
                    tile_pass::draw(&pass, job, scratch);
                });
            take_statistics(&mut memory.tiles_1, &mut statistics);
        } else {
            self.executor
                .for_each(&mut jobs, &memory.tiles_4, |job, scratch| {
                    tile_pass::draw(&pass, job, scratch);
                });
            take_statistics(&mut memory.tiles_4, &mut statistics);
        }
        for chunk in chunks {
            statistics += chunk.statistics;
        }
        memory.lists.tile_jobs = recycled(jobs);
        memory.lists.tile_items = recycled(tile_items);
        statistics
    }
}

/// Vertices that one worker shades at a time.
const VERTEX_CHUNK: usize = 4096;

impl Clear {
    fn new(target: &RenderTarget, pass: &RenderPass<'_>) -> Self {
        let mut clear = Self::default();
        let formats = target.color_formats().iter();
        for (index, (color, format)) in clear.colors.iter_mut().zip(formats).enumerate() {
            let load = pass.load_colors.get(index);
            if let LoadOp::Clear(rgba) = load.copied().unwrap_or(LoadOp::Clear([0.0; 4])) {
                let codec = TexelCodec::new(*format);
                *color = Some((codec.clear_words(rgba), codec.words));
            }
        }
        // Depths are kept in 0..=1, NaN as 0: hierarchical depth relies on their order.
        if let (LoadOp::Clear(depth), true) = (pass.load_depth, target.has_depth()) {
            let confined = if depth > 0.0 { depth.min(1.0) } else { 0.0 };
            clear.depth = Some(target.depth_format().stored(confined));
        }
        if let (LoadOp::Clear(stencil), true) = (pass.load_stencil, target.has_stencil()) {
            clear.stencil = Some(stencil);
        }
        clear
    }

    fn is_done(&self) -> bool {
        self.colors.iter().all(Option::is_none) && self.depth.is_none() && self.stencil.is_none()
    }
}

/// Cuts a target into its tiles' slices.
fn tile_jobs<'a>(target: &'a mut RenderTarget, jobs: &mut Vec<TileJob<'a>>) {
    let grid = target.grid();
    let elements = grid.tile_pixels() * target.samples() as usize;
    let formats = target.descriptor.color_formats.iter();
    jobs.extend((0u32..).take(grid.tiles()).map(|tile| TileJob {
        tile,
        ..TileJob::default()
    }));
    for (index, (colors, format)) in target.colors.iter_mut().zip(formats).enumerate() {
        let elements = elements * texel_words(*format);
        for (job, slice) in jobs.iter_mut().zip(colors.chunks_exact_mut(elements)) {
            job.colors[index] = slice;
        }
    }
    for (job, slice) in jobs
        .iter_mut()
        .zip(target.stencil.chunks_exact_mut(elements))
    {
        job.stencil = slice;
    }
    let depth = Arc::make_mut(&mut target.depth);
    for (job, slice) in jobs.iter_mut().zip(depth.chunks_exact_mut(elements)) {
        job.depth = slice;
    }
}

fn take_statistics<const N: usize>(scratch: &mut [Mutex<TileScratch<N>>], total: &mut Statistics) {
    for worker in scratch {
        let worker = worker.get_mut().unwrap_or_else(PoisonError::into_inner);
        *total += std::mem::take(&mut worker.statistics);
    }
}
