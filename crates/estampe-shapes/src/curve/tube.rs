//! Tubes around curves: closed surfaces that can be lit, printed, and seen at any size.
//!
//! Around each point lies a ring of vertices, perpendicular to the curve. Its first direction is
//! carried from point to point without turning about the curve (a rotation-minimizing frame) by
//! the double reflection of Wang, Jüttler, Zheng and Liu ("Computation of Rotation Minimizing
//! Frames", ACM Transactions on Graphics 27, 2008). Frenet's frame was rejected: it is undefined
//! on straight parts and flips at points of inflection.
//!
//! ```text
//!           ring i      ring i+1
//!        ___.---.________.---.___
//!     .-'   |   |        |   |   '-.     open ends are half spheres
//!    (      | r ↑        |   |      )
//!     '-.___|_ _|________|_ _|___.-'     the curve runs through the rings' centres
//! ```
//!
//! Around a closed curve the frame does not return to where it began; the remaining angle is
//! spread over all rings.

use glam::DVec3;

use super::{Curve, Strand};
use crate::mesh::ShapeMesh;
use crate::parametric::cos_sin_turns;

/// Vertices of a ring at which a tube of some pixels looks round.
pub const DEFAULT_SIDES: u32 = 12;

/// The maximum number of a tube's vertices; longer curves get fewer sides.
const MAX_VERTICES: usize = 1 << 23;

/// The smallest radius, relative to the extent of the curve: thinner tubes would have rings whose
/// vertices coincide in f32.
const MIN_RADIUS: f64 = 1e-5;

/// At a sharp corner the ring is widened, so that both sides keep their thickness, by at most this.
const MAX_MITRE: f64 = 2.0;

/// The tube of this radius around each polyline of a curve.
///
/// Each polyline's tube is a closed surface by indices, with normals outwards and without texture
/// coordinates. `sides` is the number of vertices of a ring, at least 3. The radius is at least
/// 1e-5 of the curve's extent. Tubes of polylines that meet or of a radius larger than that of the
/// curve's bends intersect.
#[must_use]
pub fn tube(curve: &Curve, radius: f64, sides: u32) -> ShapeMesh {
    let mut mesh = ShapeMesh::named("tube");
    let extent = curve
        .bounds()
        .map_or(0.0, |(low, high)| (high - low).length());
    let radius = if radius.is_finite() { radius } else { 0.0 };
    let radius = radius.max(MIN_RADIUS * extent);
    let points: usize = curve.strands.iter().map(|strand| strand.points.len()).sum();
    let most = u32::try_from(MAX_VERTICES / points.max(1)).unwrap_or(u32::MAX);
    let sides = sides.min(most).clamp(3, 256);
    for strand in &curve.strands {
        append(&mut mesh, strand, radius, sides);
    }
    mesh
}

/// A point of the curve with two directions perpendicular to it.
#[derive(Clone, Copy, Debug)]
struct Frame {
    center: DVec3,
    tangent: DVec3,
    /// The direction of the ring's first vertex.
    first: DVec3,
    /// The direction of a sharp bend, as long as the ring is widened along it; else zero.
    mitre: DVec3,
}

impl Frame {
    /// The direction of a vertex of the ring.
    fn direction(&self, side: u32, sides: u32) -> DVec3 {
        let (cos, sin) = cos_sin_turns(f64::from(side) / f64::from(sides));
        self.first * cos + self.tangent.cross(self.first) * sin
    }
}

fn append(mesh: &mut ShapeMesh, strand: &Strand, radius: f64, sides: u32) {
    let frames = frames(strand);
    let (Some(first), Some(last)) = (frames.first(), frames.last()) else {
        return;
    };
    let rings: Vec<u32> = frames
        .iter()
        .map(|frame| {
            let ring = (0..sides).map(|side| {
                let direction = frame.direction(side, sides);
                let widened =
                    direction + frame.mitre * direction.dot(frame.mitre.normalize_or_zero());
                (frame.center + widened * radius, direction)
            });
            push_ring(mesh, ring)
        })
        .collect();
    for pair in rings.windows(2) {
        join(mesh, pair[0], pair[1], sides);
    }
    if strand.is_closed {
        join(mesh, rings[rings.len() - 1], rings[0], sides);
    } else {
        append_cap(mesh, last, rings[rings.len() - 1], radius, sides, 1.0);
        append_cap(mesh, first, rings[0], radius, sides, -1.0);
    }
}

