//! Coverage of small triangles, sixteen triangles at a time.
//!
//! A triangle whose box holds at most 8×8 pixels would leave most of sixteen pixels' lanes idle;
//! here the lanes are the triangles of a packet, and the loop is over the pixels of their boxes,
//! once for each sample of a pixel.
//! All differences of positions are below 2¹³, so that 32-bit edges are exact without a tile's
//! constants.
//!
//! ```text
//!     pixel (0,0)   (1,0)   (0,1)  …   of each lane's own box
//!       t₀ t₁ t₂ … t₁₅                 E = c + a·x + b·y ≥ 0 of three edges, for sixteen triangles
//! ```

use super::edge_lanes::{Corners, EdgeLanes, edges};
use super::parts::Parts;
use super::{SampleSet, TileShape};
use crate::bounds::pixel_rect::PixelRect;
use crate::bounds::primitives::TrianglePacket;
use estampe_simd::{
    Bytes, LANES, Lanes, Packet, Select, SimdBase, SimdCvtFloat, f32x16, i32x16, mask32x16, u32x16,
};

/// Columns and rows of pixels that a small triangle's box has at most.
pub(crate) const SIDE: i32 = 8;
/// Pixels of the largest box.
pub(crate) const PIXELS: usize = 64;

/// The columns and rows at most of the visibility path where a pixel has several samples: the
/// packets of a larger triangle hold enough of them, and what a triangle costs beside them is
/// shared by all of its samples.
const SIDE_OF_SAMPLES: i32 = 4;

/// A small triangle's extent in 1/256 pixel is below this, whatever part of it the tile shows.
const EXTENT: i32 = 1 << 12;

/// The boxes of small triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Boxes {
    /// The columns and rows at most: [`SIDE`] or fewer.
    pub(crate) side: i32,
    /// True if they begin at a quad, so that they hold quads whole.
    pub(crate) quads: bool,
}

/// The pixels of sixteen boxes that may be covered.
pub(super) struct BoxPixels<S: Lanes> {
    /// Columns and rows, less one.
    pub(super) across: i32x16<S>,
    pub(super) down: i32x16<S>,
    /// The columns and rows at the beginning that are left out.
    pub(super) before: i32x16<S>,
    pub(super) above: i32x16<S>,
    /// The boxes that have pixels.
    pub(super) among: mask32x16<S>,
}

/// Small triangles of one packet inside a tile, or [small lines](super::small_lines).
#[derive(Debug, Clone)]
#[repr(C, align(64))]
pub(crate) struct SmallBoxes<const N: usize> {
    /// By sample and lane: bit 8·row + column is that pixel of its box, rows 0 to 3 and 4 to 7.
    pub(super) covered: [[Packet<u32>; 2]; N],
    /// Rows of the largest box.
    pub(super) rows: usize,
    /// By lane: column and row of the box's first pixel in the tile, the row in the upper half.
    pub(super) first: Packet<u32>,
    /// By lane: columns and rows of the box, less one, the rows in the upper half; of
    /// [small triangles](Self::cover_boxes) alone.
    pub(super) extent: [u32; LANES],
    /// By lane: the distance of that pixel's first sample from the planes' origin.
    pub(super) from_x: [f32; LANES],
    pub(super) from_y: [f32; LANES],
}

impl<const N: usize> Default for SmallBoxes<N> {
    fn default() -> Self {
        Self {
            covered: [[Packet::default(); 2]; N],
            rows: 0,
            first: Packet::default(),
            extent: [0; LANES],
            from_x: [0.0; LANES],
            from_y: [0.0; LANES],
        }
    }
}

impl<const N: usize> SmallBoxes<N> {
    /// Covers those of the packet's triangles in `lanes` that are small; returns which those are.
    /// Of several samples, [larger ones](Self::cover_boxes) are left to others.
    #[inline(always)]
    pub(crate) fn cover<S: Lanes>(
        &mut self,
        s: S,
        packet: &TrianglePacket,
        lanes: u16,
        tile: (TileShape, &PixelRect),
        samples: SampleSet<N>,
    ) -> u16 {
        let side = if const { N == 1 } {
            SIDE
        } else {
            SIDE_OF_SAMPLES
        };
        let boxes = Boxes { side, quads: false };
        self.cover_boxes(s, boxes, &Parts::WHOLE, (packet, lanes), (tile, samples))
    }

