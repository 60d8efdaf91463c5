//! The arrangement of a polygon's edges: divided wherever they meet, so that pieces share ends
//! only.
//!
//! ```text
//!    •       •             •       •
//!     ╲     ╱               ╲     ╱      a crossing becomes a vertex of four pieces;
//!      ╲   ╱                 ╲   ╱       pieces that coincide become one, with
//!       ╲ ╱        ───▶       •          the sum of their windings
//!       ╱ ╲                  ╱ ╲
//!      •───•                •───•
//! ```

use std::cmp::Ordering;

use super::exact::{ExactPoint, cross};

/// A corner on the integer grid.
pub(super) type Corner = [i64; 2];

/// The maximum number of places at which edges meet other than at the ends of both.
pub(super) const MAX_MEETINGS: usize = 1 << 20;

/// The maximum number of pairs of edges that are compared because their boxes overlap along y.
const MAX_PAIRS: usize = 1 << 29;

/// A piece of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Piece {
    /// The vertex at which it begins, in the order of the sweep.
    pub(super) low: usize,
    /// The vertex at which it ends.
    pub(super) high: usize,
    /// The number of edges from `low` to `high`, minus that of the edges in the other direction.
    pub(super) winding: i32,
}

/// The vertices and pieces of a polygon's edges.
#[derive(Debug, Default)]
pub(super) struct Arrangement {
    /// All vertices, different and in the order of the sweep.
    pub(super) vertices: Vec<ExactPoint>,
    /// For each vertex the number of a corner there, over all rings; `None` for a crossing.
    pub(super) corner_of: Vec<Option<usize>>,
    /// All pieces, sorted by `low`; no two have the same ends.
    pub(super) pieces: Vec<Piece>,
}

/// An edge of a ring, and where it is divided.
#[derive(Debug)]
struct Edge {
    ends: [Corner; 2],
    /// Numbers of raw points: its ends, then the places at which others meet it.
    points: Vec<usize>,
}

impl Edge {
    fn low(&self, axis: usize) -> i64 {
        self.ends[0][axis].min(self.ends[1][axis])
    }

    fn high(&self, axis: usize) -> i64 {
        self.ends[0][axis].max(self.ends[1][axis])
    }
}

/// Divides the edges of all rings; `None` if they meet more than [`MAX_MEETINGS`] times, or so many
/// overlap along y that comparing them would take too long.
pub(super) fn arrange(rings: &[Vec<Corner>]) -> Option<Arrangement> {
    let mut points: Vec<ExactPoint> = Vec::new();
    let mut edges: Vec<Edge> = Vec::new();
    for ring in rings {
        let first = points.len();
        points.extend(ring.iter().map(|&corner| ExactPoint::corner(corner)));
        for (i, &from) in ring.iter().enumerate() {
            let next = (i + 1) % ring.len();
            if from != ring[next] {
                edges.push(Edge {
                    ends: [from, ring[next]],
                    points: vec![first + i, first + next],
                });
            }
        }
    }
    let corner_count = points.len();
    meet(&mut edges, &mut points)?;

    // Number the points in the order of the sweep, equal ones alike.
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| points[a].order(&points[b]).then(a.cmp(&b)));
    let mut arrangement = Arrangement::default();
    let mut vertex_of = vec![0; points.len()];
    for point in order {
        let is_new = arrangement
            .vertices
            .last()
            .is_none_or(|last| last.order(&points[point]) != Ordering::Equal);
        if is_new {
            arrangement.vertices.push(points[point]);
            // Corners come before crossings among equal points.
            arrangement
                .corner_of
                .push((point < corner_count).then_some(point));
        }
        vertex_of[point] = arrangement.vertices.len() - 1;
    }

    // Cut the edges into pieces, and unite those that coincide.
    let mut pieces: Vec<Piece> = Vec::new();
    for edge in &edges {
        let winding = if vertex_of[edge.points[0]] < vertex_of[edge.points[1]] {
            1
        } else {
            -1
        };
        // Along an edge the order of the sweep is that of the edge.
        let mut along: Vec<usize> = edge.points.iter().map(|&point| vertex_of[point]).collect();
        along.sort_unstable();
        along.dedup();
        pieces.extend(along.windows(2).map(|ends| Piece {
            low: ends[0],
            high: ends[1],
            winding,
        }));
    }
    pieces.sort_unstable();
    pieces.dedup_by(|other, first| {
        let is_same = (other.low, other.high) == (first.low, first.high);
        if is_same {
            first.winding += other.winding;
        }
        is_same
    });
    arrangement.pieces = pieces;
    Some(arrangement)
}

/// Finds where edges meet, by a sweep along y that compares those which overlap.
fn meet(edges: &mut [Edge], points: &mut Vec<ExactPoint>) -> Option<()> {
    let mut by_low: Vec<usize> = (0..edges.len()).collect();
    by_low.sort_by_key(|&edge| edges[edge].low(1));
    let mut active: Vec<usize> = Vec::new();
    let (mut meetings, mut pairs) = (0, 0);
    for edge in by_low {
        let start = edges[edge].low(1);
        active.retain(|&other| edges[other].high(1) >= start);
        pairs += active.len();
        if pairs > MAX_PAIRS {
            return None;
        }
        for &other in &active {
            let [p, q] = [&edges[edge], &edges[other]];
            if p.low(0) <= q.high(0) && q.low(0) <= p.high(0) {
                meetings += meet_pair(edges, [edge, other], points);
                if meetings > MAX_MEETINGS {
                    return None;
                }
            }
        }
        active.push(edge);
    }
    Some(())
}

/// Divides two edges where they meet; returns the number of divisions.
fn meet_pair(edges: &mut [Edge], [p, q]: [usize; 2], points: &mut Vec<ExactPoint>) -> usize {
    let [[a, b], [c, d]] = [edges[p].ends, edges[q].ends];
    let (at_c, at_d) = (cross(a, b, c).signum(), cross(a, b, d).signum());
    let (at_a, at_b) = (cross(c, d, a).signum(), cross(c, d, b).signum());
    if at_c * at_d < 0 && at_a * at_b < 0 {
        points.push(ExactPoint::crossing([a, b], [c, d]));
        let crossing = points.len() - 1;
        edges[p].points.push(crossing);
        edges[q].points.push(crossing);
        return 1;
    }
    // An end of one edge on the other; of collinear edges that overlap there are two or more.
    let ends = [
        (at_c, p, q, 0),
        (at_d, p, q, 1),
        (at_a, q, p, 0),
        (at_b, q, p, 1),
    ];
    let mut count = 0;
    for (side, divided, other, end) in ends {
        let corner = edges[other].ends[end];
        let own = &edges[divided];
        let is_inside = |axis: usize| (own.low(axis)..=own.high(axis)).contains(&corner[axis]);
        if side == 0 && is_inside(0) && is_inside(1) && !own.ends.contains(&corner) {
            let point = edges[other].points[end];
            edges[divided].points.push(point);
            count += 1;
        }
    }
    count
}
