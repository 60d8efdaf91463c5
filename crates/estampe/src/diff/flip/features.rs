//! The feature difference ΔF: edges and points that one image has and the other lacks.

/// Edge and point strength of a pixel.
pub(super) type Features = [f32; 2];

/// The strengths, from the derivatives of edges and points in x and y.
#[inline]
pub(super) fn strengths(edge: [f32; 2], point: [f32; 2]) -> Features {
    [edge, point].map(|[x, y]| (x * x + y * y).sqrt())
}

/// ΔF in [0, 1]: the larger of the two differences over √2, to the power q_f = ½.
#[inline]
pub(super) fn difference(a: Features, b: Features) -> f32 {
    let edge = (a[0] - b[0]).abs();
    let point = (a[1] - b[1]).abs();
    (edge.max(point) * std::f32::consts::FRAC_1_SQRT_2)
        .sqrt()
        .min(1.0)
}
