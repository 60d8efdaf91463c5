//! Binning (R2): which tiles a primitive may touch.
//!
//! *In* set-up primitives · *Out* entries of [`Bins`](crate::tiles::Bins) · *Space* window, tiles ·
//! *Precision* exact.
//!
//! Most triangles of a large mesh lie in one tile, and so do their neighbours: those of a packet that share a
//! tile are found sixteen at a time and get one entry.

use super::viewport::PixelRect;
use crate::layout::TileGrid;
use crate::tiles::{BinEntry, Bins, Chunk, LinePrimitive, PointPrimitive, TrianglePacket};
use estampe_simd::{LANES, Lanes, SimdBase, i32x16};

/// Where primitives are binned.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BinState {
    pub(crate) grid: TileGrid,
    pub(crate) rect: PixelRect,
    /// The least and the greatest offset of a sample inside its pixel, in 1/256 pixel.
    pub(crate) sample_range: [i32; 2],
}

/// A half-open range of tiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct TileRange {
    x0: i32,
    y0: i32,
    x1: i32,
    y1: i32,
}

/// The tiles of sixteen triangles: first and last column and row.
pub(crate) struct TileRanges<S: Lanes> {
    pub(crate) x0: i32x16<S>,
    pub(crate) y0: i32x16<S>,
    pub(crate) x1: i32x16<S>,
    pub(crate) y1: i32x16<S>,
}

/// The most tiles of a triangle whose entries are merged with its neighbours'.
const FEW_TILES: i32 = 4;

impl BinState {
    /// Bins the last packet of a chunk.
    #[inline(always)]
    pub(crate) fn bin_packet<S: Lanes>(&self, s: S, ranges: &TileRanges<S>, chunk: &mut Chunk) {
        let Some((last, packet)) = chunk.triangles.split_last().map(|(last, others)| {
            let number = u32::try_from(others.len()).unwrap_or(u32::MAX);
            (last, number)
        }) else {
            return;
        };
        let bins = &mut chunk.bins;
        bins.end_run();
        let live = u16::MAX >> (LANES - usize::from(last.len).min(LANES));
        let splat = |value: i32| <i32x16<S> as SimdBase<S>>::splat(s, value);
        let (columns, rows) = (ranges.x1 - ranges.x0, ranges.y1 - ranges.y0);
        let single = s.bits_of_mask((columns | rows).simd_eq(splat(0))) & live;
        let mut rest = single;
        if single != live {
            let tiles = (columns + splat(1)) * (rows + splat(1));
            let many = s.bits_of_mask(tiles.simd_gt(splat(FEW_TILES))) & live;
            if many != 0 {
                // One by one, because triangles must not be merged across these.
                rest = 0;
            }
        }
        let (left, top) = (ranges.x0.to_array(), ranges.y0.to_array());
        let mut left_over = live & !rest;
        while rest != 0 {
            let lane = rest.trailing_zeros() as usize;
            let (x, y) = (left[lane], top[lane]);
            let shares = ranges.x0.simd_eq(splat(x)) & ranges.y0.simd_eq(splat(y));
            let lanes = s.bits_of_mask(shares) & rest;
            rest &= !lanes;
            let tile = self.grid.tile_at(x.cast_unsigned(), y.cast_unsigned());
            bins.push(tile, BinEntry::Triangles { packet, lanes });
        }
        if left_over != 0 {
            let (right, bottom) = (ranges.x1.to_array(), ranges.y1.to_array());
            while left_over != 0 {
                let lane = left_over.trailing_zeros() as usize;
                left_over &= left_over - 1;
                let range = TileRange {
                    x0: left[lane],
                    y0: top[lane],
                    x1: right[lane] + 1,
                    y1: bottom[lane] + 1,
                };
                self.bin_lane(last, packet, lane, range, bins);
            }
        }
    }

    /// Bins one triangle of a packet, leaving out tiles of its box that it misses.
    fn bin_lane(
        &self,
        triangles: &TrianglePacket,
        packet: u32,
        lane: usize,
        range: TileRange,
        bins: &mut Bins,
    ) {
        let (columns, rows) = (range.x1 - range.x0, range.y1 - range.y0);
        // A triangle of many tiles has entries of its own: looking for one to merge with would
        // take time quadratic in tiles. Small ones before and after it must not merge across it.
        let many = columns * rows > FEW_TILES;
        if many {
            bins.end_run();
        }
        let edges = TileEdges::new(triangles, lane, self.sample_range);
        for y in range.y0..range.y1 {
            for x in range.x0..range.x1 {
                if columns > 1 && rows > 1 && edges.miss(x, y, self.grid.tile_log2()) {
                    continue;
                }
                let tile = self.grid.tile_at(x.cast_unsigned(), y.cast_unsigned());
                if many {
                    let lanes = 1 << lane;
                    bins.push(tile, BinEntry::Triangles { packet, lanes });
                } else {
                    bins.push_lane(tile, packet, lane);
                }
            }
        }
        if many {
            bins.end_run();
        }
    }

