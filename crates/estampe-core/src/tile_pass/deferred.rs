//! Drawing in two steps: first which triangle every sample shows, then one shading of each.
//!
//! For draws that neither blend nor discard nor write depth in the shader, and for depth alone. A run is a
//! sequence of chunks of one item; it is shaded when another item or the tile's end comes.

use super::{BOUNDED_PACKETS, ChunkInTile, TileItem, TileJob, TilePass, TileScratch};
use crate::fragment::interpolate::DepthPlane;
use crate::fragment::queue::FragmentQueue;
use crate::fragment::rows::{PlaneRows, Rows};
use crate::per_sample::codes::pack;
use crate::per_sample::color::ColorTarget;
use crate::per_sample::depth_bounds::Judgement;
use crate::per_sample::owners::Owners;
use crate::per_sample::visibility::{
    ByTriangle, Decision, Numbering, ONLY_WIDE, SHADED, SeenTriangle, Sight, Visibility, orders,
    prefers_less,
};
use crate::raster::CoverageList;
use crate::raster::small::{PIXELS, SmallTriangles};
use crate::raster::triangle::TileTriangle;
use crate::tiles::{BinEntry, TrianglePacket};
use estampe_simd::{Lanes, Level, SimdBase, dispatch, f32x16};
use estampe_types::shader::DepthOutput;

mod quads;
mod shade;
mod uniform;

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
    quads: quads::Quads<N>,
    rows: PlaneRows,
    row_fragments: Box<Rows>,
    /// How many rows of fragments are shaded or queued.
    row_count: u32,
    /// Colours of rows' fragments, sixteen a row.
    row_codes: Vec<u32>,
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
            quads: quads::Quads::default(),
            rows: PlaneRows::default(),
            row_fragments: Box::default(),
            row_count: 0,
            row_codes: Vec::new(),
            codes: Vec::new(),
        }
    }
}

/// Whether a chunk's primitives may be shaded last.
pub(super) fn is_deferred(work: &ChunkInTile<'_>) -> bool {
    let key = work.item.pipeline.key();
    let mut targets = work.item.targets.iter().flatten();
    !matches!(work.level, Level::Scalar(_))
        && work.chunk.lines.is_empty()
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
    if deferred.item != Some(work.chunk.item)
        || deferred.visibility.slots.len() > MAX_RUN
        || deferred.row_codes.len() > MAX_RUN
    {
        shade_run(pass, job, scratch);
    }
    scratch.queue.configure(work.item.pipeline);
    scratch.deferred.item = has_colors(work).then_some(work.chunk.item);
    let order = sort(work, entries, &mut scratch.deferred.order);
    see_entries(work, (entries, order), job, scratch);
}

/// In which order a chunk's entries are seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Order {
    /// Their own.
    Given,
    /// Their own, and each is one large triangle; most of them may be hidden.
    Large,
    /// Each is one large triangle; nearest first.
    Sorted,
}

/// Sorts entries by the depth of their triangles at the tile's middle, nearest first, if that is allowed
/// and wanted: all must be large.
fn sort(work: &ChunkInTile<'_>, entries: &[BinEntry], order: &mut Vec<(f32, u32)>) -> Order {
    let state = match &work.test {
        Some(test) if test.state.write_enabled && orders(test.state.compare) => test.state,
        _ => return Order::Given,
    };
    if !(2..=MAX_SORTED).contains(&entries.len()) {
        return Order::Given;
    }
    order.clear();
    let half = work.shape.side() as f32 * 0.5;
    let middle = [work.shape.x as f32 + half, work.shape.y as f32 + half];
    for (number, entry) in (0..).zip(entries) {
        let BinEntry::Triangles { packet, lanes } = *entry else {
            return Order::Given;
        };
        let packet = &work.chunk.triangles[packet as usize];
        let lane = lanes.trailing_zeros() as usize;
        if !lanes.is_power_of_two() || !is_large(packet, lane) {
            return Order::Given;
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
        return Order::Large;
    }
    // A stable sort, so NaN and equal depths change nothing but time.
    order.sort_by(|a, b| a.0.total_cmp(&b.0));
    Order::Sorted
}

/// Whether a triangle is higher and wider than a block.
fn is_large(packet: &TrianglePacket, lane: usize) -> bool {
    const BLOCK: i32 = 16 * 256;
    let x = [packet.x[0][lane], packet.x[1][lane], packet.x[2][lane]];
    let (low, high) = (x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2]));
    high - low > BLOCK && packet.y[2][lane] - packet.y[0][lane] > BLOCK
}

