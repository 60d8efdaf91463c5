//! Edges of sixteen triangles, one in each lane, with the fill rule folded in.

use crate::bounds::primitives::TrianglePacket;
use estampe_simd::{LANES, Lanes, Select, SimdBase, i32x16, mask32x16};

/// The corners of sixteen triangles.
pub(super) struct Corners<S: Lanes> {
    pub(super) x: [i32x16<S>; 3],
    pub(super) y: [i32x16<S>; 3],
    /// The least and the greatest x. Those of y are the first and the last.
    pub(super) x_ends: [i32x16<S>; 2],
}

impl<S: Lanes> Corners<S> {
    #[inline(always)]
    pub(super) fn new(s: S, packet: &TrianglePacket) -> Self {
        let load = |lanes: &[i32; LANES]| i32x16::load_array_ref(s, lanes);
        let x = [load(&packet.x[0]), load(&packet.x[1]), load(&packet.x[2])];
        let y = [load(&packet.y[0]), load(&packet.y[1]), load(&packet.y[2])];
        Self {
            x,
            y,
            x_ends: [x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2])],
        }
    }
}

/// One edge of sixteen triangles: its value at a point, and what 1/256 pixel further adds, to the
/// right and below.
#[derive(Clone, Copy)]
pub(super) struct EdgeLanes<S: Lanes> {
    pub(super) value: i32x16<S>,
    pub(super) a: i32x16<S>,
    pub(super) b: i32x16<S>,
}

/// One edge of sixteen triangles, and the way to a point from a vertex on it: the edge's value
/// there is `a·x + b·y + bias`.
#[derive(Clone, Copy)]
pub(super) struct EdgeFrom<S: Lanes> {
    pub(super) a: i32x16<S>,
    pub(super) b: i32x16<S>,
    /// The point's distance from the vertex.
    pub(super) way: [i32x16<S>; 2],
    /// 0, or −1 for the fill rule.
    pub(super) bias: i32x16<S>,
}

impl<S: Lanes> EdgeFrom<S> {
    /// The edge at the point, modulo 2³².
    #[inline(always)]
    pub(super) fn at_point(self) -> EdgeLanes<S> {
        let Self { a, b, way, bias } = self;
        EdgeLanes {
            value: a * way[0] + b * way[1] + bias,
            a,
            b,
        }
    }
}

/// The three edges, wound so that inside is ≥ 0, the fill rule folded in, to a point for each
/// triangle.
///
/// Vertices are sorted by (y, x), which decides what is a top or a left edge: clockwise 0→1 and 1→2
/// where they are level (top) and 2→0 always (left); counter-clockwise 0→2 never, 2→1 and 1→0 where
/// they rise (left).
#[inline(always)]
pub(super) fn edges<S: Lanes>(
    s: S,
    packet: &TrianglePacket,
    corners: &Corners<S>,
    point: [i32x16<S>; 2],
) -> [EdgeFrom<S>; 3] {
    let ([x0, x1, x2], [y0, y1, y2]) = (corners.x, corners.y);
    let clockwise = s.mask_from_bits(packet.clockwise);
    let never = s.mask_from_bits(0);
    let always = s.mask_from_bits(u16::MAX);
    let (level_01, level_12) = (y0.simd_eq(y1), y1.simd_eq(y2));
    let wound = Winding { clockwise, point };
    [
        wound.edge(s, [x0, y0], [x1, y1], [level_01, !level_01]),
        wound.edge(s, [x1, y1], [x2, y2], [level_12, !level_12]),
        wound.edge(s, [x2, y2], [x0, y0], [always, never]),
    ]
}

/// The winding of sixteen triangles, and the points at which their edges have values.
struct Winding<S: Lanes> {
    clockwise: mask32x16<S>,
    point: [i32x16<S>; 2],
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
    ) -> EdgeFrom<S> {
        let (zero, less) = (
            <i32x16<S> as SimdBase<S>>::splat(s, 0),
            <i32x16<S> as SimdBase<S>>::splat(s, -1),
        );
        let (a, b) = (ay - by, bx - ax);
        let a = self.clockwise.select(a, zero - a);
        let b = self.clockwise.select(b, zero - b);
        let owns = (self.clockwise & if_clockwise) | (!self.clockwise & if_not);
        EdgeFrom {
            a,
            b,
            way: [self.point[0] - ax, self.point[1] - ay],
            bias: owns.select(zero, less),
        }
    }
}
