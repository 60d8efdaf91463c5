//! Convex polygons in space, with attributes at their corners.

use crate::exact::Plane;
use std::cmp::Ordering;

/// A corner of a polygon.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corner<const N: usize> {
    /// The position in world space.
    pub position: [f64; 3],
    /// Numbers that are interpolated where the polygon is cut, such as a colour.
    pub attributes: [f32; N],
}

/// A convex polygon, flat but for rounding, with `N` attributes at each corner.
#[derive(Debug, Clone, PartialEq)]
pub struct Polygon<const N: usize> {
    corners: Vec<Corner<N>>,
    /// The corners through which the polygon's plane goes.
    spanning: [usize; 3],
}

/// The reason why corners are no polygon.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PolygonError {
    /// Fewer than three corners.
    #[error("a polygon has three corners or more; {0} were given")]
    TooFewCorners(usize),
    /// A coordinate is infinite or no number.
    #[error("corner {0} is not finite")]
    NotFinite(usize),
    /// All corners lie on one line.
    #[error("the corners lie on one line; leave the polygon out")]
    NoArea,
    /// A corner lies outside of the plane of the others.
    #[error("corner {0} is not in the plane of the others; cut the polygon into triangles")]
    NotFlat(usize),
    /// The polygon turns in both directions.
    #[error("the polygon is not convex at corner {0}; cut it into triangles")]
    NotConvex(usize),
}

/// The greatest distance of a corner from the plane, in parts of the polygon's extent: the rounding
/// of f32, with room.
const FLATNESS: f64 = 1e-5;

impl<const N: usize> Polygon<N> {
    /// The polygon of corners in either winding; positions and attributes.
    ///
    /// # Errors
    /// [`PolygonError`] if the corners are not those of a convex, flat polygon with an area.
    pub fn new(corners: &[([f32; 3], [f32; N])]) -> Result<Self, PolygonError> {
        if corners.len() < 3 {
            return Err(PolygonError::TooFewCorners(corners.len()));
        }
        let is_finite = |corner: &([f32; 3], [f32; N])| corner.0.iter().all(|x| x.is_finite());
        if let Some(wrong) = corners.iter().position(|corner| !is_finite(corner)) {
            return Err(PolygonError::NotFinite(wrong));
        }
        let corner = |(position, attributes): &([f32; 3], [f32; N])| Corner {
            position: position.map(f64::from),
            attributes: *attributes,
        };
        let corners: Vec<Corner<N>> = corners.iter().map(corner).collect();
        let spanning = spanning(&corners).ok_or(PolygonError::NoArea)?;
        let polygon = Self { corners, spanning };
        polygon.check_shape()?;
        Ok(polygon)
    }

    /// The corners, in the given order.
    #[must_use]
    pub fn corners(&self) -> &[Corner<N>] {
        &self.corners
    }

    /// The plane through three of the corners.
    pub(crate) fn plane(&self) -> Plane {
        Plane::new(self.spanning.map(|corner| self.corners[corner].position))
    }

    /// Checks that the corners are in the plane, and turn in one direction.
    fn check_shape(&self) -> Result<(), PolygonError> {
        let plane = self.plane();
        let normal = plane.normal();
        let length = normal.iter().fold(0.0, |sum, x| sum + x * x);
        let length = libm::sqrt(length);
        let origin = self.corners[self.spanning[0]].position;
        let extent = self.corners.iter().flat_map(|corner| {
            [0, 1, 2].map(|axis: usize| (corner.position[axis] - origin[axis]).abs())
        });
        let extent = extent.fold(0.0, f64::max);
        for (number, corner) in self.corners.iter().enumerate() {
            let (estimate, error) = plane.estimate(corner.position);
            if estimate.abs() > extent * length * FLATNESS + error {
                return Err(PolygonError::NotFlat(number));
            }
        }
        // In the plane of the two axes in which the polygon is largest.
        let axis = (0..3)
            .max_by(|a, b| normal[*a].abs().total_cmp(&normal[*b].abs()))
            .unwrap_or(0);
        let at = |corner: usize| {
            let p = self.corners[corner % self.corners.len()].position;
            [p[(axis + 1) % 3], p[(axis + 2) % 3]]
        };
        let mut winding = Ordering::Equal;
        for corner in 0..self.corners.len() {
            let [a, b, c] = [at(corner), at(corner + 1), at(corner + 2)];
            let area = (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]);
            // Corners on an edge may be off it by rounding.
            let is_straight = area.abs() <= extent * extent * FLATNESS;
            let turn = if is_straight {
                Ordering::Equal
            } else {
                area.total_cmp(&0.0)
            };
            if winding.is_eq() {
                winding = turn;
            } else if turn == winding.reverse() {
                return Err(PolygonError::NotConvex((corner + 1) % self.corners.len()));
            }
        }
        Ok(())
    }
}

/// Three corners that span the polygon's plane: the first, the farthest from it, and the one that
/// makes the largest triangle with both.
fn spanning<const N: usize>(corners: &[Corner<N>]) -> Option<[usize; 3]> {
    let first = corners[0].position;
    let offset =
        |corner: usize| [0, 1, 2].map(|axis: usize| corners[corner].position[axis] - first[axis]);
    let square = |v: [f64; 3]| v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    let farthest =
        (1..corners.len()).max_by(|a, b| square(offset(*a)).total_cmp(&square(offset(*b))))?;
    let u = offset(farthest);
    let area = |corner: usize| {
        let v = offset(corner);
        square([
            u[1] * v[2] - u[2] * v[1],
            u[2] * v[0] - u[0] * v[2],
            u[0] * v[1] - u[1] * v[0],
        ])
    };
    let third = (1..corners.len()).max_by(|a, b| area(*a).total_cmp(&area(*b)))?;
    let flat = square(u) * square(offset(third)) * (FLATNESS * FLATNESS * FLATNESS);
    (area(third) > flat).then_some([0, farthest, third])
}
