//! The page of the tile side: one tile, from its bins to its attachments.
//!
//! A worker owns the tile's slices of the attachments, clears them if the pass says so, and
//! consumes the chunks in submission order, so an image does not depend on which worker draws which
//! tile. A sub-draw's [path](TilePath) says how: opaque triangles go to the [visibility] path,
//! which runs on over draws; everything else is drawn [in order](in_order). Opaque lines over such
//! triangles are covered and tested there, too, and then join the run of visibility.

mod clear;
mod fragments;
mod in_order;
mod jobs;
mod next_tile;
mod tile_queue;
mod upcoming_runs;
mod visibility;
mod worker_tile;

pub(crate) use clear::Clear;
pub(crate) use jobs::TileJobs;
pub(crate) use tile_queue::{TileQueue, TileShares};
pub(crate) use worker_tile::TileWords;

use crate::attachment::resolve::ResolveJob;
use crate::attachment::{RowsPlace, StoredBounds, StoredRows};
use crate::bounds::bins::BinEntry;
use crate::bounds::chunk::{Chunk, ChunkPackets, Packets};
use crate::bounds::chunk_index::ChunkIndex;
use crate::bounds::pixel_rect::PixelRect;
use crate::commands::{Discards, OcclusionQueries};
use crate::fragment::interpolate::VaryingSource;
use crate::fragment::queue::{FragmentQueue, ShadedBatch};
use crate::layout::TileGrid;
use crate::per_sample::color_writer::ColorWriter;
use crate::per_sample::hiz::HierarchicalZ;
use crate::plan::tile_plan::TilePlan;
use crate::raster::{MAX_PACKETS, SampleSet, TileShape};
use crate::segments::Segments;
use crate::statistics::Statistics;
use estampe_simd::{LANES, Level, Stream, dispatch, outline};
use estampe_types::TextureFormat;
use in_order::FragmentsTo;
use next_tile::NextTile;
use worker_tile::WorkerTile;

/// The most colour targets of a pass.
pub(crate) const MAX_TARGETS: usize = 8;

/// Packets of a tile, one bit each.
type PacketSet = [u64; MAX_PACKETS / 64];

/// Boxes of fewer packets than this are not worth asking hierarchical z for.
const HIZ_PACKETS: i32 = 16;

/// Data that every tile of a pass shares.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TilePass<'a> {
    pub(crate) level: Level,
    pub(crate) grid: TileGrid,
    /// The pixels of the attachments, which end before the tiles at the right and below do.
    pub(crate) target: PixelRect,
    /// By sub-draw.
    pub(crate) plans: &'a Segments<TilePlan<'a>>,
    pub(crate) chunks: &'a [Chunk],
    /// The packets of these chunks.
    pub(crate) packets: ChunkPackets<'a>,
    /// The chunks that reach each tile.
    pub(crate) chunk_index: &'a ChunkIndex,
    /// The values that attachments are cleared to first.
    pub(crate) clear: Clear,
    pub(crate) samples: usize,
    pub(crate) occlusion_queries: Option<&'a OcclusionQueries>,
    /// The attachments of which workers keep one tile each, and what they keep of it.
    pub(crate) in_workers: Discards,
    pub(crate) worker_words: &'a TileWords,
    /// Those of them that are stored when a tile is drawn.
    pub(crate) streams: Discards,
    /// By colour attachment: the format, if it is resolved when the tile is drawn.
    pub(crate) resolved: [Option<TextureFormat>; MAX_TARGETS],
    /// The images in row order that tiles are stored to.
    pub(crate) rows: &'a [RowsPlace],
}

/// What all tiles of a pass store to when they are drawn, while they are in the cache.
#[derive(Debug, Default)]
pub(crate) struct TileStores<'a> {
    /// Images in row order of colours.
    pub(crate) rows: Vec<StoredRows<'a>>,
    /// The bounds of depths.
    pub(crate) bounds: Option<StoredBounds<'a>>,
}