    /// Adds a line to a chunk, whose pixels begin no farther from it than `reach`, in 1/256 pixel.
    pub(crate) fn push_line(&self, line: LinePrimitive, reach: i32, chunk: &mut Chunk) {
        let [a, b] = &line.ends;
        let range = self.tiles_of(
            [a.x.min(b.x), a.y.min(b.y), a.x.max(b.x), a.y.max(b.y)],
            reach,
        );
        let entry = BinEntry::Line(u32::try_from(chunk.lines.len()).unwrap_or(u32::MAX));
        chunk.lines.push(line);
        self.push_range(range, entry, chunk);
    }

    /// Adds a point to a chunk.
    pub(crate) fn push_point(&self, point: PointPrimitive, chunk: &mut Chunk) {
        let (x, y, half) = (point.center.x, point.center.y, point.half);
        let range = self.tiles_of([x - half, y - half, x + half, y + half], 0);
        let entry = BinEntry::Point(u32::try_from(chunk.points.len()).unwrap_or(u32::MAX));
        chunk.points.push(point);
        self.push_range(range, entry, chunk);
    }

    /// The tiles of a box in 1/256 pixel, grown by a margin, inside the rectangle of pixels.
    fn tiles_of(&self, [x0, y0, x1, y1]: [i32; 4], margin: i32) -> Option<TileRange> {
        let (rect, log2) = (self.rect, self.grid.tile_log2());
        let first = |low: i32, edge: i32| ((low - margin) >> 8).max(edge);
        let last = |high: i32, edge: i32| ((high + margin) >> 8).min(edge - 1);
        let (x0, x1) = (first(x0, rect.x0), last(x1, rect.x1));
        let (y0, y1) = (first(y0, rect.y0), last(y1, rect.y1));
        let range = TileRange {
            x0: x0 >> log2,
            y0: y0 >> log2,
            x1: (x1 >> log2) + 1,
            y1: (y1 >> log2) + 1,
        };
        (x0 <= x1 && y0 <= y1).then_some(range)
    }

    fn push_range(&self, range: Option<TileRange>, entry: BinEntry, chunk: &mut Chunk) {
        let Some(range) = range else {
            return;
        };
        chunk.statistics.primitives_binned += 1;
        for y in range.y0..range.y1 {
            for x in range.x0..range.x1 {
                let tile = self.grid.tile_at(x.cast_unsigned(), y.cast_unsigned());
                chunk.bins.push(tile, entry);
            }
        }
    }
}

/// The edges of one triangle, to tell tiles of its box that it misses. Exact in 64 bits.
struct TileEdges {
    /// For each edge the values at a point: `a·x + b·y + c`, in 1/256 pixel; inside is ≥ 0.
    edges: [[i64; 3]; 3],
    sample_range: [i32; 2],
}

impl TileEdges {
    fn new(packet: &TrianglePacket, lane: usize, sample_range: [i32; 2]) -> Self {
        let at = |corner: usize| {
            (
                i64::from(packet.x[corner][lane]),
                i64::from(packet.y[corner][lane]),
            )
        };
        let clockwise = packet.clockwise >> lane & 1 == 1;
        let ends = if clockwise {
            [(0, 1), (1, 2), (2, 0)]
        } else {
            [(0, 2), (2, 1), (1, 0)]
        };
        let edge = |(from, to)| {
            let ((ax, ay), (bx, by)) = (at(from), at(to));
            [ay - by, bx - ax, (by - ay) * ax - (bx - ax) * ay]
        };
        Self {
            edges: ends.map(edge),
            sample_range,
        }
    }

    /// Whether no sample of the tile can be inside.
    fn miss(&self, column: i32, row: i32, tile_log2: u32) -> bool {
        let [first, last] = self.sample_range;
        let low = |tile: i32| i64::from((tile << (tile_log2 + 8)) + first);
        let high = |tile: i32| i64::from(((tile + 1) << (tile_log2 + 8)) - 256 + last);
        self.edges.iter().any(|[a, b, c]| {
            let x = if *a > 0 { high(column) } else { low(column) };
            let y = if *b > 0 { high(row) } else { low(row) };
            a * x + b * y + c < 0
        })
    }
}
