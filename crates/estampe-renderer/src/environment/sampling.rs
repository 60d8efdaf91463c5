//! Points and directions of numerical integrals, always the same ones.

use glam::Vec3;
use std::f32::consts::TAU;

/// The points of a Hammersley set: evenly spread in the unit square.
pub(super) fn hammersley(count: u16) -> impl Iterator<Item = [f32; 2]> {
    (0..count).map(move |index| {
        let first = (f32::from(index) + 0.5) / f32::from(count);
        // The bits mirrored at the binary point.
        let second = f32::from(index.reverse_bits()) / 65_536.0;
        [first, second]
    })
}

/// The half vector of a point, distributed as D(h)·(n·h) of GGX; n is +Z (B. Walter et al.,
/// "Microfacet Models for Refraction through Rough Surfaces", 2007, equations 35 and 36).
pub(super) fn ggx_half_vector([first, second]: [f32; 2], alpha: f32) -> Vec3 {
    let cos_squared = (1.0 - first) / (1.0 + (alpha * alpha - 1.0) * first);
    let (cos, sin) = (cos_squared.sqrt(), (1.0 - cos_squared).max(0.0).sqrt());
    let (sin_phi, cos_phi) = libm::sincosf(second * TAU);
    Vec3::new(sin * cos_phi, sin * sin_phi, cos)
}

/// The density D of GGX (T. Trowbridge, K. Reitz, 1975).
pub(super) fn ggx_density(n_dot_h: f32, alpha: f32) -> f32 {
    let squared = alpha * alpha;
    let f = (n_dot_h * n_dot_h) * (squared - 1.0) + 1.0;
    squared / (std::f32::consts::PI * f * f)
}

/// A point whose second number is an angle.
#[derive(Debug, Clone, Copy)]
pub(super) struct TurnedPoint {
    /// 0..1.
    pub(super) first: f32,
    /// Cosine and sine of the angle.
    pub(super) direction: [f32; 2],
}

impl TurnedPoint {
    pub(super) fn new([first, second]: [f32; 2]) -> Self {
        let (sin, cos) = libm::sincosf(second * TAU);
        Self {
            first,
            direction: [cos, sin],
        }
    }
}

/// The half vector of a point, distributed as the facets that a view sees (E. Heitz, "Sampling the
/// GGX Distribution of Visible Normals", 2018): the facets of the hemisphere, stretched by α.
pub(super) fn visible_half_vector(point: &TurnedPoint, view: Vec3, alpha: f32) -> Vec3 {
    let stretched = Vec3::new(view.x * alpha, view.y * alpha, view.z);
    let stretched = stretched / stretched.length();
    let across = Vec3::new(-stretched.y, stretched.x, 0.0);
    let side = across.try_normalize().unwrap_or(Vec3::X);
    let up = stretched.cross(side);
    // A point of the disk that the view sees: half of it is the hemisphere's, foreshortened.
    let radius = point.first.sqrt();
    let [cos, sin] = point.direction;
    let x = radius * cos;
    let whole = (1.0 - x * x).max(0.0).sqrt();
    let share = 0.5 * (1.0 + stretched.z);
    let y = (1.0 - share) * whole + share * (radius * sin);
    let z = (1.0 - x * x - y * y).max(0.0).sqrt();
    let facet = side * x + up * y + stretched * z;
    let half = Vec3::new(facet.x * alpha, facet.y * alpha, facet.z.max(1e-6));
    half / half.length()
}