    /// [`SmallBoxes::cover`] of the triangles whose boxes are as given, or of parts of larger
    /// ones, of which all or none are covered. Rectangles are of one sample.
    #[inline(always)]
    pub(crate) fn cover_boxes<S: Lanes>(
        &mut self,
        s: S,
        boxes: Boxes,
        parts: &Parts,
        (packet, lanes): (&TrianglePacket, u16),
        ((tile, rect), samples): ((TileShape, &PixelRect), SampleSet<N>),
    ) -> u16 {
        let splat = |value: i32| <i32x16<S> as SimdBase<S>>::splat(s, value);
        let corners = Corners::new(s, packet);
        let ([x0, ..], [y0, _, y2]) = (corners.x, corners.y);
        let [x_min, x_max] = corners.x_ends;
        // The box's pixels in the tile: those of which samples may lie in it. Of one sample, those
        // whose centres do.
        let positions = samples.subpixels();
        let [x_ends, y_ends] = axis_ends(&positions);
        let x_first = ((x_min + (255 - x_ends[1])) >> 8).max(splat(tile.x + rect.x0));
        let y_first = ((y0 + (255 - y_ends[1])) >> 8).max(splat(tile.y + rect.y0));
        // Samples on the right and the lower side of a rectangle are outside.
        let is_rectangle = s.mask_from_bits(parts.rectangles);
        let off_side = is_rectangle.select(splat(1), splat(0));
        let (x_last, y_last) = (x_max - off_side - x_ends[0], y2 - off_side - y_ends[0]);
        let across = (x_last >> 8).min(splat(tile.x + rect.x1 - 1)) - x_first;
        let down = (y_last >> 8).min(splat(tile.y + rect.y1 - 1)) - y_first;
        let is_empty = across.simd_lt(splat(0)) | down.simd_lt(splat(0));
        // Boxes of quads begin at a quad: its first column or row may lie before the box.
        let (mut before, mut above) = (splat(0), splat(0));
        if boxes.quads {
            (before, above) = (x_first & splat(1), y_first & splat(1));
        }
        let (mut across, mut down) = (across + before, down + above);
        let [columns, rows] = parts.divided;
        let (most, side) = (splat(2 * SIDE), splat(boxes.side));
        let columns = s.mask_from_bits(columns).select(most, side);
        let rows = s.mask_from_bits(rows).select(most, side);
        let extent = (x_max - x_min).max(y2 - y0);
        let is_small = extent.simd_lt(splat(EXTENT)) & across.simd_lt(columns) & down.simd_lt(rows);
        let small = s.bits_of_mask(is_small) & lanes;
        if small == 0 {
            return 0;
        }
        // A part begins where the part before it ends, at most.
        let (right, below) = parts.offsets(s);
        let x_first = x_first - before + right;
        let y_first = y_first - above + below;
        before = right.simd_eq(splat(0)).select(before, splat(0));
        above = below.simd_eq(splat(0)).select(above, splat(0));
        across = (across - right).min(splat(SIDE - 1));
        down = (down - below).min(splat(SIDE - 1));
        let is_empty = is_empty | across.simd_lt(splat(0)) | down.simd_lt(splat(0));
        let among = s.mask_from_bits(small) & !is_empty;

        let [first_x, first_y] = positions[0];
        let place = [(x_first << 8) + first_x, (y_first << 8) + first_y];
        let [first, second, third] = edges(s, packet, &corners, place);
        let mut edges = [first.at_point(), second.at_point(), third.at_point()];
        if parts.rectangles != 0 {
            for edge in &mut edges {
                // An edge that is inside everywhere.
                edge.value = is_rectangle.select(splat(0), edge.value);
                edge.a = is_rectangle.select(splat(0), edge.a);
                edge.b = is_rectangle.select(splat(0), edge.b);
            }
        }
        let pixels = BoxPixels {
            across,
            down,
            before,
            above,
            among,
        };
        self.cover_pixels(s, &edges, &pixels, positions);
        let offsets = [place[0] - x0, place[1] - y0];
        self.set_places([x_first - splat(tile.x), y_first - splat(tile.y)], offsets);
        // No packets in an empty box: it ends far away.
        let extent = among.select(across | (down << 16), splat(0x7FFF_7FFF));
        let extent: u32x16<S> = extent.bitcast();
        extent.store_array(&mut self.extent);
        small
    }

