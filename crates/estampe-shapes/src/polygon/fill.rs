//! Triangulation of any polygon by a fill rule: with holes, crossing itself, touching itself.

use std::fmt;

use glam::{DVec2, Vec2};

use super::arrangement::{Corner, MAX_MEETINGS, arrange};
use super::exact::MAX_COORDINATE;
use super::measure::FillRule;
use super::sweep::triangulate;

/// The maximum number of corners of all rings together.
pub const MAX_CORNERS: usize = 1 << 17;

/// The triangles of a polygon.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FilledPolygon {
    /// The corners of all rings in their order, then the points at which edges cross.
    pub vertices: Vec<Vec2>,
    /// Triangles, counter-clockwise with y up, whatever the winding of the rings. They cover the
    /// inside once and touch each other along whole edges.
    pub triangles: Vec<[u32; 3]>,
}

/// The reason why a polygon cannot be filled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum PolygonError {
    /// A coordinate is infinite or NaN, or too large for a fill on pixels.
    Coordinate {
        /// The number of the ring.
        ring: usize,
        /// The number of the corner in the ring.
        corner: usize,
    },
    /// More than [`MAX_CORNERS`] corners.
    TooManyCorners {
        /// The number of corners.
        count: usize,
    },
    /// The edges meet, or lie beside each other, too often.
    TooManyCrossings,
}

impl fmt::Display for PolygonError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Coordinate { ring, corner } => write!(
                f,
                "corner {corner} of ring {ring} is not finite or too far away; check its coordinates"
            ),
            Self::TooManyCorners { count } => write!(
                f,
                "the polygon has {count} corners, more than {MAX_CORNERS}; divide it or simplify it"
            ),
            Self::TooManyCrossings => write!(
                f,
                "the polygon's edges meet more than {MAX_MEETINGS} times or nearly all overlap; \
                 divide it or simplify it"
            ),
        }
    }
}

impl std::error::Error for PolygonError {}

/// Triangulates the inside of a polygon of several rings.
///
/// The rings may be given in any order and winding; they may cross and touch themselves and each
/// other, and edges may coincide. With [`FillRule::EvenOdd`] a ring in a ring is a hole; with
/// [`FillRule::NonZero`] it is one if it has the other winding.
///
/// Corners are rounded to a grid of 2⁻²⁸ of the polygon's extent, on which all decisions are exact:
/// the triangles cover the inside of the rounded polygon without overlap or gap. Corners whose
/// coordinates are integers of up to 28 bits, times a common power of two, are not rounded. The
/// crossings in [`FilledPolygon::vertices`] are rounded to f32.
///
/// # Errors
/// [`PolygonError`] says when.
pub fn triangulate_rings(rings: &[&[Vec2]], rule: FillRule) -> Result<FilledPolygon, PolygonError> {
    check(rings, f32::MAX)?;
    let corners = || rings.iter().flat_map(|ring| ring.iter().copied());
    let grid = Grid::around(corners());
    let snapped: Vec<Vec<Corner>> = rings
        .iter()
        .map(|ring| ring.iter().map(|&corner| grid.snapped(corner)).collect())
        .collect();
    let arrangement = arrange(&snapped).ok_or(PolygonError::TooManyCrossings)?;

    let mut vertices: Vec<Vec2> = corners().collect();
    let numbers: Vec<u32> = arrangement
        .vertices
        .iter()
        .zip(&arrangement.corner_of)
        .map(|(point, corner)| {
            let number = corner.unwrap_or_else(|| {
                vertices.push(grid.position(point.rounded()));
                vertices.len() - 1
            });
            u32::try_from(number).expect("2¹⁷ corners and 2²⁰ crossings")
        })
        .collect();
    let triangles = triangulate(&arrangement, rule);
    Ok(FilledPolygon {
        triangles: triangles
            .into_iter()
            .map(|t| t.map(|vertex| numbers[vertex]))
            .collect(),
        vertices,
    })
}

/// Checks the number of corners, and that all coordinates are within a limit.
pub(super) fn check(rings: &[&[Vec2]], limit: f32) -> Result<(), PolygonError> {
    let count = rings.iter().map(|ring| ring.len()).sum();
    if count > MAX_CORNERS {
        return Err(PolygonError::TooManyCorners { count });
    }
    for (number, ring) in rings.iter().enumerate() {
        // A comparison with NaN is false.
        let is_bad = |corner: &Vec2| !corner.abs().cmple(Vec2::splat(limit)).all();
        if let Some(corner) = ring.iter().position(is_bad) {
            return Err(PolygonError::Coordinate {
                ring: number,
                corner,
            });
        }
    }
    Ok(())
}

/// The integer grid on which a polygon's corners are rounded.
#[derive(Clone, Copy, Debug)]
struct Grid {
    origin: DVec2,
    /// The power of two of grid steps per unit.
    exponent: i32,
}

impl Grid {
    /// The finest grid on which these corners have coordinates of up to 28 bits.
    fn around(corners: impl Iterator<Item = Vec2> + Clone) -> Self {
        let low = corners.clone().reduce(Vec2::min).unwrap_or_default();
        let high = corners.reduce(Vec2::max).unwrap_or_default();
        let extent = (high.as_dvec2() - low.as_dvec2()).max_element();
        // The extent is below 2^bits.
        let (_, bits) = libm::frexp(extent);
        Self {
            origin: low.as_dvec2(),
            exponent: i32::try_from(MAX_COORDINATE.ilog2()).unwrap_or(0) - bits,
        }
    }

    #[expect(
        clippy::cast_possible_truncation,
        reason = "the offsets are at most 2²⁸"
    )]
    fn snapped(&self, corner: Vec2) -> Corner {
        let offset = corner.as_dvec2() - self.origin;
        [offset.x, offset.y].map(|x| libm::rint(libm::scalbn(x, self.exponent)) as i64)
    }

    fn position(&self, point: DVec2) -> Vec2 {
        let offset = DVec2::new(
            libm::scalbn(point.x, -self.exponent),
            libm::scalbn(point.y, -self.exponent),
        );
        (self.origin + offset).as_vec2()
    }
}
