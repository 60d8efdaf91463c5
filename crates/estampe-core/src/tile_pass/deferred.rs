//! Drawing in two steps: first which triangle every sample shows, then one shading of each.
//!
//! For draws that neither blend nor discard nor write depth in the shader, and for depth alone. A run is a
//! sequence of chunks of one item; it is shaded when another item or the tile's end comes.

use super::{BOUNDED_PACKETS, ChunkInTile, TileJob, TilePass, TileScratch};
use crate::fragment::interpolate::DepthPlane;
use crate::per_sample::color::ColorTarget;
use crate::per_sample::depth::DepthTest;
use crate::per_sample::visibility::{
    ANY, LESS, SORTED, SeenTriangle, Sight, Visibility, orders, prefers_less,
};
use crate::raster::small::SmallTriangles;
use crate::raster::triangle::TileTriangle;
use crate::raster::{CoverageList, pixel_index};
use crate::tiles::{BinEntry, TrianglePacket};
use estampe_simd::{Lanes, dispatch};
use estampe_types::shader::DepthOutput;
use estampe_types::state::CompareFunction;

mod shade;

use shade::Shown;
pub(super) use shade::shade_run;

/// Triangles of a run in one tile, at most (a chunk's more): their planes should stay in the cache.
const MAX_RUN: usize = 8192;

/// Triangles of a chunk's bin that are worth sorting, at most.
const MAX_SORTED: usize = 256;

/// A run and what its shading needs.
#[derive(Debug)]
pub(super) struct Deferred<const N: usize> {
    visibility: Visibility<N>,
    /// The run's item, while there is a run.
    item: Option<usize>,
    small: SmallTriangles,
    /// Bin entries by depth.
    order: Vec<(f32, u32)>,
    /// By slot: where the triangle is in `shown`.
    shown_of: Vec<u32>,
    shown: Vec<Shown>,
    planes: Vec<f32>,
    /// Colours of triangles that have one: of each target, by place in `shown`.
    codes: Vec<u32>,
}

impl<const N: usize> Default for Deferred<N> {
    fn default() -> Self {
        Self {
            visibility: Visibility::default(),
            item: None,
            small: SmallTriangles::default(),
            order: Vec::new(),
            shown_of: Vec::new(),
            shown: Vec::new(),
            planes: Vec::new(),
            codes: Vec::new(),
        }
    }
}

/// Whether a chunk's primitives may be shaded last.
pub(super) fn is_deferred(work: &ChunkInTile<'_>) -> bool {
    let key = work.item.pipeline.key();
    let mut targets = work.item.targets.iter().flatten();
    work.chunk.lines.is_empty()
        && work.chunk.points.is_empty()
        && key.early_depth
        && targets.all(ColorTarget::replaces)
}

/// Whether the item's fragments have colours at all.
fn has_colors(work: &ChunkInTile<'_>) -> bool {
    let interface = work.item.pipeline.interface();
    debug_assert_eq!(interface.depth_output, DepthOutput::None);
    work.item.targets[0].is_some() && interface.color_targets > 0
}

/// Sees the tile's triangles of one chunk.
pub(super) fn see_chunk<const N: usize>(
    pass: &TilePass<'_>,
    (work, entries): (&ChunkInTile<'_>, &[BinEntry]),
    job: &mut TileJob<'_>,
    scratch: &mut TileScratch<N>,
) {
    let deferred = &scratch.deferred;
    if deferred.item != Some(work.chunk.item) || deferred.visibility.slots.len() > MAX_RUN {
        shade_run(pass, job, scratch);
    }
    scratch.deferred.item = has_colors(work).then_some(work.chunk.item);
    let is_sorted = sort(work, entries, &mut scratch.deferred.order);
    dispatch!(work.level, s => see_lanes(s, work, (entries, is_sorted), job, scratch));
}

/// Sorts entries by the depth of their triangles at the tile's middle, nearest first, if that is allowed
/// and wanted: all must be large. False where the entries' own order serves.
fn sort(work: &ChunkInTile<'_>, entries: &[BinEntry], order: &mut Vec<(f32, u32)>) -> bool {
    let state = match &work.test {
        Some(test) if test.state.write_enabled && orders(test.state.compare) => test.state,
        _ => return false,
    };
    if !(2..=MAX_SORTED).contains(&entries.len()) {
        return false;
    }
    order.clear();
    let half = work.shape.side() as f32 * 0.5;
    let middle = [work.shape.x as f32 + half, work.shape.y as f32 + half];
    for (number, entry) in (0..).zip(entries) {
        let BinEntry::Triangles { packet, lanes } = *entry else {
            return false;
        };
        let packet = &work.chunk.triangles[packet as usize];
        let lane = lanes.trailing_zeros() as usize;
        if !lanes.is_power_of_two() || !is_large(packet, lane) {
            return false;
        }
        let DepthPlane { origin, z } = DepthPlane::new(packet, lane);
        let depth = z.origin + ((middle[0] - origin.x) * z.dx + (middle[1] - origin.y) * z.dy);
        let key = if prefers_less(state.compare) {
            depth
        } else {
            -depth
        };
        order.push((key, number));
    }
    if order.is_sorted_by(|a, b| a.0 <= b.0) {
        return false;
    }
    // A stable sort, so NaN and equal depths change nothing but time.
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    true
}

/// Whether a triangle is higher and wider than a block.
fn is_large(packet: &TrianglePacket, lane: usize) -> bool {
    const BLOCK: i32 = 16 * 256;
    let x = [packet.x[0][lane], packet.x[1][lane], packet.x[2][lane]];
    let (low, high) = (x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2]));
    high - low > BLOCK && packet.y[2][lane] - packet.y[0][lane] > BLOCK
}

