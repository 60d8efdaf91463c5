//! Bézier curves of any degree, and bicubic patches, with derivatives and normals.
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
//! CAGD", §14). De Casteljau's scheme gives the same points by repeated interpolation, and divides
//! curves and patches; [`BezierCurve`], of any degree, uses it. For cubic points the Bernstein form
//! was preferred because it can be summed symmetrically: patches that share the control points of
//! an edge then agree on it to the bit, whichever way each runs along it.

mod cubic;
mod curve;
mod patch;

pub use cubic::{CurveParameter, cubic_derivative, cubic_point, cubic_second_derivative};
pub use curve::BezierCurve;
pub use patch::BicubicPatch;

#[cfg(test)]
mod tests;
