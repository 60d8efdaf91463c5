//! Planes: values that are linear in the window, at sixteen pixels and over blocks of 16×16 pixels.

use super::{PixelOffsets, WindowPixels};
use crate::bounds::plane::Plane;
use crate::bounds::primitives::{Triangle, TrianglePacket};
use estampe_simd::{LANE_X, LANE_Y, LANES, Lanes, SimdBase, f32x16, outline};

/// Columns (or rows) of a packet's lanes.
#[inline(always)]
fn lane_steps<S: Lanes>(s: S, lanes: &[u8; LANES]) -> f32x16<S> {
    let mut steps = [0.0; LANES];
    let mut lane = 0;
    while lane < LANES {
        steps[lane] = lanes[lane] as f32;
        lane += 1;
    }
    f32x16::load_array(s, steps)
}

/// The origin of a triangle's planes: its first sorted vertex, in pixels.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PlaneOrigin {
    pub(crate) x: f32,
    pub(crate) y: f32,
}

impl PlaneOrigin {
    #[inline(always)]
    pub(crate) fn new(triangle: &Triangle) -> Self {
        Self {
            x: pixels(triangle.x[0]),
            y: pixels(triangle.y[0]),
        }
    }

    /// Distances of the packet's pixels (at an offset in each) from the origin.
    ///
    /// Positions and offsets are multiples of 1/256 and distances below 2¹⁶, so every sum here is
    /// exact, in whatever order it is taken.
    #[inline(always)]
    pub(crate) fn distances<S: Lanes>(
        &self,
        s: S,
        [x, y]: [i32; 2],
        [sx, sy]: [f32; 2],
    ) -> [f32x16<S>; 2] {
        [self.columns_from(s, x, sx), self.rows_from(s, y, sy)]
    }

    /// [`PlaneOrigin::distances`] of a place in each pixel.
    #[inline(always)]
    pub(super) fn distances_of<S: Lanes>(
        &self,
        s: S,
        [x, y]: [i32; 2],
        places: &PixelOffsets,
    ) -> [f32x16<S>; 2] {
        [
            self.columns_from(s, x, 0.0) + f32x16::load_array_ref(s, &places.x),
            self.rows_from(s, y, 0.0) + f32x16::load_array_ref(s, &places.y),
        ]
    }

    /// [`PlaneOrigin::distances`] of any pixels.
    #[inline(always)]
    pub(super) fn distances_to<S: Lanes>(
        &self,
        pixels: WindowPixels<S>,
        [sx, sy]: [f32; 2],
    ) -> [f32x16<S>; 2] {
        pixels.coordinates([sx - self.x, sy - self.y])
    }

    /// [`PlaneOrigin::distances`] of the columns alone.
    #[inline(always)]
    pub(crate) fn columns_from<S: Lanes>(&self, s: S, x: i32, offset: f32) -> f32x16<S> {
        let first = x as f32 + offset - self.x;
        lane_steps(s, &LANE_X) + <f32x16<S> as SimdBase<S>>::splat(s, first)
    }

    /// [`PlaneOrigin::distances`] of the rows alone.
    #[inline(always)]
    pub(crate) fn rows_from<S: Lanes>(&self, s: S, y: i32, offset: f32) -> f32x16<S> {
        let first = y as f32 + offset - self.y;
        lane_steps(s, &LANE_Y) + <f32x16<S> as SimdBase<S>>::splat(s, first)
    }
}

/// The depth of a triangle, over the window.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DepthPlane {
    pub(crate) origin: PlaneOrigin,
    pub(crate) z: Plane,
}

impl DepthPlane {
    #[inline(always)]
    pub(crate) fn new(triangle: &Triangle) -> Self {
        Self {
            origin: PlaneOrigin::new(triangle),
            z: triangle.z,
        }
    }

    /// True if it has the same bits at every pixel: products of distances are zeros, whose sign
    /// tells only in a sum with another zero.
    #[inline(always)]
    pub(crate) fn is_level(&self) -> bool {
        self.z.dx == 0.0 && self.z.dy == 0.0 && self.z.origin != 0.0
    }

    /// That of a packet's triangle: few of the triangle's values, each of which is in a cache line
    /// of its own.
    #[inline(always)]
    pub(crate) fn of_lane(packet: &TrianglePacket, lane: usize) -> Self {
        Self {
            origin: PlaneOrigin {
                x: pixels(packet.x[0][lane]),
                y: pixels(packet.y[0][lane]),
            },
            z: packet.z.lane(lane),
        }
    }
}

/// 1/256 pixel to pixels: exact below 2²⁴.
#[inline(always)]
pub(super) fn pixels(subpixels: i32) -> f32 {
    subpixels as f32 * (1.0 / 256.0)
}

/// A plane's value at sixteen pixels.
#[inline(always)]
pub(crate) fn evaluate<S: Lanes>(s: S, plane: &Plane, [dx, dy]: [f32x16<S>; 2]) -> f32x16<S> {
    outline!(s, {
        let splat = |value| <f32x16<S> as SimdBase<S>>::splat(s, value);
        splat(plane.origin) + (dx * splat(plane.dx) + dy * splat(plane.dy))
    })
}

/// A plane over a block of 16×16 pixels: its packets' four columns and four rows share their
/// products.
#[derive(Clone, Copy)]
pub(crate) struct PlaneBlock<S: Lanes> {
    origin: f32x16<S>,
    by_x: [f32x16<S>; 4],
    by_y: [f32x16<S>; 4],
}

impl<S: Lanes> PlaneBlock<S> {
    /// The plane at an offset in the pixels of the block that begins at the target's pixel (x, y).
    #[inline(always)]
    pub(crate) fn new(
        s: S,
        origin: &PlaneOrigin,
        plane: &Plane,
        [x, y]: [i32; 2],
        [sx, sy]: [f32; 2],
    ) -> Self {
        let zero = <f32x16<S> as SimdBase<S>>::splat(s, 0.0);
        let (mut by_x, mut by_y) = ([zero; 4], [zero; 4]);
        for (step, at) in [0, 4, 8, 12].into_iter().enumerate() {
            by_x[step] = origin.columns_from(s, x + at, sx) * plane.dx;
            by_y[step] = origin.rows_from(s, y + at, sy) * plane.dy;
        }
        Self {
            origin: SimdBase::splat(s, plane.origin),
            by_x,
            by_y,
        }
    }

    /// The plane at a packet of the block, 0 to 15.
    #[inline(always)]
    pub(crate) fn at(&self, packet: usize) -> f32x16<S> {
        let (column, row) = (
            LANE_X[packet % LANES] as usize % 4,
            LANE_Y[packet % LANES] as usize % 4,
        );
        self.origin + (self.by_x[column] + self.by_y[row])
    }
}
