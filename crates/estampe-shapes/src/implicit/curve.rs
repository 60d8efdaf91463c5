//! Curves F(x, y) = 0 by marching triangles.

use std::collections::HashMap;
use std::ops::Range;

use glam::{DVec2, DVec3};

use super::axis::{Axis, least_fraction};
use super::root::sign_change;
use super::{ImplicitError, MAX_CURVE_CELLS, MAX_ELEMENTS};
use crate::curve::{Curve, Strand};

/// A meshed implicit curve.
#[derive(Clone, Debug, PartialEq)]
pub struct ImplicitCurve {
    /// The curve, in the plane z = 0. Its polylines have the points at which F is negative on their
    /// left.
    pub curve: Curve,
    /// The number of places inside the box at which the curve is open: edges of the lattice on
    /// which F changes its sign without a root, at jumps and poles, and triangles with both signs
    /// and a node at which F is not defined.
    pub interruptions: u64,
}

/// A node of the lattice with the function's value.
#[derive(Clone, Copy, Debug)]
struct Node {
    id: u32,
    position: DVec2,
    value: f64,
}

/// Meshes the curve `function` = 0 in a box.
///
/// `bounds` are the ranges of x and y, and `cells` the numbers of cells along them, clamped to
/// 1..=[`MAX_CURVE_CELLS`]. Each polyline is closed, or ends on the box, or where the function
/// jumps or is not defined. Points lie at roots of the function to 1e-10 of a cell, except those
/// nearest to nodes of the lattice, which may be up to 1e-3 of a cell away.
///
/// # Errors
/// [`ImplicitError`] says when.
pub fn curve(
    bounds: &[Range<f64>; 2],
    cells: [u32; 2],
    function: impl Fn(DVec2) -> f64,
) -> Result<ImplicitCurve, ImplicitError> {
    let axis = |i: usize| Axis::new(i, &bounds[i], cells[i].clamp(1, MAX_CURVE_CELLS));
    let axes = [axis(0)?, axis(1)?];
    let mut march = March {
        least: least_fraction(&axes)?,
        function: &function,
        point_of_edge: HashMap::new(),
        points: Vec::new(),
        jumps: Vec::new(),
        segments: Vec::new(),
        skipped: 0,
    };
    let [nx, ny] = axes.map(|axis| axis.cells);
    let node = |halves: [u32; 2], id: u32| {
        let position = DVec2::new(axes[0].coordinate(halves[0]), axes[1].coordinate(halves[1]));
        Node {
            id,
            position,
            value: function(position),
        }
    };
    let corners = |j: u32| -> Vec<Node> {
        let first = (nx + 1) * j;
        (0..=nx).map(|i| node([2 * i, 2 * j], first + i)).collect()
    };
    let mut below = corners(0);
    for j in 0..ny {
        let above = corners(j + 1);
        for i in 0..nx {
            let (left, right) = (i as usize, i as usize + 1);
            let around = [below[left], below[right], above[right], above[left]];
            let first_center = (nx + 1) * (ny + 1);
            let center = node([2 * i + 1, 2 * j + 1], first_center + nx * j + i);
            for side in 0..4 {
                march.triangle([center, around[side], around[(side + 1) % 4]]);
            }
        }
        if march.segments.len() > MAX_ELEMENTS {
            return Err(ImplicitError::TooManyElements);
        }
        below = above;
    }
    Ok(march.finish())
}

struct March<'f, F> {
    /// The least distance of a point from a node, as a fraction of the edge.
    least: f64,
    function: &'f F,
    point_of_edge: HashMap<(u32, u32), u32>,
    points: Vec<DVec2>,
    /// For each point whether there is no root but a jump.
    jumps: Vec<bool>,
    segments: Vec<[u32; 2]>,
    skipped: u64,
}

impl<F: Fn(DVec2) -> f64> March<'_, F> {
    /// Appends the segment of a triangle whose corners are counter-clockwise.
    ///
    /// ```text
    ///      c             a alone is negative: from ab to ac, with a on the left
    ///     ╱ ╲
    ///   ac   ╲
    ///   ╱     ╲
    ///  a──ab───b
    /// ```
    fn triangle(&mut self, nodes: [Node; 3]) {
        let negative = nodes.iter().filter(|node| node.value < 0.0).count();
        let undefined = nodes.iter().filter(|node| node.value.is_nan()).count();
        if undefined > 0 {
            self.skipped += u64::from(negative > 0 && negative + undefined < 3);
            return;
        }
        if negative == 0 || negative == 3 {
            return;
        }
        let is_alone = |node: &Node| (node.value < 0.0) == (negative == 1);
        let alone = nodes.iter().position(is_alone).unwrap_or(0);
        let [a, b, c] = [0, 1, 2].map(|i| nodes[(alone + i) % 3]);
        let (ab, ac) = (self.crossing(a, b), self.crossing(a, c));
        self.segments
            .push(if negative == 1 { [ab, ac] } else { [ac, ab] });
    }

    /// The point on an edge of the lattice.
    fn crossing(&mut self, a: Node, b: Node) -> u32 {
        let (first, last) = if a.id < b.id { (a, b) } else { (b, a) };
        if let Some(&point) = self.point_of_edge.get(&(first.id, last.id)) {
            return point;
        }
        // In this form a coordinate that both ends share stays exact.
        let at = |t: f64| first.position + (last.position - first.position) * t;
        let change = sign_change(first.value, last.value, |t| (self.function)(at(t)));
        let number = u32::try_from(self.points.len())
            .expect("a triangle adds at most two points to at most 2²³ segments");
        self.points
            .push(at(change.at.clamp(self.least, 1.0 - self.least)));
        self.jumps.push(change.is_jump);
        self.point_of_edge.insert((first.id, last.id), number);
        number
    }

    /// Connects the segments to polylines.
    fn finish(self) -> ImplicitCurve {
        const NONE: u32 = u32::MAX;
        let is_jump = |point: u32| self.jumps[point as usize];
        let mut next = vec![NONE; self.points.len()];
        let mut has_previous = vec![false; self.points.len()];
        for &[from, to] in &self.segments {
            if !is_jump(from) && !is_jump(to) {
                next[from as usize] = to;
                has_previous[to as usize] = true;
            }
        }
        let mut strands = Vec::new();
        let mut follow = |start: usize, is_closed: bool| {
            let mut points = Vec::new();
            let mut at = start;
            loop {
                points.push(self.points[at].extend(0.0) + DVec3::ZERO);
                let to = std::mem::replace(&mut next[at], NONE);
                if to == NONE || to as usize == start {
                    break;
                }
                at = to as usize;
            }
            if points.len() > 1 {
                strands.push(Strand { points, is_closed });
            }
        };
        // Open polylines first, because the rest are rings.
        for (start, has_previous) in has_previous.iter().enumerate() {
            if !has_previous {
                follow(start, false);
            }
        }
        for start in 0..self.points.len() {
            follow(start, true);
        }
        let jumps = self.jumps.iter().filter(|is_jump| **is_jump).count() as u64;
        ImplicitCurve {
            curve: Curve { strands },
            interruptions: jumps + self.skipped,
        }
    }
}
