//! The nearest eye that sees every point inside the frame less its margin.
//!
//! In view-aligned coordinates (x right, y up, z towards the eye) a point p is seen from the eye e
//! at ((pₓ − eₓ)/(e_z − p_z), …). It lies inside the frame when |pₓ − eₓ| ≤ kₓ·(e_z − p_z), where
//! kₓ is the tangent of half the opening angle, less the margin: two constraints that are *linear*
//! in e:
//!
//! ```text
//!   eₓ + kₓ·e_z ≥ A = max(pₓ + kₓ·p_z)         e_z ≥ (A + B) / 2kₓ, reached by eₓ = (A − B) / 2
//!  −eₓ + kₓ·e_z ≥ B = max(−pₓ + kₓ·p_z)
//! ```
//!
//! The constraints in y have the same form. One pass over the points therefore gives the exact
//! nearest eye. Along the axis that is not tight, the model is then centred by equal projected
//! margins on both sides. Rejected: a bounding sphere, which leaves a flat model a third of the
//! frame.

use super::Cloud;
use super::centred::centred;
use glam::DVec3;

/// Tangents of half the opening angles, less the margin; for orthographic views the half extents
/// that a half height of 1 gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameTangents {
    /// Horizontally; > 0.
    pub x: f64,
    /// Vertically; > 0.
    pub y: f64,
}

impl FrameTangents {
    /// A frame of `width` × `height` pixels whose half height has the tangent `half_height_tangent`
    /// (1 for orthographic views), less `margin` of the shorter side on every side.
    #[must_use]
    pub fn new(width: f64, height: f64, half_height_tangent: f64, margin: f64) -> Self {
        let margin_px = margin * width.min(height);
        let per_px = half_height_tangent / (height / 2.0);
        Self {
            x: (width / 2.0 - margin_px) * per_px,
            y: (height / 2.0 - margin_px) * per_px,
        }
    }
}

/// The least distance between the eye and a point, in units of the normalised model (about 1 in
/// radius).
const CLOSEST: f64 = 1e-3;

/// The nearest eye of a perspective camera that looks down −z. With `through`, the eye stays on the
/// line through that point, which is then in the middle of the image.
///
/// Without points, the result is the eye for the unit box.
#[must_use]
pub fn perspective_eye(points: &Cloud, k: FrameTangents, through: Option<DVec3>) -> DVec3 {
    let Some(reach) = points.reach(k) else {
        return perspective_eye(&box_corners(), k, through);
    };
    let front = reach.most.z;
    let (a, b, c, d) = (reach.right, reach.left, reach.top, reach.bottom);
    if let Some(t) = through {
        let nearest = |a: f64, b: f64, at: f64, k: f64| ((a - at) / k).max((b + at) / k);
        let z = nearest(a, b, t.x, k.x)
            .max(nearest(c, d, t.y, k.y))
            .max(front + CLOSEST);
        return DVec3::new(t.x, t.y, at_least_a_step(z, front, points));
    }
    let z = ((a + b) / (2.0 * k.x))
        .max((c + d) / (2.0 * k.y))
        .max(front + CLOSEST);
    let z = at_least_a_step(z, front, points);
    let x = centred(points, z, (a - b) / 2.0, |p| p.x);
    let y = centred(points, z, (c - d) / 2.0, |p| p.y);
    DVec3::new(x, y, z)
}

/// A model without extent across the view (one point, or points behind one another) is seen from a
/// distance of 2.
fn at_least_a_step(z: f64, front: f64, points: &Cloud) -> f64 {
    let first = points.iter().next().copied().unwrap_or_default();
    let has_no_size = |p: &DVec3| (p.x - first.x).abs() + (p.y - first.y).abs() < CLOSEST;
    if z - front < 2.0 * CLOSEST && points.iter().all(has_no_size) {
        front + 2.0
    } else {
        z
    }
}

/// The middle (its z is that of the nearest point) and the half height of the smallest orthographic
/// view that holds every point; `through` fixes the middle.
#[must_use]
pub fn orthographic_view(points: &Cloud, k: FrameTangents, through: Option<DVec3>) -> (DVec3, f64) {
    let (least, most) = points
        .reach(k)
        .map_or((-DVec3::ONE, DVec3::ONE), |reach| (reach.least, reach.most));
    let middle = through.unwrap_or((least + most) / 2.0).with_z(most.z);
    let reach = (most - middle).max(middle - least);
    let half_height = (reach.x / k.x).max(reach.y / k.y);
    (
        middle,
        if half_height > CLOSEST * CLOSEST {
            half_height
        } else {
            1.0
        },
    )
}

fn box_corners() -> Cloud {
    let sign = |bit: usize| if bit == 0 { -1.0 } else { 1.0 };
    let corners = [0, 1, 2, 3, 4, 5, 6, 7];
    corners
        .map(|i: usize| DVec3::new(sign(i & 1), sign(i & 2), sign(i & 4)))
        .as_slice()
        .into()
}
