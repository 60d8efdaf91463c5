//! Surfaces F(x, y, z) = 0 by marching tetrahedra.

use std::collections::HashMap;
use std::ops::Range;

use glam::DVec3;

use super::axis::{Axis, least_fraction};
use super::finish::Draft;
use super::lattice::{Lattice, Node};
use super::root::sign_change;
use super::{ImplicitError, MAX_ELEMENTS, MAX_SURFACE_CELLS};
use crate::mesh::ShapeMesh;

/// A meshed implicit surface.
#[derive(Clone, Debug, PartialEq)]
pub struct ImplicitSurface {
    /// The mesh, without texture coordinates. Its normals point to where F is positive.
    pub mesh: ShapeMesh,
    /// The number of places inside the box at which the surface is open: edges of the lattice on
    /// which F changes its sign without a root, at jumps and poles, and tetrahedra with both signs
    /// and a node at which F is not defined.
    pub interruptions: u64,
}

/// A vertex in the making.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vertex {
    pub(super) position: DVec3,
    /// True if it was moved away from a node, and so from the root.
    pub(super) is_moved: bool,
    /// True if there is no root but a jump.
    pub(super) is_jump: bool,
}

/// Meshes the surface `function` = 0 in a box.
///
/// `bounds` are the ranges of x, y and z, and `cells` the numbers of cells along them, clamped to
/// 1..=[`MAX_SURFACE_CELLS`]. `gradient` gives the normals, and is used to improve roots.
///
/// The mesh is a manifold: each edge belongs to two triangles that have it in opposite directions,
/// or lies on the box, or where the function jumps or is not defined. No triangle is degenerate.
/// Vertices lie at roots of the function to 1e-10 of a cell, except those nearest to nodes of the
/// lattice, which may be up to 1e-3 of a cell away.
///
/// # Errors
/// [`ImplicitError`] says when.
pub fn surface(
    bounds: &[Range<f64>; 3],
    cells: [u32; 3],
    function: impl Fn(DVec3) -> f64,
    gradient: impl Fn(DVec3) -> DVec3,
) -> Result<ImplicitSurface, ImplicitError> {
    surface_up_to(MAX_ELEMENTS, bounds, cells, function, gradient)
}

/// [`surface()`] with another maximum number of triangles.
pub(super) fn surface_up_to(
    most: usize,
    bounds: &[Range<f64>; 3],
    cells: [u32; 3],
    function: impl Fn(DVec3) -> f64,
    gradient: impl Fn(DVec3) -> DVec3,
) -> Result<ImplicitSurface, ImplicitError> {
    let axis = |i: usize| Axis::new(i, &bounds[i], cells[i].clamp(1, MAX_SURFACE_CELLS));
    let axes = [axis(0)?, axis(1)?, axis(2)?];
    let mut march = March {
        least: least_fraction(&axes)?,
        function: &function,
        vertex_of_edge: HashMap::new(),
        vertices: Vec::new(),
        triangles: Vec::new(),
        skipped: 0,
    };
    let lattice = Lattice { axes };
    lattice.visit(&function, |ends, around| {
        for side in 0..4 {
            let [a, b] = ends;
            march.tetrahedron([a, b, around[side], around[(side + 1) % 4]]);
        }
        if march.triangles.len() > most {
            return Err(ImplicitError::TooManyElements);
        }
        Ok(())
    })?;
    let March {
        vertices,
        triangles,
        skipped,
        ..
    } = march;
    let draft = Draft {
        vertices,
        triangles,
        skipped,
    };
    Ok(draft.finish(&lattice.axes, &function, &gradient))
}

struct March<'f, F> {
    /// The least distance of a vertex from a node, as a fraction of the edge.
    least: f64,
    function: &'f F,
    vertex_of_edge: HashMap<(u32, u32), u32>,
    vertices: Vec<Vertex>,
    triangles: Vec<[u32; 3]>,
    /// Tetrahedra with both signs and a node at which the function is not defined.
    skipped: u64,
}

