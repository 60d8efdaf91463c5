//! The tessellated domain of a patch (V3): its points, and the primitives between them.
//!
//! *In* the levels of a patch · *Out* places in the domain, and points, lines or triangles of them
//! · *Spec* Vulkan §Tessellation.
//!
//! ```text
//!      triangle, inner level 4            quad, inner levels 4 and 3
//!              C                            ┌──┬──┬──┬──┐
//!             ╱ ╲        ring 0: the        │  ├──┼──┤  │    the grid inside, and a band around
//!            ╱ ∙ ╲       outer levels       ├──┼──┼──┼──┤    it that is stitched to the edges,
//!           ╱ ╱ ╲ ╲      ring 1: inner      │  ├──┼──┤  │    each with a level of its own
//!          ╱ ∙───∙ ╲     level − 2          └──┴──┴──┴──┘
//!         A─────────B    …
//! ```
//!
//! Two polylines that run side by side, an edge and the ring inside it, are *stitched*: of the two
//! next segments, that with the nearer middle along the edge is taken first, the outer one if both
//! are as near, and joined to the point that was reached on the other side.

use super::subdivision::{ONE, Subdivision, rounded};
use estampe_types::state::{FrontFace, TessellationDomain, TessellationMode};
use std::collections::BTreeSet;

/// The points of a tessellated patch, and the primitives between them.
///
/// A pipeline with [tessellation](crate::RenderPipelineDescriptor::tessellation) makes these for
/// each patch.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TessellatedDomain {
    /// The places of the points: barycentric (u, v, w) of triangles, (u, v, 0) of quads and
    /// isolines. All are multiples of 2⁻²⁴.
    pub coordinates: Vec<[f32; 3]>,
    /// The numbers of the points of each primitive, one primitive after the other:
    /// [`TessellatedDomain::corners_of`] for each.
    pub indices: Vec<u32>,
    places: Vec<[u32; 3]>,
}

/// The subdivisions of the edges and of the inside.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Subdivisions {
    pub(crate) outer: [Subdivision; 4],
    pub(crate) inner: [Subdivision; 2],
}

impl Subdivisions {
    /// The subdivisions at some levels; `None` if the patch is dropped.
    pub(crate) fn new(mode: &TessellationMode, levels: &[f32; 6]) -> Option<Self> {
        let [a, b, c, d, e, f] = *levels;
        let used = match mode.domain {
            TessellationDomain::Triangles => 3,
            TessellationDomain::Quads => 4,
            TessellationDomain::Isolines => 2,
        };
        // NaN is not above zero.
        if !levels[..used].iter().all(|level| *level > 0.0) {
            return None;
        }
        let of = |level| Subdivision::new(mode.spacing, level);
        let mut all = Self {
            outer: [of(a), of(b), of(c), of(d)],
            inner: [of(e), of(f)],
        };
        let inner = match mode.domain {
            TessellationDomain::Triangles => 1,
            TessellationDomain::Quads => 2,
            TessellationDomain::Isolines => {
                let lines = Subdivision::new(Default::default(), a);
                all.outer[0] = lines;
                all.outer[2..].fill(lines);
                0
            }
        };
        // What the domain does not use, so that equal patches have equal subdivisions.
        let first = all.outer[0];
        all.outer[used..].fill(first);
        all.inner[inner..].fill(first);
        let divided = all.outer[..used].iter().chain(&all.inner[..inner]);
        if divided.clone().any(|edge| edge.segments > 1) {
            for edge in &mut all.inner[..inner] {
                *edge = edge.divided(mode.spacing);
            }
        }
        Some(all)
    }

    /// The most points that the domain has.
    pub(crate) fn points_at_most(&self) -> usize {
        let segments = |edge: &Subdivision| edge.segments as usize;
        let outer: usize = self.outer.iter().map(segments).sum();
        let [u, v] = self.inner.each_ref().map(segments);
        let lines = segments(&self.outer[0]) * (segments(&self.outer[1]) + 1);
        (outer + (u + 1) * (v.max(u) + 1)).max(lines)
    }
}

impl TessellatedDomain {
    /// Divides a domain at the four outer and the two inner levels. A dropped patch has no points.
    #[must_use]
    pub fn new(mode: &TessellationMode, outer: [f32; 4], inner: [f32; 2]) -> Self {
        let [a, b, c, d] = outer;
        let mut domain = Self::default();
        if let Some(edges) = Subdivisions::new(mode, &[a, b, c, d, inner[0], inner[1]]) {
            domain.divide(mode, &edges);
        }
        domain
    }

