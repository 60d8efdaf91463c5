//! Coverage of small lines, sixteen lines at a time.
//!
//! A line of five pixels lies in two packets or three, and leaves most of their lanes idle. As of
//! [small triangles](super::small), lanes are lines, and the loop is over the pixels of their boxes.
//! Any line is four edges: those of its rectangle, or, of Bresenham lines, the two that cut
//! the pixels' columns and the two between which its columns begin and end:
//!
//! ```text
//!       ┌──────────┐              │ · ─ ─ ┬ ·      Bresenham, x-major: a pixel is covered if the
//!      a┤          ├b   or       a│       │b       line goes through its column's centre between
//!       └──────────┘              └ ─ ─ ─ ┘        its lower and its upper edge
//! ```
//!
//! A line that is too long for one box is two halves, each of which is a lane.

#[cfg(test)]
mod tests;

use super::edge_lanes::EdgeLanes;
use super::small::{BoxPixels, SIDE, SmallBoxes, axis_ends};
use super::{SampleSet, TileShape};
use crate::bounds::lines::LinePacket;
use crate::bounds::pixel_rect::PixelRect;
use crate::geometry::line_style::LineShape;
use estampe_simd::{
    LANES, Lanes, Select, SimdBase, SimdCvtFloat, SimdFloat, f32x16, i32x16, mask32x16,
};

/// Columns (of a y-major line, rows) of the first half of a line. An even number, so that both
/// halves begin at a quad if the line's box does. On the way through them a line of one pixel's
/// width touches seven rows at most: 5 steps of at most one pixel, and √2 pixels.
const HALF: i32 = 6;

/// A small line's box is less than this wide and high, in 1/256 pixel: 14 pixels. With two pixels
/// around it, products of distances in it are below 2²⁴, so that 32-bit floats hold them.
const EXTENT: i32 = 14 * 256;

/// How far a line of one pixel's width reaches from its middle along its minor axis, at most, in
/// 1/256 pixel: half its width times √2, and the rounding of [`Bounds::halved`].
const REACH: f32 = 182.0 + 3.0;

/// How many lanes lines take: those in neither mask are drawn alone.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct LineSizes {
    /// Those that take one lane.
    pub(crate) one: u16,
    /// Those that take two.
    pub(crate) two: u16,
}

impl LineSizes {
    /// Those of a packet's lines; of what is in lanes that are not in use, anything.
    #[inline(always)]
    pub(crate) fn new<S: Lanes, const N: usize>(
        s: S,
        packet: &LinePacket,
        shape: LineShape,
        quads: bool,
    ) -> Self {
        let longest = LineLanes::new(s, packet).length;
        let (width, across) = match shape {
            LineShape::Columns { width } => (width as f32, 0.0),
            LineShape::Rectangle { width, .. } => (width, width * 182.0),
        };
        // An extent of n pixels holds the centres of n + 1 columns at most.
        let extent = (f32x16::float_from(longest) + across) * (1.0 / 256.0);
        let holds_up_to = |columns: i32| {
            let columns = (columns - i32::from(quads)) as f32;
            s.bits_of_mask(extent.simd_lt(<f32x16<S> as SimdBase<S>>::splat(s, columns)))
        };
        let limit = <i32x16<S> as SimdBase<S>>::splat(s, EXTENT);
        let short = s.bits_of_mask(longest.simd_lt(limit));
        let one = short & holds_up_to(SIDE);
        let two = if const { N == 1 } && width <= 1.0 {
            short & holds_up_to(2 * HALF) & !one
        } else {
            0
        };
        Self { one, two }
    }
}

/// Those lanes of a packet that are halves of lines.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct LineHalves {
    /// First and second halves.
    pub(crate) any: u16,
    pub(crate) seconds: u16,
}

/// Sixteen lines: where they begin, and the way to their ends.
struct LineLanes<S: Lanes> {
    start: [i32x16<S>; 2],
    way: [i32x16<S>; 2],
    /// The lines whose major axis is x.
    x_major: mask32x16<S>,
    /// The way along the major axis, without sign.
    length: i32x16<S>,
}