impl TilePass<'_> {
    /// The samples of a pixel.
    fn sample_set<const N: usize>(&self) -> SampleSet<N> {
        SampleSet::new(self.samples)
    }

    /// Returns true if no primitive reaches a tile.
    fn is_empty(&self, tile: u32) -> bool {
        self.chunk_index.is_empty(tile)
    }

    fn tile_shape(&self, tile: u32) -> TileShape {
        let (x, y) = self.grid.tile_origin(tile);
        TileShape {
            x: x.cast_signed(),
            y: y.cast_signed(),
            log2: self.grid.tile_log2(),
        }
    }
}

/// One tile's share of the attachments: packets of sixteen words, depths, stencil values.
#[derive(Debug, Default)]
pub(crate) struct TileJob<'a> {
    pub(crate) tile: u32,
    pub(crate) colors: [&'a mut [[u32; LANES]]; MAX_TARGETS],
    pub(crate) depth: &'a mut [[f32; LANES]],
    pub(crate) stencil: &'a mut [[u8; LANES]],
    /// The images that colours are resolved into.
    pub(crate) resolved: [&'a mut [u32]; MAX_TARGETS],
    /// The tile that the worker draws next.
    pub(crate) next: NextTile<'a>,
}

/// Memory of one worker, for `N` samples.
#[derive(Debug, Default)]
pub(crate) struct TileScratch<const N: usize> {
    queue: FragmentQueue<N>,
    /// Packets of one colour, while others wait in the queue.
    solid_queue: FragmentQueue<N>,
    hiz: HierarchicalZ,
    in_order: in_order::InOrderScratch<N>,
    visibility: visibility::VisibilityScratch<N>,
    tile: WorkerTile,
    /// The blocks of the tile that wait to be cleared, one bit each: where the first triangles of
    /// all replace what is there, they need not be.
    blocks_wait: u16,
    /// True if colours of the tile wait to be cleared.
    colors_wait: bool,
    statistics: Statistics,
}

/// Draws tiles that follow one another.
pub(crate) fn draw<'a, const N: usize>(
    (pass, stores): (&TilePass<'_>, &TileStores<'_>),
    mut jobs: TileJobs<'a>,
    scratch: &mut TileScratch<N>,
) {
    Stream::<'a>::with(pass.level, |stream| {
        while let Some(job) = jobs.take_tile() {
            // While nothing is drawn, nothing is prefetched.
            let next = match pass.is_empty(job.tile) {
                true => NextTile::default(),
                false => NextTile::of(pass, &jobs),
            };
            if pass.in_workers == Discards::default() {
                draw_into((pass, stores), &mut TileJob { next, ..job }, scratch);
            } else {
                draw_in_worker((pass, stores), (job, next), stream, scratch);
            }
        }
    });
}

/// Draws a tile, in the worker's memory in place of the attachments that the pass discards, and of
/// those that are stored afterwards.
fn draw_in_worker<'a, const N: usize>(
    (pass, stores): (&TilePass<'_>, &TileStores<'_>),
    (job, next): (TileJob<'a>, NextTile<'_>),
    stream: &mut Stream<'a>,
    scratch: &mut TileScratch<N>,
) {
    let mut tile = std::mem::take(&mut scratch.tile);
    let (mut in_tile, images) = tile.job((pass.in_workers, pass.worker_words), job);
    in_tile.next = next;
    draw_into((pass, stores), &mut in_tile, scratch);
    if pass.in_workers != pass.streams {
        scratch.statistics.tiles_in_workers += 1;
    }
    if pass.streams != Discards::default() {
        worker_tile::store(&in_tile, images, (pass.streams, stream));
        scratch.statistics.tiles_streamed += 1;
    }
    scratch.tile = tile;
}