    /// Covers the pixels of sixteen boxes by the edges that hold in each, at the samples'
    /// positions. The edges' values are those at the first sample of each box's first pixel.
    #[inline(always)]
    pub(super) fn cover_pixels<S: Lanes, const EDGES: usize>(
        &mut self,
        s: S,
        edges: &[EdgeLanes<S>; EDGES],
        pixels: &BoxPixels<S>,
        positions: [[i32; 2]; N],
    ) {
        let splat = |value: i32| <i32x16<S> as SimdBase<S>>::splat(s, value);
        let BoxPixels {
            across,
            down,
            before,
            above,
            among,
        } = *pixels;
        let (columns, rows) = (largest(s, across, among), largest(s, down, among));
        // What a pixel further on adds.
        let (mut to_right, mut below) = ([splat(0); EDGES], [splat(0); EDGES]);
        let mut first = [splat(0); EDGES];
        for (number, edge) in edges.iter().enumerate() {
            to_right[number] = edge.a << 8;
            below[number] = edge.b << 8;
            first[number] = edge.value;
        }
        let [first_x, first_y] = positions[0];
        // The columns of each box, and with them the lanes that have a row.
        let mut inside_box = splat(0);
        for column in 0..columns {
            let has_column = across.simd_ge(splat(column)) & before.simd_le(splat(column)) & among;
            inside_box = has_column.select(inside_box | splat(1 << column), inside_box);
        }
        for (covered, [x, y]) in self.covered.iter_mut().zip(positions) {
            let [x, y] = [x - first_x, y - first_y];
            // The rows of a sample: the edges at its place in the first pixel, and down from there.
            let mut row_edges = first;
            if const { N > 1 } {
                for (value, edge) in row_edges.iter_mut().zip(edges) {
                    *value += edge.a * x + edge.b * y;
                }
            }
            let mut halves = [splat(0); 2];
            for row in 0..rows {
                let mut values = row_edges;
                let mut of_row = splat(0);
                for column in 0..columns {
                    // Outside an edge the sign bit is set.
                    let mut outside = values[0];
                    for value in &values[1..] {
                        outside |= *value;
                    }
                    let outside = outside >> 31;
                    of_row |= !outside & splat(1 << column);
                    for (value, step) in values.iter_mut().zip(to_right) {
                        *value += step;
                    }
                }
                let has_row = down.simd_ge(splat(row)) & above.simd_le(splat(row));
                let of_row = has_row.select(of_row & inside_box, splat(0));
                let (half, shift) = ((row >> 2) as usize & 1, (row & 3) * SIDE);
                halves[half] |= of_row << shift.cast_unsigned();
                for (value, step) in row_edges.iter_mut().zip(below) {
                    *value += step;
                }
            }
            let [upper, lower]: [u32x16<S>; 2] = halves.map(|half| half.bitcast());
            upper.store_array(&mut covered[0].0);
            lower.store_array(&mut covered[1].0);
        }
        self.rows = rows as usize;
    }

    /// Notes where the boxes are in the tile, and how far, in 1/256 pixel, the first samples of
    /// their first pixels are from the origins.
    #[inline(always)]
    pub(super) fn set_places<S: Lanes>(&mut self, [x, y]: [i32x16<S>; 2], from: [i32x16<S>; 2]) {
        let first: u32x16<S> = (x | (y << 16)).bitcast();
        first.store_array(&mut self.first.0);
        // Distances are exact: multiples of 1/256 below 2¹⁶.
        let [from_x, from_y] = from;
        (f32x16::float_from(from_x) * (1.0 / 256.0)).store_array(&mut self.from_x);
        (f32x16::float_from(from_y) * (1.0 / 256.0)).store_array(&mut self.from_y);
    }
}

/// The least and the greatest x, then y.
#[inline(always)]
pub(super) fn axis_ends<const N: usize>(positions: &[[i32; 2]; N]) -> [[i32; 2]; 2] {
    let [x, y] = positions[0];
    let mut ends = [[x; 2], [y; 2]];
    for position in positions {
        for ([least, most], at) in ends.iter_mut().zip(*position) {
            *least = at.min(*least);
            *most = at.max(*most);
        }
    }
    ends
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
