//! Binning (R2): which tiles a primitive may touch.
//!
//! *In* set-up primitives · *Out* entries of [`Bins`] · *Space* window, tiles ·
//! *Precision* exact.
//!
//! Most triangles and lines of a large mesh lie in one tile, and so do their neighbours: those of a
//! packet that share a tile are found sixteen at a time and get one entry.

use super::plan::GeometryPlan;
use super::tile_edges::TileEdges;
use crate::bounds::bins::{BinEntry, Bins, TileSpan};
use crate::bounds::chunk::{Chunk, number};
use crate::bounds::lines::LinePrimitive;
use crate::bounds::primitives::{PointPrimitive, TrianglePacket};
use crate::layout::TileGrid;
use estampe_simd::{LANES, Lane, Lanes, SimdBase, i32x16, outline};
use std::ops::Range;

/// A half-open range of tiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct TileRange {
    x0: i32,
    y0: i32,
    x1: i32,
    y1: i32,
}

/// The tiles of sixteen primitives: first and last column and row.
struct TileRanges<S: Lanes> {
    x0: i32x16<S>,
    y0: i32x16<S>,
    x1: i32x16<S>,
    y1: i32x16<S>,
}

/// The most tiles of a primitive whose entries are merged with its neighbours'.
const FEW_TILES: i32 = 4;

impl<S: Lanes> TileRanges<S> {
    /// The tiles of the boxes of sixteen triangles with samples of the plan's rectangle; their
    /// vertices are sorted by y.
    #[inline(always)]
    fn new(s: S, plan: &GeometryPlan, [x, y]: [[i32x16<S>; 3]; 2]) -> Self {
        let splat = |value: i32| <i32x16<S> as SimdBase<S>>::splat(s, value);
        let [first, last] = plan.sample_range.map(splat);
        let (rect, log2) = (plan.rect, plan.grid.tile_log2());
        let (x_min, x_max) = (x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2]));
        Self {
            x0: ((x_min - last + 255) >> 8).max(splat(rect.x0)) >> log2,
            y0: ((y[0] - last + 255) >> 8).max(splat(rect.y0)) >> log2,
            x1: ((x_max - first) >> 8).min(splat(rect.x1 - 1)) >> log2,
            y1: ((y[2] - first) >> 8).min(splat(rect.y1 - 1)) >> log2,
        }
    }
}

/// Bins the last packet of a chunk, whose triangles have these x and y. A triangle of `rectangles`
/// stands for the next one, too: both have one box.
#[inline(always)]
pub(crate) fn bin_packet<S: Lanes>(
    s: S,
    plan: &GeometryPlan,
    positions: [[i32x16<S>; 3]; 2],
    rectangles: u16,
    chunk: &mut Chunk,
) {
    outline!(s, {
        let ranges = TileRanges::new(s, plan, positions);
        let Some((last, packet)) = chunk.triangles.last() else {
            unreachable!("a packet was just set up");
        };
        let packet = number(packet);
        let used = u16::MAX >> (LANES - usize::from(last.len).min(LANES)) & !(rectangles << 1);
        let entry = |lanes| BinEntry::Triangles { packet, lanes };
        // Rectangles fill their boxes.
        let triangle = |lane: Lane| {
            let misses_none = lane.is_in(rectangles);
            (!misses_none).then_some((last, lane))
        };
        bin_lanes(s, plan, (&ranges, used), (entry, triangle), &mut chunk.bins);
    })
}

/// A triangle: its packet and its lane.
type InPacket<'a> = (&'a TrianglePacket, Lane);

