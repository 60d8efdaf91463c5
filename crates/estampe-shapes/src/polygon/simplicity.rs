//! Test whether a polygon is simple.

use std::cmp::Ordering;

use glam::Vec2;

use super::exact::orientation;

/// True if the polygon is simple: its edges have no point in common but the corner between
/// neighbours, and no edge has the length zero.
///
/// Corners along a straight edge are allowed; spikes, corners that touch an edge and repeated
/// corners are not. Fewer than three corners, and coordinates that are not finite, are not simple.
/// The answer is exact. Edges are compared where they overlap along x: O(n log n) for compact
/// polygons, n² ÷ 2 where all overlap.
#[must_use]
pub fn is_simple_2d(corners: &[Vec2]) -> bool {
    let count = corners.len();
    if count < 3 || corners.iter().any(|corner| !corner.is_finite()) {
        return false;
    }
    let ends = |edge: usize| [corners[edge], corners[(edge + 1) % count]];
    let left = |edge: usize| ends(edge)[0].x.min(ends(edge)[1].x);
    let right = |edge: usize| ends(edge)[0].x.max(ends(edge)[1].x);
    let mut by_left: Vec<usize> = (0..count).collect();
    by_left.sort_by(|&a, &b| left(a).total_cmp(&left(b)));
    let mut active: Vec<usize> = Vec::new();
    for edge in by_left {
        let [a, b] = ends(edge);
        if a == b {
            return false;
        }
        active.retain(|&other| right(other) >= left(edge));
        for &other in &active {
            let is_allowed = if (edge + 1) % count == other {
                leave_each_other(a, b, ends(other)[1])
            } else if (other + 1) % count == edge {
                leave_each_other(ends(other)[0], a, b)
            } else {
                !do_meet([a, b], ends(other))
            };
            if !is_allowed {
                return false;
            }
        }
        active.push(edge);
    }
    true
}

/// True if the edges `a b` and `b c` have only `b` in common: if they do not fold back.
fn leave_each_other(a: Vec2, b: Vec2, c: Vec2) -> bool {
    if orientation(a, b, c) != Ordering::Equal {
        return true;
    }
    // Collinear: b must lie between the others, on any axis on which they differ.
    let is_between = |a: f32, b: f32, c: f32| (a <= b && b <= c) || (c <= b && b <= a);
    is_between(a.x, b.x, c.x) && is_between(a.y, b.y, c.y)
}

/// True if two segments share a point; touching counts.
fn do_meet([a, b]: [Vec2; 2], [c, d]: [Vec2; 2]) -> bool {
    let (low, high) = (a.min(b), a.max(b));
    if !(c.min(d).cmple(high).all() && low.cmple(c.max(d)).all()) {
        return false;
    }
    let is_apart = |p: Ordering, q: Ordering| p == q && p != Ordering::Equal;
    !is_apart(orientation(a, b, c), orientation(a, b, d))
        && !is_apart(orientation(c, d, a), orientation(c, d, b))
}
