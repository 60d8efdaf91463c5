//! Cubic curves and their parameter, in Bernstein form.

use glam::DVec3;

/// A curve parameter t in [0, 1], together with 1 − t.
///
/// Both are stored so that a curve has exactly the same points when it is traversed backwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveParameter {
    /// The parameter t.
    from_start: f64,
    /// 1 − t.
    from_end: f64,
}

impl CurveParameter {
    /// The parameter t. Outside [0, 1] the curve is extrapolated.
    #[must_use]
    pub fn new(t: f64) -> Self {
        Self {
            from_start: t,
            from_end: 1.0 - t,
        }
    }

    /// The parameter step ÷ steps; 0 steps count as 1.
    #[must_use]
    pub fn fraction(step: u32, steps: u32) -> Self {
        let steps = steps.max(1);
        Self {
            from_start: f64::from(step) / f64::from(steps),
            from_end: (f64::from(steps) - f64::from(step)) / f64::from(steps),
        }
    }

    /// The parameter t.
    #[must_use]
    pub fn t(self) -> f64 {
        self.from_start
    }

    /// The cubic Bernstein polynomials B₀…B₃, which sum to 1.
    #[must_use]
    pub fn cubic_weights(self) -> [f64; 4] {
        let Self {
            from_start: t,
            from_end: e,
        } = self;
        [e * e * e, 3.0 * (e * e * t), 3.0 * (t * t * e), t * t * t]
    }

    /// The weights of the differences p₁−p₀, p₂−p₁, p₃−p₂ in the derivative; they sum to 3.
    #[must_use]
    pub fn cubic_derivative_weights(self) -> [f64; 3] {
        let Self {
            from_start: t,
            from_end: e,
        } = self;
        [3.0 * (e * e), 6.0 * (e * t), 3.0 * (t * t)]
    }
}

/// A point on the cubic curve over four control points.
#[must_use]
pub fn cubic_point(control: [DVec3; 4], t: CurveParameter) -> DVec3 {
    let [b0, b1, b2, b3] = t.cubic_weights();
    let [p0, p1, p2, p3] = control;
    (p0 * b0 + p3 * b3) + (p1 * b1 + p2 * b2)
}

/// The derivative dC/dt of the cubic curve over four control points.
#[must_use]
pub fn cubic_derivative(control: [DVec3; 4], t: CurveParameter) -> DVec3 {
    let [b0, b1, b2] = t.cubic_derivative_weights();
    let [p0, p1, p2, p3] = control;
    ((p1 - p0) * b0 + (p3 - p2) * b2) + (p2 - p1) * b1
}

/// The second derivative d²C/dt² of the cubic curve over four control points.
#[must_use]
pub fn cubic_second_derivative(control: [DVec3; 4], t: CurveParameter) -> DVec3 {
    let [p0, p1, p2, p3] = control;
    let (first, last) = ((p2 - p1) - (p1 - p0), (p3 - p2) - (p2 - p1));
    (first * t.from_end + last * t.from_start) * 6.0
}
