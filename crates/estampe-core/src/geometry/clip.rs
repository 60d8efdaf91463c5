//! Clipping (A3): the few primitives that leave the view volume or the guard band.
//!
//! *In* clip-space vertices · *Out* a polygon inside the planes · *Space* clip · *Precision* f32 in
//! the order of `docs/NUMERICS.md` · *Spec* Sutherland and Hodgman, Reentrant Polygon Clipping,
//! 1974.
//!
//! ```text
//!     inside a ──────●────── b outside      t = d(a) ÷ (d(a) − d(b)), always from the inside out:
//!                 plane d = 0               both neighbours of an edge get the same bits
//! ```
//!
//! A vertex is its position and varyings in one run of floats, so that one loop interpolates both.

use super::viewport::{GUARD_MAX, GUARD_MIN, LEAST_W, ViewportTransform, is_within_guard_band};

/// A plane that cuts: the distance of a position, and the coordinate to be set at a crossing.
#[derive(Debug, Clone, Copy)]
enum Plane {
    Near,
    Far,
    /// The least w, where depth is not clipped.
    Eye,
    /// A clip distance: the number of that place.
    Distance(usize),
    /// A side of the guard band: `coordinate·scale` against `bound·w`.
    AtLeast {
        axis: usize,
        scale: f32,
        bound: f32,
    },
    AtMost {
        axis: usize,
        scale: f32,
        bound: f32,
    },
}

/// One pixel outside the guard band, on either side.
const SIDE_MIN: f32 = GUARD_MIN - 1.0;
const SIDE_MAX: f32 = GUARD_MAX + 1.0;

impl Plane {
    const DEPTH: [Self; 2] = [Self::Near, Self::Far];
    const UNCLIPPED_DEPTH: [Self; 1] = [Self::Eye];

    /// Left, right, top and bottom of the guard band under a viewport. They lie at the band rather
    /// than at ±w, so that an edge with both ends inside the band stays whole in both of its
    /// triangles.
    fn sides(transform: &ViewportTransform) -> [Self; 4] {
        let side = |axis: usize| {
            let (scale, offset) = (transform.scale[axis], transform.offset[axis]);
            [
                Self::AtLeast {
                    axis,
                    scale,
                    bound: offset - SIDE_MIN,
                },
                Self::AtMost {
                    axis,
                    scale,
                    bound: SIDE_MAX - offset,
                },
            ]
        };
        let ([left, right], [top, bottom]) = (side(0), side(1));
        [left, right, top, bottom]
    }

    fn distance(self, p: &[f32]) -> f32 {
        let (z, w) = (p[2], p[3]);
        match self {
            Self::Near => z,
            Self::Far => w - z,
            Self::Eye => w - LEAST_W,
            Self::Distance(at) => p[at],
            Self::AtLeast { axis, scale, bound } => p[axis] * scale + bound * w,
            Self::AtMost { axis, scale, bound } => bound * w - p[axis] * scale,
        }
    }

    /// Puts a crossing exactly onto the plane, where it bounds a single coordinate.
    fn settle(self, p: &mut [f32]) {
        match self {
            Self::Near => p[2] = 0.0,
            Self::Far => p[2] = p[3],
            Self::Eye => p[3] = LEAST_W,
            Self::Distance(at) => p[at] = 0.0,
            Self::AtLeast { .. } | Self::AtMost { .. } => {}
        }
    }
}

/// Returns true if all the vertices lie outside one side of the view volume. Near and far are not
/// tested where depth is not clipped.
fn are_outside<'a>(
    transform: &ViewportTransform,
    vertices: impl Iterator<Item = &'a [f32]> + Clone,
) -> bool {
    let distances: [fn(&[f32]) -> f32; 6] = [
        |p| p[0] + p[3],
        |p| p[3] - p[0],
        |p| p[1] + p[3],
        |p| p[3] - p[1],
        |p| p[2],
        |p| p[3] - p[2],
    ];
    let sides = if transform.unclipped_depth { 4 } else { 6 };
    distances[..sides]
        .iter()
        .any(|distance| vertices.clone().all(|vertex| distance(vertex) < 0.0))
}

/// A polygon (or, of two vertices, a line) that is being clipped; reused from one to the next.
#[derive(Debug, Default)]
pub(crate) struct ClipPolygon {
    /// Floats of a vertex: x, y, z, w, the varyings and the clip distances.
    stride: usize,
    /// The number of clip distances among them.
    distances: usize,
    vertices: Vec<f32>,
    next: Vec<f32>,
}

impl ClipPolygon {
    /// Begins anew with vertices of so many varyings and clip distances.
    pub(crate) fn begin(&mut self, varyings: usize, distances: usize) {
        self.stride = 4 + varyings + distances;
        self.distances = distances;
        self.vertices.clear();
    }

    pub(crate) fn push(
        &mut self,
        position: [f32; 4],
        varyings: &[f32],
        distances: impl Iterator<Item = f32>,
    ) {
        self.vertices.extend_from_slice(&position);
        self.vertices.extend_from_slice(varyings);
        self.vertices.extend(distances);
    }

    /// The vertices: position, varyings and clip distances in one slice.
    pub(crate) fn vertices(&self) -> impl ExactSizeIterator<Item = &[f32]> + Clone {
        self.vertices.chunks_exact(self.stride)
    }

