//! Clipping in clip space, before the division (Sutherland and Hodgman 1974).
//!
//! In · Out: clip vertices · clip vertices whose w has a finite reciprocal. Precision: f32 in the
//! order of NUMERICS.md. A crossing is always computed from the inside vertex towards the outside
//! one, so that two triangles that share an edge get the same bits.
//!
//! ```text
//!  inside │ outside        d_in ≥ 0 > d_out
//!    a●───┼──────●b        t = d_in ÷ (d_in − d_out)
//!   d_in  │    d_out       crossing = a + (b − a)·t; near and far then set z onto the plane
//! ```

use crate::ClipVertex;
use crate::viewport::{GUARD_BAND_MAX, GUARD_BAND_MIN, LEAST_W, ViewportTransform};

/// A clip plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Plane {
    /// z ≥ 0.
    Near,
    /// z ≤ w.
    Far,
    /// w ≥ [`LEAST_W`]; in use if depth is not clipped.
    Eye,
    /// Clip distance k ≥ 0.
    Distance(usize),
    /// The window coordinate is at least `SIDE_MIN`: `coordinate·scale + reach·w ≥ 0`.
    Least {
        /// 0 for x, 1 for y.
        axis: usize,
        /// `sx` or `sy`.
        scale: f32,
        /// `ox + 8193` or `oy + 8193`.
        reach: f32,
    },
    /// The window coordinate is at most `SIDE_MAX`: `reach·w − coordinate·scale ≥ 0`.
    Greatest {
        /// 0 for x, 1 for y.
        axis: usize,
        /// `sx` or `sy`.
        scale: f32,
        /// `24576 − ox` or `24576 − oy`.
        reach: f32,
    },
}

/// The left and top clip planes in window coordinates: one pixel outside the guard band. An edge
/// whose ends are both within the band is then never cut, so two triangles that share it agree if
/// one of them leaves the band.
pub const SIDE_MIN: f32 = GUARD_BAND_MIN - 1.0;
/// The right and bottom clip planes in window coordinates: one pixel outside the guard band.
pub const SIDE_MAX: f32 = GUARD_BAND_MAX + 1.0;

impl Plane {
    /// The planes that clip depth.
    pub const DEPTH: [Self; 2] = [Self::Near, Self::Far];

    /// The planes that clip every primitive, in order. The sides clip only primitives that leave
    /// the guard band.
    #[must_use]
    pub fn always(viewport: &ViewportTransform, clip_distances: usize) -> Vec<Self> {
        let depth: &[Self] = if viewport.unclipped_depth {
            &[Self::Eye]
        } else {
            &Self::DEPTH
        };
        let distances = (0..clip_distances).map(Self::Distance);
        depth.iter().copied().chain(distances).collect()
    }

    /// The left, right, top and bottom planes, in the order in which they clip.
    #[must_use]
    pub fn sides(viewport: &ViewportTransform) -> [Self; 4] {
        let (scale, offset) = (viewport.scale, viewport.offset);
        let least = |axis: usize| Self::Least {
            axis,
            scale: scale[axis],
            reach: offset[axis] - SIDE_MIN,
        };
        let greatest = |axis: usize| Self::Greatest {
            axis,
            scale: scale[axis],
            reach: SIDE_MAX - offset[axis],
        };
        [least(0), greatest(0), least(1), greatest(1)]
    }

    /// The signed distance of a vertex to the plane, scaled: positive inside, negative outside.
    #[must_use]
    pub fn distance(self, vertex: &ClipVertex) -> f32 {
        let position = vertex.position;
        let [_, _, z, w] = position;
        match self {
            Self::Near => z,
            Self::Far => w - z,
            Self::Eye => w - LEAST_W,
            Self::Distance(k) => vertex.clip_distances[k],
            Self::Least { axis, scale, reach } => position[axis] * scale + reach * w,
            Self::Greatest { axis, scale, reach } => reach * w - position[axis] * scale,
        }
    }

    /// Sets the coordinate that this plane bounds to its exact value. The sides bound a sum of two
    /// coordinates: nothing is set.
    fn set(self, vertex: &mut ClipVertex) {
        let position = &mut vertex.position;
        match self {
            Self::Near => position[2] = 0.0,
            Self::Far => position[2] = position[3],
            Self::Eye => position[3] = LEAST_W,
            Self::Distance(k) => vertex.clip_distances[k] = 0.0,
            Self::Least { .. } | Self::Greatest { .. } => {}
        }
    }

