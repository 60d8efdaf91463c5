//! Planes: values that are linear in the window.

use estampe_simd::LANES;

/// A value that is linear in the window: `origin + ((X − x₀)·dx + (Y − y₀)·dy)`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Plane {
    pub(crate) origin: f32,
    pub(crate) dx: f32,
    pub(crate) dy: f32,
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

    #[inline(always)]
    pub(super) fn set(&mut self, lane: usize, plane: Plane) {
        self.origin[lane] = plane.origin;
        self.dx[lane] = plane.dx;
        self.dy[lane] = plane.dy;
    }
}
