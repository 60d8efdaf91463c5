//! Coverage of small triangles, sixteen triangles at a time.
//!
//! A triangle whose box holds at most 8×8 pixels would leave most of sixteen pixels' lanes idle;
//! here the lanes are the triangles of a packet, and the loop is over the pixels of their boxes.
//! All differences of positions are below 2¹³, so that 32-bit edges are exact without a tile's
//! constants.
//!
//! ```text
//!     pixel (0,0)   (1,0)   (0,1)  …   of each lane's own box
//!       t₀ t₁ t₂ … t₁₅                 E = c + a·x + b·y ≥ 0 of three edges, for sixteen triangles
//! ```

use super::TileShape;
use crate::bounds::pixel_rect::PixelRect;
use crate::bounds::primitives::TrianglePacket;
use crate::depth_format::StoredDepth;
use estampe_simd::{
    Bytes, LANES, Lanes, Select, SimdBase, SimdCvtFloat, f32x16, i32x16, mask32x16, u32x16,
};

/// Columns and rows of pixels that a small triangle's box has at most.
const SIDE: i32 = 8;
/// Pixels of the largest box.
pub(crate) const PIXELS: usize = 64;

/// A small triangle's extent in 1/256 pixel is below this, whatever part of it the tile shows.
const EXTENT: i32 = 1 << 12;

/// Small triangles of one packet inside a tile, with the depth of every pixel of their boxes.
#[derive(Debug, Clone)]
#[repr(C, align(64))]
pub(crate) struct SmallTriangles {
    /// By pixel of the box (8·row + column), the depth of each lane, clamped.
    pub(crate) depth: [[f32; LANES]; PIXELS],
    /// By lane: bit 8·row + column is that pixel of its box, rows 0 to 3 and 4 to 7.
    covered: [[i32; LANES]; 2],
    /// By column and lane: the bits of the pixel's place in the tile that come from x.
    place_x: [[u32; LANES]; SIDE as usize],
    /// By row and lane: those that come from y.
    place_y: [[u32; LANES]; SIDE as usize],
    /// By lane: the distance of that pixel's centre from the planes' origin.
    pub(crate) from_x: [f32; LANES],
    pub(crate) from_y: [f32; LANES],
}

impl Default for SmallTriangles {
    fn default() -> Self {
        Self {
            depth: [[0.0; LANES]; PIXELS],
            covered: [[0; LANES]; 2],
            place_x: [[0; LANES]; SIDE as usize],
            place_y: [[0; LANES]; SIDE as usize],
            from_x: [0.0; LANES],
            from_y: [0.0; LANES],
        }
    }
}

impl SmallTriangles {
    /// The pixels of a lane's box that are covered: bit 8·row + column.
    #[inline(always)]
    pub(crate) fn pixels_of(&self, lane: usize) -> u64 {
        let [upper, lower] = [self.covered[0][lane], self.covered[1][lane]];
        u64::from(upper.cast_unsigned()) | u64::from(lower.cast_unsigned()) << 32
    }

    /// Returns the index in its tile at which a pixel of a lane's box is stored, if the pixel is
    /// covered.
    #[inline(always)]
    pub(crate) fn place_of(&self, pixel: usize, lane: usize) -> usize {
        let (column, row) = (pixel % SIDE as usize, pixel / SIDE as usize % SIDE as usize);
        (self.place_x[column][lane] | self.place_y[row][lane]) as usize
    }