/// Draws a tile into the attachments of its job.
fn draw_into<const N: usize>(
    (pass, stores): (&TilePass<'_>, &TileStores<'_>),
    job: &mut TileJob<'_>,
    scratch: &mut TileScratch<N>,
) {
    let is_empty = pass.is_empty(job.tile);
    if is_empty {
        pass.clear.tile::<N>(pass, job);
        scratch.statistics.tiles_only_cleared += 1;
    } else {
        draw_chunks(pass, job, scratch);
    }
    resolve_samples(pass, job, scratch);
    let origin = pass.grid.tile_origin(job.tile);
    for rows in &stores.rows {
        let texels = job.colors[rows.place.color].as_flattened();
        rows.store(pass.level, origin, texels);
        scratch.statistics.tiles_to_rows += 1;
    }
    if let Some(bounds) = &stores.bounds {
        match pass.clear.depth.filter(|_| is_empty) {
            Some(depth) => bounds.fill(origin, depth),
            None => bounds.find(pass.level, origin, job.depth.as_flattened()),
        }
        scratch.statistics.tiles_bounded += 1;
    }
}

/// Draws the runs of all chunks that reach a tile.
fn draw_chunks<const N: usize>(
    pass: &TilePass<'_>,
    job: &mut TileJob<'_>,
    scratch: &mut TileScratch<N>,
) {
    begin(pass, job, scratch);
    let mut ahead = in_order::Ahead::new(pass, job.tile);
    let mut packets_ahead = visibility::Ahead::new(pass, job.tile);
    for number in pass.chunk_index.of_tile(job.tile) {
        for (sub_draw, entries) in pass.chunks[number as usize].runs_of_tile(job.tile) {
            let work = TileWork::new(pass, [number, sub_draw], job.tile);
            scratch.count(&work, entries);
            if work.plan.path.is_visibility() {
                in_order::finish(pass, job, scratch);
                let job = (&mut *job, &mut packets_ahead);
                visibility::add(pass, (&work, entries), job, scratch);
            } else {
                let to = if visibility::takes_lines(pass, &work, job, scratch) {
                    FragmentsTo::Visibility
                } else {
                    visibility::resolve(pass, job, scratch);
                    clear_colors(pass, job, scratch);
                    FragmentsTo::Attachments
                };
                clear_blocks(pass, job, u16::MAX, scratch);
                let job = (&mut *job, &mut ahead);
                in_order::draw(pass, (&work, entries), to, job, scratch);
            }
        }
    }
    in_order::finish(pass, job, scratch);
    visibility::resolve(pass, job, scratch);
    clear_blocks(pass, job, u16::MAX, scratch);
    clear_colors(pass, job, scratch);
}

/// Resolves the colours of a tile that is drawn, while they are in the cache.
fn resolve_samples<const N: usize>(
    pass: &TilePass<'_>,
    job: &mut TileJob<'_>,
    scratch: &mut TileScratch<N>,
) {
    if const { N == 1 } {
        return;
    }
    let images = job.colors.iter().zip(&mut job.resolved);
    for (format, (samples, pixels)) in pass.resolved.iter().zip(images) {
        let Some(format) = *format else {
            continue;
        };
        let samples = samples.as_flattened();
        ResolveJob::of_tile(samples, pixels, format, pass.samples).run(pass.level);
        scratch.statistics.tiles_resolved += 1;
    }
}

fn begin<const N: usize>(pass: &TilePass<'_>, job: &mut TileJob<'_>, scratch: &mut TileScratch<N>) {
    pass.clear.stencil(job);
    scratch.blocks_wait = u16::MAX;
    let waiting = pass.clear.first_waiting::<N>();
    scratch.colors_wait = pass.clear.clears_colors_from(waiting);
    let tile = pass.tile_shape(job.tile);
    scratch.hiz.begin(tile, pass.clear.depth);
}

/// Clears those of some blocks of the tile that still wait for it.
fn clear_blocks<const N: usize>(
    pass: &TilePass<'_>,
    job: &mut TileJob<'_>,
    blocks: u16,
    scratch: &mut TileScratch<N>,
) {
    let blocks = scratch.blocks_wait & blocks;
    if blocks != 0 {
        scratch.blocks_wait &= !blocks;
        pass.clear.blocks::<N>(pass, job, blocks);
    }
}