    fn keeps(self, vertex: &ClipVertex) -> bool {
        self.distance(vertex) >= 0.0
    }

    /// The point at which the edge from an inside to an outside vertex crosses the plane.
    #[must_use]
    pub fn crossing(self, inside: &ClipVertex, outside: &ClipVertex) -> ClipVertex {
        let d_in = self.distance(inside);
        let d_out = self.distance(outside);
        let t = d_in / (d_in - d_out);
        let mix = |a: f32, b: f32| a + (b - a) * t;
        let mix_all = |a: &[f32], b: &[f32]| a.iter().zip(b).map(|(&a, &b)| mix(a, b)).collect();
        let mut crossing = ClipVertex {
            position: [0, 1, 2, 3].map(|k: usize| mix(inside.position[k], outside.position[k])),
            varyings: mix_all(&inside.varyings, &outside.varyings),
            clip_distances: mix_all(&inside.clip_distances, &outside.clip_distances),
            ..inside.clone()
        };
        self.set(&mut crossing);
        crossing
    }
}

/// The signed distances of a clip-space position to the six planes of the view volume, in the order
/// x ≥ −w, x ≤ w, y ≥ −w, y ≤ w, z ≥ 0, z ≤ w; negative outside.
#[must_use]
pub fn view_volume_distances([x, y, z, w]: [f32; 4]) -> [f32; 6] {
    [x + w, w - x, y + w, w - y, z, w - z]
}

/// Returns true if 1/w of a position is positive and finite, and the position is inside the depth
/// planes: near and far, or w ≥ [`LEAST_W`] if depth is not clipped.
#[must_use]
pub fn is_inside([_, _, z, w]: [f32; 4], viewport: &ViewportTransform) -> bool {
    let is_in_depth = if viewport.unclipped_depth {
        w >= LEAST_W
    } else {
        0.0 <= z && z <= w
    };
    is_in_depth && w > 0.0 && (1.0 / w).is_finite()
}

/// Returns true if a primitive is culled by distance: one cull distance is negative at all of its
/// vertices.
#[must_use]
pub fn is_distant(vertices: &[ClipVertex]) -> bool {
    let distances = vertices
        .first()
        .map_or(0, |vertex| vertex.cull_distances.len());
    (0..distances).any(|k| vertices.iter().all(|vertex| vertex.cull_distances[k] < 0.0))
}

/// Returns true if a position is inside the depth planes and its window coordinates fit the
/// rasterizer's fixed point.
#[must_use]
pub fn is_within_guard_band(position: [f32; 4], viewport: &ViewportTransform) -> bool {
    let window = viewport.window(position);
    let band = GUARD_BAND_MIN..=GUARD_BAND_MAX;
    is_inside(position, viewport) && band.contains(&window.x) && band.contains(&window.y)
}

/// The result of the clip test of a primitive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ClipTest {
    /// The primitive is drawn unclipped.
    Accept,
    /// The primitive is dropped: it is outside one plane with all of its vertices, or not all of
    /// its numbers are finite.
    Drop,
    /// It must be clipped.
    Clip,
}

/// Classifies a line or triangle.
#[must_use]
pub fn test(vertices: &[ClipVertex], viewport: &ViewportTransform) -> ClipTest {
    let positions = || vertices.iter().map(|vertex| vertex.position);
    let distances = || vertices.iter().flat_map(|vertex| &vertex.clip_distances);
    if positions().any(|p| p.iter().any(|component| !component.is_finite()))
        || distances().any(|distance| !distance.is_finite())
    {
        return ClipTest::Drop;
    }
    if positions().all(|p| is_within_guard_band(p, viewport))
        && distances().all(|&distance| distance >= 0.0)
    {
        return ClipTest::Accept;
    }
    let all_outside = |side: usize| positions().all(|p| view_volume_distances(p)[side] < 0.0);
    let sides = if viewport.unclipped_depth { 4 } else { 6 };
    if (0..sides).any(all_outside) {
        return ClipTest::Drop;
    }
    ClipTest::Clip
}

/// Clips a triangle and cuts the result into a fan: at most seven triangles, and one more for each
/// clip distance. The winding is kept.
#[must_use]
pub fn clip_triangle(
    vertices: &[ClipVertex; 3],
    viewport: &ViewportTransform,
) -> Vec<[ClipVertex; 3]> {
    match test(vertices, viewport) {
        ClipTest::Accept => vec![vertices.clone()],
        ClipTest::Drop => Vec::new(),
        ClipTest::Clip => fan(&clip_polygon(vertices, viewport)),
    }
}