    /// Covers those of the packet's triangles in `lanes` that are small; returns which those are.
    #[inline(always)]
    pub(crate) fn cover<S: Lanes>(
        &mut self,
        s: S,
        packet: &TrianglePacket,
        lanes: u16,
        (tile, rect): (TileShape, &PixelRect),
        stored: StoredDepth,
    ) -> u16 {
        let splat = |value: i32| <i32x16<S> as SimdBase<S>>::splat(s, value);
        let (mut x, mut y) = ([splat(0); 3], [splat(0); 3]);
        for corner in 0..3 {
            x[corner] = i32x16::load_array_ref(s, &packet.x[corner]);
            y[corner] = i32x16::load_array_ref(s, &packet.y[corner]);
        }
        let ([x0, x1, x2], [y0, y1, y2]) = (x, y);
        let (x_min, x_max) = (x0.min(x1).min(x2), x0.max(x1).max(x2));
        // The box's pixels: those whose centres lie in it, in the tile.
        let x_first = ((x_min + 127) >> 8).max(splat(tile.x + rect.x0));
        let y_first = ((y0 + 127) >> 8).max(splat(tile.y + rect.y0));
        let across = ((x_max - 128) >> 8).min(splat(tile.x + rect.x1 - 1)) - x_first;
        let down = ((y2 - 128) >> 8).min(splat(tile.y + rect.y1 - 1)) - y_first;
        let extent = (x_max - x_min).max(y2 - y0);
        let is_small =
            extent.simd_lt(splat(EXTENT)) & across.simd_lt(splat(SIDE)) & down.simd_lt(splat(SIDE));
        let small = s.bits_of_mask(is_small) & lanes;
        if small == 0 {
            return 0;
        }
        let among = s.mask_from_bits(small);
        let is_empty = across.simd_lt(splat(0)) | down.simd_lt(splat(0));
        let among = among & !is_empty;
        let (columns, rows) = (largest(s, across, among), largest(s, down, among));

        let edges = edges(s, packet, [x0, x1, x2], [y0, y1, y2], [x_first, y_first]);
        let origin = f32x16::load_array_ref(s, &packet.z.origin);
        let dx = f32x16::load_array_ref(s, &packet.z.dx);
        let dy = f32x16::load_array_ref(s, &packet.z.dy);
        // Distances from the planes' origin are exact: multiples of 1/256 below 2¹⁶.
        let from_x = f32x16::float_from((x_first << 8) + 128 - x0) * (1.0 / 256.0);
        let from_y = f32x16::float_from((y_first << 8) + 128 - y0) * (1.0 / 256.0);

        let mut covered = [splat(0); 2];
        let mut row_edges = [edges[0].value, edges[1].value, edges[2].value];
        for row in 0..rows {
            let by_y = (from_y + row as f32) * dy;
            let mut values = row_edges;
            let half = (row >> 2) as usize & 1;
            for column in 0..columns {
                // Outside an edge, or beyond the box: the sign bit is set.
                let beyond = (across - column) | (down - row);
                let outside = values[0] | values[1] | values[2] | beyond;
                let inside = outside.simd_ge(splat(0)) & among;
                let bit = 1i32 << ((row & 3) * SIDE + column);
                covered[half] = inside.select(covered[half] | splat(bit), covered[half]);
                let by_x = (from_x + column as f32) * dx;
                let depth = origin + (by_x + by_y);
                let depth = stored.of(s, depth);
                depth.store_array(&mut self.depth[(row * SIDE + column) as usize % PIXELS]);
                for (value, edge) in values.iter_mut().zip(&edges) {
                    *value += edge.a;
                }
            }
            for (value, edge) in row_edges.iter_mut().zip(&edges) {
                *value += edge.b;
            }
        }
        let [upper, lower] = covered;
        upper.store_array(&mut self.covered[0]);
        lower.store_array(&mut self.covered[1]);
        let (x, y) = (x_first - tile.x, y_first - tile.y);
        for column in 0..columns {
            let place = spread(s, x + column);
            place.store_array(&mut self.place_x[column as usize % SIDE as usize]);
        }
        for row in 0..rows {
            let place = spread(s, y + row) << 1;
            place.store_array(&mut self.place_y[row as usize % SIDE as usize]);
        }
        from_x.store_array(&mut self.from_x);
        from_y.store_array(&mut self.from_y);
        small
    }
}

