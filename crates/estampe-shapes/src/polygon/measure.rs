//! Signed area, convexity and the point test of polygons in the plane.

use glam::Vec2;

use super::plane::{Convexity, Point, convexity, doubled_area, relative_to_first};

/// Rule for the inside of polygons that cross themselves.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum FillRule {
    /// A point is inside if a ray to infinity crosses the boundary an odd number of times.
    #[default]
    EvenOdd,
    /// A point is inside if the boundary winds around it, in either direction.
    NonZero,
}

/// The area of a polygon, positive if its corners run counter-clockwise with y up.
///
/// The shoelace formula, ½ Σ (xᵢ yᵢ₊₁ − xᵢ₊₁ yᵢ), relative to the first corner. Fewer than three
/// corners have no area; coordinates that are not finite give NaN.
#[must_use]
pub fn signed_area_2d(corners: &[Vec2]) -> f64 {
    let ring: Vec<Point> = relative_to_first(corners).collect();
    0.5 * doubled_area(&ring)
}

/// True if the polygon is convex: simple, and never turning against its winding.
///
/// Corners along a straight edge and repeated corners are allowed. Either winding. Polygons without
/// area, and those that turn more than once around (a pentagram), are not convex.
#[must_use]
pub fn is_convex_2d(corners: &[Vec2]) -> bool {
    let ring: Vec<Point> = relative_to_first(corners).collect();
    convexity(&ring) != Convexity::Concave
}

/// True if `point` lies inside the polygon.
///
/// Crossings are counted along the ray from the point towards +x (Sunday, "Inclusion of a Point in
/// a Polygon", 2001). An edge includes its lower end only, and points on an edge belong to the
/// polygon on its right, so of polygons that share edges exactly one contains each point.
///
/// ```text
///        ╱╲        each edge that crosses the ray: +1 upwards, −1 downwards;
///   p ──╱──╲──▶    even-odd uses the count, non-zero the sum
///      ╱____╲
/// ```
#[must_use]
pub fn point_in_polygon(point: Vec2, corners: &[Vec2], rule: FillRule) -> bool {
    let mut crossings = 0_usize;
    let mut winding = 0_isize;
    let ends = corners.iter().skip(1).chain(corners.first());
    for (&from, &to) in corners.iter().zip(ends) {
        let is_upward = from.y < to.y;
        // Always start from the lower end, so that both neighbours of a shared edge compute the
        // same numbers.
        let (low, high) = if is_upward { (from, to) } else { (to, from) };
        if !(low.y <= point.y && point.y < high.y) {
            continue;
        }
        let [low, high, point] = [low, high, point].map(|p| p.as_dvec2());
        if (high - low).perp_dot(point - low) > 0.0 {
            crossings += 1;
            winding += if is_upward { 1 } else { -1 };
        }
    }
    match rule {
        FillRule::EvenOdd => crossings % 2 == 1,
        FillRule::NonZero => winding != 0,
    }
}
