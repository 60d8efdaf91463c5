//! Least-squares line through measurements: the fixed cost of a frame, and the cost of each element
//! in it.

/// `cost = fixed + each · count`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// The cost of an empty frame.
    pub fixed: f64,
    /// The cost of one element.
    pub each: f64,
}

impl Line {
    /// The line with the least squares of *relative* errors: counts and costs span decades, so
    /// absolute errors would be dominated by the largest count. `None` with fewer than two
    /// different counts.
    ///
    /// With weights w = 1/y²: minimise Σ w·(a + b·x − y)².
    #[must_use]
    pub fn through(points: &[[f64; 2]]) -> Option<Self> {
        let [mut w, mut wx, mut wy, mut wxx, mut wxy] = [0.0; 5];
        for &[x, y] in points.iter().filter(|[_, y]| *y > 0.0) {
            let weight = 1.0 / (y * y);
            w += weight;
            wx += weight * x;
            wy += weight * y;
            wxx += weight * x * x;
            wxy += weight * x * y;
        }
        let determinant = w * wxx - wx * wx;
        // With a single count it is zero, except for rounding.
        (determinant > 1e-9 * w * wxx).then(|| Self {
            fixed: (wxx * wy - wx * wxy) / determinant,
            each: (w * wxy - wx * wy) / determinant,
        })
    }

    /// The line's cost of `count` elements.
    #[must_use]
    pub fn at(&self, count: f64) -> f64 {
        self.fixed + self.each * count
    }

    /// The largest relative distance of a point from the line.
    #[must_use]
    pub fn deviation(&self, points: &[[f64; 2]]) -> f64 {
        let off = points.iter().map(|&[x, y]| (y / self.at(x) - 1.0).abs());
        off.fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_on_a_line_give_that_line() {
        let points = [1e2, 1e4, 1e6].map(|x| [x, 0.25 + 3e-5 * x]);
        let line = Line::through(&points).unwrap();
        assert!((line.fixed - 0.25).abs() < 1e-9 && (line.each - 3e-5).abs() < 1e-14);
        assert!(line.deviation(&points) < 1e-9);
        // One point is a tenth too high.
        let [x, y] = points[1];
        assert!((line.deviation(&[[x, y * 1.1]]) - 0.1).abs() < 1e-9);
    }

    #[test]
    fn errors_count_relatively() {
        // Off by a tenth at both ends: both ends have the same weight.
        let points = [[1.0, 1.1], [10.0, 10.0], [1e6, 0.9e6]];
        let line = Line::through(&points).unwrap();
        assert!(line.deviation(&points) < 0.11, "{line:?}");
    }

    #[test]
    fn one_count_is_no_line() {
        assert_eq!(Line::through(&[]), None);
        assert_eq!(Line::through(&[[2.0, 1.0], [2.0, 3.0]]), None);
    }
}