/// Bins some primitives of a packet, of which `entry` makes entries. `triangle` has the one in a
/// lane, to tell tiles of its box that it misses.
#[inline(always)]
fn bin_lanes<'a, S: Lanes>(
    s: S,
    plan: &GeometryPlan,
    (ranges, used): (&TileRanges<S>, u16),
    (entry, triangle): (
        impl Fn(u16) -> BinEntry,
        impl Fn(Lane) -> Option<InPacket<'a>>,
    ),
    bins: &mut Bins,
) {
    bins.end_packet();
    let splat = |value: i32| <i32x16<S> as SimdBase<S>>::splat(s, value);
    let (columns, rows) = (ranges.x1 - ranges.x0, ranges.y1 - ranges.y0);
    let single = s.bits_of_mask((columns | rows).simd_eq(splat(0))) & used;
    let mut rest = single;
    if single != used {
        let tiles = (columns + splat(1)) * (rows + splat(1));
        let many = s.bits_of_mask(tiles.simd_gt(splat(FEW_TILES))) & used;
        if many != 0 {
            // One by one, because primitives must not be merged across these.
            rest = 0;
        }
    }
    let (left, top) = (ranges.x0.to_array(), ranges.y0.to_array());
    let one_by_one = used & !rest;
    while let Some(lane) = Lane::first_of(rest) {
        let (x, y) = (lane.of(&left), lane.of(&top));
        let shares = ranges.x0.simd_eq(splat(x)) & ranges.y0.simd_eq(splat(y));
        let lanes = s.bits_of_mask(shares) & rest;
        rest &= !lanes;
        let tile = plan.grid.tile_at(x.cast_unsigned(), y.cast_unsigned());
        bins.push(TileSpan::of_tile(tile), entry(lanes));
    }
    if one_by_one != 0 {
        let (right, bottom) = (ranges.x1.to_array(), ranges.y1.to_array());
        for lane in Lane::all_of(one_by_one) {
            let range = TileRange {
                x0: lane.of(&left),
                y0: lane.of(&top),
                x1: lane.of(&right) + 1,
                y1: lane.of(&bottom) + 1,
            };
            bin_range(plan, range, entry(lane.bit()), triangle(lane), bins);
        }
    }
}

/// Bins one primitive of a packet; if it is a triangle, without the tiles of its box that it
/// misses.
fn bin_range(
    plan: &GeometryPlan,
    range: TileRange,
    entry: BinEntry,
    triangle: Option<InPacket<'_>>,
    bins: &mut Bins,
) {
    let (columns, rows) = (range.x1 - range.x0, range.y1 - range.y0);
    // A primitive of many tiles has entries of its own: looking for one to merge with would
    // take time quadratic in tiles. Small ones before and after it must not merge across it.
    let many = columns * rows > FEW_TILES;
    if many {
        bins.end_packet();
    }
    let edges = triangle
        .filter(|_| columns > 1 && rows > 1)
        .map(|(packet, lane)| TileEdges::new(packet, lane, plan.sample_range));
    let grid = plan.grid;
    for y in range.y0..range.y1 {
        let columns = range.x0..range.x1;
        if many {
            let columns = match &edges {
                Some(edges) => edges.columns(y, columns, grid.tile_log2()),
                None => columns,
            };
            push_row(grid, y, columns, entry, bins);
            continue;
        }
        for x in columns {
            let edges = edges.as_ref();
            if edges.is_some_and(|edges| edges.miss(x, y, grid.tile_log2())) {
                continue;
            }
            let tile = grid.tile_at(x.cast_unsigned(), y.cast_unsigned());
            bins.push_lane(tile, entry);
        }
    }
    if many {
        bins.end_packet();
    }
}

/// Adds an entry to some columns of a row of tiles.
fn push_row(grid: TileGrid, row: i32, columns: Range<i32>, entry: BinEntry, bins: &mut Bins) {
    if columns.is_empty() {
        return;
    }
    let tile = |column: i32| grid.tile_at(column.cast_unsigned(), row.cast_unsigned());
    if grid.tiles_are_blocks() {
        let count = (columns.end - columns.start).cast_unsigned();
        bins.push(TileSpan::new(tile(columns.start), count), entry);
        return;
    }
    // Two tiles of a block follow one another.
    let mut column = columns.start;
    while column < columns.end {
        let next = columns.end.min((column | 1) + 1);
        let count = (next - column).cast_unsigned();
        bins.push(TileSpan::new(tile(column), count), entry);
        column = next;
    }
}

