//! The edges of sixteen triangles, from which the planes of their values are made.

use super::primitives::TrianglePacket;
use estampe_simd::{LANES, Lane, Lanes, SimdBase, SimdCvtFloat, f32x16, i32x16, outline};

/// Differences of sixteen triangles' second and third vertices from their first, in pixels, and 1 ÷
/// doubled area.
pub(crate) struct TriangleEdges<S: Lanes> {
    dx: [f32x16<S>; 2],
    dy: [f32x16<S>; 2],
    r: f32x16<S>,
}

impl<S: Lanes> TriangleEdges<S> {
    /// Those of triangles with these vertices, in 1/256 pixel, and this doubled area, in 1/256
    /// pixel², rounded once.
    #[inline(always)]
    pub(crate) fn new(s: S, [x, y]: [&[i32x16<S>; 3]; 2], doubled_area: f32x16<S>) -> Self {
        // Exact.
        let scale = <f32x16<S> as SimdBase<S>>::splat(s, 1.0 / 256.0);
        Self {
            dx: [
                f32x16::float_from(x[1] - x[0]) * scale,
                f32x16::float_from(x[2] - x[0]) * scale,
            ],
            dy: [
                f32x16::float_from(y[1] - y[0]) * scale,
                f32x16::float_from(y[2] - y[0]) * scale,
            ],
            r: <f32x16<S> as SimdBase<S>>::splat(s, 65_536.0) / doubled_area,
        }
    }

    /// Those of a packet's triangles in some lanes.
    #[inline(always)]
    pub(crate) fn of_packet(s: S, packet: &TrianglePacket, lanes: u16) -> Self {
        let load = |lanes: &[i32; LANES]| i32x16::load_array_ref(s, lanes);
        let x = [load(&packet.x[0]), load(&packet.x[1]), load(&packet.x[2])];
        let y = [load(&packet.y[0]), load(&packet.y[1]), load(&packet.y[2])];
        let mut area = f32x16::float_from(doubled_area_of_small([&x, &y]));
        let limit = <i32x16<S> as SimdBase<S>>::splat(s, 1 << 15);
        let across = x[0].max(x[1]).max(x[2]) - x[0].min(x[1]).min(x[2]);
        // Sorted by y.
        let is_large = across.simd_ge(limit) | (y[2] - y[0]).simd_ge(limit);
        let large = s.bits_of_mask(is_large) & lanes;
        if large != 0 {
            let mut areas = area.to_array();
            for lane in Lane::all_of(large) {
                let of = |corners: &[[i32; LANES]; 3]| [0, 1, 2].map(|at| lane.of(&corners[at]));
                *lane.of_mut(&mut areas) = doubled_area([of(&packet.x), of(&packet.y)]) as f32;
            }
            area = f32x16::load_array(s, areas);
        }
        Self::new(s, [&x, &y], area)
    }

    /// What the plane through three values rises along x and along y.
    #[inline(always)]
    pub(crate) fn slopes(&self, s: S, [p0, p1, p2]: [f32x16<S>; 3]) -> [f32x16<S>; 2] {
        let Self {
            dx: [dx1, dx2],
            dy: [dy1, dy2],
            r,
        } = *self;
        outline!(s, {
            let (e1, e2) = (p1 - p0, p2 - p0);
            [(e1 * dy2 - e2 * dy1) * r, (e2 * dx1 - e1 * dx2) * r]
        })
    }
}

/// The doubled area of a triangle.
#[inline(always)]
pub(super) fn doubled_area([x, y]: [[i32; 3]; 2]) -> i64 {
    let difference = |of: [i32; 3], corner: usize| i64::from(of[corner] - of[0]);
    difference(x, 1) * difference(y, 2) - difference(x, 2) * difference(y, 1)
}

/// The doubled areas of triangles of less than 128 pixels, exact: each product is below 2³⁰.
#[inline(always)]
pub(super) fn doubled_area_of_small<S: Lanes>([x, y]: [&[i32x16<S>; 3]; 2]) -> i32x16<S> {
    (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])
}
