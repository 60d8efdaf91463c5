//! The visibility path: first which triangle each sample shows, then one shading of each visible
//! sample.
//!
//! If a shader neither discards nor writes depth and colours replace the stored ones, only the last
//! triangle that passes its tests at a sample matters. So the visibility pass tests the triangles
//! of all such draws in a row, and each writes its *visibility ID* where it passes (Burns and Hunt,
//! The Visibility Buffer, 2013). When another path follows, or the tile ends, the run is resolved:
//! every sample is shaded once.
//!
//! ```text
//!   chunk ─▶ rasterize (coverage, hierarchical z) ─▶ writer (tests, ids) ──┐   one run: many
//!                └─ small triangles, sixteen at a time                     │   chunks, many draws
//!                                                                          ▼
//!                                              buffer: ids, unresolved samples
//!                                                                          ▼
//!                                              resolve: by pipeline, packets and quads
//! ```
//!
//! The IDs are stored in the first colour attachment itself if its texels are words of 32 bits, so
//! that a tile's working set stays two lines a packet; beside it for wider texels. Overdraw costs a
//! test, not a shader: `textured` took 29 ms without it, 9.4 with it.
//!
//! `shortcuts` holds optimisations for large triangles that fill whole blocks; each of them can be
//! deleted alone.

mod ahead;
mod buffer;
mod counting;
mod cross_triangle;
mod gathered;
mod lines;
mod parts;
mod quads;
mod rasterize;
mod resolve;
mod shortcuts;
mod small;
mod touched;
mod writer;

use super::{TileJob, TilePass, TileScratch, TileWork, clear_blocks};
use crate::bounds::bins::BinEntry;
use crate::fragment::queue::packets_of_visibility;
use crate::raster::CoverageList;
use crate::raster::packet_edges::PacketEdges;
use crate::raster::pixel_list::PixelList;
use crate::raster::small::SmallBoxes;
use crate::tile_path::TilePath;
use buffer::VisibilityBuffer;
use cross_triangle::CrossTriangleScratch;
use resolve::ResolveScratch;

pub(super) use ahead::Ahead;
pub(super) use lines::takes_lines;
pub(super) use resolve::resolve;

/// Triangles of a run in one tile, at most (a chunk's more): their planes should stay in the cache.
const MAX_RUN: usize = 8192;

/// Kernels of this path have no scalar form: sixteen scalar lanes took the compiler many minutes.
const ONLY_WIDE: &str = "the scalar level draws in order";

/// Memory of one worker.
#[derive(Debug)]
pub(super) struct VisibilityScratch<const N: usize> {
    list: CoverageList<N>,
    buffer: VisibilityBuffer<N>,
    small: SmallBoxes<N>,
    pixels: PixelList,
    edges: PacketEdges<N>,
    cross: CrossTriangleScratch,
    waiting: shortcuts::WaitingTriangles,
    resolve: ResolveScratch<N>,
}

impl<const N: usize> Default for VisibilityScratch<N> {
    fn default() -> Self {
        Self {
            list: CoverageList::default(),
            buffer: VisibilityBuffer::default(),
            small: SmallBoxes::default(),
            pixels: PixelList::default(),
            edges: PacketEdges::default(),
            cross: CrossTriangleScratch::default(),
            waiting: shortcuts::WaitingTriangles::default(),
            resolve: ResolveScratch::default(),
        }
    }
}

/// Adds the tile's triangles of one run of a chunk to the run of visibility.
pub(super) fn add<const N: usize>(
    pass: &TilePass<'_>,
    (work, entries): (&TileWork<'_>, &[BinEntry]),
    (job, ahead): (&mut TileJob<'_>, &mut Ahead<'_>),
    scratch: &mut TileScratch<N>,
) {
    let visibility = &scratch.visibility;
    if visibility.buffer.triangles.len() > MAX_RUN || visibility.cross.texels() > MAX_RUN {
        resolve(pass, job, scratch);
    }
    scratch.visibility.list.set_samples(pass.sample_set());
    let buffer = &mut scratch.visibility.buffer;
    let may_wait = shortcuts::may_wait(work, entries);
    let first = match work.plan.path {
        // Nothing has an id.
        TilePath::VisibilityDepthOnly if !may_wait => buffer.next_id(),
        // Fragments of small triangles have ids of their own, and triangles seldom need one.
        TilePath::VisibilityCrossTriangle if !may_wait => {
            let first = buffer.next_id();
            buffer.end_sub_draw(work.sub_draw, first, pass.plans);
            first
        }
        _ => buffer.add((work.chunk, work.number), entries, pass.plans),
    };
    let key = work.plan.pipeline.key();
    buffer.has_one_color_draws |= key.has_colors && key.uniform_over_draw;
    if may_wait {
        ahead.skip(entries.len());
        let samples = pass.sample_set::<N>();
        let waiting = &mut scratch.visibility.waiting;
        if !waiting.add(work, entries, first, samples) {
            rasterize::rasterize_waiting(pass, job, scratch);
            let waiting = &mut scratch.visibility.waiting;
            let added = waiting.add(work, entries, first, samples);
            debug_assert!(added, "as many as may wait fit an empty list");
        }
        return;
    }
    rasterize::rasterize_waiting(pass, job, scratch);
    clear_blocks(pass, job, u16::MAX, scratch);
    let plan = work.plan;
    if plan.path == TilePath::VisibilityCrossTriangle {
        let range = plan.tests.stored.range;
        let queue = &mut scratch.queue;
        queue.configure(
            plan.pipeline,
            pass.sample_set(),
            range,
            (false, packets_of_visibility(plan.pipeline)),
        );
    }
    rasterize::rasterize(pass, (work, entries), first, (job, ahead), scratch);
}
