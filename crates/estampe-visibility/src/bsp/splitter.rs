//! Splitters: the planes of polygons, and planes across an axis.

use super::tree::Piece;
use crate::exact::Plane;
use crate::eye::Eye;
use std::cmp::Ordering;

/// A plane that divides space.
#[derive(Debug, Clone, Copy)]
pub(super) enum Splitter {
    /// The plane of a polygon.
    Polygon {
        /// The number of the polygon in the input.
        source: u32,
        plane: Plane,
    },
    /// The plane across an axis; greater coordinates are in front.
    Axis { axis: usize, at: f64 },
}

/// Where a piece lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    Front,
    Back,
    /// In the plane.
    On,
    /// On both sides.
    Across,
}

impl Splitter {
    /// The side of a point.
    pub(super) fn side(&self, p: [f64; 3]) -> Ordering {
        match self {
            Self::Polygon { plane, .. } => plane.side(p),
            // Coordinates are finite; −0 equals 0.
            Self::Axis { axis, at } => p[*axis].partial_cmp(at).unwrap_or(Ordering::Equal),
        }
    }

    /// The signed distance of a point, rounded, in units of its own.
    pub(super) fn distance(&self, p: [f64; 3]) -> f64 {
        match self {
            Self::Polygon { plane, .. } => plane.estimate(p).0,
            Self::Axis { axis, at } => p[*axis] - at,
        }
    }

    /// The side on which the eye is.
    pub(super) fn side_of_eye(&self, eye: Eye) -> Ordering {
        match (self, eye) {
            (_, Eye::Point(eye)) => self.side(eye),
            (Self::Polygon { plane, .. }, Eye::Direction(towards)) => {
                plane.side_of_direction(towards)
            }
            (Self::Axis { axis, .. }, Eye::Direction(towards)) => towards[*axis].total_cmp(&0.0),
        }
    }

    /// Where a piece of a polygon lies, whose plane is `own`.
    pub(super) fn classify<const N: usize>(&self, piece: &Piece<N>, own: &Plane) -> Side {
        if let Self::Polygon { source, plane } = self {
            let is_near = |position: [f64; 3]| {
                let (estimate, error) = plane.estimate(position);
                estimate.abs() <= error * 64.0
            };
            // Corners that cuts made are rounded, those of the polygon are not.
            let is_own = *source == piece.source;
            if is_own
                || piece.corners.iter().all(|corner| is_near(corner.position))
                    && own.points().iter().all(|point| plane.side(*point).is_eq())
            {
                return Side::On;
            }
        }
        let (mut is_front, mut is_back) = (false, false);
        for corner in &piece.corners {
            match self.side(corner.position) {
                Ordering::Greater => is_front = true,
                Ordering::Less => is_back = true,
                Ordering::Equal => {}
            }
        }
        match (is_front, is_back) {
            (true, true) => Side::Across,
            (true, false) => Side::Front,
            (false, true) => Side::Back,
            (false, false) => Side::On,
        }
    }
}