/// Clears the colours of the tile that still wait for it.
fn clear_colors<const N: usize>(
    pass: &TilePass<'_>,
    job: &mut TileJob<'_>,
    scratch: &mut TileScratch<N>,
) {
    if std::mem::take(&mut scratch.colors_wait) {
        pass.clear.waiting_colors::<N>(pass, job, None);
    }
}

impl<const N: usize> TileScratch<N> {
    /// Takes memory for so much of a tile that a pass discards; `None` if it is short.
    pub(crate) fn make_room(&mut self, words: &TileWords) -> Option<()> {
        self.tile.make_room(words)
    }

    /// Ends a pass: what is known of its draws is forgotten. Gives what was counted.
    pub(crate) fn end_pass(&mut self) -> Statistics {
        self.in_order.end_pass();
        std::mem::take(&mut self.statistics)
    }

    /// Counts the primitives of a path.
    fn count(&mut self, work: &TileWork<'_>, entries: &[BinEntry]) {
        // As lane code, because processors without SIMD levels count bits in many steps.
        let count = dispatch!(work.level, s => outline!(s, {
            let counts = entries.iter().map(|entry| u64::from(entry.count()));
            counts.sum::<u64>()
        }));
        self.statistics.paths.add(work.plan.path, count);
    }
}

/// Writes shaded packets to the colour attachments.
fn write_colors(
    plan: &TilePlan<'_>,
    level: Level,
    batch: &ShadedBatch<'_>,
    colors: &mut [&mut [[u32; LANES]]; MAX_TARGETS],
) {
    let targets = plan.pipeline.color_targets().iter().zip(colors);
    for (target, stored) in targets {
        let writer = ColorWriter {
            target,
            index: target.output,
            constant: plan.blend_constant,
        };
        writer.write_batch(level, batch, stored);
    }
}

/// A run of a chunk in the tile at hand.
#[derive(Debug, Clone, Copy)]
struct TileWork<'a> {
    level: Level,
    chunk: &'a Chunk,
    packets: Packets<'a>,
    /// The chunk's number in the pass.
    number: u32,
    /// The number of its first sub-draw in the pass.
    sub_draw: u32,
    /// That sub-draw's plan. The others' bindings and varyings differ, nothing else.
    plan: &'a TilePlan<'a>,
    samples: usize,
    queries: Option<&'a OcclusionQueries>,
    shape: TileShape,
    /// The pixels that may change, in the tile's own pixels.
    rect: PixelRect,
    /// True if `rect` is the whole tile.
    is_whole: bool,
    /// The blocks of 16×16 pixels that lie in it, one bit each.
    blocks: u16,
}

impl<'a> TileWork<'a> {
    fn new(pass: &TilePass<'a>, [number, sub_draw]: [u32; 2], tile: u32) -> Self {
        let chunk = &pass.chunks[number as usize];
        let plan = &pass.plans[sub_draw as usize];
        let shape = pass.tile_shape(tile);
        let rect = shape.local(&plan.rect);
        Self {
            level: pass.level,
            chunk,
            packets: pass.packets.of(chunk),
            number,
            sub_draw,
            plan,
            samples: pass.samples,
            queries: pass.occlusion_queries,
            shape,
            rect,
            is_whole: shape.is_whole(&rect),
            blocks: shape.blocks_inside(&rect),
        }
    }

    /// The varyings of the sub-draw's vertices, and of the vertices that the chunk made by
    /// clipping.
    fn varyings(&self) -> VaryingSource<'a> {
        varyings_of(self.chunk, self.plan)
    }
}

/// The varyings of a sub-draw's vertices, and of the vertices that a chunk made by clipping.
fn varyings_of<'a>(chunk: &'a Chunk, plan: &TilePlan<'a>) -> VaryingSource<'a> {
    let interface = plan.pipeline.interface();
    VaryingSource {
        shaded: plan.varyings,
        clipped: &chunk.clipped_varyings,
        modes: &interface.varyings,
        gradients: &interface.gradients,
    }
}
