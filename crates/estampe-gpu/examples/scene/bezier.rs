//! Cubic Bézier curves in shaders, whose points are the same bits from either end.

use estampe::{Real, Vec3};

estampe::shader! {
    /// Bernstein's polynomials, the same bits for t and, reversed, for 1 − t.
    pub(crate) fn weights<R: Real>(t: R) -> [R; 4] {
        let s = 1.0 - t;
        [s * s * s, t * (s * s) * 3.0, s * (t * t) * 3.0, t * t * t]
    }

    /// A third of their derivatives.
    pub(crate) fn slopes<R: Real>(t: R) -> [R; 4] {
        let s = 1.0 - t;
        [-(s * s), s * s - s * t * 2.0, s * t * 2.0 - t * t, t * t]
    }

    /// A weighted sum, the same bits from either end.
    pub(crate) fn sum<R: Real>([a, b, c, d]: [Vec3<R>; 4], [i, j, k, l]: [R; 4]) -> Vec3<R> {
        (a * i + d * l) + (b * j + c * k)
    }
}
