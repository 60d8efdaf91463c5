//! Line rasterization (R3): the shape of lines, and the parts that a stipple pattern leaves out.
//!
//! ```text
//!     Bresenham      columns of pixels (of a y-major line: rows), as many high as the line is wide
//!     rectangular    the rectangle around the line, its corners at ±half the width across it
//! ```
//!
//! *Precision* exact integers, but for the rectangle's corners, which are rounded to 1/256 pixel ·
//! *Spec* Vulkan §Line Segments; `docs/NUMERICS.md`.

use crate::bounds::lines::LinePrimitive;
use estampe_types::state::{LineRasterization, LineState, LineStipple};

/// The shape of a pipeline's lines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum LineShape {
    /// By the columns (or rows) of pixels that they cross, so many pixels across.
    Columns { width: i32 },
    /// Rectangles of a width in pixels.
    Rectangle { width: f32, smooth: bool },
}

/// The shape and the stipple pattern of a pipeline's lines.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LineStyle {
    pub(crate) shape: LineShape,
    pub(crate) stipple: Option<LineStipple>,
}

impl LineStyle {
    pub(crate) fn new(state: &LineState) -> Self {
        let shape = match state.rasterization {
            LineRasterization::Bresenham => LineShape::Columns {
                width: whole_width(state.width),
            },
            kind => LineShape::Rectangle {
                width: state.width,
                smooth: kind == LineRasterization::RectangularSmooth,
            },
        };
        let stipple = state.stipple;
        Self { shape, stipple }
    }

    /// Returns the width of lines that are rectangles and nothing else: not smooth, not stippled.
    #[inline]
    pub(crate) fn plain_rectangle(&self) -> Option<f32> {
        match self.shape {
            LineShape::Rectangle {
                width,
                smooth: false,
            } if self.stipple.is_none() => Some(width),
            _ => None,
        }
    }

    /// Returns true if lines are neither smooth nor stippled.
    #[inline]
    pub(crate) fn is_plain(&self) -> bool {
        self.stipple.is_none() && !self.is_smooth()
    }

    /// Returns true if alpha is multiplied by the covered part of the pixel.
    pub(crate) fn is_smooth(&self) -> bool {
        matches!(self.shape, LineShape::Rectangle { smooth: true, .. })
    }

    /// Returns the greatest distance from a line, between its ends, at which its pixels may begin,
    /// in 1/256 pixel.
    pub(crate) fn reach(&self) -> i32 {
        match self.shape {
            LineShape::Columns { width } => 256 + (width - 1) * 128,
            LineShape::Rectangle { width, .. } => 257 + round(width * 128.0),
        }
    }

    /// The phase of the stipple pattern at the end of a line, which begins with the phase
    /// [`LinePrimitive::stipple`].
    ///
    /// A phase counts columns; of rectangles it counts 1/65536 pixels, so that the next line of a
    /// strip goes on with the part of a pixel that this one left. It is less than the length of the
    /// pattern.
    pub(crate) fn phase_after(&self, line: &LinePrimitive) -> u32 {
        let Some(LineStipple { factor, .. }) = self.stipple else {
            return 0;
        };
        let (advance, per_bit) = match self.shape {
            LineShape::Columns { .. } => {
                let [first, last] = LineAxis::new(line).span();
                (u64::try_from(last - first + 1).unwrap_or(0), 1)
            }
            LineShape::Rectangle { .. } => (
                phases((length(line) * 256.0).round_ties_even()),
                PHASES_OF_A_PIXEL,
            ),
        };
        // At most 16 · 256 pixels: less than 2²⁹ phases.
        let period = 16 * u64::from(factor.max(1)) * per_bit;
        u32::try_from((u64::from(line.stipple) + advance) % period).unwrap_or(0)
    }

    /// Returns true if the pattern shows the fragment with this number, counted from the pattern's
    /// beginning.
    pub(crate) fn shows(&self, fragment: u64) -> bool {
        self.stipple.is_none_or(|LineStipple { factor, pattern }| {
            let bit = fragment / u64::from(factor.max(1)) % 16;
            pattern >> bit & 1 == 1
        })
    }

    /// Returns true if the pattern shows a rectangle at a distance, in 1/256 pixel, from its start.
    pub(crate) fn shows_at(&self, line: &LinePrimitive, distance: f32) -> bool {
        let phase = u64::from(line.stipple) + phases(distance * 256.0);
        self.shows(phase / PHASES_OF_A_PIXEL)
    }
}

/// The number of phases of a stipple pattern in one pixel of a rectangular line.
const PHASES_OF_A_PIXEL: u64 = 65_536;

/// ⌊phases⌋, at least 0. Distances are below 2²⁶ in 1/256 pixel, so that 64 bits hold any.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "`as` saturates, and NaN is 0"
)]
fn phases(value: f32) -> u64 {
    value as u64
}

/// A width in whole pixels: ⌊w + ½⌋, at least 1.
fn whole_width(width: f32) -> i32 {
    round((width + 0.5).floor()).max(1)
}

/// A line along its major axis, in 1/256 pixel.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LineAxis {
    /// True if x is the major axis.
    pub(crate) x_major: bool,
    /// The start on the major and the minor axis.
    pub(crate) start: [i64; 2],
    /// The way to the end on both.
    pub(crate) delta: [i64; 2],
}

impl LineAxis {
    pub(crate) fn new(line: &LinePrimitive) -> Self {
        let [a, b] = &line.ends;
        let (dx, dy) = (i64::from(b.x - a.x), i64::from(b.y - a.y));
        let x_major = dx.abs() >= dy.abs();
        let start = [i64::from(a.x), i64::from(a.y)];
        let (start, delta) = if x_major {
            (start, [dx, dy])
        } else {
            ([start[1], start[0]], [dy, dx])
        };
        Self {
            x_major,
            start,
            delta,
        }
    }