fn see_entries<const N: usize>(
    work: &ChunkInTile<'_>,
    (entries, order): (&[BinEntry], Order),
    job: &mut TileJob<'_>,
    scratch: &mut TileScratch<N>,
) {
    let by_depth = std::mem::take(&mut scratch.deferred.order);
    let mut next = scratch.deferred.visibility.add(work.number, entries);
    let mut seeing = Seeing {
        work,
        order,
        has_colors: has_colors(work),
        shades_rows: shades_rows(work),
        job,
        scratch,
    };
    if order == Order::Sorted {
        // Numbers follow the order of submission, whatever that of seeing.
        for &(_, at) in &by_depth {
            if let BinEntry::Triangles { packet, lanes } = entries[at as usize] {
                seeing.entry(packet, lanes, next + at);
            }
        }
    } else {
        for entry in entries {
            if let BinEntry::Triangles { packet, lanes } = *entry {
                seeing.entry(packet, lanes, next);
                next += lanes.count_ones();
            }
        }
    }
    seeing.flush_rows();
    scratch.deferred.order = by_depth;
}

/// Whether small triangles' fragments are shaded as they are seen, a fragment of each of sixteen triangles
/// at once.
fn shades_rows(work: &ChunkInTile<'_>) -> bool {
    let interface = work.item.pipeline.interface();
    has_colors(work)
        && interface.independent_fragments
        && !interface.reads_position
        && interface.color_targets == 1
}

/// Appends sixteen codes for each shaded row.
#[inline(always)]
fn keep_codes<S: Lanes, const N: usize>(
    s: S,
    item: &TileItem<'_>,
    queue: &mut FragmentQueue<N>,
    codes: &mut Vec<u32>,
) {
    let is_srgb = item.targets[0].as_ref().is_some_and(ColorTarget::is_srgb);
    for shaded in queue.drain(false) {
        if let [r, g, b, a] = shaded.colors {
            let color = [
                f32x16::load_array_ref(s, &r.0),
                f32x16::load_array_ref(s, &g.0),
                f32x16::load_array_ref(s, &b.0),
                f32x16::load_array_ref(s, &a.0),
            ];
            codes.extend_from_slice(&pack(s, color, is_srgb).to_array());
        }
    }
}

/// Numbers fragments by their places in rows.
struct ByFragment<'a> {
    rows: &'a mut Rows,
    /// The number of the first row's first lane.
    first: u32,
}

impl Numbering for ByFragment<'_> {
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "a lane is below 16")]
    fn first_of(&mut self, lane: usize) -> u32 {
        self.first + lane as u32
    }

    #[inline(always)]
    fn next(&mut self, lane: usize, pixel: usize, number: u32) -> u32 {
        let row = ((number - self.first) / 16) as usize;
        self.rows.push(lane, row, pixel);
        number + 16
    }
}

/// A chunk being seen in a tile.
struct Seeing<'a, 'j, 't, const N: usize> {
    work: &'a ChunkInTile<'a>,
    order: Order,
    has_colors: bool,
    shades_rows: bool,
    job: &'j mut TileJob<'t>,
    scratch: &'j mut TileScratch<N>,
}

