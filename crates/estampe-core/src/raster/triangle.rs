//! Coverage of a triangle or another convex polygon, tile by tile.
//!
//! **Two widths.** Positions are 1/256 pixel in a guard band of 2¹⁵ pixels, so an edge's constant
//! needs 48 bits. It is computed once per tile in 64 bits with the fill rule's bias folded in; then
//! every value at a sample is `c + 256·(a·i + b·j)`, whose sign is that of `(c >> 8) + a·i + b·j`
//! (the shift is a floor and the rest an integer). Inside a tile that the edge crosses these values
//! are below 126·2²³ in magnitude and fit 32 bits; an edge that does not cross the tile is decided
//! there and then.

use super::{SampleSet, TileShape};
use crate::bounds::pixel_rect::PixelRect;
use crate::bounds::primitives::Triangle;

/// One edge inside a tile: `c[s] + a·i + b·j ≥ 0` is inside for sample `s` of the tile's pixel (i,
/// j).
#[derive(Debug, Clone, Copy)]
pub(super) struct Edge<const N: usize> {
    pub(super) a: i32,
    pub(super) b: i32,
    pub(super) c: [i32; N],
}

/// A convex polygon of `E` edges inside a tile.
#[derive(Debug, Clone, Copy)]
pub(crate) struct TilePolygon<const N: usize, const E: usize> {
    pub(super) edges: [Edge<N>; E],
    /// Columns and rows of packets that its box touches; half-open.
    pub(super) columns: [i32; 2],
    pub(super) rows: [i32; 2],
    /// True if the box lies in the rectangle that the pixels are confined to.
    pub(super) is_inside: bool,
}

/// A triangle inside a tile.
pub(crate) type TileTriangle<const N: usize> = TilePolygon<N, 3>;

impl<const N: usize> TilePolygon<N, 3> {
    /// A triangle inside a tile, whose pixels are confined to `rect` (of the tile's own
    /// pixels); `None` when it covers nothing of it.
    #[inline(always)]
    pub(crate) fn new(
        triangle: &Triangle,
        tile: TileShape,
        rect: &PixelRect,
        samples: SampleSet<N>,
    ) -> Option<Self> {
        let corner = |corner: usize| [triangle.x[corner], triangle.y[corner]];
        let others = if triangle.clockwise { [1, 2] } else { [2, 1] };
        let corners = [corner(0), corner(others[0]), corner(others[1])];
        Self::of_corners(corners, tile, rect, samples)
    }
}

impl<const N: usize, const E: usize> TilePolygon<N, E> {
    /// The polygon with these corners, clockwise in a window with y down, as
    /// [`TilePolygon::new`].
    #[inline(always)]
    pub(crate) fn of_corners(
        corners: [[i32; 2]; E],
        tile: TileShape,
        rect: &PixelRect,
        samples: SampleSet<N>,
    ) -> Option<Self> {
        // The box, in the tile's own pixels; a pixel more on each side does no harm.
        let (mut low, mut high) = (corners[0], corners[0]);
        for [x, y] in corners {
            low = [low[0].min(x), low[1].min(y)];
            high = [high[0].max(x), high[1].max(y)];
        }
        let column = |subpixels: i32| (subpixels >> 8) - tile.x;
        let row = |subpixels: i32| (subpixels >> 8) - tile.y;
        let bounds = [column(low[0]), row(low[1]), column(high[0]), row(high[1])];
        let (left, right) = (bounds[0].max(rect.x0), bounds[2].min(rect.x1 - 1));
        let (top, bottom) = (bounds[1].max(rect.y0), bounds[3].min(rect.y1 - 1));
        if left > right || top > bottom {
            return None;
        }
        let mut edges = [Edge {
            a: 0,
            b: 0,
            c: [0; N],
        }; E];
        for (from, edge) in edges.iter_mut().enumerate() {
            *edge = Edge::new(corners[from], corners[(from + 1) % E], tile, samples)?;
        }
        Some(Self {
            edges,
            columns: [left >> 2, (right >> 2) + 1],
            rows: [top >> 2, (bottom >> 2) + 1],
            is_inside: [left, top, right, bottom] == bounds,
        })
    }

    /// Returns true if every pixel that may be covered is in the rectangle that pixels are confined
    /// to.
    #[inline(always)]
    pub(crate) fn is_inside(&self) -> bool {
        self.is_inside
    }

    /// The number of packets that the box touches.
    #[inline(always)]
    pub(crate) fn packets(&self) -> i32 {
        (self.columns[1] - self.columns[0]) * (self.rows[1] - self.rows[0])
    }
}

impl<const N: usize> Edge<N> {
    /// The edge from one vertex to another; `None` when all of the tile is outside, and an edge
    /// that is always inside when all of the tile is.
    #[inline(always)]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "see the head: an edge that crosses fits"
    )]
    pub(super) fn new(
        [ax, ay]: [i32; 2],
        [bx, by]: [i32; 2],
        tile: TileShape,
        samples: SampleSet<N>,
    ) -> Option<Self> {
        // E(x, y) = (bx − ax)·(y − ay) − (by − ay)·(x − ax), differences below 2²⁴.
        let (a, b) = (i64::from(ay - by), i64::from(bx - ax));
        // A sample on the edge is inside if the edge is a top or a left one.
        let is_top_left = by < ay || by == ay && bx > ax;
        let bias = i64::from(is_top_left) - 1;
        let positions = samples.subpixels();
        let mut c = [0; N];
        for (c, [sx, sy]) in c.iter_mut().zip(positions) {
            let (x, y) = (tile.x * 256 + sx - ax, tile.y * 256 + sy - ay);
            *c = (a * i64::from(x) + b * i64::from(y) + bias) >> 8;
        }
        let reach = i64::from(tile.side() - 1);
        let (most, least) = c.iter().fold((i64::MIN, i64::MAX), |(most, least), &c| {
            (most.max(c), least.min(c))
        });
        if most + (a.max(0) + b.max(0)) * reach < 0 {
            return None;
        }
        if least + (a.min(0) + b.min(0)) * reach >= 0 {
            return Some(Self {
                a: 0,
                b: 0,
                c: [0; N],
            });
        }
        Some(Self {
            a: a as i32,
            b: b as i32,
            c: c.map(|c| c as i32),
        })
    }

    /// The edge's value at the best and at the worst sample of the first square of `side` pixels.
    #[inline(always)]
    pub(super) fn extremes(&self, side: i32) -> [i32; 2] {
        let Self { a, b, c } = self;
        let (mut most, mut least) = (c[0], c[0]);
        for &c in c {
            (most, least) = (most.max(c), least.min(c));
        }
        let reach = side - 1;
        [
            most + (a.max(&0) + b.max(&0)) * reach,
            least + (a.min(&0) + b.min(&0)) * reach,
        ]
    }
}