impl<S: Lanes> LineLanes<S> {
    #[inline(always)]
    fn new(s: S, lines: &LinePacket) -> Self {
        let load = |lanes: &[i32; LANES]| i32x16::load_array_ref(s, lanes);
        let zero = <i32x16<S> as SimdBase<S>>::splat(s, 0);
        let start = [load(&lines.x[0]), load(&lines.y[0])];
        let way = [load(&lines.x[1]) - start[0], load(&lines.y[1]) - start[1]];
        let across = way[0].max(zero - way[0]);
        let down = way[1].max(zero - way[1]);
        Self {
            start,
            way,
            x_major: across.simd_ge(down),
            length: across.max(down),
        }
    }
}

/// The shape of sixteen lines.
struct Outlines<S: Lanes> {
    /// With their values at the lines' starts.
    edges: [EdgeLanes<S>; 4],
    /// How far the shape reaches from the line between the ends.
    reach: [i32x16<S>; 2],
    /// The lines that have an area.
    exist: mask32x16<S>,
}

impl<S: Lanes> Outlines<S> {
    #[inline(always)]
    fn new(s: S, lines: &LineLanes<S>, shape: LineShape) -> Self {
        match shape {
            LineShape::Columns { width } => Self::columns(s, lines, width),
            LineShape::Rectangle { width, .. } => Self::rectangles(s, lines, width),
        }
    }

    /// As [`LineRectangle`](crate::geometry::line_style::LineRectangle).
    #[inline(always)]
    fn rectangles(s: S, lines: &LineLanes<S>, width: f32) -> Self {
        let zero = <i32x16<S> as SimdBase<S>>::splat(s, 0);
        let [x, y] = lines.way;
        let (dx, dy) = (f32x16::float_from(x), f32x16::float_from(y));
        let across = <f32x16<S> as SimdBase<S>>::splat(s, width * 128.0);
        let across = across / (dx * dx + dy * dy).sqrt();
        // Of a line without length, anything.
        let hx = s.round_to_i32((-dy) * across);
        let hy = s.round_to_i32(dx * across);
        let area = x * hy - y * hx;
        let edges = [
            edge_along(s, [x, y], area),
            edge_along(s, [hx, hy], area),
            edge_along(s, [zero - x, zero - y], area),
            edge_along(s, [zero - hx, zero - hy], zero),
        ];
        Self {
            edges,
            reach: [hx.max(zero - hx), hy.max(zero - hy)],
            exist: area.simd_gt(zero) & lines.length.simd_gt(zero),
        }
    }

    /// Of Bresenham lines: the pixels whose lower edge is below the line at their column's centre,
    /// and whose upper edge is not; and the columns whose centres lie between the ends.
    #[inline(always)]
    fn columns(s: S, lines: &LineLanes<S>, width: i32) -> Self {
        let (zero, one) = (
            <i32x16<S> as SimdBase<S>>::splat(s, 0),
            <i32x16<S> as SimdBase<S>>::splat(s, 1),
        );
        let ([x, y], x_major, length) = (lines.way, lines.x_major, lines.length);
        let major = x_major.select(x, y);
        let minor = x_major.select(y, x);
        let leftward = major.simd_lt(zero);
        let sign = leftward.select(zero - one, one);
        let rise = leftward.select(zero - minor, minor);
        let half = length * (width * 128);
        let edges = [
            edge_by_axes(x_major, [zero - rise, length], half - one),
            edge_by_axes(x_major, [rise, zero - length], half),
            edge_by_axes(x_major, [sign, zero], zero),
            edge_by_axes(x_major, [zero - sign, zero], length - one),
        ];
        let across = <i32x16<S> as SimdBase<S>>::splat(s, width * 128);
        Self {
            edges,
            reach: [x_major.select(zero, across), x_major.select(across, zero)],
            exist: length.simd_gt(zero),
        }
    }
}

