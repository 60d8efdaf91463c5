//! Signed area, convexity and the point test of polygons in the plane.

use glam::Vec2;

use super::plane::{Convexity, Point, convexity, doubled_area, relative_to_first};

/// What counts as inside where a polygon crosses itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum FillRule {
    /// Inside where a ray to infinity crosses the boundary an odd number of times.
    #[default]
    EvenOdd,
    /// Inside where the boundary winds around the point, in whichever direction.
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

/// Whether the polygon is convex: simple, and never turning against its own winding.
///
/// Corners along a straight edge and repeated corners are allowed. Either winding. Polygons without
/// area, and those that turn more than once around (a pentagram), are not convex.
#[must_use]
pub fn is_convex_2d(corners: &[Vec2]) -> bool {
    let ring: Vec<Point> = relative_to_first(corners).collect();
    convexity(&ring) != Convexity::Concave
}

/// Whether `point` lies inside the polygon.
///
/// Crossings are counted along the ray from the point towards +x (Sunday, "Inclusion of a Point in
/// a Polygon", 2001). Edges own their lower end only and points on an edge belong to the polygon on
/// its right, so of polygons that share edges exactly one contains each point.
///
/// ```text
///        ╱╲        each edge that crosses the ray: +1 upwards, −1 downwards;
///   p ──╱──╲──▶    even-odd looks at the count, non-zero at the sum
///      ╱____╲
/// ```
#[must_use]
pub fn point_in_polygon(point: Vec2, corners: &[Vec2], rule: FillRule) -> bool {
    let mut crossings = 0_usize;
    let mut winding = 0_isize;
    let ends = corners.iter().skip(1).chain(corners.first());
    for (&from, &to) in corners.iter().zip(ends) {
        let is_upward = from.y < to.y;
        // Both neighbours of a shared edge must see the same numbers: always from its lower end.
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