/// Adds a line to a chunk; its pixels begin no farther from it than the line style's reach.
#[inline(never)]
pub(crate) fn push_line(plan: &GeometryPlan, line: &LinePrimitive, chunk: &mut Chunk) {
    let [a, b] = &line.ends;
    let Some(range) = TileRange::new(
        plan,
        [a.x.min(b.x), a.y.min(b.y), a.x.max(b.x), a.y.max(b.y)],
        plan.line_style.reach(),
    ) else {
        return;
    };
    let lane = chunk.lines.push_line(line);
    chunk.statistics.primitives_binned += 1;
    let entry = BinEntry::Lines {
        packet: number(chunk.lines.len() - 1),
        lanes: lane.bit(),
    };
    if lane == Lane::new(0) {
        chunk.bins.end_packet();
    }
    bin_range(plan, range, entry, None, &mut chunk.bins);
}

/// The tiles of sixteen lines.
pub(crate) struct LineTiles<S: Lanes> {
    /// The lines that touch any.
    pub(crate) any: u16,
    ranges: TileRanges<S>,
}

impl<S: Lanes> LineTiles<S> {
    /// Those of lines whose ends have these x and y.
    #[inline(always)]
    pub(crate) fn new(s: S, plan: &GeometryPlan, [x, y]: [[i32x16<S>; 2]; 2]) -> Self {
        let splat = |value: i32| <i32x16<S> as SimdBase<S>>::splat(s, value);
        let (rect, log2) = (plan.rect, plan.grid.tile_log2());
        let reach = plan.line_style.reach();
        let x0 = ((x[0].min(x[1]) - reach) >> 8).max(splat(rect.x0));
        let y0 = ((y[0].min(y[1]) - reach) >> 8).max(splat(rect.y0));
        let x1 = ((x[0].max(x[1]) + reach) >> 8).min(splat(rect.x1 - 1));
        let y1 = ((y[0].max(y[1]) + reach) >> 8).min(splat(rect.y1 - 1));
        // The sign bit is set if there is no pixel.
        let any = !s.sign_bits((x1 - x0) | (y1 - y0));
        let ranges = TileRanges {
            x0: x0 >> log2,
            y0: y0 >> log2,
            x1: x1 >> log2,
            y1: y1 >> log2,
        };
        Self { any, ranges }
    }
}

/// Bins some lines of the last packet of a chunk, which all touch tiles.
#[inline(always)]
pub(crate) fn bin_lines<S: Lanes>(
    s: S,
    plan: &GeometryPlan,
    (tiles, lanes): (&LineTiles<S>, u16),
    chunk: &mut Chunk,
) {
    let packet = number(chunk.lines.len() - 1);
    let count = u64::from(lanes.count_ones());
    chunk.statistics.primitives_binned += count;
    chunk.statistics.lines_in_packets += count;
    let entry = |lanes| BinEntry::Lines { packet, lanes };
    let ranges = (&tiles.ranges, lanes);
    bin_lanes(s, plan, ranges, (entry, |_| None), &mut chunk.bins);
}

/// Adds a point to a chunk.
pub(crate) fn push_point(plan: &GeometryPlan, point: PointPrimitive, chunk: &mut Chunk) {
    let (x, y, half) = (point.center.x, point.center.y, point.half);
    let entry = BinEntry::Point(number(chunk.points.len()));
    chunk.points.push(point);
    let around = [x - half, y - half, x + half, y + half];
    let Some(range) = TileRange::new(plan, around, 0) else {
        return;
    };
    chunk.statistics.primitives_binned += 1;
    for y in range.y0..range.y1 {
        push_row(plan.grid, y, range.x0..range.x1, entry, &mut chunk.bins);
    }
}

impl TileRange {
    /// The tiles of a box in 1/256 pixel, grown by a margin, inside the plan's rectangle.
    fn new(plan: &GeometryPlan, [x0, y0, x1, y1]: [i32; 4], margin: i32) -> Option<Self> {
        let (rect, log2) = (plan.rect, plan.grid.tile_log2());
        let first = |low: i32, edge: i32| ((low - margin) >> 8).max(edge);
        let last = |high: i32, edge: i32| ((high + margin) >> 8).min(edge - 1);
        let (x0, x1) = (first(x0, rect.x0), last(x1, rect.x1));
        let (y0, y1) = (first(y0, rect.y0), last(y1, rect.y1));
        let range = Self {
            x0: x0 >> log2,
            y0: y0 >> log2,
            x1: (x1 >> log2) + 1,
            y1: (y1 >> log2) + 1,
        };
        (x0 <= x1 && y0 <= y1).then_some(range)
    }
}

#[cfg(test)]
mod tests;