/// The edge along a vector, whose inside is on the right of it as seen, y pointing down. Those that
/// rise own their points, and level ones with the inside below them.
#[inline(always)]
fn edge_along<S: Lanes>(s: S, [x, y]: [i32x16<S>; 2], value: i32x16<S>) -> EdgeLanes<S> {
    let (zero, one) = (
        <i32x16<S> as SimdBase<S>>::splat(s, 0),
        <i32x16<S> as SimdBase<S>>::splat(s, 1),
    );
    let owns = y.simd_lt(zero) | (y.simd_eq(zero) & x.simd_gt(zero));
    EdgeLanes {
        value: owns.select(value, value - one),
        a: zero - y,
        b: x,
    }
}

/// The edge that changes by these values along the major and the minor axis.
#[inline(always)]
fn edge_by_axes<S: Lanes>(
    x_major: mask32x16<S>,
    [major, minor]: [i32x16<S>; 2],
    value: i32x16<S>,
) -> EdgeLanes<S> {
    EdgeLanes {
        value,
        a: x_major.select(major, minor),
        b: x_major.select(minor, major),
    }
}

/// The pixels of sixteen boxes: the first, and the last one, column and row.
struct Bounds<S: Lanes> {
    first: [i32x16<S>; 2],
    last: [i32x16<S>; 2],
    /// The extent of the shapes in 1/256 pixel, whatever part of them the tile shows.
    extent: i32x16<S>,
}

impl<S: Lanes> Bounds<S> {
    #[inline(always)]
    fn new(
        s: S,
        lines: &LineLanes<S>,
        reach: [i32x16<S>; 2],
        (tile, rect): (TileShape, &PixelRect),
        sample_ends: [[i32; 2]; 2],
    ) -> Self {
        let splat = |value: i32| <i32x16<S> as SimdBase<S>>::splat(s, value);
        let (low, high) = (
            [tile.x + rect.x0, tile.y + rect.y0],
            [tile.x + rect.x1 - 1, tile.y + rect.y1 - 1],
        );
        let (mut first, mut last) = ([splat(0); 2], [splat(0); 2]);
        let mut extent = splat(0);
        for axis in 0..2 {
            let (from, to) = (lines.start[axis], lines.start[axis] + lines.way[axis]);
            let least = from.min(to) - reach[axis];
            let most = from.max(to) + reach[axis];
            let [least_sample, most_sample] = sample_ends[axis];
            first[axis] = ((least + (255 - most_sample)) >> 8).max(splat(low[axis]));
            last[axis] = ((most - least_sample) >> 8).min(splat(high[axis]));
            extent = extent.max(most - least);
        }
        Self {
            first,
            last,
            extent,
        }
    }

    /// The first row that a half of a line may touch, which begins at a column: or, if it is
    /// y-major, the first column of the half that begins at a row. Samples are in the middle of
    /// pixels.
    #[inline(always)]
    fn halved(s: S, lines: &LineLanes<S>, column: i32x16<S>) -> i32x16<S> {
        let ([x, y], [dx, dy]) = (lines.start, lines.way);
        let x_major = lines.x_major;
        let from = (column << 8) + 128 - x_major.select(x, y);
        let slope =
            f32x16::float_from(x_major.select(dy, dx)) / f32x16::float_from(x_major.select(dx, dy));
        let at_first = f32x16::float_from(from) * slope;
        let at_last = f32x16::float_from(from + (HALF - 1) * 256) * slope;
        let least = s.round_to_i32(s.min_f32(at_first, at_last) - REACH);
        (least + x_major.select(y, x) + 127) >> 8
    }
}

