//! The geometry side of a pass: vertices are shaded, then primitives become chunks.

use super::vertex_runs::{VertexJobs, VertexRuns};
use super::{Context, Memory};
use crate::bounds::bin_limits::BinSizes;
use crate::bounds::chunk::Chunk;
use crate::bounds::slabs::Expected;
use crate::geometry::chunk::{ChunkScratch, Neighbours, add_part};
use crate::geometry::shading::shade;
use crate::plan::chunk_plan::{ChunkPart, VERTEX_CHUNK, part_size};
use crate::plan::draw_batch::DrawBatch;
use crate::recycle::recycled;
use crate::schedule::{Executor, lock};
use crate::statistics::Statistics;
use std::ops::Range;
use std::sync::Mutex;

/// A chunk, and the primitives that it takes.
#[derive(Debug)]
pub(super) struct ChunkJob<'a> {
    chunk: &'a mut Chunk,
    parts: &'a [ChunkPart],
    /// The tiles that the chunk reaches, one bit each.
    reached: &'a mut [u64],
}

/// Chunks that were made.
#[derive(Debug, Default)]
pub(super) struct Built {
    pub(super) bins: BinSizes,
    pub(super) statistics: Statistics,
}

/// Sub-draws of a group beyond which one thread divides their primitives while others shade
/// vertices: of fewer this takes no longer than to wake a thread.
const MANY_SUB_DRAWS: usize = 512;

impl Context {
    /// Geometry, first half: every vertex of a group of sub-draws is shaded once and taken to the
    /// window, and their primitives are divided among chunks.
    pub(super) fn shade_vertices(
        &self,
        executor: &Executor,
        (batch, group): (&DrawBatch<'_>, Range<usize>),
        memory: &mut Memory,
    ) {
        memory.vertices.resize_for(&batch.group);
        // Groups grow with the threads.
        let threads = self.executor.threads();
        let is_job = executor.threads() > 1 && group.len() > MANY_SUB_DRAWS;
        if !is_job {
            memory.chunk_plan.build((batch, group.clone()), threads);
        }
        let size = part_size(batch.group.count, executor.threads(), VERTEX_CHUNK);
        let out = memory.vertices.of_group_mut(&batch.group);
        let sub_draws = (&batch.group, (&batch.sub_draws, group.clone()));
        let jobs = VertexJobs {
            plan: is_job.then_some(&mut memory.chunk_plan),
            runs: VertexRuns::new(sub_draws, size, out),
        };
        executor.for_each_worker(jobs, &memory.shading, |next, scratch| {
            while let Some(VertexJobs { plan, runs }) = next() {
                if let Some(plan) = plan {
                    plan.build((batch, group.clone()), threads);
                }
                for mut part in runs.parts() {
                    let source = part.sub_draw.vertex_source(batch.listed(part.sub_draw));
                    let transform = &batch.plan(part.sub_draw).transform;
                    let first = part.first;
                    shade(
                        self.level,
                        &source,
                        transform,
                        first,
                        &mut part.out,
                        scratch,
                    );
                }
            }
        });
    }

    /// Geometry, second half: primitives are assembled, culled, clipped, set up and binned, in
    /// some chunks of the plan. Where a chunk ends changes no result. They come behind `before`
    /// others.
    pub(super) fn build_chunks(
        &self,
        executor: &Executor,
        batch: &DrawBatch<'_>,
        samples: usize,
        (planned, before): (Range<usize>, usize),
        memory: &mut Memory,
    ) -> Built {
        let count = planned.len();
        if memory.chunks.len() < before + count {
            memory.chunks.resize_with(before + count, Chunk::default);
        }
        let mut jobs: Vec<ChunkJob<'_>> = recycled(std::mem::take(&mut memory.lists.chunk_jobs));
        let chunks = memory.chunks[before..].iter_mut();
        let plan = memory.chunk_plan.chunks();
        let chunks = chunks.zip(plan.skip(planned.start));
        let chunks = chunks.zip(memory.chunk_index.add(count));
        jobs.extend(chunks.map(|((chunk, parts), reached)| ChunkJob {
            chunk,
            parts,
            reached,
        }));
        let vertices = &memory.vertices;
        let (level, limits) = (self.level, self.bin_limits);
        let slabs = &memory.chunk_slabs;
        let chunks_of_thread = count.div_ceil(executor.threads());
        let costs = memory.tile_costs.entries();
        let build = |job: &mut ChunkJob<'_>, scratch: &mut ChunkScratch| {
            let expected = batch.packets(job.parts).map(|most| Expected {
                most,
                // Chunks are about as large as one another.
                share: most * chunks_of_thread,
            });
            job.chunk.open(slabs, expected);
            job.chunk.bins.borrow(&mut scratch.entries);
            let mut joins_last = false;
            for (at, part) in job.parts.iter().enumerate() {
                let sub_draw = &batch.sub_draws[part.sub_draw as usize];
                let next = job.parts.get(at + 1);
                let joins_next = next.is_some_and(|next| {
                    batch.joins([part.sub_draw, next.sub_draw], level, samples)
                });
                let (plan, vertices) = (batch.plan(sub_draw), vertices.of_span(&sub_draw.span));
                let vertices = (vertices, batch.listed(sub_draw));
                let work = sub_draw.run_work(level, plan, vertices, part.primitives);
                let neighbours = Neighbours {
                    joins_last,
                    joins_next,
                };
                add_part(part.sub_draw, &work, neighbours, job.chunk, scratch);
                joins_last = joins_next;
            }
            scratch.statistics += std::mem::take(&mut job.chunk.statistics);
            let sizes = job.chunk.sort_bins(limits, (job.reached, costs));
            job.chunk.bins.give_back(&mut scratch.entries);
            job.chunk.close(slabs);
            sizes
        };
        let built = Mutex::new(Built::default());
        executor.for_each_worker(&mut jobs[..], &memory.chunk_scratch, |next, scratch| {
            let mut bins = BinSizes::default();
            while let Some(jobs) = next() {
                for job in jobs {
                    bins += build(job, scratch);
                }
            }
            let mut built = lock(&built);
            built.bins += bins;
            built.statistics += std::mem::take(&mut scratch.statistics);
        });
        memory.lists.chunk_jobs = recycled(jobs);
        std::mem::take(&mut *lock(&built))
    }
}
