//! The plane in which a polygon is triangulated, and the predicates there.

use glam::{DVec3, Vec2, Vec3};

/// A corner in the plane, relative to the polygon's first one.
pub(super) type Point = [f64; 2];

/// The corners relative to the first, so that small polygons stay exact far from the origin.
pub(super) fn relative_to_first(corners: &[Vec2]) -> impl Iterator<Item = Point> {
    let first = corners.first().copied().unwrap_or_default().as_dvec2();
    corners
        .iter()
        .map(move |corner| (corner.as_dvec2() - first).to_array())
}

/// Twice the signed area of the triangle `a b c`: positive if counter-clockwise.
pub(super) fn turn(a: Point, b: Point, c: Point) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])
}

/// Twice the signed area of the polygon: positive if counter-clockwise.
pub(super) fn doubled_area(ring: &[Point]) -> f64 {
    let nexts = ring.iter().skip(1).chain(ring.first());
    ring.iter()
        .zip(nexts)
        .map(|(a, b)| a[0] * b[1] - b[0] * a[1])
        .sum()
}

/// Convexity of a ring.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Convexity {
    /// Convex without collinear or repeated corners: no fan of it has a degenerate triangle.
    Strict,
    /// Convex, but some corner lies on a straight edge or repeats its neighbour.
    Weak,
    /// All other rings: concave, crossing themselves, winding twice, without area, not finite.
    Concave,
}

/// Classifies a ring of either winding.
///
/// A ring is convex if all its turns have one sign and its edges go around once. The second is
/// seen from the edges' heading: "forwards" is +x, or +y if vertical, and a convex ring changes
/// between forwards and backwards exactly twice.
pub(super) fn convexity(ring: &[Point]) -> Convexity {
    let count = ring.len();
    let mut turns_left = false;
    let mut turns_right = false;
    let mut is_strict = true;
    let mut heading_changes = 0;
    let mut first_heading = None;
    let mut last_heading = None;
    for (i, &b) in ring.iter().enumerate() {
        let c = ring[(i + 1) % count];
        if b == c {
            is_strict = false;
            continue;
        }
        let heading = c[0] > b[0] || (c[0] == b[0] && c[1] > b[1]);
        heading_changes += usize::from(last_heading.is_some_and(|last| last != heading));
        last_heading = Some(heading);
        first_heading.get_or_insert(heading);

        // The turn at b: from the last corner that differs from it.
        let a = (1..count)
            .map(|back| ring[(i + count - back) % count])
            .find(|&a| a != b);
        let turn = a.map_or(f64::NAN, |a| turn(a, b, c));
        if turn > 0.0 {
            turns_left = true;
        } else if turn < 0.0 {
            turns_right = true;
        } else if turn == 0.0 {
            is_strict = false;
        } else {
            return Convexity::Concave;
        }
        if turns_left && turns_right {
            return Convexity::Concave;
        }
    }
    heading_changes += usize::from(first_heading != last_heading);
    match (turns_left != turns_right && heading_changes == 2, is_strict) {
        (true, true) => Convexity::Strict,
        (true, false) => Convexity::Weak,
        (false, _) => Convexity::Concave,
    }
}

/// The axes that remain when a polygon in space is projected to the plane.
///
/// The Newell normal, Σ cᵢ × cᵢ₊₁, is twice the polygon's area vector, and its components are twice
/// the areas seen along the axes (Sutherland, Sproull, Schumacker 1974). Dropping the axis of its
/// largest component shrinks the polygon least; the order of the other two makes the result
/// counter-clockwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct DominantPlane {
    horizontal: usize,
    vertical: usize,
}

impl DominantPlane {
    /// The plane of a polygon, or `None` if it has no area or is not finite.
    pub(super) fn of(corners: &[Vec3]) -> Option<Self> {
        let first = corners.first()?.as_dvec3();
        let mut normal = DVec3::ZERO;
        let mut from = DVec3::ZERO;
        for corner in corners.iter().skip(1) {
            let to = corner.as_dvec3() - first;
            normal += from.cross(to);
            from = to;
        }
        if !normal.is_finite() || normal == DVec3::ZERO {
            return None;
        }
        let size = normal.abs();
        let axis = if size.z >= size.x && size.z >= size.y {
            2
        } else if size.y >= size.x {
            1
        } else {
            0
        };
        let (horizontal, vertical) = ((axis + 1) % 3, (axis + 2) % 3);
        Some(if normal[axis] > 0.0 {
            Self {
                horizontal,
                vertical,
            }
        } else {
            Self {
                horizontal: vertical,
                vertical: horizontal,
            }
        })
    }

    /// The projected corners, relative to the first.
    pub(super) fn flatten(self, corners: &[Vec3]) -> impl Iterator<Item = Point> {
        let first = corners.first().copied().unwrap_or_default().as_dvec3();
        corners.iter().map(move |corner| {
            let offset = corner.as_dvec3() - first;
            [offset[self.horizontal], offset[self.vertical]]
        })
    }
}
