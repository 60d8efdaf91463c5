//! The plane through three points, and the side of a fourth.
//!
//! ```text
//!          n = (b − a) × (c − a)
//!          ▲      p: n·(p − a) > 0: in front
//!   a ─────┼───── b
//!           c     q: n·(q − a) < 0: behind
//! ```

use super::expansion::Expansion;
use std::cmp::Ordering;

/// A plane through three points, whose sides are exact.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plane {
    points: [[f64; 3]; 3],
    /// (b − a) × (c − a), rounded.
    normal: [f64; 3],
    /// The normal with all products added: its error is at most 4·2⁻⁵³ times this.
    magnitude: [f64; 3],
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl Plane {
    /// The plane through three points that are not on one line.
    pub(crate) fn new(points: [[f64; 3]; 3]) -> Self {
        let [a, b, c] = points;
        let (u, v) = (minus(b, a), minus(c, a));
        let products = [0, 1, 2].map(|axis: usize| {
            let (y, z) = ((axis + 1) % 3, (axis + 2) % 3);
            [u[y] * v[z], u[z] * v[y]]
        });
        Self {
            points,
            normal: products.map(|[first, second]| first - second),
            magnitude: products.map(|[first, second]| first.abs() + second.abs()),
        }
    }

    /// The points that the plane goes through.
    pub(crate) fn points(&self) -> &[[f64; 3]; 3] {
        &self.points
    }

    /// The normal, rounded; not of unit length.
    pub(crate) fn normal(&self) -> [f64; 3] {
        self.normal
    }

    /// n·(p − a), rounded, and a bound of its error.
    ///
    /// Differences and products are wrong by 2⁻⁵³ of themselves each, so a component of n by 4
    /// such errors of the magnitude, its product with the difference by 6, the sum by 8; 16 leave
    /// room for the bound's own rounding.
    pub(crate) fn estimate(&self, p: [f64; 3]) -> (f64, f64) {
        let offset = minus(p, self.points[0]);
        let error = dot(self.magnitude, offset.map(f64::abs)) * (8.0 * f64::EPSILON);
        (dot(self.normal, offset), error)
    }

    /// The side of a point: `Greater` in front, `Equal` on the plane. Exact for coordinates whose
    /// products neither overflow nor vanish: all those of f32, and points between such.
    pub(crate) fn side(&self, p: [f64; 3]) -> Ordering {
        let (estimate, error) = self.estimate(p);
        if estimate.abs() > error {
            return estimate.total_cmp(&0.0);
        }
        if error == 0.0 {
            // The offset is zero along every axis along which the normal may differ from zero.
            return Ordering::Equal;
        }
        let [a, b, c] = self.points;
        side_of_points(a, b, c, p)
    }

    /// The side of a direction, or of a point at infinity: the sign of n·d.
    pub(crate) fn side_of_direction(&self, d: [f64; 3]) -> Ordering {
        let (estimate, error) = (
            dot(self.normal, d),
            dot(self.magnitude, d.map(f64::abs)) * (8.0 * f64::EPSILON),
        );
        if estimate.abs() > error {
            return estimate.total_cmp(&0.0);
        }
        // n·d is the sum of the determinants (d, b, c), (a, d, c) and (a, b, d).
        let [a, b, c] = self.points;
        let mut sum = Expansion::default();
        for [p, q, r] in [[d, b, c], [a, d, c], [a, b, d]] {
            add_determinant(&mut sum, [p, q, r], 1.0);
        }
        sum.sign()
    }
}

/// Adds the determinant of three rows times ±1.
fn add_determinant(sum: &mut Expansion, [p, q, r]: [[f64; 3]; 3], sign: f64) {
    for (axis, x) in p.into_iter().enumerate() {
        let (y, z) = ((axis + 1) % 3, (axis + 2) % 3);
        sum.add_product(sign * x, q[y], r[z]);
        sum.add_product(-sign * x, q[z], r[y]);
    }
}

/// The sign of ((b − a) × (c − a))·(p − a), in exact arithmetic.
pub(super) fn side_of_points(a: [f64; 3], b: [f64; 3], c: [f64; 3], p: [f64; 3]) -> Ordering {
    let mut sum = Expansion::default();
    add_determinant(&mut sum, [b, c, p], 1.0);
    add_determinant(&mut sum, [a, c, p], -1.0);
    add_determinant(&mut sum, [a, b, p], 1.0);
    add_determinant(&mut sum, [a, b, c], -1.0);
    sum.sign()
}
