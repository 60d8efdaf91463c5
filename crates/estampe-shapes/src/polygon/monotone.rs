//! Triangulation of monotone polygons, vertex by vertex, as a sweep finds them.
//!
//! The part of a polygon that lies below the sweep line and is not triangulated yet is a chain of
//! vertices, all but the first on one side, which bends inwards at each of them (Garey, Johnson,
//! Preparata, Tarjan 1978):
//!
//! ```text
//!    s2 •            a vertex on the other side sees all of the chain: it makes
//!       │ ╲    ─ v   a triangle with each pair of neighbours;
//!    s1 •  ╲         one on the same side cuts corners off while they bend outwards
//!        ╲  │
//!      s0 •─┘        sweep: upwards
//! ```

use std::cmp::Ordering;

use super::exact::ExactPoint;

/// A side of a span, as seen in the direction of the sweep with y up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Left,
    Right,
}

/// The triangles of all spans, counter-clockwise with y up, by numbers of vertices.
pub(super) struct Triangles<'a> {
    pub(super) vertices: &'a [ExactPoint],
    pub(super) triangles: Vec<[usize; 3]>,
}

impl Triangles<'_> {
    fn orientation(&self, [a, b, c]: [usize; 3]) -> Ordering {
        let [a, b, c] = [a, b, c].map(|vertex| &self.vertices[vertex]);
        ExactPoint::orientation(a, b, c)
    }

    /// Appends the triangle of two neighbours of a chain on `side`, the lower first, and a later
    /// vertex towards which the chain is open.
    fn push(&mut self, [low, high]: [usize; 2], vertex: usize, side: Side) {
        let triangle = match side {
            Side::Left => [low, vertex, high],
            Side::Right => [low, high, vertex],
        };
        debug_assert!(
            self.orientation(triangle) == Ordering::Greater,
            "a chain is seen from its open side"
        );
        self.triangles.push(triangle);
    }
}

/// The part of a monotone polygon that is not triangulated yet.
#[derive(Clone, Debug)]
pub(super) struct Chain {
    /// At least one vertex, from low to high.
    vertices: Vec<usize>,
    /// The side of all vertices but the first.
    side: Side,
}

impl Chain {
    /// The chain of a polygon that begins at a vertex.
    pub(super) fn new(vertex: usize) -> Self {
        Self {
            vertices: vec![vertex],
            side: Side::Left,
        }
    }

    /// The chain between two vertices, the second of which is on `side`.
    fn between(low: usize, high: usize, side: Side) -> Self {
        Self {
            vertices: vec![low, high],
            side,
        }
    }

    fn last(&self) -> usize {
        self.vertices[self.vertices.len() - 1]
    }

    /// Adds the next vertex of the polygon.
    pub(super) fn add(&mut self, vertex: usize, side: Side, out: &mut Triangles<'_>) {
        if self.vertices.len() == 1 {
            self.side = side;
        }
        if side != self.side {
            let last = self.last();
            self.close(vertex, out);
            *self = Self::between(last, vertex, side);
            return;
        }
        let outwards = match side {
            Side::Left => Ordering::Less,
            Side::Right => Ordering::Greater,
        };
        while let &[.., a, b] = &self.vertices[..]
            && out.orientation([a, b, vertex]) == outwards
        {
            out.push([a, b], vertex, side);
            self.vertices.pop();
        }
        self.vertices.push(vertex);
    }

    /// Triangulates all of the chain with the last vertex of the polygon, or one on the other side.
    pub(super) fn close(&self, vertex: usize, out: &mut Triangles<'_>) {
        for pair in self.vertices.windows(2) {
            out.push([pair[0], pair[1]], vertex, self.side);
        }
    }

    /// Divides the polygon at a vertex between its sides, by a diagonal to the last vertex; returns
    /// the polygon on the left and the one on the right.
    pub(super) fn divide(mut self, vertex: usize, out: &mut Triangles<'_>) -> [Self; 2] {
        let last = self.last();
        if self.vertices.len() == 1 || self.side == Side::Left {
            self.add(vertex, Side::Left, out);
            [Self::between(last, vertex, Side::Right), self]
        } else {
            self.add(vertex, Side::Right, out);
            [self, Self::between(last, vertex, Side::Left)]
        }
    }
}
