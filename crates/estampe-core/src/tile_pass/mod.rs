//! The page of the tile side: one tile, from its bins to its attachments.
//!
//! A worker owns the tile's slices of the attachments, clears them if the pass says so, and consumes the
//! chunks in submission order, so an image does not depend on who draws which tile. Most triangles are first
//! [seen and then shaded](deferred); what depends on order is drawn [in order](immediate).

mod deferred;
mod general;
mod immediate;

use crate::commands::{Draw, OcclusionQueries};
use crate::fragment::interpolate::VaryingSource;
use crate::fragment::queue::FragmentQueue;
use crate::geometry::viewport::PixelRect;
use crate::layout::TileGrid;
use crate::per_sample::color::ColorTarget;
use crate::per_sample::depth::DepthTest;
use crate::per_sample::depth_bounds::DepthBounds;
use crate::per_sample::general::DepthFormat;
use crate::per_sample::texel::MAX_WORDS;
use crate::pipeline::RenderPipeline;
use crate::raster::{CoverageList, TileShape};
use crate::statistics::Statistics;
use crate::tiles::{Chunk, ChunkIndex};
use estampe_simd::{LANES, Lanes, Level, SimdBase, dispatch, f32x16, u32x16};
use estampe_types::Bindings;

/// The most colour targets of a pass.
pub(crate) const MAX_TARGETS: usize = 8;

/// Boxes of fewer packets than this are not worth asking the depth bounds for.
const BOUNDED_PACKETS: i32 = 16;

/// An item of a wave as its fragments need it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TileItem<'a> {
    pub(crate) pipeline: &'a RenderPipeline,
    pub(crate) bindings: &'a Bindings,
    pub(crate) varyings: &'a [f32],
    pub(crate) rect: PixelRect,
    pub(crate) depth_range: [f32; 2],
    pub(crate) targets: [Option<ColorTarget>; MAX_TARGETS],
    pub(crate) all_smooth: bool,
    pub(crate) draw: &'a Draw<'a>,
    /// How the target stores depth.
    pub(crate) depth_format: DepthFormat,
    /// Whether its state, or the target's, is beyond the common paths.
    pub(crate) is_general: bool,
}

/// What every tile of a pass shares.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TilePass<'a> {
    pub(crate) level: Level,
    pub(crate) grid: TileGrid,
    pub(crate) items: &'a [TileItem<'a>],
    pub(crate) chunks: &'a [Chunk],
    /// Which of the chunks reach a tile.
    pub(crate) chunk_index: &'a ChunkIndex,
    /// What is cleared first.
    pub(crate) clear: Clear,
    pub(crate) samples: usize,
    pub(crate) occlusion_queries: Option<&'a OcclusionQueries>,
}

/// What a pass clears in each tile.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Clear {
    /// The words of a texel, by colour attachment, and how many there are.
    pub(crate) colors: [Option<([u32; MAX_WORDS], usize)>; MAX_TARGETS],
    pub(crate) depth: Option<f32>,
    pub(crate) stencil: Option<u8>,
}

/// One tile's share of the attachments.
#[derive(Debug, Default)]
pub(crate) struct TileJob<'a> {
    pub(crate) tile: u32,
    pub(crate) colors: [&'a mut [u32]; MAX_TARGETS],
    pub(crate) depth: &'a mut [f32],
    pub(crate) stencil: &'a mut [u8],
}

/// Memory of one worker, for `N` samples.
#[derive(Debug, Default)]
pub(crate) struct TileScratch<const N: usize> {
    list: CoverageList<N>,
    /// Planes of one triangle's varyings.
    planes: Vec<f32>,
    queue: FragmentQueue<N>,
    bounds: DepthBounds,
    deferred: deferred::Deferred<N>,
    general: general::GeneralScratch,
    pub(crate) statistics: Statistics,
}

/// Memory of one worker, for any number of samples: such targets have the general path alone.
#[derive(Debug, Default)]
pub(crate) struct AnyTileScratch {
    general: general::GeneralScratch,
    pub(crate) statistics: Statistics,
}

