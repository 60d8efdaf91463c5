//! Test for rings that cross themselves so often that no triangulation is meaningful.

use super::plane::{Point, turn};

/// An edge that the sweep has reached and not yet passed.
#[derive(Clone, Copy, Debug)]
pub(super) struct SweptEdge {
    index: usize,
    right: f64,
    lower: f64,
    upper: f64,
}

/// True if more than `limit` pairs of edges that are not neighbours meet.
///
/// The sweep reaches edges in the order of their left ends, and drops those that it has passed.
/// That is O(n log n) for compact polygons and n² ÷ 2 quick rejections where all edges overlap in
/// x. It stops at the limit, which a polygon that crosses itself everywhere reaches soon.
pub(super) fn exceed(ring: &[Point], limit: usize, active: &mut Vec<SweptEdge>) -> bool {
    let count = ring.len();
    let ends = |edge: usize| (ring[edge], ring[(edge + 1) % count]);
    let mut by_left: Vec<(f64, usize)> = (0..count)
        .map(|edge| {
            let (from, to) = ends(edge);
            (from[0].min(to[0]), edge)
        })
        .collect();
    by_left.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));

    let mut crossings = 0;
    active.clear();
    for (left, index) in by_left {
        active.retain(|other| other.right >= left);
        let (from, to) = ends(index);
        let (lower, upper) = (from[1].min(to[1]), from[1].max(to[1]));
        for other in active
            .iter()
            .filter(|other| other.lower <= upper && lower <= other.upper)
        {
            let is_neighbour =
                (index + 1) % count == other.index || (other.index + 1) % count == index;
            if !is_neighbour && do_meet((from, to), ends(other.index)) {
                crossings += 1;
                if crossings > limit {
                    return true;
                }
            }
        }
        active.push(SweptEdge {
            index,
            right: from[0].max(to[0]),
            lower,
            upper,
        });
    }
    false
}

/// True if two segments whose bounds overlap share a point; touching counts.
fn do_meet((a, b): (Point, Point), (c, d): (Point, Point)) -> bool {
    turn(a, b, c) * turn(a, b, d) <= 0.0 && turn(c, d, a) * turn(c, d, b) <= 0.0
}
