//! Points with rational coordinates: corners of a grid, and crossings of edges between them.

use std::cmp::Ordering;

use glam::DVec2;

use super::Wide;

/// The largest coordinate of a corner, in either direction.
pub(in crate::polygon) const MAX_COORDINATE: i64 = 1 << 28;

/// The point (x/w, y/w), with w > 0.
#[derive(Clone, Copy, Debug)]
pub(in crate::polygon) struct ExactPoint {
    x: i128,
    y: i128,
    w: i128,
    /// The coordinates in f64. Their error is below 2⁻²³: coordinates are at most 2²⁸.
    approximate: DVec2,
}

/// Twice the signed area of the triangle of three corners. At most 2⁵⁹.
pub(in crate::polygon) fn cross(a: [i64; 2], b: [i64; 2], c: [i64; 2]) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
}

impl ExactPoint {
    /// A corner.
    pub(in crate::polygon) fn corner([x, y]: [i64; 2]) -> Self {
        Self {
            x: i128::from(x),
            y: i128::from(y),
            w: 1,
            approximate: DVec2::new(x as f64, y as f64),
        }
    }

    /// The crossing of two edges that are not parallel.
    pub(in crate::polygon) fn crossing([a, b]: [[i64; 2]; 2], [c, d]: [[i64; 2]; 2]) -> Self {
        let [dx, dy] = [b[0] - a[0], b[1] - a[1]].map(i128::from);
        // The crossing is a + (b − a) · t / w.
        let t = i128::from(cross(a, c, d));
        let w = i128::from((b[0] - a[0]) * (d[1] - c[1]) - (d[0] - c[0]) * (b[1] - a[1]));
        let (t, w) = if w < 0 { (-t, -w) } else { (t, w) };
        let (x, y) = (i128::from(a[0]) * w + t * dx, i128::from(a[1]) * w + t * dy);
        Self {
            x,
            y,
            w,
            approximate: DVec2::new(x as f64, y as f64) / w as f64,
        }
    }

    /// The point in f64, rounded.
    pub(in crate::polygon) fn rounded(&self) -> DVec2 {
        self.approximate
    }

    /// The order of a sweep: by y, then by x. Equal points are `Equal`, whatever fractions they
    /// are.
    pub(in crate::polygon) fn order(&self, other: &Self) -> Ordering {
        self.axis_order(other, 1)
            .then_with(|| self.axis_order(other, 0))
    }

    fn axis_order(&self, other: &Self, axis: usize) -> Ordering {
        let difference = self.approximate[axis] - other.approximate[axis];
        if difference.abs() > 1e-6 {
            return difference.total_cmp(&0.0);
        }
        let own = [self.x, self.y][axis];
        let others = [other.x, other.y][axis];
        Wide::product(own, other.w)
            .minus(Wide::product(others, self.w))
            .sign()
    }

    /// Compares twice the signed area of the triangle `a b c` with zero: `Greater` if it is
    /// counter-clockwise with y up.
    pub(in crate::polygon) fn orientation(a: &Self, b: &Self, c: &Self) -> Ordering {
        let estimate = (b.approximate - a.approximate).perp_dot(c.approximate - a.approximate);
        // Differences of at most 2³⁰ with errors of 2⁻²²: products are wrong by less than 2¹⁰.
        if estimate.abs() > 4096.0 {
            return estimate.total_cmp(&0.0);
        }
        // The determinant of the rows (x, y, w), whose sign is that of the area, as all w are
        // positive.
        let minor = |p: &Self, q: &Self| Wide::product(p.x, q.y).minus(Wide::product(q.x, p.y));
        let determinant = minor(b, c).times(a.w).plus(minor(c, a).times(b.w));
        determinant.plus(minor(a, b).times(c.w)).sign()
    }

    /// The numerators and the denominator, for tests.
    #[cfg(test)]
    pub(in crate::polygon) fn fraction(&self) -> [i128; 3] {
        [self.x, self.y, self.w]
    }
}