/// Draws a tile.
pub(crate) fn draw<const N: usize>(
    pass: &TilePass<'_>,
    job: &mut TileJob<'_>,
    scratch: &mut TileScratch<N>,
) {
    dispatch!(pass.level, s => clear(s, pass, job));
    scratch.bounds.begin(pass.clear.depth);
    for &number in pass.chunk_index.of_tile(job.tile) {
        let entries = pass.chunks[number as usize].bins.of_tile(job.tile);
        let work = ChunkInTile::new(pass, number, job);
        if work.item.is_general {
            deferred::shade_run(pass, job, scratch);
            let memory = (&mut scratch.general, &mut scratch.statistics);
            let samples = (N, pass.occlusion_queries);
            general::draw_chunk(&work, entries, samples, job, memory);
            scratch.bounds.invalidate(u16::MAX);
        } else if deferred::is_deferred(&work) {
            deferred::see_chunk(pass, (&work, entries), job, scratch);
        } else {
            deferred::shade_run(pass, job, scratch);
            dispatch!(pass.level, s => immediate::draw_chunk(s, &work, entries, job, scratch));
        }
    }
    deferred::shade_run(pass, job, scratch);
}

/// Draws a tile of any number of samples.
pub(crate) fn draw_any(pass: &TilePass<'_>, job: &mut TileJob<'_>, scratch: &mut AnyTileScratch) {
    dispatch!(pass.level, s => clear(s, pass, job));
    for &number in pass.chunk_index.of_tile(job.tile) {
        let entries = pass.chunks[number as usize].bins.of_tile(job.tile);
        let work = ChunkInTile::new(pass, number, job);
        let memory = (&mut scratch.general, &mut scratch.statistics);
        let samples = (pass.samples, pass.occlusion_queries);
        general::draw_chunk(&work, entries, samples, job, memory);
    }
}

/// Clears the tile's attachments, sixteen elements a store: `fill` is compiled for the least processor.
#[inline(always)]
fn clear<S: Lanes>(s: S, pass: &TilePass<'_>, job: &mut TileJob<'_>) {
    for (colors, color) in job.colors.iter_mut().zip(&pass.clear.colors) {
        let Some((words, count)) = color else {
            continue;
        };
        let lines = colors.as_chunks_mut::<LANES>().0;
        for (word, code) in words.iter().enumerate().take(*count) {
            let value = <u32x16<S> as SimdBase<S>>::splat(s, *code);
            if *count == 1 {
                lines.iter_mut().for_each(|line| value.store_array(line));
                break;
            }
            for line in lines.iter_mut().skip(word).step_by(*count) {
                value.store_array(line);
            }
        }
    }
    if let Some(stencil) = pass.clear.stencil {
        job.stencil.fill(stencil);
    }
    if let Some(depth) = pass.clear.depth {
        let value = <f32x16<S> as SimdBase<S>>::splat(s, depth);
        for line in job.depth.as_chunks_mut::<LANES>().0 {
            value.store_array(line);
        }
    }
}

/// A chunk in the tile at hand.
#[derive(Debug, Clone, Copy)]
struct ChunkInTile<'a> {
    level: Level,
    chunk: &'a Chunk,
    /// The chunk's number in the pass.
    number: u32,
    item: &'a TileItem<'a>,
    shape: TileShape,
    /// Where pixels may change, in the tile's own pixels.
    rect: PixelRect,
    /// Whether that is all of the tile.
    is_whole: bool,
    /// The blocks of 16×16 pixels that lie in it, one bit each.
    blocks: u16,
    test: Option<DepthTest>,
}

impl<'a> ChunkInTile<'a> {
    fn new(pass: &TilePass<'a>, number: u32, job: &TileJob<'_>) -> Self {
        let chunk = &pass.chunks[number as usize];
        let item = &pass.items[chunk.item];
        let (x, y) = pass.grid.tile_origin(job.tile);
        let shape = TileShape {
            x: x.cast_signed(),
            y: y.cast_signed(),
            log2: pass.grid.tile_log2(),
        };
        let rect = shape.local(&item.rect);
        let depth = item.pipeline.key().depth;
        Self {
            level: pass.level,
            chunk,
            number,
            item,
            shape,
            rect,
            is_whole: shape.is_whole(&rect),
            blocks: shape.blocks_inside(&rect),
            test: depth
                .filter(|_| !job.depth.is_empty())
                .map(|state| DepthTest {
                    state,
                    range: item.depth_range,
                    origin: [shape.x, shape.y],
                }),
        }
    }

    /// The varyings of the item's vertices, and of those that a chunk made by clipping.
    fn varyings<'c>(&self, chunk: &'c Chunk) -> VaryingSource<'c>
    where
        'a: 'c,
    {
        VaryingSource {
            shaded: self.item.varyings,
            clipped: &chunk.clipped_varyings,
            modes: &self.item.pipeline.interface().varyings,
        }
    }
}