#[inline(always)]
fn see_lanes<S: Lanes, const N: usize>(
    s: S,
    work: &ChunkInTile<'_>,
    (entries, is_sorted): (&[BinEntry], bool),
    job: &mut TileJob<'_>,
    scratch: &mut TileScratch<N>,
) {
    let order = std::mem::take(&mut scratch.deferred.order);
    let mut next = scratch.deferred.visibility.add(work.number, entries);
    let mut seeing = Seeing {
        work,
        mode: match &work.test {
            Some(_) if is_sorted => SORTED,
            Some(DepthTest { state, .. })
                if state.write_enabled && state.compare == CompareFunction::Less =>
            {
                LESS
            }
            _ => ANY,
        },
        has_colors: has_colors(work),
        job,
        scratch,
    };
    if is_sorted {
        // Each entry is one triangle. Numbers follow the order of submission, whatever that of seeing.
        for &(_, at) in &order {
            if let BinEntry::Triangles { packet, lanes } = entries[at as usize] {
                seeing.entry(s, packet, lanes, next + at);
            }
        }
    } else {
        for entry in entries {
            if let BinEntry::Triangles { packet, lanes } = *entry {
                seeing.entry(s, packet, lanes, next);
                next += lanes.count_ones();
            }
        }
    }
    scratch.deferred.order = order;
}

/// A chunk being seen in a tile.
struct Seeing<'a, 'j, 't, const N: usize> {
    work: &'a ChunkInTile<'a>,
    mode: u8,
    has_colors: bool,
    job: &'j mut TileJob<'t>,
    scratch: &'j mut TileScratch<N>,
}

impl<const N: usize> Seeing<'_, '_, '_, N> {
    /// Triangles of one packet; `number` is the first one's.
    #[inline(always)]
    fn entry<S: Lanes>(&mut self, s: S, packet: u32, lanes: u16, mut number: u32) {
        let packet = &self.work.chunk.triangles[packet as usize];
        let mut small = 0;
        if N == 1 {
            let (tile, rect) = (self.work.shape, &self.work.rect);
            let cover = &mut self.scratch.deferred.small;
            small = cover.cover(s, packet, lanes, tile, rect);
        }
        let mut lanes = lanes;
        while lanes != 0 {
            let lane = lanes.trailing_zeros() as usize;
            lanes &= lanes - 1;
            if small >> lane & 1 == 1 {
                self.small(lane, number);
            } else {
                self.large(s, packet, lane, number);
            }
            number += 1;
        }
    }

    /// The pixels of a small triangle.
    #[inline(always)]
    fn small(&mut self, lane: usize, number: u32) {
        let (mut sight, _, small) = self.parts();
        let (x, y) = (small.x[lane], small.y[lane]);
        let mut covered = small.covered[lane];
        let mut blocks = 0;
        while covered != 0 {
            let pixel = covered.trailing_zeros() as usize % 16;
            covered &= covered - 1;
            let at = pixel_index(x + (pixel & 3) as i32, y + (pixel >> 2) as i32);
            sight.pixel(at, small.depth[pixel][lane], number);
            blocks |= 1u16 << (at >> 8);
        }
        self.scratch.bounds.invalidate(blocks);
    }

    /// A triangle of any size, by blocks and packets.
    #[inline(always)]
    fn large<S: Lanes>(&mut self, s: S, packet: &TrianglePacket, lane: usize, number: u32) {
        let ChunkInTile {
            shape,
            rect,
            is_whole,
            level,
            test,
            ..
        } = *self.work;
        let Some(triangle) = TileTriangle::<N>::new(packet, lane, shape, &rect) else {
            return;
        };
        let plane = DepthPlane::new(packet, lane);
        // Leave out the blocks where everything is nearer already.
        let mut hidden = 0;
        if triangle.packets() > BOUNDED_PACKETS
            && let Some(mut test) = test
        {
            if self.mode == SORTED {
                // An equal depth may still win: by its number.
                test.state.compare = match test.state.compare {
                    CompareFunction::Less => CompareFunction::LessEqual,
                    CompareFunction::Greater => CompareFunction::GreaterEqual,
                    other => other,
                };
            }
            let depth = &mut *self.job.depth;
            hidden = self.scratch.bounds.hidden::<N>(level, &test, &plane, depth);
            if hidden == u16::MAX {
                return;
            }
        }
        self.scratch.list.clear();
        let list = &mut self.scratch.list;
        let whole = triangle.cover(s, shape, hidden, !is_whole, list);
        if !is_whole {
            list.confine(&rect);
        }
        let mode = self.mode;
        let (mut sight, list, _) = self.parts();
        let seen = SeenTriangle { plane, number };
        match mode {
            LESS => sight.triangle::<S, LESS>(s, &seen, whole, list),
            SORTED => sight.triangle::<S, SORTED>(s, &seen, whole, list),
            _ => sight.triangle::<S, ANY>(s, &seen, whole, list),
        }
        if test.is_some_and(|test| test.state.write_enabled) {
            let written = Sight::blocks_of(whole, list);
            self.scratch.bounds.invalidate(written);
        }
    }

    /// The attachments, to be written, beside what is read meanwhile.
    #[inline(always)]
    fn parts(&mut self) -> (Sight<'_, N>, &CoverageList<N>, &SmallTriangles) {
        let numbers: &mut [u32] = if self.has_colors {
            self.job.colors[0]
        } else {
            &mut []
        };
        let deferred = &mut self.scratch.deferred;
        let sight = Sight {
            test: self.work.test,
            depth: self.job.depth,
            numbers,
            pending: &mut deferred.visibility.pending,
            tile: self.work.shape,
        };
        (sight, &self.scratch.list, &deferred.small)
    }
}