impl<F: Fn(DVec3) -> f64> March<'_, F> {
    /// Appends the triangles of a tetrahedron a b c d with (b − a) · ((c − a) × (d − a)) > 0.
    ///
    /// ```text
    ///   a negative:  ab ac ad                a and b negative:  ac ad bd bc
    ///
    ///        d                                     c ────── d
    ///       ╱│╲    seen from the positive          │ bc──bd │
    ///      c─┼─b   side, counter-clockwise         │ ac──ad │
    /// ```
    fn tetrahedron(&mut self, nodes: [Node; 4]) {
        let is_negative = |i: usize| nodes[i].value < 0.0;
        if nodes.iter().any(|node| node.value.is_nan()) {
            let defined = (0..4).filter(|&i| !nodes[i].value.is_nan());
            let negative = defined.clone().filter(|&i| is_negative(i)).count();
            self.skipped += u64::from(negative > 0 && negative < defined.count());
            return;
        }
        let signs = (0..4)
            .filter(|&i| is_negative(i))
            .fold(0, |signs, i| signs | 1 << i);
        // Even permutations of the nodes that put one alone, or the negative pair, first.
        let (order, is_pair, is_positive_first): ([usize; 4], bool, bool) = match signs {
            0b0001 => ([0, 1, 2, 3], false, false),
            0b0010 => ([1, 0, 3, 2], false, false),
            0b0100 => ([2, 3, 0, 1], false, false),
            0b1000 => ([3, 2, 1, 0], false, false),
            0b1110 => ([0, 1, 2, 3], false, true),
            0b1101 => ([1, 0, 3, 2], false, true),
            0b1011 => ([2, 3, 0, 1], false, true),
            0b0111 => ([3, 2, 1, 0], false, true),
            0b0011 => ([0, 1, 2, 3], true, false),
            0b1100 => ([2, 3, 0, 1], true, false),
            0b0101 => ([0, 2, 3, 1], true, false),
            0b1010 => ([3, 1, 0, 2], true, false),
            0b1001 => ([0, 3, 1, 2], true, false),
            0b0110 => ([1, 2, 0, 3], true, false),
            _ => return,
        };
        let [a, b, c, d] = order.map(|i| nodes[i]);
        if is_pair {
            let quad = [(a, c), (a, d), (b, d), (b, c)].map(|(p, q)| self.crossing(p, q));
            let [p, q, r, s] = quad;
            let at = |vertex: u32| self.vertices[vertex as usize].position;
            // Both diagonals lie in the tetrahedron; the shorter one makes better triangles.
            if at(p).distance_squared(at(r)) <= at(q).distance_squared(at(s)) {
                self.triangles.extend([[p, q, r], [p, r, s]]);
            } else {
                self.triangles.extend([[p, q, s], [q, r, s]]);
            }
        } else {
            let [p, q, r] = [b, c, d].map(|other| self.crossing(a, other));
            self.triangles.push(if is_positive_first {
                [p, r, q]
            } else {
                [p, q, r]
            });
        }
    }

    /// The vertex on an edge of the lattice.
    fn crossing(&mut self, a: Node, b: Node) -> u32 {
        let (first, last) = if a.id < b.id { (a, b) } else { (b, a) };
        if let Some(&vertex) = self.vertex_of_edge.get(&(first.id, last.id)) {
            return vertex;
        }
        // In this form a coordinate that both ends share stays exact.
        let at = |t: f64| first.position + (last.position - first.position) * t;
        let change = sign_change(first.value, last.value, |t| (self.function)(at(t)));
        let kept = change.at.clamp(self.least, 1.0 - self.least);
        let vertex = u32::try_from(self.vertices.len())
            .expect("a tetrahedron adds at most four vertices to at most 2²³ triangles");
        self.vertices.push(Vertex {
            position: at(kept),
            is_moved: kept != change.at,
            is_jump: change.is_jump,
        });
        self.vertex_of_edge.insert((first.id, last.id), vertex);
        vertex
    }
}