impl<const N: usize> Seeing<'_, '_, '_, N> {
    /// Triangles of one packet; `number` is the first one's.
    fn entry(&mut self, packet: u32, lanes: u16, mut number: u32) {
        let packet = &self.work.chunk.triangles[packet as usize];
        if self.order != Order::Given {
            let lane = lanes.trailing_zeros() as usize;
            if !self.is_hidden(packet, lane) {
                self.large(packet, lane, number);
            }
            return;
        }
        let mut small = 0;
        if N == 1 {
            let (tile, rect) = (self.work.shape, &self.work.rect);
            let range = self.work.item.depth_range;
            let cover = &mut self.scratch.deferred.small;
            small = dispatch!(@wide self.work.level, s => cover.cover(s, packet, lanes, (tile, rect), range),
                scalar => unreachable!("{ONLY_WIDE}"));
        }
        // Small triangles between large ones are seen together.
        let first = number;
        let (mut left, mut run) = (lanes, 0);
        while left != 0 {
            let lane = left.trailing_zeros() as usize;
            left &= left - 1;
            if small >> lane & 1 == 1 {
                run |= 1 << lane;
            } else {
                self.small(packet, std::mem::take(&mut run), (lanes, first));
                self.large(packet, lane, number);
            }
            number += 1;
        }
        self.small(packet, run, (lanes, first));
    }

    /// Small triangles of a packet; `entry` is all of its lanes and their first number.
    fn small(&mut self, packet: &TrianglePacket, lanes: u16, entry: (u16, u32)) {
        if lanes == 0 {
            return;
        }
        let numbers: &mut [u32] = if self.has_colors {
            self.job.colors[0]
        } else {
            &mut []
        };
        let Deferred {
            visibility,
            small,
            row_fragments: rows,
            row_count,
            ..
        } = &mut self.scratch.deferred;
        let mut sight = Sight {
            test: self.work.test,
            depth: self.job.depth,
            numbers,
            pending: &mut visibility.pending,
            tile: self.work.shape,
            decision: Decision::InOrder,
        };
        sight.settle(self.work.level, u16::MAX, &mut visibility.owners);
        let (all, first) = entry;
        let blocks = if self.shades_rows {
            rows.count = 0;
            let first = SHADED | (*row_count * 16);
            sight.small(small, lanes, &mut ByFragment { rows, first })
        } else {
            sight.small(small, lanes, &mut ByTriangle { lanes: all, first })
        };
        self.scratch.bounds.invalidate(blocks);
        if self.shades_rows && self.scratch.deferred.row_fragments.count != 0 {
            dispatch!(@wide self.work.level, s => self.shade_rows(s, packet),
                scalar => unreachable!("{ONLY_WIDE}"));
        }
    }

    /// Queues rows of fragments.
    #[inline(always)]
    fn shade_rows<S: Lanes>(&mut self, s: S, packet: &TrianglePacket) {
        let source = self.work.varyings(self.work.chunk);
        let Deferred {
            rows: planes,
            row_fragments,
            row_count,
            ..
        } = &mut self.scratch.deferred;
        // Every lane that has fragments has one in the first row.
        planes.set(s, packet, row_fragments.lanes[0], &source);
        let count = row_fragments.count;
        *row_count += u32::try_from(count).unwrap_or_default();
        for row in 0..count {
            if self.scratch.queue.is_full() {
                self.flush_rows();
            }
            let TileScratch {
                queue, deferred, ..
            } = &mut *self.scratch;
            let Deferred {
                small,
                rows: planes,
                row_fragments: rows,
                ..
            } = deferred;
            // Exact, as in the coverage.
            let [x, y] = rows.steps(s, row);
            let x = f32x16::load_array_ref(s, &small.from_x) + x;
            let y = f32x16::load_array_ref(s, &small.from_y) + y;
            let out = queue.push_row(rows.lanes[row % PIXELS], packet.front);
            planes.varyings(s, packet, source.modes, [x, y], out);
        }
    }

    /// Shades the queued rows and keeps their colours.
    fn flush_rows(&mut self) {
        let TileScratch {
            queue,
            deferred,
            statistics,
            ..
        } = &mut *self.scratch;
        if queue.is_empty() {
            return;
        }
        let (level, item) = (self.work.level, self.work.item);
        statistics.fragments_shaded += queue.shade(level, item.pipeline, item.bindings);
        dispatch!(@wide level, s => keep_codes(s, item, queue, &mut deferred.row_codes),
            scalar => unreachable!("{ONLY_WIDE}"));
    }

    /// Whether a large triangle is seen nowhere in the tile, by a quick look.
    fn is_hidden(&self, packet: &TrianglePacket, lane: usize) -> bool {
        let (work, plane) = (self.work, DepthPlane::new(packet, lane));
        let (or_equal, side) = (self.order == Order::Sorted, work.shape.side());
        let bounds = &self.scratch.bounds;
        let test = work.test.as_ref();
        test.is_some_and(|test| bounds.hide::<N>(test, &plane, or_equal, side))
    }

    /// A triangle of any size, by blocks and packets.
    fn large(&mut self, packet: &TrianglePacket, lane: usize, number: u32) {
        let ChunkInTile {
            shape,
            rect,
            is_whole,
            blocks,
            level,
            test,
            ..
        } = *self.work;
        let Some(triangle) = TileTriangle::<N>::new(packet, lane, shape, &rect) else {
            return;
        };
        let plane = DepthPlane::new(packet, lane);
        // Leave out the blocks where everything is nearer already.
        let mut judged = Judgement::of_all(0, 0);
        if triangle.packets() > BOUNDED_PACKETS
            && let Some(test) = &test
        {
            // An equal depth that is not seen in order may win by its number.
            let or_equal = self.order == Order::Sorted;
            let (bounds, depth) = (&mut self.scratch.bounds, &mut *self.job.depth);
            judged = bounds.judge::<N>(level, test, &plane, or_equal, depth);
            if judged.hidden == u16::MAX {
                return;
            }
        }
        self.scratch.list.clear();
        let list = &mut self.scratch.list;
        let hidden = judged.hidden;
        let whole = dispatch!(@wide level, s => triangle.cover(s, shape, hidden, blocks, list),
            scalar => unreachable!("{ONLY_WIDE}"));
        if !is_whole {
            list.confine(&rect);
        }
        // Without a test everything passes.
        let certain = whole & test.map_or(u16::MAX, |_| judged.certain);
        let is_sorted = self.order == Order::Sorted;
        let (mut sight, owners, list) = self.parts();
        let seen = SeenTriangle { plane, number };
        let written = Sight::blocks_of(whole, list) & !certain;
        if certain != 0 {
            sight.certain(level, &seen, certain, owners);
        }
        if written != 0 {
            sight.settle(level, written, owners);
            sight.decision = if is_sorted {
                Decision::Sorted
            } else {
                Decision::InOrder
            };
            sight.triangle(level, &seen, whole & !certain, list.items());
        }
        if test.is_some_and(|test| test.state.write_enabled) {
            self.scratch.bounds.invalidate(written);
            self.scratch.bounds.replace(certain, &judged);
        }
    }

    /// The attachments and owners, to be written, beside what is read meanwhile.
    #[inline(always)]
    fn parts(&mut self) -> (Sight<'_, N>, &mut Owners, &CoverageList<N>) {
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
            decision: Decision::InOrder,
        };
        (sight, &mut deferred.visibility.owners, &self.scratch.list)
    }
}