    /// The points of each primitive: 1, 2 or 3.
    #[must_use]
    pub fn corners_of(mode: &TessellationMode) -> usize {
        match mode.domain {
            _ if mode.point_mode => 1,
            TessellationDomain::Isolines => 2,
            TessellationDomain::Triangles | TessellationDomain::Quads => 3,
        }
    }

    /// Divides a domain, in memory that is used again.
    pub(crate) fn divide(&mut self, mode: &TessellationMode, edges: &Subdivisions) {
        self.places.clear();
        self.indices.clear();
        match mode.domain {
            TessellationDomain::Triangles => self.triangles(edges),
            TessellationDomain::Quads => self.quads(edges),
            TessellationDomain::Isolines => self.isolines(edges),
        }
        self.coordinates.clear();
        let places = self.places.iter();
        // Exact: multiples of 2⁻²⁴ up to 1.
        let coordinates = places.map(|place| place.map(|at| at as f32 * (1.0 / ONE as f32)));
        self.coordinates.extend(coordinates);
        if mode.point_mode {
            self.indices.clear();
            let mut seen = BTreeSet::new();
            let different = (0..).zip(&self.places).filter(|(_, at)| seen.insert(**at));
            self.indices.extend(different.map(|(index, _)| index));
        } else if mode.winding == FrontFace::Cw && mode.domain != TessellationDomain::Isolines {
            for [_, second, third] in self.indices.as_chunks_mut().0 {
                std::mem::swap(second, third);
            }
        }
    }

    fn push(&mut self, place: [u32; 3]) -> u32 {
        let index = self.places.len();
        self.places.push(place);
        debug_assert!(index < 1 << 16, "level 64 has some thousand points");
        u32::try_from(index).unwrap_or(u32::MAX)
    }

    fn triangles(&mut self, edges: &Subdivisions) {
        let inner = edges.inner[0];
        let [opposite_a, opposite_b, opposite_c, _] = edges.outer;
        // From A to B, B to C, C to A.
        let sides = [opposite_c, opposite_a, opposite_b];
        let mut outside = sides.map(|edge| Side {
            points: Vec::new(),
            edge,
            first: 0,
        });
        for (side, line) in outside.iter_mut().enumerate() {
            for j in 0..line.edge.segments {
                let along = line.edge.place(j);
                line.points
                    .push(self.push(on_side(side, [ONE - along, along, 0])));
            }
        }
        close(&mut outside);
        if inner.segments == 1 {
            let [a, b, c] = outside.each_ref().map(|side| side.points[0]);
            self.indices.extend([a, b, c]);
            return;
        }
        let mut ring = 1;
        while 2 * ring <= inner.segments {
            let segments = inner.segments - 2 * ring;
            let mut inside = [0, 1, 2].map(|_| Side {
                points: Vec::new(),
                edge: inner,
                first: ring,
            });
            if segments == 0 {
                let center = self.push(ring_place(inner, ring, ring));
                inside.iter_mut().for_each(|side| side.points.push(center));
            } else {
                for (side, line) in inside.iter_mut().enumerate() {
                    for j in 0..segments {
                        let place = ring_place(inner, ring, ring + j);
                        line.points.push(self.push(on_side(side, place)));
                    }
                }
                close(&mut inside);
            }
            for (outer, inner) in outside.iter().zip(&inside) {
                stitch(outer, inner, &mut self.indices);
            }
            if segments == 1 {
                let [a, b, c] = inside.each_ref().map(|side| side.points[0]);
                self.indices.extend([a, b, c]);
            }
            outside = inside;
            ring += 1;
        }
    }

