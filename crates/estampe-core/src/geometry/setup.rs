//! Set-up (R1, R5): sorts a triangle's vertices, makes its planes, and bins it.
//!
//! *In* window vertices · *Out* [`TrianglePacket`]s, lines and points in [`Bins`](crate::tiles::Bins) ·
//! *Space* window · *Precision* positions exact, planes f32 in the order of `docs/NUMERICS.md`.
//!
//! Triangles that survive culling are gathered into packets of sixteen, whose planes are computed
//! together, whoever their neighbours were. Sorting by (y, x) first makes everything that follows
//! independent of the order in which a triangle's vertices were given.

use super::viewport::PixelRect;
use crate::layout::TileGrid;
use crate::tiles::{
    BinEntry, Chunk, LinePrimitive, PlanePacket, PointPrimitive, TrianglePacket, VertexRef,
    WindowVertex,
};
use estampe_simd::{Bytes, LANES, Lanes, Level, SimdBase, SimdCvtFloat, dispatch, f32x16, i32x16};

/// One triangle on its way into a packet.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SetupTriangle {
    /// In the order given.
    pub(crate) vertices: [WindowVertex; 3],
    pub(crate) provoking: VertexRef,
    /// In the order given, in 1/256 pixel²; not 0.
    pub(crate) doubled_area: i64,
    pub(crate) front: bool,
}

/// Where primitives are binned.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BinState {
    pub(crate) grid: TileGrid,
    pub(crate) rect: PixelRect,
    /// The least and the greatest offset of a sample inside its pixel, in 1/256 pixel.
    pub(crate) sample_range: [i32; 2],
}

/// Fills packets and bins them into a chunk.
#[derive(Debug)]
pub(crate) struct Setup<'a> {
    level: Level,
    bins: BinState,
    packet: Box<TrianglePacket>,
    z_at: [[f32; LANES]; 3],
    chunk: &'a mut Chunk,
}

/// A half-open range of tiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct TileRange {
    x0: i32,
    y0: i32,
    x1: i32,
    y1: i32,
}

impl<'a> Setup<'a> {
    pub(crate) fn new(level: Level, bins: BinState, chunk: &'a mut Chunk) -> Self {
        let packet = Box::new(TrianglePacket::EMPTY);
        Self {
            level,
            bins,
            packet,
            z_at: [[0.0; LANES]; 3],
            chunk,
        }
    }

    pub(crate) fn chunk(&mut self) -> &mut Chunk {
        self.chunk
    }

    /// Adds a triangle.
    #[inline(always)]
    pub(crate) fn push(&mut self, triangle: &SetupTriangle) {
        let (order, odd) = sorted(&triangle.vertices);
        let packet = &mut *self.packet;
        let lane = packet.len as usize % LANES;
        for (corner, &from) in order.iter().enumerate() {
            let vertex = &triangle.vertices[from];
            packet.x[corner][lane] = vertex.x;
            packet.y[corner][lane] = vertex.y;
            packet.vertex[corner][lane] = vertex.vertex;
            packet.iw_at[corner][lane] = vertex.iw;
            self.z_at[corner][lane] = vertex.z;
        }
        packet.provoking[lane] = triangle.provoking;
        let area = if odd {
            -triangle.doubled_area
        } else {
            triangle.doubled_area
        };
        // One rounding; the division is done for all sixteen.
        packet.r[lane] = area as f32;
        packet.clockwise |= u16::from(area > 0) << lane;
        packet.front |= u16::from(triangle.front) << lane;
        packet.len += 1;
        if usize::from(packet.len) == LANES {
            self.finish_packet();
        }
    }

    /// Sets up and bins the packet that is being filled.
    pub(crate) fn finish_packet(&mut self) {
        if self.packet.len == 0 {
            return;
        }
        let ranges =
            dispatch!(self.level, s => finish(s, &mut self.packet, &self.z_at, &self.bins));
        self.bin_packet(&ranges);
        self.chunk.statistics.primitives_binned += u64::from(self.packet.len);
        self.chunk.triangles.push((*self.packet).clone());
        self.packet.len = 0;
        self.packet.clockwise = 0;
        self.packet.front = 0;
    }

