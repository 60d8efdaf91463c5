//! Cutting convex polygons in two.

use super::splitter::Splitter;
use super::tree::Piece;
use crate::polygon::Corner;
use std::cmp::Ordering;

/// The parts of a piece in front of a splitter and behind it; both have an area, as the piece has
/// corners on both sides.
pub(super) fn cut<const N: usize>(piece: &Piece<N>, splitter: &Splitter) -> [Piece<N>; 2] {
    let corners = &piece.corners;
    let sides: Vec<Ordering> = corners
        .iter()
        .map(|corner| splitter.side(corner.position))
        .collect();
    let [mut front, mut back] = [(); 2].map(|()| Vec::with_capacity(corners.len() + 1));
    for (k, corner) in corners.iter().enumerate() {
        if sides[k].is_ge() {
            front.push(*corner);
        }
        if sides[k].is_le() {
            back.push(*corner);
        }
        let next = (k + 1) % corners.len();
        // Always from the front to the back, so that polygons that share the edge share the corner.
        let crossing = match (sides[k], sides[next]) {
            (Ordering::Greater, Ordering::Less) => crossing(corner, &corners[next], splitter),
            (Ordering::Less, Ordering::Greater) => crossing(&corners[next], corner, splitter),
            _ => continue,
        };
        front.push(crossing);
        back.push(crossing);
    }
    [front, back].map(|corners| Piece {
        corners,
        source: piece.source,
    })
}

/// The point of an edge in the splitter's plane.
fn crossing<const N: usize>(from: &Corner<N>, to: &Corner<N>, splitter: &Splitter) -> Corner<N> {
    let [a, b] = [from, to].map(|corner| splitter.distance(corner.position));
    // Next to the plane the distances may be rounded to zero or across it.
    let t = a / (a - b);
    let t = if t.is_finite() {
        t.clamp(0.0, 1.0)
    } else {
        0.5
    };
    let mut position: [f64; 3] = std::array::from_fn(|axis| {
        from.position[axis] + (to.position[axis] - from.position[axis]) * t
    });
    if let Splitter::Axis { axis, at } = splitter {
        position[*axis] = *at;
    }
    #[expect(
        clippy::cast_possible_truncation,
        reason = "rounds to the nearest float"
    )]
    let attributes = std::array::from_fn(|k| {
        let [p, q] = [from.attributes[k], to.attributes[k]].map(f64::from);
        (p + (q - p) * t) as f32
    });
    Corner {
        position,
        attributes,
    }
}
