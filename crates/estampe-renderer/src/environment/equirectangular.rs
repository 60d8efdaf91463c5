//! Panoramas in equirectangular projection: longitude to the right, latitude downwards.
//!
//! The middle of the image is +Z, and its left half is at −X: what a viewer who looks along +Z has
//! at the right hand is in the image's right half, −X for a viewer with Y up. So u = ½ − φ ÷ 2π
//! with φ = atan2(x, z), and v = acos(y) ÷ π.

use super::cube::{side_f32, whole};
use super::{EnvironmentError, checked};
use glam::Vec3;
use std::f32::consts::{FRAC_1_PI, TAU};

/// The pixels of a panorama.
pub(super) struct Panorama<'a> {
    width: usize,
    height: usize,
    rgb: &'a [f32],
}

/// The greatest side of a face: mirrors show no more.
const MAX_SIDE: usize = 256;

impl<'a> Panorama<'a> {
    pub(super) fn new(
        width: usize,
        height: usize,
        rgb: &'a [f32],
    ) -> Result<Self, EnvironmentError> {
        let expected = width.saturating_mul(height).saturating_mul(3);
        if rgb.len() != expected {
            return Err(EnvironmentError::Size {
                width,
                height,
                expected,
                actual: rgb.len(),
            });
        }
        if rgb.is_empty() {
            return Err(EnvironmentError::Empty);
        }
        Ok(Self { width, height, rgb })
    }

    /// The side of a cube's face with about as many texels: a power of two.
    pub(super) fn cube_side(&self) -> usize {
        (self.width / 4).clamp(16, MAX_SIDE).next_power_of_two()
    }

    /// The mean of the pixels that a texel of the cube covers, about.
    pub(super) fn radiance(&self, direction: Vec3) -> Vec3 {
        let u = 0.5 - libm::atan2f(direction.x, direction.z) / TAU;
        let v = libm::acosf(direction.y.clamp(-1.0, 1.0)) * FRAC_1_PI;
        let texels = 4 * self.cube_side();
        let steps = self.width.div_ceil(texels).clamp(1, 8);
        let spread = 1.0 / side_f32(texels);
        let mut sum = Vec3::ZERO;
        for j in 0..steps {
            for i in 0..steps {
                let [du, dv] = [i, j].map(|k| (side_f32(k) + 0.5) / side_f32(steps) - 0.5);
                sum += self.bilinear(u + du * spread, v + dv * 2.0 * spread);
            }
        }
        sum / side_f32(steps * steps)
    }

    /// Interpolated between pixels; repeated along u, clamped along v.
    fn bilinear(&self, u: f32, v: f32) -> Vec3 {
        let x = (u - u.floor()) * side_f32(self.width) - 0.5;
        let y = (v * side_f32(self.height) - 0.5).clamp(0.0, side_f32(self.height - 1));
        let (left, top) = (x.floor(), whole(y));
        let (fx, fy) = (x - left, y - side_f32(top));
        // From −1 on, so one width is added.
        let column = |offset: usize| (whole(left + 1.0) + self.width - 1 + offset) % self.width;
        let row = |offset: usize| (top + offset).min(self.height - 1);
        let at = |x: usize, y: usize| {
            let first = (y * self.width + x) * 3;
            checked(Vec3::from_slice(&self.rgb[first..first + 3]))
        };
        let line = |y: usize| at(column(0), y).lerp(at(column(1), y), fx);
        line(row(0)).lerp(line(row(1)), fy)
    }
}