impl<const N: usize> SmallBoxes<N> {
    /// Covers those of the lines in `lanes` that are small, or halves of them; returns which those
    /// are: both halves of a line or none. Distances are then those from the lines' starts.
    #[inline(always)]
    pub(crate) fn cover_lines<S: Lanes>(
        &mut self,
        s: S,
        (packet, lanes, halves): (&LinePacket, u16, LineHalves),
        (shape, quads): (LineShape, bool),
        ((tile, rect), samples): ((TileShape, &PixelRect), SampleSet<N>),
    ) -> u16 {
        let splat = |value: i32| <i32x16<S> as SimdBase<S>>::splat(s, value);
        let lines = LineLanes::new(s, packet);
        let outlines = Outlines::new(s, &lines, shape);
        // Bresenham lines cover all samples of the pixels whose centres they cover.
        let first_sample = samples.subpixels()[0];
        let positions = match shape {
            LineShape::Columns { .. } => [[128; 2]; N],
            LineShape::Rectangle { .. } => samples.subpixels(),
        };
        let sample_ends = axis_ends(&positions);
        let bounds = Bounds::new(s, &lines, outlines.reach, (tile, rect), sample_ends);
        let ([mut x_first, mut y_first], [x_last, y_last]) = (bounds.first, bounds.last);
        let is_empty = x_last.simd_lt(x_first) | y_last.simd_lt(y_first);
        // Boxes of quads begin at a quad: its first column or row may lie before the box.
        let (mut before, mut above) = (splat(0), splat(0));
        if quads {
            (before, above) = (x_first & splat(1), y_first & splat(1));
            (x_first, y_first) = (x_first - before, y_first - above);
        }
        let (mut across, mut down) = (x_last - x_first, y_last - y_first);
        let x_major = lines.x_major;
        let is_half = s.mask_from_bits(halves.any);
        let along = x_major.select(across, down);
        let is_small = is_half
            .select(along, across.max(down))
            .simd_lt(is_half.select(splat(2 * HALF), splat(SIDE)));
        let is_small = is_small & bounds.extent.simd_lt(splat(EXTENT));
        let small = s.bits_of_mask(is_small) & lanes;
        if small == 0 {
            return 0;
        }
        if halves.any & small != 0 {
            let is_second = s.mask_from_bits(halves.seconds);
            let moved = is_second.select(splat(HALF), splat(0));
            let column = x_major.select(x_first, y_first) + moved;
            let row = Bounds::halved(s, &lines, column)
                .max(x_major.select(y_first + above, x_first + before));
            let aligned = if quads { row & splat(1) } else { splat(0) };
            let (x, y) = (
                x_major.select(column, row - aligned),
                x_major.select(row - aligned, column),
            );
            let not_second = is_second.select(splat(0), splat(-1));
            let (left, top) = (
                x_major.select(before & not_second, aligned),
                x_major.select(aligned, above & not_second),
            );
            x_first = is_half.select(x, x_first);
            y_first = is_half.select(y, y_first);
            before = is_half.select(left, before);
            above = is_half.select(top, above);
            let most_x = x_major.select(splat(HALF - 1), splat(SIDE - 1));
            let most_y = x_major.select(splat(SIDE - 1), splat(HALF - 1));
            across = is_half.select((x_last - x_first).min(most_x), across);
            down = is_half.select((y_last - y_first).min(most_y), down);
        }
        let is_empty = is_empty | across.simd_lt(splat(0)) | down.simd_lt(splat(0));
        let pixels = BoxPixels {
            across,
            down,
            before,
            above,
            among: s.mask_from_bits(small) & outlines.exist & !is_empty,
        };
        let corner = [x_first << 8, y_first << 8];
        let [start_x, start_y] = lines.start;
        let [first_x, first_y] = positions[0];
        let (from_x, from_y) = (corner[0] + first_x - start_x, corner[1] + first_y - start_y);
        let mut edges = outlines.edges;
        for edge in &mut edges {
            edge.value += edge.a * from_x + edge.b * from_y;
        }
        self.cover_pixels(s, &edges, &pixels, positions);
        let [first_x, first_y] = first_sample;
        let from = [corner[0] + first_x - start_x, corner[1] + first_y - start_y];
        self.set_places([x_first - splat(tile.x), y_first - splat(tile.y)], from);
        small
    }
}
