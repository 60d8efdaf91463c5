//! Cubic Bézier curves and bicubic patches, with derivatives and normals.
//!
//! A cubic Bézier curve over the control points p₀…p₃ and its derivative, in Bernstein form:
//!
//! ```text
//!   C(t)  = (1−t)³ p₀ + 3(1−t)²t p₁ + 3(1−t)t² p₂ + t³ p₃
//!   C′(t) = 3 [ (1−t)² (p₁−p₀) + 2(1−t)t (p₂−p₁) + t² (p₃−p₂) ]
//!
//!       p₁───────p₂        the curve leaves p₀ towards p₁,
//!      ╱   .-~-.   ╲       arrives at p₃ from p₂, and
//!     ╱ .`       `. ╲      stays inside the hull of all four
//!    p₀`           `p₃
//! ```
//!
//! A patch is a curve of curves: S(s, t) = Σᵢ Σⱼ Bᵢ(s) Bⱼ(t) pᵢⱼ (Farin, "Curves and Surfaces for
//! CAGD", §14). De Casteljau's scheme gives the same points by repeated interpolation; the
//! Bernstein form was preferred because it can be summed symmetrically: patches that share the
//! control points of an edge then agree on it to the bit, whichever way each runs along it.

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

/// A bicubic patch: four rows along s, of four control points along t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BicubicPatch {
    /// `control[i][j]` belongs to Bᵢ(s) Bⱼ(t).
    pub control: [[DVec3; 4]; 4],
}

impl BicubicPatch {
    /// The point S(s, t).
    #[must_use]
    pub fn point(&self, s: CurveParameter, t: CurveParameter) -> DVec3 {
        cubic_point(self.control.map(|row| cubic_point(row, t)), s)
    }

    /// The derivative ∂S/∂s.
    #[must_use]
    pub fn derivative_s(&self, s: CurveParameter, t: CurveParameter) -> DVec3 {
        cubic_derivative(self.control.map(|row| cubic_point(row, t)), s)
    }

    /// The derivative ∂S/∂t.
    #[must_use]
    pub fn derivative_t(&self, s: CurveParameter, t: CurveParameter) -> DVec3 {
        cubic_point(self.control.map(|row| cubic_derivative(row, t)), s)
    }

    /// The mixed derivative ∂²S/∂s∂t.
    #[must_use]
    pub fn derivative_st(&self, s: CurveParameter, t: CurveParameter) -> DVec3 {
        cubic_derivative(self.control.map(|row| cubic_derivative(row, t)), s)
    }

    /// The unit normal, on the side of ∂S/∂t × ∂S/∂s; zero where it is not defined.
    ///
    /// If the row s = 0 is a single point, ∂S/∂t vanishes there. Near it ∂S/∂t grows as
    /// s · ∂²S/∂s∂t, so the limit of the normal's direction is that of ∂²S/∂s∂t × ∂S/∂s.
    ///
    /// ```text
    ///        ∂S/∂t ◀──┬ normal: towards the reader
    ///                 │
    ///                 ▼ ∂S/∂s
    /// ```
    #[must_use]
    pub fn normal(&self, s: CurveParameter, t: CurveParameter) -> DVec3 {
        let along_s = self.derivative_s(s, t);
        let along_t = self.derivative_t(s, t);
        let normal = along_t.cross(along_s);
        // A product of lengths that is this much smaller than the patch is rounding error, not
        // direction.
        let scale = along_s.length_squared() + along_t.length_squared();
        if normal.length() > 1e-9 * scale {
            return normal.normalize();
        }
        self.derivative_st(s, t).cross(along_s).normalize_or_zero()
    }
}

#[cfg(test)]
mod tests;
