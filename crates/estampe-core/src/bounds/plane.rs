//! Planes: values that are linear in the window.

use super::lane_order::LaneOrder;
use estampe_simd::{LANES, Lanes, f32x16};

/// A value that is linear in the window: `origin + ((X − x₀)·dx + (Y − y₀)·dy)`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Plane {
    pub(crate) origin: f32,
    pub(crate) dx: f32,
    pub(crate) dy: f32,
}

/// One plane for each lane.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PlaneLanes<S: Lanes> {
    origin: f32x16<S>,
    dx: f32x16<S>,
    dy: f32x16<S>,
}

impl<S: Lanes> PlaneLanes<S> {
    /// The planes' values at these distances from their origins.
    #[inline(always)]
    pub(crate) fn at(&self, [x, y]: [f32x16<S>; 2]) -> f32x16<S> {
        self.origin + (x * self.dx + y * self.dy)
    }
}

/// Sixteen planes.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
pub(crate) struct PlanePacket {
    pub(crate) origin: [f32; LANES],
    pub(crate) dx: [f32; LANES],
    pub(crate) dy: [f32; LANES],
}

impl PlanePacket {
    pub(super) const ZERO: Self = Self {
        origin: [0.0; LANES],
        dx: [0.0; LANES],
        dy: [0.0; LANES],
    };

    #[inline(always)]
    pub(crate) fn lane(&self, lane: usize) -> Plane {
        Plane {
            origin: self.origin[lane],
            dx: self.dx[lane],
            dy: self.dy[lane],
        }
    }

    /// The planes of the lanes' primitives.
    #[inline(always)]
    pub(crate) fn of_lanes<S: Lanes>(&self, s: S, order: impl LaneOrder<S>) -> PlaneLanes<S> {
        PlaneLanes {
            origin: order.permuted(s, &self.origin),
            dx: order.permuted(s, &self.dx),
            dy: order.permuted(s, &self.dy),
        }
    }

    #[inline(always)]
    pub(super) fn set(&mut self, lane: usize, plane: Plane) {
        self.origin[lane] = plane.origin;
        self.dx[lane] = plane.dx;
        self.dy[lane] = plane.dy;
    }
}
