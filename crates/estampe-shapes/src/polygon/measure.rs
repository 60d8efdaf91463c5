//! Signed area, convexity and the point test of polygons in the plane.

use std::cmp::Ordering;

use glam::Vec2;

use super::exact::orientation;
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
/// polygon on its right, so of polygons that share edges exactly one contains each point. The
/// answer is exact. [`locate_in_polygon`] tells points on edges apart.
///
/// ```text
///        ╱╲        each edge that crosses the ray: +1 upwards, −1 downwards;
///   p ──╱──╲──▶    even-odd uses the count, non-zero the sum
///      ╱____╲
/// ```
#[must_use]
pub fn point_in_polygon(point: Vec2, corners: &[Vec2], rule: FillRule) -> bool {
    Crossings::of(point, corners).are_inside(rule)
}

/// The place of a point in relation to a polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PointLocation {
    /// Inside by the fill rule, and on no edge.
    Inside,
    /// On an edge or corner, even if the inside is on both sides of it.
    OnEdge,
    /// Outside, and on no edge.
    Outside,
}

/// The place of a point in relation to a polygon of several rings. The answer is exact.
///
/// With [`FillRule::EvenOdd`] a ring in a ring is a hole; with [`FillRule::NonZero`] it is one if
/// it has the other winding. A ring of one corner is a point, of two an edge there and back.
#[must_use]
pub fn locate_in_polygon(point: Vec2, rings: &[&[Vec2]], rule: FillRule) -> PointLocation {
    let mut all = Crossings::default();
    for ring in rings {
        let own = Crossings::of(point, ring);
        all.count += own.count;
        all.winding += own.winding;
        all.is_on_edge |= own.is_on_edge;
    }
    if all.is_on_edge {
        PointLocation::OnEdge
    } else if all.are_inside(rule) {
        PointLocation::Inside
    } else {
        PointLocation::Outside
    }
}

/// The crossings of the ray from a point towards +x with a ring.
#[derive(Clone, Copy, Debug, Default)]
struct Crossings {
    count: usize,
    winding: isize,
    is_on_edge: bool,
}

impl Crossings {
    fn of(point: Vec2, corners: &[Vec2]) -> Self {
        let mut found = Self::default();
        let ends = corners.iter().skip(1).chain(corners.first());
        for (&from, &to) in corners.iter().zip(ends) {
            let is_upward = from.y < to.y;
            // Always start from the lower end, so that both neighbours of a shared edge ask the
            // same question.
            let (low, high) = if is_upward { (from, to) } else { (to, from) };
            let is_beside = low.y <= point.y && point.y <= high.y;
            let is_beyond = point.x > low.x.max(high.x);
            if !is_beside || is_beyond {
                continue;
            }
            let side = orientation(low, high, point);
            found.is_on_edge |= side == Ordering::Equal && point.x >= low.x.min(high.x);
            if side == Ordering::Greater && point.y < high.y {
                found.count += 1;
                found.winding += if is_upward { 1 } else { -1 };
            }
        }
        found
    }

    fn are_inside(self, rule: FillRule) -> bool {
        match rule {
            FillRule::EvenOdd => self.count % 2 == 1,
            FillRule::NonZero => self.winding != 0,
        }
    }
}
