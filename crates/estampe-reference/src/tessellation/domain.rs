//! The divided domain of a patch.

use super::Edge;
use super::Fraction;
use super::edge::ONE;
use estampe_types::state::{FrontFace, TessellationDomain, TessellationMode, TessellationSpacing};
use std::collections::HashSet;

/// Points of a domain, and the primitives between them.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Domain {
    /// Places, as numbers of multiples of 2⁻²⁴. Several points may have one place.
    pub points: Vec<[u32; 3]>,
    /// The points of each primitive.
    pub primitives: Vec<Vec<usize>>,
}

/// A line of points, each with its place along the edge that it runs beside.
type Line = Vec<(usize, u32)>;

/// The place of a point from its place along a side.
type PlaceOnSide = fn(u32) -> [u32; 3];

/// Divides a domain; empty if the patch is dropped.
#[must_use]
pub fn divide(mode: &TessellationMode, outer: [f32; 4], inner: [f32; 2]) -> Domain {
    let (outers, inners) = match mode.domain {
        TessellationDomain::Triangles => (3, 1),
        TessellationDomain::Quads => (4, 2),
        TessellationDomain::Isolines => (2, 0),
    };
    if outer[..outers]
        .iter()
        .any(|level| level.is_nan() || *level <= 0.0)
    {
        return Domain::default();
    }
    let edge = |level| Edge::new(mode.spacing, level, false);
    let used = outer[..outers].iter().chain(&inner[..inners]);
    let is_divided = used.clone().any(|level| edge(*level).segments() > 1);
    let inside = inner.map(|level| Edge::new(mode.spacing, level, is_divided));
    let mut domain = Domain::default();
    match mode.domain {
        TessellationDomain::Triangles => {
            domain.triangles(
                &[edge(outer[0]), edge(outer[1]), edge(outer[2])],
                &inside[0],
            );
        }
        TessellationDomain::Quads => domain.quads(&outer.map(edge), &inside),
        TessellationDomain::Isolines => {
            let lines = Edge::new(TessellationSpacing::Equal, outer[0], false);
            domain.isolines(&lines, &edge(outer[1]));
        }
    }
    if mode.point_mode {
        domain.keep_points();
    } else if mode.winding == FrontFace::Cw {
        for primitive in &mut domain.primitives {
            if let [_, second, third] = &mut primitive[..] {
                std::mem::swap(second, third);
            }
        }
    }
    domain
}

impl Domain {
    fn point(&mut self, place: [u32; 3]) -> usize {
        self.points.push(place);
        self.points.len() - 1
    }

    /// Different places, in the order in which they were made, as points.
    fn keep_points(&mut self) {
        self.primitives.clear();
        let mut seen = HashSet::new();
        for (point, place) in self.points.iter().enumerate() {
            if seen.insert(place) {
                self.primitives.push(vec![point]);
            }
        }
    }

    /// A closed ring of sides: `place(side, j)` are the weights of the side's start, its end, and
    /// the corner opposite, and the place along the edge.
    fn ring(
        &mut self,
        segments: [usize; 3],
        place: impl Fn(usize, usize) -> ([u32; 3], u32),
    ) -> [Line; 3] {
        let mut sides = [Line::new(), Line::new(), Line::new()];
        for side in 0..3 {
            for j in 0..segments[side] {
                let (weights, along) = place(side, j);
                let mut corners = [0; 3];
                for (k, weight) in weights.into_iter().enumerate() {
                    corners[(side + k) % 3] = weight;
                }
                let point = self.point(corners);
                sides[side].push((point, along));
            }
        }
        for side in 0..3 {
            let first = sides[(side + 1) % 3][0].0;
            let along = place(side, segments[side]).1;
            sides[side].push((first, along));
        }
        sides
    }