/// Moves bit i of six-bit numbers to bit 2i.
#[inline(always)]
fn spread<S: Lanes>(s: S, value: i32x16<S>) -> u32x16<S> {
    let mask = |bits: u32| <u32x16<S> as SimdBase<S>>::splat(s, bits);
    let v: u32x16<S> = value.bitcast();
    let v = v & mask(0x3F);
    let v = (v | (v << 4)) & mask(0x30F);
    let v = (v | (v << 2)) & mask(0x333);
    (v | (v << 1)) & mask(0x555)
}

/// One edge of sixteen triangles: its value at the box's first pixel, and what a pixel further
/// adds.
#[derive(Clone, Copy)]
struct EdgeLanes<S: Lanes> {
    value: i32x16<S>,
    a: i32x16<S>,
    b: i32x16<S>,
}

/// The three edges, wound so that inside is ≥ 0, the fill rule folded in.
///
/// Vertices are sorted by (y, x), which decides what is a top or a left edge: clockwise 0→1 and 1→2
/// where they are level (top) and 2→0 always (left); counter-clockwise 0→2 never, 2→1 and 1→0 where
/// they rise (left).
#[inline(always)]
fn edges<S: Lanes>(
    s: S,
    packet: &TrianglePacket,
    [x0, x1, x2]: [i32x16<S>; 3],
    [y0, y1, y2]: [i32x16<S>; 3],
    [x_first, y_first]: [i32x16<S>; 2],
) -> [EdgeLanes<S>; 3] {
    let clockwise = s.mask_from_bits(packet.clockwise);
    let never = s.mask_from_bits(0);
    let always = s.mask_from_bits(u16::MAX);
    let (level_01, level_12) = (y0.simd_eq(y1), y1.simd_eq(y2));
    let wound = Winding {
        clockwise,
        center: [(x_first << 8) + 128, (y_first << 8) + 128],
    };
    [
        wound.edge(s, [x0, y0], [x1, y1], [level_01, !level_01]),
        wound.edge(s, [x1, y1], [x2, y2], [level_12, !level_12]),
        wound.edge(s, [x2, y2], [x0, y0], [always, never]),
    ]
}

/// The winding of sixteen triangles, and the centres of the first pixels.
struct Winding<S: Lanes> {
    clockwise: mask32x16<S>,
    center: [i32x16<S>; 2],
}

impl<S: Lanes> Winding<S> {
    /// The edge from a to b of clockwise triangles, from b to a of others; and where each has its
    /// samples inside.
    #[inline(always)]
    fn edge(
        &self,
        s: S,
        [ax, ay]: [i32x16<S>; 2],
        [bx, by]: [i32x16<S>; 2],
        [if_clockwise, if_not]: [mask32x16<S>; 2],
    ) -> EdgeLanes<S> {
        let (zero, less) = (
            <i32x16<S> as SimdBase<S>>::splat(s, 0),
            <i32x16<S> as SimdBase<S>>::splat(s, -1),
        );
        let (a, b) = (ay - by, bx - ax);
        let a = self.clockwise.select(a, zero - a);
        let b = self.clockwise.select(b, zero - b);
        let owns = (self.clockwise & if_clockwise) | (!self.clockwise & if_not);
        let [x, y] = self.center;
        EdgeLanes {
            value: a * (x - ax) + b * (y - ay) + owns.select(zero, less),
            a: a << 8,
            b: b << 8,
        }
    }
}

/// The number of columns (or rows) of the largest of some boxes; `span` holds one less of each.
#[inline(always)]
fn largest<S: Lanes>(s: S, span: i32x16<S>, among: mask32x16<S>) -> i32 {
    let mut count = 1;
    while count < SIDE {
        let reached = span.simd_ge(<i32x16<S> as SimdBase<S>>::splat(s, count)) & among;
        if s.bits_of_mask(reached) == 0 {
            break;
        }
        count += 1;
    }
    count
}