    fn bin_packet(&mut self, ranges: &[[i32; LANES]; 4]) {
        let packet_index = u32::try_from(self.chunk.triangles.len()).unwrap_or(u32::MAX);
        let bins = &mut self.chunk.bins;
        bins.end_run();
        let len = usize::from(self.packet.len);
        let [left, top, right, bottom] = ranges;
        let sides = left.iter().zip(top).zip(right.iter().zip(bottom)).take(len);
        for (lane, ((&x0, &y0), (&x1, &y1))) in sides.enumerate() {
            let range = TileRange {
                x0,
                y0,
                x1: x1 + 1,
                y1: y1 + 1,
            };
            let (columns, rows) = (range.x1 - range.x0, range.y1 - range.y0);
            if columns == 1 && rows == 1 {
                let tile = self
                    .bins
                    .grid
                    .tile_at(x0.cast_unsigned(), y0.cast_unsigned());
                bins.push_lane(tile, packet_index, lane);
                continue;
            }
            // A triangle of many tiles has entries of its own: looking for one to merge with would
            // take time quadratic in tiles. Small ones before and after it must not merge across it.
            let many = columns * rows > 4;
            if many {
                bins.end_run();
            }
            let edges = TileEdges::new(&self.packet, lane, self.bins.sample_range);
            for y in range.y0..range.y1 {
                for x in range.x0..range.x1 {
                    if columns > 1 && rows > 1 && edges.miss(x, y, self.bins.grid.tile_log2()) {
                        continue;
                    }
                    let tile = self.bins.grid.tile_at(x.cast_unsigned(), y.cast_unsigned());
                    if many {
                        let lanes = 1 << lane;
                        bins.push(
                            tile,
                            BinEntry::Triangles {
                                packet: packet_index,
                                lanes,
                            },
                        );
                    } else {
                        bins.push_lane(tile, packet_index, lane);
                    }
                }
            }
            if many {
                bins.end_run();
            }
        }
    }

    /// Adds a line.
    pub(crate) fn push_line(&mut self, line: LinePrimitive) {
        let [a, b] = &line.ends;
        // Pixels whose centres the line's box may touch on either axis.
        let range = self.tiles_of(
            [a.x.min(b.x), a.y.min(b.y), a.x.max(b.x), a.y.max(b.y)],
            256,
        );
        let entry = BinEntry::Line(u32::try_from(self.chunk.lines.len()).unwrap_or(u32::MAX));
        self.chunk.lines.push(line);
        self.push_range(range, entry);
    }

    /// Adds a point.
    pub(crate) fn push_point(&mut self, point: PointPrimitive) {
        let (x, y, half) = (point.center.x, point.center.y, point.half);
        let range = self.tiles_of([x - half, y - half, x + half, y + half], 0);
        let entry = BinEntry::Point(u32::try_from(self.chunk.points.len()).unwrap_or(u32::MAX));
        self.chunk.points.push(point);
        self.push_range(range, entry);
    }

