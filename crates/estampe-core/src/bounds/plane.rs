//! Planes: values that are linear in the window.

use estampe_simd::{LANES, Lanes, SimdBase, f32x16, u32x16};

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

    /// The values of the planes that `lane` names, at these distances from their origins.
    #[inline(always)]
    pub(crate) fn at<S: Lanes>(&self, s: S, lane: u32x16<S>, [x, y]: [f32x16<S>; 2]) -> f32x16<S> {
        let origin = s.permute_f32(f32x16::load_array_ref(s, &self.origin), lane);
        let dx = s.permute_f32(f32x16::load_array_ref(s, &self.dx), lane);
        let dy = s.permute_f32(f32x16::load_array_ref(s, &self.dy), lane);
        origin + (x * dx + y * dy)
    }

    #[inline(always)]
    pub(super) fn set(&mut self, lane: usize, plane: Plane) {
        self.origin[lane] = plane.origin;
        self.dx[lane] = plane.dx;
        self.dy[lane] = plane.dy;
    }
}
