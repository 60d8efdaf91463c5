//! Points: squares around a snapped position, or the discs in them.
//!
//! In · Out: one window vertex and a size · quads of covered samples, and interpolants. Precision:
//! coverage exact. Spec: NUMERICS.md, *Lines and points*.

use crate::WindowVertex;
use crate::arithmetic::{clamp, round_half_even};
use crate::fragment::Surface;
use crate::raster::{self, QuadCoverage};
use crate::viewport::PixelBounds;

/// The least and the greatest width of a point, in pixels.
const SIZES: [f32; 2] = [1.0, 1024.0];

/// Half of a point's width, in 1/256 pixel; the width is clamped to `SIZES`. NaN counts as the
/// least size.
#[must_use]
pub fn half_width_subpixel(size: f32) -> i32 {
    round_half_even(clamp(size, SIZES[0], SIZES[1]) * 128.0)
}

/// The quads with samples inside the half-open square of a point.
#[must_use]
pub fn cover(center: [i32; 2], size: f32, bounds: &PixelBounds, samples: u32) -> Vec<QuadCoverage> {
    let half = i64::from(half_width_subpixel(size));
    let square = center.map(i64::from).map(|at| [at - half, at + half]);
    raster::cover(square, bounds, samples, |point| {
        let within = |axis: usize| square[axis][0] <= point[axis] && point[axis] < square[axis][1];
        within(0) && within(1)
    })
}

/// The quads with samples inside a round point: those of the square whose distance from the centre
/// is at most half of its width.
#[must_use]
pub fn cover_round(
    center: [i32; 2],
    size: f32,
    bounds: &PixelBounds,
    samples: u32,
) -> Vec<QuadCoverage> {
    let half = i64::from(half_width_subpixel(size));
    let center = center.map(i64::from);
    let square = center.map(|at| [at - half, at + half]);
    raster::cover(square, bounds, samples, |point| {
        let within = |axis: usize| square[axis][0] <= point[axis] && point[axis] < square[axis][1];
        let [x, y] = [0, 1].map(|axis: usize| point[axis] - center[axis]);
        within(0) && within(1) && x * x + y * y <= half * half
    })
}

/// The interpolants of a point: the vertex's values, constant.
#[derive(Debug, Clone, Copy)]
pub struct PointSurface<'a> {
    /// The vertex.
    pub vertex: &'a WindowVertex,
    /// The provoking vertex's varyings.
    pub flat: &'a [f32],
    /// The interpolation of each scalar of the varyings.
    pub modes: &'a [estampe_types::Interpolation],
}

impl Surface for PointSurface<'_> {
    fn depth(&self, _pixel: [u32; 2], _sample: [u8; 2]) -> f32 {
        self.vertex.z
    }

    fn inverse_w(&self, _pixel: [u32; 2]) -> f32 {
        self.vertex.inverse_w
    }

    fn varyings(&self, _pixel: [u32; 2]) -> Vec<f32> {
        let value = |(k, mode): (usize, &estampe_types::Interpolation)| match mode {
            estampe_types::Interpolation::Flat => self.flat[k],
            _ => self.vertex.varyings[k],
        };
        self.modes.iter().enumerate().map(value).collect()
    }

    fn derivatives_at(&self, _pixel: [u32; 2], _place: [u8; 2]) -> Vec<[f32; 2]> {
        vec![[0.0; 2]; self.modes.len()]
    }
}