/// Appends the vertices of a ring; returns the index of the first.
fn push_ring(mesh: &mut ShapeMesh, ring: impl Iterator<Item = (DVec3, DVec3)>) -> u32 {
    let first = u32::try_from(mesh.positions.len()).expect("tubes are limited to 2²³ vertices");
    for (position, normal) in ring {
        mesh.positions.push((position + DVec3::ZERO).as_vec3());
        mesh.normals.push((normal + DVec3::ZERO).as_vec3());
    }
    first
}

/// Joins two rings, the second of which lies ahead.
fn join(mesh: &mut ShapeMesh, behind: u32, ahead: u32, sides: u32) {
    for side in 0..sides {
        let next = (side + 1) % sides;
        mesh.push_triangle([behind + side, behind + next, ahead + next]);
        mesh.push_triangle([behind + side, ahead + next, ahead + side]);
    }
}

/// Appends a half sphere at an end; `way` is 1 at the end of the curve, −1 at its beginning.
fn append_cap(mesh: &mut ShapeMesh, end: &Frame, ring: u32, radius: f64, sides: u32, way: f64) {
    let rings = (sides / 4).max(1);
    let mut below = ring;
    let close = |mesh: &mut ShapeMesh, below: u32, above: u32| {
        if way > 0.0 {
            join(mesh, below, above, sides);
        } else {
            join(mesh, above, below, sides);
        }
    };
    for step in 1..rings {
        let (cos, sin) = cos_sin_turns(0.25 * f64::from(step) / f64::from(rings));
        let vertices = (0..sides).map(|side| {
            let normal = end.direction(side, sides) * cos + end.tangent * (way * sin);
            (end.center + normal * radius, normal)
        });
        let above = push_ring(mesh, vertices);
        close(mesh, below, above);
        below = above;
    }
    let normal = end.tangent * way;
    let tip = push_ring(
        mesh,
        std::iter::once((end.center + normal * radius, normal)),
    );
    for side in 0..sides {
        let (a, b) = (below + side, below + (side + 1) % sides);
        mesh.push_triangle(if way > 0.0 { [a, b, tip] } else { [b, a, tip] });
    }
}

/// The frames of all points.
fn frames(strand: &Strand) -> Vec<Frame> {
    let points = &strand.points;
    let count = points.len();
    let direction = |from: usize, to: usize| (points[to] - points[from]).normalize_or_zero();
    let mut frames: Vec<Frame> = Vec::with_capacity(count);
    for (i, &center) in points.iter().enumerate() {
        let arriving = match i {
            0 if !strand.is_closed => direction(0, 1),
            _ => direction((i + count - 1) % count, i),
        };
        let leaving = match i + 1 {
            next if next == count && !strand.is_closed => arriving,
            next => direction(i, next % count),
        };
        let tangent = (arriving + leaving).normalize_or(leaving);
        let half_cosine = tangent.dot(leaving).max(1.0 / MAX_MITRE);
        let mitre = (leaving - arriving).normalize_or_zero() * (1.0 / half_cosine - 1.0);
        let first = match frames.last() {
            None => tangent.any_orthonormal_vector(),
            Some(before) => carried(before, center, tangent),
        };
        frames.push(Frame {
            center,
            tangent,
            first,
            mitre,
        });
    }
    if strand.is_closed {
        untwist(&mut frames);
    }
    frames
}

/// The first direction of a frame, carried to the next point by two reflections: one that
/// exchanges the points, one that turns the reflected tangent to the next one.
fn carried(from: &Frame, center: DVec3, tangent: DVec3) -> DVec3 {
    let reflected = |vector: DVec3, across: DVec3| {
        let square = across.length_squared();
        if square > 0.0 {
            vector - across * (2.0 * across.dot(vector) / square)
        } else {
            vector
        }
    };
    let step = center - from.center;
    let (first, along) = (reflected(from.first, step), reflected(from.tangent, step));
    let carried = reflected(first, tangent - along);
    // Against the sum of rounding errors.
    let flat = carried - tangent * tangent.dot(carried);
    flat.normalize_or(tangent.any_orthonormal_vector())
}

/// Turns each frame of a closed curve about its tangent, so that the last one fits the first.
fn untwist(frames: &mut [Frame]) {
    let (Some(first), Some(last)) = (frames.first().copied(), frames.last()) else {
        return;
    };
    let arriving = carried(last, first.center, first.tangent);
    let across = first.tangent.cross(first.first);
    let angle = libm::atan2(arriving.dot(across), arriving.dot(first.first));
    let count = frames.len() as f64;
    for (i, frame) in frames.iter_mut().enumerate() {
        let part = -angle * i as f64 / count;
        let (cos, sin) = (libm::cos(part), libm::sin(part));
        frame.first = frame.first * cos + frame.tangent.cross(frame.first) * sin;
    }
}