    /// Clips. False when nothing is left, or a position or a clip distance is not finite.
    pub(crate) fn clip(&mut self, transform: &ViewportTransform) -> bool {
        let first_distance = self.stride - self.distances;
        let is_finite = |vertex: &[f32]| {
            let numbers = vertex[..4].iter().chain(&vertex[first_distance..]);
            numbers.copied().all(f32::is_finite)
        };
        if !self.vertices().all(is_finite) || are_outside(transform, self.vertices()) {
            return false;
        }
        let depth: &[Plane] = if transform.unclipped_depth {
            &Plane::UNCLIPPED_DEPTH
        } else {
            &Plane::DEPTH
        };
        for &plane in depth {
            self.clip_by(plane);
        }
        for distance in first_distance..self.stride {
            self.clip_by(Plane::Distance(distance));
        }
        if self
            .vertices()
            .any(|vertex| !is_in_guard_band(transform, vertex))
        {
            for plane in Plane::sides(transform) {
                self.clip_by(plane);
            }
        }
        !self.vertices.is_empty()
    }

    fn clip_by(&mut self, plane: Plane) {
        let is_inside = |vertex: &[f32]| plane.distance(vertex) >= 0.0;
        if self.vertices().all(is_inside) {
            return;
        }
        self.next.clear();
        let (stride, count) = (self.stride, self.vertices.len() / self.stride);
        // A line has one edge, a polygon as many as vertices.
        let edges = if count == 2 { 1 } else { count };
        for i in 0..count {
            let a = &self.vertices[i * stride..][..stride];
            if is_inside(a) {
                self.next.extend_from_slice(a);
            }
            let successor = if i + 1 == count { 0 } else { i + 1 };
            let b = &self.vertices[successor * stride..][..stride];
            if i < edges && is_inside(a) != is_inside(b) {
                let (from, to) = if is_inside(a) { (a, b) } else { (b, a) };
                let (d_in, d_out) = (plane.distance(from), plane.distance(to));
                let t = d_in / (d_in - d_out);
                let start = self.next.len();
                self.next
                    .extend(from.iter().zip(to).map(|(from, to)| from + (to - from) * t));
                plane.settle(&mut self.next[start..]);
            }
        }
        std::mem::swap(&mut self.vertices, &mut self.next);
    }
}

fn is_in_guard_band(transform: &ViewportTransform, vertex: &[f32]) -> bool {
    let projected = transform.project([vertex[0], vertex[1], vertex[2], vertex[3]]);
    vertex[3] > 0.0 && is_within_guard_band(projected.x, projected.y)
}

/// Returns true if a point is drawn: its centre lies inside the view volume.
pub(crate) fn is_point_visible(transform: &ViewportTransform, position: [f32; 4]) -> bool {
    let [x, y, _, w] = position;
    (-w..=w).contains(&x) && (-w..=w).contains(&y) && transform.is_in_depth(position)
}

#[cfg(test)]
mod tests {
    use super::*;
    use estampe_types::state::Viewport;

    fn transform() -> ViewportTransform {
        ViewportTransform::new(&Viewport::of_target(64, 64), false)
    }

    fn clipped(corners: &[[f32; 4]]) -> Vec<Vec<f32>> {
        let mut polygon = ClipPolygon::default();
        polygon.begin(1, 0);
        for (index, corner) in corners.iter().enumerate() {
            polygon.push(*corner, &[index as f32], std::iter::empty());
        }
        if !polygon.clip(&transform()) {
            return Vec::new();
        }
        polygon.vertices().map(<[f32]>::to_vec).collect()
    }

    #[test]
    fn near_plane_cuts_a_corner_off() {
        let polygon = clipped(&[
            [0.0, 0.0, -1.0, 1.0],
            [1.0, 0.0, 1.0, 2.0],
            [0.0, 1.0, 1.0, 2.0],
        ]);
        assert_eq!(polygon.len(), 4);
        assert!(polygon.iter().all(|vertex| vertex[2] >= 0.0));
        // The crossing of edge 1-0 is half-way, varying included.
        assert!(
            polygon
                .iter()
                .any(|vertex| vertex[..] == [0.5, 0.0, 0.0, 1.5, 0.5])
        );
    }

    #[test]
    fn neighbours_share_their_crossings() {
        let (a, b) = ([0.3, 0.1, -0.7, 0.2], [0.9, -0.4, 0.45, 1.7]);
        let one = clipped(&[a, b, [0.1, 0.9, 0.3, 1.0]]);
        let other = clipped(&[b, a, [-0.5, -0.9, 0.3, 1.0]]);
        let shared = |polygon: &[Vec<f32>]| {
            let crossing = polygon
                .iter()
                .find(|vertex| vertex[2] == 0.0 && vertex[0] > 0.5);
            crossing.map(|vertex| vertex[..4].to_vec())
        };
        assert!(shared(&one).is_some());
        assert_eq!(shared(&one), shared(&other));
    }

    #[test]
    fn what_is_outside_or_not_finite_vanishes() {
        assert!(
            clipped(&[
                [5.0, 0.0, 0.5, 1.0],
                [6.0, 0.0, 0.5, 1.0],
                [5.0, 1.0, 0.5, 1.0]
            ])
            .is_empty()
        );
        let nan = [f32::NAN, 0.0, 0.5, 1.0];
        assert!(clipped(&[nan, [0.0, 0.0, 0.5, 1.0], [0.0, 1.0, 0.5, 1.0]]).is_empty());
    }

    #[test]
    fn a_line_keeps_its_inner_part() {
        let line = clipped(&[[0.0, 0.0, -1.0, 1.0], [0.0, 0.0, 1.0, 1.0]]);
        assert_eq!(
            line,
            [vec![0.0, 0.0, 0.0, 1.0, 0.5], vec![0.0, 0.0, 1.0, 1.0, 1.0]]
        );
    }
}