/// Clips a polygon by the depth planes and the clip distances, then, if it leaves the guard band,
/// by the sides around it.
#[must_use]
pub fn clip_polygon(vertices: &[ClipVertex], viewport: &ViewportTransform) -> Vec<ClipVertex> {
    let mut polygon = vertices.to_vec();
    for plane in Plane::always(viewport, vertices[0].clip_distances.len()) {
        polygon = clip_polygon_by(plane, &polygon);
    }
    if needs_sides(&polygon, viewport) {
        for plane in Plane::sides(viewport) {
            polygon = clip_polygon_by(plane, &polygon);
        }
    }
    polygon
}

/// Clips a polygon by one plane: one pass of Sutherland and Hodgman's loop.
#[must_use]
pub fn clip_polygon_by(plane: Plane, polygon: &[ClipVertex]) -> Vec<ClipVertex> {
    let mut kept = Vec::new();
    for (i, vertex) in polygon.iter().enumerate() {
        let next = &polygon[(i + 1) % polygon.len()];
        if plane.keeps(vertex) {
            kept.push(vertex.clone());
        }
        match (plane.keeps(vertex), plane.keeps(next)) {
            (true, false) => kept.push(plane.crossing(vertex, next)),
            (false, true) => kept.push(plane.crossing(next, vertex)),
            _ => {}
        }
    }
    kept
}

/// Clips a line: its inside part, in the same direction, or `None`.
#[must_use]
pub fn clip_line(line: &[ClipVertex; 2], viewport: &ViewportTransform) -> Option<[ClipVertex; 2]> {
    match test(line, viewport) {
        ClipTest::Accept => return Some(line.clone()),
        ClipTest::Drop => return None,
        ClipTest::Clip => {}
    }
    let mut line = line.clone();
    for plane in Plane::always(viewport, line[0].clip_distances.len()) {
        line = clip_line_by(plane, line)?;
    }
    if needs_sides(&line, viewport) {
        for plane in Plane::sides(viewport) {
            line = clip_line_by(plane, line)?;
        }
    }
    line.iter().all(is_divisible).then_some(line)
}

/// The part of a line on the inside of a plane.
#[must_use]
pub fn clip_line_by(plane: Plane, [start, end]: [ClipVertex; 2]) -> Option<[ClipVertex; 2]> {
    match (plane.keeps(&start), plane.keeps(&end)) {
        (true, true) => Some([start, end]),
        (true, false) => {
            let end = plane.crossing(&start, &end);
            Some([start, end])
        }
        (false, true) => {
            let start = plane.crossing(&end, &start);
            Some([start, end])
        }
        (false, false) => None,
    }
}

/// Returns true if a point is drawn: its centre lies in the view volume, and no clip distance is
/// negative.
#[must_use]
pub fn keeps_point(vertex: &ClipVertex, viewport: &ViewportTransform) -> bool {
    let [x, y, _, w] = vertex.position;
    vertex
        .position
        .iter()
        .all(|component| component.is_finite())
        && is_inside(vertex.position, viewport)
        && vertex
            .clip_distances
            .iter()
            .all(|&distance| distance.is_finite() && distance >= 0.0)
        && (-w..=w).contains(&x)
        && (-w..=w).contains(&y)
}

fn needs_sides(vertices: &[ClipVertex], viewport: &ViewportTransform) -> bool {
    let leaves = |vertex: &ClipVertex| !is_within_guard_band(vertex.position, viewport);
    vertices.iter().any(leaves)
}

/// Cuts a polygon into (0, 1, 2), (0, 2, 3), …; triangles with a vertex whose 1/w is not finite are
/// dropped.
fn fan(polygon: &[ClipVertex]) -> Vec<[ClipVertex; 3]> {
    let triangle = |k: usize| [&polygon[0], &polygon[k], &polygon[k + 1]].map(Clone::clone);
    (1..polygon.len().saturating_sub(1))
        .map(triangle)
        .filter(|corners: &[ClipVertex; 3]| corners.iter().all(is_divisible))
        .collect()
}

fn is_divisible(vertex: &ClipVertex) -> bool {
    let w = vertex.position[3];
    w > 0.0 && (1.0 / w).is_finite()
}