    /// Returns the line moved along the minor axis by `across`, in 1/256 pixel.
    pub(crate) fn moved(mut self, across: i64) -> Self {
        self.start[1] += across;
        self
    }

    /// The first and last unit of the major axis that the line covers; empty when first > last.
    pub(crate) fn span(&self) -> [i64; 2] {
        let [from, to] = [self.start[0], self.start[0] + self.delta[0]];
        // Centres 256·i + 128 with from ≤ centre < to, or to < centre ≤ from.
        if self.delta[0] >= 0 {
            [(from + 127) >> 8, (to - 129) >> 8]
        } else {
            [(to + 128) >> 8, (from - 128) >> 8]
        }
    }

    /// The pixel on the minor axis at a unit of the major axis: ⌊minor(centre) / 256⌋ exactly.
    pub(crate) fn minor_at(&self, unit: i64) -> i64 {
        let along = unit * 256 + 128 - self.start[0];
        // minor = start + along·Δminor/Δmajor; products are below 2⁴⁹.
        let numerator = self.start[1] * self.delta[0] + along * self.delta[1];
        let denominator = 256 * self.delta[0];
        numerator.div_euclid(denominator)
            - i64::from(denominator < 0 && numerator.rem_euclid(denominator) != 0)
    }
}

/// The rectangle around a line.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LineRectangle {
    /// In 1/256 pixel, clockwise in a window with y down.
    pub(crate) corners: [[i32; 2]; 4],
    /// A point (x, y) in 1/256 pixel is inside where `a·x + b·y + c ≥ 0` for each [a, b, c].
    pub(crate) edges: [[i64; 3]; 4],
    /// Least x and y, greatest x and y.
    pub(crate) bounds: [i32; 4],
}

impl LineRectangle {
    /// None of a line without length, or too thin to have an area.
    #[inline(always)]
    pub(crate) fn new(line: &LinePrimitive, width: f32) -> Option<Self> {
        let [a, b] = &line.ends;
        let (dx, dy) = ((b.x - a.x) as f32, (b.y - a.y) as f32);
        let across = (width * 128.0) / length(line);
        let (hx, hy) = (round(-dy * across), round(dx * across));
        let corners = [
            [a.x - hx, a.y - hy],
            [b.x - hx, b.y - hy],
            [b.x + hx, b.y + hy],
            [a.x + hx, a.y + hy],
        ];
        let way = [b.x - a.x, b.y - a.y].map(i64::from);
        if way[0] * i64::from(hy) - way[1] * i64::from(hx) <= 0 {
            return None;
        }
        let edge = |from: usize| {
            let [ax, ay] = corners[from].map(i64::from);
            let [bx, by] = corners[(from + 1) % 4].map(i64::from);
            // The fill rule of triangles: points on top and left edges are inside.
            let is_inside = by == ay && bx > ax || by < ay;
            let c = (by - ay) * ax - (bx - ax) * ay;
            [ay - by, bx - ax, c - i64::from(!is_inside)]
        };
        let along = |axis: usize| corners.map(|corner| corner[axis]);
        let least = |values: [i32; 4]| values.into_iter().fold(i32::MAX, i32::min);
        let greatest = |values: [i32; 4]| values.into_iter().fold(i32::MIN, i32::max);
        Some(Self {
            corners,
            edges: [edge(0), edge(1), edge(2), edge(3)],
            bounds: [
                least(along(0)),
                least(along(1)),
                greatest(along(0)),
                greatest(along(1)),
            ],
        })
    }

    pub(crate) fn contains(&self, [x, y]: [i32; 2]) -> bool {
        let (x, y) = (i64::from(x), i64::from(y));
        self.edges.iter().all(|[a, b, c]| a * x + b * y + c >= 0)
    }

    /// Returns the number of points of a 4×4 grid in the pixel, 0 to 16, that are inside.
    pub(crate) fn sixteenths(&self, [x, y]: [i32; 2]) -> u32 {
        let point = |at: u32| {
            let [right, below] = [at % 4, at / 4].map(|step| step.cast_signed() * 64 + 32);
            [x * 256 + right, y * 256 + below]
        };
        let inside = (0..16).filter(|&at| self.contains(point(at)));
        inside.map(|_| 1).sum()
    }
}

/// The position of a point along a line, times the line's length: the dot product of the vectors
/// from the line's start to the point and to its end. The point is in 1/256 pixel.
pub(crate) fn along(line: &LinePrimitive, [x, y]: [i32; 2]) -> i64 {
    let [a, b] = &line.ends;
    let product = |at: i32, from: i32, to: i32| i64::from(at - from) * i64::from(to - from);
    product(x, a.x, b.x) + product(y, a.y, b.y)
}

/// The square of a line's length in 1/256 pixel, exactly.
pub(crate) fn length_squared(line: &LinePrimitive) -> i64 {
    let [_, b] = &line.ends;
    along(line, [b.x, b.y])
}

/// A line's length in 1/256 pixel.
#[inline(always)]
pub(crate) fn length(line: &LinePrimitive) -> f32 {
    let [a, b] = &line.ends;
    let (dx, dy) = ((b.x - a.x) as f32, (b.y - a.y) as f32);
    (dx * dx + dy * dy).sqrt()
}

/// Half to even; NaN is 0.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "`as` saturates")]
fn round(value: f32) -> i32 {
    value.round_ties_even() as i32
}