    fn quads(&mut self, edges: &Subdivisions) {
        let [left, bottom, right, top] = edges.outer;
        // Counter-clockwise from (0, 0), each with the place of its point j.
        let sides: [(Subdivision, PlaceOnSide); 4] = [
            (bottom, |at| [at, 0, 0]),
            (right, |at| [ONE, at, 0]),
            (top, |at| [ONE - at, ONE, 0]),
            (left, |at| [0, ONE - at, 0]),
        ];
        let mut outside = sides.map(|(edge, place)| Side {
            points: (0..edge.segments)
                .map(|j| self.push(place(edge.place(j))))
                .collect(),
            edge,
            first: 0,
        });
        close(&mut outside);
        let [u, v] = edges.inner;
        if u.segments == 1 {
            // Then all others are 1, too.
            let [a, b, c, d] = outside.each_ref().map(|side| side.points[0]);
            self.indices.extend([a, b, c, a, c, d]);
            return;
        }
        let [columns, rows] = [u.segments - 1, v.segments - 1];
        let first = self.push([u.place(1), v.place(1), 0]);
        for j in 0..rows {
            for i in 0..columns {
                if (i, j) != (0, 0) {
                    self.push([u.place(1 + i), v.place(1 + j), 0]);
                }
            }
        }
        let point = |i: u32, j: u32| first + j * columns + i;
        let inside = [
            (u, (0..columns).map(|i| point(i, 0)).collect()),
            (v, (0..rows).map(|j| point(columns - 1, j)).collect()),
            (u, (0..columns).rev().map(|i| point(i, rows - 1)).collect()),
            (v, (0..rows).rev().map(|j| point(0, j)).collect()),
        ];
        for (outer, (edge, points)) in outside.iter().zip(inside) {
            let inner = Side {
                points,
                edge,
                first: 1,
            };
            stitch(outer, &inner, &mut self.indices);
        }
        for j in 1..rows {
            for i in 1..columns {
                let [a, b] = [point(i - 1, j - 1), point(i, j - 1)];
                let [c, d] = [point(i, j), point(i - 1, j)];
                self.indices.extend([a, b, c, a, c, d]);
            }
        }
    }

    fn isolines(&mut self, edges: &Subdivisions) {
        let [lines, along, ..] = edges.outer;
        for line in 0..lines.segments {
            let height = lines.place(line);
            for j in 0..=along.segments {
                let index = self.push([along.place(j), height, 0]);
                if j > 0 {
                    self.indices.extend([index - 1, index]);
                }
            }
        }
    }
}

/// The place of a point from its place along a side.
type PlaceOnSide = fn(u32) -> [u32; 3];

/// One side of a ring: the points from a corner to the next, both included.
#[derive(Debug)]
struct Side {
    points: Vec<u32>,
    /// The subdivision whose points `first`, `first + 1`, … lie along the edge.
    edge: Subdivision,
    first: u32,
}

impl Side {
    /// Twice the middle of a segment along the edge; `None` beyond the last one.
    fn middle(&self, segment: usize) -> Option<u32> {
        self.points.get(segment + 1)?;
        let j = self.first + u32::try_from(segment).unwrap_or(u32::MAX);
        Some(self.edge.place(j) + self.edge.place(j + 1))
    }
}

/// Adds to each side the first point of the next one.
fn close<const N: usize>(sides: &mut [Side; N]) {
    let first = sides.each_ref().map(|side| side.points[0]);
    for (side, line) in sides.iter_mut().enumerate() {
        line.points.push(first[(side + 1) % N]);
    }
}

/// The weights of a triangle's corners A, B and C, from those of a side's start, its end and the
/// corner opposite.
fn on_side(side: usize, [start, end, opposite]: [u32; 3]) -> [u32; 3] {
    match side {
        0 => [start, end, opposite],
        1 => [opposite, start, end],
        _ => [end, opposite, start],
    }
}

/// The point of a ring that lies above point `j` of the edge: the weights of the side's start, of
/// its end, and of the corner opposite.
///
/// The ring's corners lie on the bisectors of the angles, at the distance of point `ring` from the
/// corner along both edges. With t the place of that point and s that of point j, the weight of
/// the opposite corner is 2t/3 and that of the end s − t/3.
fn ring_place(edge: Subdivision, ring: u32, j: u32) -> [u32; 3] {
    let (s, t) = (edge.numerator(j), edge.numerator(ring));
    let opposite = rounded(2 * t, 3 * edge.denominator());
    let end = rounded(3 * s - t, 3 * edge.denominator());
    [ONE - end - opposite, end, opposite]
}

/// The triangles between an outer and an inner side, counter-clockwise where the inner side is to
/// the left.
fn stitch(outer: &Side, inner: &Side, indices: &mut Vec<u32>) {
    let (mut a, mut b) = (0, 0);
    loop {
        let takes_outer = match (outer.middle(a), inner.middle(b)) {
            (Some(outer), Some(inner)) => outer <= inner,
            (Some(_), None) => true,
            (None, Some(_)) => false,
            (None, None) => return,
        };
        if takes_outer {
            indices.extend([outer.points[a], outer.points[a + 1], inner.points[b]]);
            a += 1;
        } else {
            indices.extend([outer.points[a], inner.points[b + 1], inner.points[b]]);
            b += 1;
        }
    }
}