    fn triangles(&mut self, outer: &[Edge; 3], inner: &Edge) {
        // Side 0 runs from (1, 0, 0) to (0, 1, 0), along the edge w = 0.
        let sides = [&outer[2], &outer[0], &outer[1]];
        let mut around = self.ring(sides.map(Edge::segments), |side, j| {
            let along = sides[side].place(j);
            ([ONE - along, along, 0], along)
        });
        let n = inner.segments();
        if n == 1 {
            self.primitives.push(vec![0, 1, 2]);
            return;
        }
        for ring in 1..=n / 2 {
            let third = Fraction::new(1, 3);
            let t = inner.places[ring] * third;
            let opposite = (t + t).rounded();
            let place = |_, j: usize| {
                let end = (inner.places[ring + j] - t).rounded();
                ([ONE - end - opposite, end, opposite], inner.place(ring + j))
            };
            let inside = if n == 2 * ring {
                let (center, along) = place(0, 0);
                let center = self.point(center);
                [(); 3].map(|()| vec![(center, along)])
            } else {
                self.ring([n - 2 * ring; 3], place)
            };
            for (outer, inner) in around.iter().zip(&inside) {
                self.stitch(outer, inner);
            }
            if n == 2 * ring + 1 {
                let corners = inside.iter().map(|side| side[0].0);
                self.primitives.push(corners.collect());
            }
            around = inside;
        }
    }

    fn quads(&mut self, outer: &[Edge; 4], [columns, rows]: &[Edge; 2]) {
        let [left, bottom, right, top] = outer;
        // Counter-clockwise from the corner (0, 0): a place from the place along the side.
        let sides: [(&Edge, PlaceOnSide); 4] = [
            (bottom, |at| [at, 0, 0]),
            (right, |at| [ONE, at, 0]),
            (top, |at| [ONE - at, ONE, 0]),
            (left, |at| [0, ONE - at, 0]),
        ];
        let mut around: Vec<Line> = Vec::new();
        for (edge, place) in sides {
            let mut line = Line::new();
            for j in 0..edge.segments() {
                line.push((self.point(place(edge.place(j))), edge.place(j)));
            }
            around.push(line);
        }
        for side in 0..4 {
            let next = around[(side + 1) % 4][0].0;
            around[side].push((next, ONE));
        }
        let (m, n) = (columns.segments(), rows.segments());
        if m == 1 && n == 1 {
            self.primitives.extend([vec![0, 1, 2], vec![0, 2, 3]]);
            return;
        }
        let first = self.points.len();
        for j in 1..n {
            for i in 1..m {
                self.point([columns.place(i), rows.place(j), 0]);
            }
        }
        let at = |i: usize, j: usize| first + (j - 1) * (m - 1) + i - 1;
        let inside: [Line; 4] = [
            (1..m).map(|i| (at(i, 1), columns.place(i))).collect(),
            (1..n).map(|j| (at(m - 1, j), rows.place(j))).collect(),
            (1..m)
                .map(|i| (at(m - i, n - 1), columns.place(i)))
                .collect(),
            (1..n).map(|j| (at(1, n - j), rows.place(j))).collect(),
        ];
        for (outer, inner) in around.iter().zip(&inside) {
            self.stitch(outer, inner);
        }
        for j in 1..n - 1 {
            for i in 1..m - 1 {
                let [a, b] = [at(i, j), at(i + 1, j)];
                let [c, d] = [at(i + 1, j + 1), at(i, j + 1)];
                self.primitives.extend([vec![a, b, c], vec![a, c, d]]);
            }
        }
    }

    fn isolines(&mut self, lines: &Edge, along: &Edge) {
        for line in 0..lines.segments() {
            let height = lines.place(line);
            let first = self.points.len();
            for j in 0..=along.segments() {
                self.point([along.place(j), height, 0]);
            }
            let segments = (0..along.segments()).map(|j| vec![first + j, first + j + 1]);
            self.primitives.extend(segments);
        }
    }

    /// The triangles between two lines. The segments of both are sorted by their middles, an outer
    /// one before an inner one with the same middle; each makes a triangle with the point that was
    /// reached on the other line.
    fn stitch(&mut self, outer: &Line, inner: &Line) {
        let segments = |line: &Line, is_inner: bool| {
            let middles = line.windows(2).enumerate();
            let middles = middles.map(|(j, ends)| (ends[0].1 + ends[1].1, is_inner, j));
            middles.collect::<Vec<_>>()
        };
        let mut all = segments(outer, false);
        all.extend(segments(inner, true));
        all.sort_unstable();
        let mut reached = [0, 0];
        for (_, is_inner, j) in all {
            let triangle = if is_inner {
                [outer[reached[0]].0, inner[j + 1].0, inner[j].0]
            } else {
                [outer[j].0, outer[j + 1].0, inner[reached[1]].0]
            };
            reached[usize::from(is_inner)] = j + 1;
            self.primitives.push(triangle.to_vec());
        }
    }
}