    /// The tiles of a box in 1/256 pixel, grown by a margin, inside the rectangle of pixels.
    fn tiles_of(&self, [x0, y0, x1, y1]: [i32; 4], margin: i32) -> Option<TileRange> {
        let (rect, log2) = (self.bins.rect, self.bins.grid.tile_log2());
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

    fn push_range(&mut self, range: Option<TileRange>, entry: BinEntry) {
        let Some(range) = range else {
            return;
        };
        self.chunk.statistics.primitives_binned += 1;
        for y in range.y0..range.y1 {
            for x in range.x0..range.x1 {
                let tile = self.bins.grid.tile_at(x.cast_unsigned(), y.cast_unsigned());
                self.chunk.bins.push(tile, entry);
            }
        }
    }
}

/// The order of three vertices by (y, x), and whether it is an odd permutation. Equal ones keep theirs.
#[inline(always)]
fn sorted(vertices: &[WindowVertex; 3]) -> ([usize; 3], bool) {
    let before = |a: usize, b: usize| {
        let (a, b) = (&vertices[a], &vertices[b]);
        (a.y, a.x) <= (b.y, b.x)
    };
    let (mut order, mut odd) = ([0, 1, 2], false);
    for (a, b) in [(0, 1), (1, 2), (0, 1)] {
        if !before(order[a], order[b]) {
            order.swap(a, b);
            odd = !odd;
        }
    }
    (order, odd)
}

/// Computes the planes of a packet and each lane's range of tiles: first and last column and row.
#[inline(always)]
fn finish<S: Lanes>(
    s: S,
    packet: &mut TrianglePacket,
    z_at: &[[f32; LANES]; 3],
    bins: &BinState,
) -> [[i32; LANES]; 4] {
    let load = |values: &[i32; LANES]| i32x16::load_array_ref(s, values);
    let floats = |values: &[f32; LANES]| f32x16::load_array_ref(s, values);
    let [x0, x1, x2] = [load(&packet.x[0]), load(&packet.x[1]), load(&packet.x[2])];
    let [y0, y1, y2] = [load(&packet.y[0]), load(&packet.y[1]), load(&packet.y[2])];
    let pixels = |subpixels: i32x16<S>| f32x16::float_from(subpixels) * (1.0 / 256.0);
    let edges = Edges {
        dx1: pixels(x1 - x0),
        dy1: pixels(y1 - y0),
        dx2: pixels(x2 - x0),
        dy2: pixels(y2 - y0),
        r: <f32x16<S> as SimdBase<S>>::splat(s, 65_536.0) / floats(&packet.r),
    };
    edges.r.store_array(&mut packet.r);
    let [z0, z1, z2] = [floats(&z_at[0]), floats(&z_at[1]), floats(&z_at[2])];
    edges.plane(z0, z1, z2, &mut packet.z);
    let w = &packet.iw_at;
    let [w0, w1, w2] = [floats(&w[0]), floats(&w[1]), floats(&w[2])];
    edges.plane(w0, w1, w2, &mut packet.iw);
    let [b0, b1, b2]: [i32x16<S>; 3] = [w0.bitcast(), w1.bitcast(), w2.bitcast()];
    packet.equal_w = s.bits_of_mask(b0.simd_eq(b1) & b0.simd_eq(b2));

    let splat = |value: i32| <i32x16<S> as SimdBase<S>>::splat(s, value);
    let [first, last] = bins.sample_range.map(splat);
    let rect = bins.rect;
    let log2 = bins.grid.tile_log2();
    let (x_min, x_max) = (x0.min(x1).min(x2), x0.max(x1).max(x2));
    let x_first = ((x_min - last + 255) >> 8).max(splat(rect.x0));
    let y_first = ((y0 - last + 255) >> 8).max(splat(rect.y0));
    let x_last = ((x_max - first) >> 8).min(splat(rect.x1 - 1));
    let y_last = ((y2 - first) >> 8).min(splat(rect.y1 - 1));
    [
        (x_first >> log2).to_array(),
        (y_first >> log2).to_array(),
        (x_last >> log2).to_array(),
        (y_last >> log2).to_array(),
    ]
}

/// Differences of sixteen triangles' positions, in pixels, and 1 ÷ doubled area.
struct Edges<S: Lanes> {
    dx1: f32x16<S>,
    dy1: f32x16<S>,
    dx2: f32x16<S>,
    dy2: f32x16<S>,
    r: f32x16<S>,
}

impl<S: Lanes> Edges<S> {
    #[inline(always)]
    fn plane(&self, p0: f32x16<S>, p1: f32x16<S>, p2: f32x16<S>, out: &mut PlanePacket) {
        let (e1, e2) = (p1 - p0, p2 - p0);
        p0.store_array(&mut out.origin);
        ((e1 * self.dy2 - e2 * self.dy1) * self.r).store_array(&mut out.dx);
        ((e2 * self.dx1 - e1 * self.dx2) * self.r).store_array(&mut out.dy);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertices_are_sorted_by_row_then_column() {
        let at = |x, y| WindowVertex {
            x,
            y,
            ..WindowVertex::default()
        };
        let cases = [
            ([at(0, 0), at(1, 0), at(0, 1)], [0, 1, 2], false),
            ([at(1, 0), at(0, 0), at(0, 1)], [1, 0, 2], true),
            ([at(5, 9), at(0, 1), at(9, 0)], [2, 1, 0], true),
            ([at(5, 9), at(9, 0), at(0, 1)], [1, 2, 0], false),
            ([at(3, 3), at(3, 3), at(0, 3)], [2, 0, 1], false),
        ];
        for (vertices, order, odd) in cases {
            assert_eq!(sorted(&vertices), (order, odd), "{vertices:?}");
        }
    }
}
