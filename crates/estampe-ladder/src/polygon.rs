//! Convex polygons in the cube −1..1, seen along −z by a parallel projection: for the rungs that
//! decide what hides what.

use crate::Color;
use estampe_reference::scan_conversion::bounding_box;
use estampe_reference::viewport::{PixelBounds, snap};
use glam::Vec3;

/// A convex, planar polygon of one colour.
#[derive(Debug, Clone)]
pub struct Polygon {
    /// Three corners or more, in either winding.
    pub corners: Vec<Vec3>,
    /// The colour of all its pixels.
    pub color: Color,
}

impl Polygon {
    /// The normal of the polygon's plane, not of unit length: (b − a) × (c − a).
    #[must_use]
    pub fn normal(&self) -> Vec3 {
        let [a, b, c] = [0, 1, 2].map(|k: usize| self.corners[k]);
        (b - a).cross(c - a)
    }

    /// The side of the polygon's plane on which a point lies: n·(p − a), positive where the normal
    /// points, 0 within a millionth of the plane.
    #[must_use]
    pub fn side(&self, point: Vec3) -> f32 {
        let side = self.normal().dot(point - self.corners[0]);
        if side.abs() > 1e-6 { side } else { 0.0 }
    }

    /// The mean of the corners' z.
    #[must_use]
    pub fn mean_z(&self) -> f32 {
        let sum: f32 = self.corners.iter().map(|corner| corner.z).sum();
        sum / self.corners.len() as f32
    }

    /// Calls `plot` for each pixel that the polygon covers in a picture of `size` × `size` pixels,
    /// with its z at the pixel's centre, from the equation of the plane:
    ///
    /// ```text
    ///   n·(p − a) = 0   →   z = a_z − (n_x·(x − a_x) + n_y·(y − a_y)) / n_z
    /// ```
    pub fn fill(&self, size: u32, mut plot: impl FnMut([i32; 2], f32)) {
        let half = size as f32 / 2.0;
        let window = |p: Vec3| [snap((p.x + 1.0) * half), snap((1.0 - p.y) * half)];
        let (n, a) = (self.normal(), self.corners[0]);
        let bounds = PixelBounds {
            x: 0..size,
            y: 0..size,
        };
        for k in 2..self.corners.len() {
            let triangle = [0, k - 1, k].map(|corner| window(self.corners[corner]));
            for pixel in bounding_box::repaired(triangle, &bounds) {
                let [x, y] = pixel.map(|at| (at as f32 + 0.5) / half - 1.0);
                let z = a.z - (n.x * (x - a.x) + n.y * (-y - a.y)) / n.z;
                plot(pixel.map(u32::cast_signed), z);
            }
        }
    }

    /// The parts on the positive and on the negative side of a plane; a part of less than three
    /// corners is empty. Corners on the plane belong to both.
    #[must_use]
    pub fn split(&self, side: impl Fn(Vec3) -> f32) -> [Self; 2] {
        let [mut front, mut back] = [(); 2].map(|()| Self {
            corners: Vec::new(),
            color: self.color,
        });
        for (k, &a) in self.corners.iter().enumerate() {
            let b = self.corners[(k + 1) % self.corners.len()];
            let (side_a, side_b) = (side(a), side(b));
            if side_a >= 0.0 {
                front.corners.push(a);
            }
            if side_a <= 0.0 {
                back.corners.push(a);
            }
            if side_a * side_b < 0.0 {
                let crossing = a + (b - a) * (side_a / (side_a - side_b));
                front.corners.push(crossing);
                back.corners.push(crossing);
            }
        }
        [front, back]
    }
}
