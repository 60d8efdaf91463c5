//! Coverage of a triangle or another convex polygon, tile by tile.
//!
//! **Two widths.** Positions are 1/256 pixel in a guard band of 2¹⁵ pixels, so an edge's constant
//! needs 48 bits. It is computed once per tile in 64 bits with the fill rule's bias folded in; then
//! every value at a sample is `c + 256·(a·i + b·j)`, whose sign is that of `(c >> 8) + a·i + b·j`
//! (the shift is a floor and the rest an integer). Inside a tile that the edge crosses these values
//! are below 126·2²³ in magnitude and fit 32 bits; an edge that does not cross the tile is decided
//! there and then.
//!
//! **Two paths.** A triangle whose box lies in few packets goes straight to pixels; others descend
//! blocks, packets, pixels. With the hierarchy for all, a frame of 998 k triangles of about a pixel
//! took 63 ms on one core in place of 48 (`estampe-bench --scenes small_tris --threads 1`).

use super::{CoverageList, SampleSet, TileShape};
use crate::bounds::pixel_rect::PixelRect;
use crate::bounds::primitives::Triangle;
use estampe_simd::{LANE_X, LANE_Y, LANES, Lanes, SimdBase, i32x16};

/// Packets of a box that are tried one by one rather than through the hierarchy, where a pixel has
/// one sample; of several samples each is tried.
const DIRECT_PACKETS: i32 = 16;
const DIRECT_PACKETS_OF_SAMPLES: i32 = 6;

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

    /// Lists the packets that the polygon covers, leaving out the blocks of `skip`. Of the
    /// blocks `whole`, those that are covered whole are returned, one bit each, and not listed.
    #[inline(always)]
    pub(crate) fn cover<S: Lanes>(
        &self,
        s: S,
        tile: TileShape,
        skip: u16,
        whole: u16,
        out: &mut CoverageList<N>,
    ) -> u16 {
        let lanes = EdgeLanes::new(s, self);
        let direct = if const { N == 1 } {
            DIRECT_PACKETS
        } else {
            DIRECT_PACKETS_OF_SAMPLES
        };
        if self.packets() <= direct {
            for row in self.rows[0]..self.rows[1] {
                for column in self.columns[0]..self.columns[1] {
                    let packet = crate::layout::morton(column.cast_unsigned(), row.cast_unsigned());
                    if skip >> (packet >> 4) & 1 == 0 {
                        self.cover_packet(s, &lanes, packet, [column * 4, row * 4], out);
                    }
                }
            }
            return 0;
        }
        // A tile of 32×32 has four blocks: the first four lanes.
        let blocks = if tile.log2 == 6 { u16::MAX } else { 0xF };
        let (some, all) = lanes.classify(s, self, [0, 0], 16);
        let mut live = some & blocks & !skip;
        let whole = live & all & whole;
        live &= !whole;
        while live != 0 {
            let block = live.trailing_zeros();
            live &= live - 1;
            let origin = origin_of(block, 16);
            if all >> block & 1 == 1 {
                for packet in 0..16 {
                    out.push(block * 16 + packet, [u16::MAX; N]);
                }
                continue;
            }
            let (some, all) = lanes.classify(s, self, origin, 4);
            let mut live = some;
            while live != 0 {
                let packet = live.trailing_zeros();
                live &= live - 1;
                if all >> packet & 1 == 1 {
                    out.push(block * 16 + packet, [u16::MAX; N]);
                } else {
                    let [x, y] = origin_of(packet, 4);
                    let at = [origin[0] + x, origin[1] + y];
                    self.cover_packet(s, &lanes, block * 16 + packet, at, out);
                }
            }
        }
        whole
    }

    /// Lists one packet, sample by sample.
    #[inline(always)]
    fn cover_packet<S: Lanes>(
        &self,
        s: S,
        lanes: &EdgeLanes<S, E>,
        packet: u32,
        [x, y]: [i32; 2],
        out: &mut CoverageList<N>,
    ) {
        let mut masks = [0; N];
        for (sample, mask) in masks.iter_mut().enumerate().take(out.samples().count()) {
            let mut outside = <i32x16<S> as SimdBase<S>>::splat(s, 0);
            for (edge, units) in self.edges.iter().zip(&lanes.pixel) {
                let Edge { a, b, c } = edge;
                outside |= *units + <i32x16<S> as SimdBase<S>>::splat(s, c[sample] + a * x + b * y);
            }
            *mask = !s.sign_bits(outside);
        }
        if masks != [0; N] {
            out.push(packet, masks);
        }
    }
}

/// The pixel at which unit `index` of a level begins, `size` pixels a unit.
#[inline(always)]
fn origin_of(index: u32, size: i32) -> [i32; 2] {
    let lane = index as usize % LANES;
    [
        i32::from(LANE_X[lane]) * size,
        i32::from(LANE_Y[lane]) * size,
    ]
}

impl<const N: usize> Edge<N> {
    /// The edge from one vertex to another; `None` when all of the tile is outside, and an edge
    /// that is always inside when all of the tile is.
    #[inline(always)]
    #[expect(
        clippy::cast_possible_truncation,
        reason = "see the head: an edge that crosses fits"
    )]
    fn new(
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
}

/// The values that sixteen lanes add to an edge's value: `a·column + b·row` of each lane, one pixel
/// apart.
struct EdgeLanes<S: Lanes, const E: usize> {
    pixel: [i32x16<S>; E],
}

impl<S: Lanes, const E: usize> EdgeLanes<S, E> {
    #[inline(always)]
    fn new<const N: usize>(s: S, polygon: &TilePolygon<N, E>) -> Self {
        let mut x = [0; LANES];
        let mut y = [0; LANES];
        let mut lane = 0;
        while lane < LANES {
            (x[lane], y[lane]) = (i32::from(LANE_X[lane]), i32::from(LANE_Y[lane]));
            lane += 1;
        }
        let (x, y) = (i32x16::load_array(s, x), i32x16::load_array(s, y));
        let splat = |value| <i32x16<S> as SimdBase<S>>::splat(s, value);
        let mut pixel = [splat(0); E];
        for (pixel, Edge { a, b, .. }) in pixel.iter_mut().zip(&polygon.edges) {
            *pixel = x * splat(*a) + y * splat(*b);
        }
        Self { pixel }
    }

    /// Of sixteen units of `size` pixels from (x, y) on: which hold covered samples, perhaps, and
    /// which are covered whole.
    #[inline(always)]
    fn classify<const N: usize>(
        &self,
        s: S,
        polygon: &TilePolygon<N, E>,
        [x, y]: [i32; 2],
        size: i32,
    ) -> (u16, u16) {
        let shift = size.trailing_zeros();
        let mut outside = <i32x16<S> as SimdBase<S>>::splat(s, 0);
        let mut partial = outside;
        for (edge, units) in polygon.edges.iter().zip(&self.pixel) {
            let Edge { a, b, c } = edge;
            let (mut most, mut least) = (c[0], c[0]);
            for &c in c {
                (most, least) = (most.max(c), least.min(c));
            }
            let base = a * x + b * y;
            let best = most + base + (a.max(&0) + b.max(&0)) * (size - 1);
            let worst = least + base + (a.min(&0) + b.min(&0)) * (size - 1);
            let units = *units << shift;
            outside |= units + <i32x16<S> as SimdBase<S>>::splat(s, best);
            partial |= units + <i32x16<S> as SimdBase<S>>::splat(s, worst);
        }
        (!s.sign_bits(outside), !s.sign_bits(partial))
    }
}
