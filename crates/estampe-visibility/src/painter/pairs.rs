//! Orders by comparing all pairs.

use super::by_farthest_corner;
use crate::exact::Plane;
use crate::eye::Eye;
use crate::polygon::Polygon;
use std::cmp::Ordering;

/// The result of [`by_pairs`].
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct PairwiseOrder {
    /// All polygons, from the farthest on: exact but for those below.
    pub order: Vec<u32>,
    /// Pairs that cross in the picture: each hides a part of the other.
    pub crossing: Vec<[u32; 2]>,
    /// Polygons that hide each other in a cycle, or stand behind such a cycle in the order.
    pub cyclic: Vec<u32>,
}

/// The reason why there is no order by pairs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("{0} polygons are too many to compare all pairs: at most {MAX_POLYGONS}; use a BSP tree")]
pub struct TooManyPolygons(pub usize);

/// The most polygons that are compared by pairs.
pub const MAX_POLYGONS: usize = 4096;

/// An order in which no polygon hides a later one, found by comparing all pairs; as near to it as
/// there is one.
///
/// # Errors
/// [`TooManyPolygons`] above [`MAX_POLYGONS`]: n² pairs are compared.
pub fn by_pairs<const N: usize>(
    polygons: &[Polygon<N>],
    eye: Eye,
) -> Result<PairwiseOrder, TooManyPolygons> {
    if polygons.len() > MAX_POLYGONS {
        return Err(TooManyPolygons(polygons.len()));
    }
    let silhouettes: Vec<Silhouette> = polygons.iter().map(|p| Silhouette::new(p, eye)).collect();
    let mut result = PairwiseOrder::default();
    // For each polygon those that hide it, and the number of those that it hides and that are not
    // drawn yet.
    let mut hidden_by: Vec<Vec<u32>> = vec![Vec::new(); polygons.len()];
    let mut waits_for: Vec<u32> = vec![0; polygons.len()];
    for (p, number_p) in (0_usize..).zip(0_u32..).take(polygons.len()) {
        for (q, number_q) in (0..p).zip(0_u32..) {
            match relation(&silhouettes[p], &silhouettes[q]) {
                Relation::Apart => {}
                Relation::Crossing => result.crossing.push([number_q, number_p]),
                Relation::FirstHides => {
                    hidden_by[q].push(number_p);
                    waits_for[p] += 1;
                }
                Relation::SecondHides => {
                    hidden_by[p].push(number_q);
                    waits_for[q] += 1;
                }
            }
        }
    }
    // Of those that wait for nothing the farthest is drawn next; in a cycle, the farthest of all.
    let mut remaining = by_farthest_corner(polygons, eye);
    while !remaining.is_empty() {
        let free = remaining
            .iter()
            .position(|number| waits_for[*number as usize] == 0);
        let number = remaining.remove(free.unwrap_or(0));
        if free.is_none() {
            result.cyclic.push(number);
        }
        result.order.push(number);
        for hider in std::mem::take(&mut hidden_by[number as usize]) {
            waits_for[hider as usize] = waits_for[hider as usize].saturating_sub(1);
        }
    }
    Ok(result)
}

/// How two polygons hide each other in the picture.
enum Relation {
    Apart,
    FirstHides,
    SecondHides,
    Crossing,
}

/// A polygon with the planes through the eye and its edges.
struct Silhouette {
    corners: Vec<[f64; 3]>,
    plane: Plane,
    /// The side of the plane on which the eye is.
    side_of_eye: Ordering,
    /// The planes through the eye and each edge, and the side of the polygon.
    edges: Vec<(Plane, Ordering)>,
}

impl Silhouette {
    fn new<const N: usize>(polygon: &Polygon<N>, eye: Eye) -> Self {
        let plane = polygon.plane();
        let corners: Vec<[f64; 3]> = polygon.corners().iter().map(|c| c.position).collect();
        let side_of_eye = match eye {
            Eye::Point(eye) => plane.side(eye),
            Eye::Direction(towards) => plane.side_of_direction(towards),
        };
        let edge = |k: usize| {
            let (from, to) = (corners[k], corners[(k + 1) % corners.len()]);
            let third = match eye {
                Eye::Point(eye) => eye,
                Eye::Direction(towards) => [0, 1, 2].map(|axis: usize| from[axis] + towards[axis]),
            };
            let plane = Plane::new([third, from, to]);
            let sides = corners.iter().map(|corner| plane.side(*corner));
            let inside = sides.clone().find(|side| side.is_ne());
            Some((plane, inside?))
        };
        Self {
            edges: (0..corners.len()).filter_map(edge).collect(),
            corners,
            plane,
            side_of_eye,
        }
    }

    /// The part of a polygon that covers this one in the picture, or is covered by it.
    fn overlap(&self, corners: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let mut part = corners.to_vec();
        for (plane, inside) in &self.edges {
            let sides: Vec<Ordering> = part.iter().map(|corner| plane.side(*corner)).collect();
            if !sides.contains(inside) {
                return Vec::new();
            }
            let mut kept = Vec::with_capacity(part.len() + 1);
            for (k, corner) in part.iter().enumerate() {
                let next = (k + 1) % part.len();
                if sides[k] != inside.reverse() {
                    kept.push(*corner);
                }
                if sides[k].is_ne() && sides[next] == sides[k].reverse() {
                    let (a, b) = (plane.estimate(*corner).0, plane.estimate(part[next]).0);
                    let t = (a / (a - b)).clamp(0.0, 1.0);
                    kept.push(
                        [0, 1, 2].map(|axis: usize| {
                            corner[axis] + (part[next][axis] - corner[axis]) * t
                        }),
                    );
                }
            }
            part = kept;
        }
        part
    }
}

/// Compares two polygons where both cover the picture. Corners of the overlap are rounded: those
/// next to the other polygon's plane do not count.
fn relation(first: &Silhouette, second: &Silhouette) -> Relation {
    // Polygons seen from the side cover nothing.
    if first.side_of_eye.is_eq() || second.side_of_eye.is_eq() {
        return Relation::Apart;
    }
    let overlap = second.overlap(&first.corners);
    let scale = |plane: &Plane| {
        plane
            .normal()
            .iter()
            .fold(0.0_f64, |most, x| most.max(x.abs()))
    };
    let extent = first
        .corners
        .iter()
        .flatten()
        .fold(0.0_f64, |most, x| most.max(x.abs()));
    let nothing = scale(&second.plane) * extent * 1e-12;
    let (mut nearer, mut farther) = (false, false);
    for corner in overlap {
        let (estimate, error) = second.plane.estimate(corner);
        if estimate.abs() > nothing.max(error) {
            let is_nearer = estimate.total_cmp(&0.0) == second.side_of_eye;
            nearer |= is_nearer;
            farther |= !is_nearer;
        }
    }
    match (nearer, farther) {
        (true, true) => Relation::Crossing,
        (true, false) => Relation::FirstHides,
        (false, true) => Relation::SecondHides,
        (false, false) => Relation::Apart,
    }
}
