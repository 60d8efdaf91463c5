//! Triangulation: by diagonal, by fan, by ear clipping.
//!
//! Ear clipping repeatedly cuts a corner whose triangle contains no other corner (Meisters 1975);
//! `earcut` finds the corners nearby through a z-order curve. Its worst time grows with n² for
//! simple polygons (16,000 corners that are all needles: 0.3 s) but about with n^2.5 for those that
//! cross themselves everywhere (16,000 corners: 25 s). Three guards keep hostile files from
//! stopping a reader:
//!
//! - polygons with many more crossings than corners become fans, which look no worse;
//! - so do concave ones of more than [`Triangulator::MAX_CONCAVE_CORNERS`];
//! - and all large concave ones once a [`Triangulator`] has spent [`Triangulator::WORK_BUDGET`].
//!
//! Rejected: sweeping into monotone pieces, O(n log n), which fails outright on the slightly
//! self-crossing polygons that real files contain.

use std::fmt;

use earcut::Earcut;
use glam::{DVec3, Vec2, Vec3};

use super::crossings::{self, SweptEdge};
use super::plane::{
    Convexity, DominantPlane, Point, convexity, doubled_area, relative_to_first, turn,
};

/// Appends the triangles of a polygon in space to `out`, as indices into `corners`.
///
/// The winding is kept. The polygon need not be quite planar: it is projected along the axis that
/// is closest to its normal. Fewer than three corners append nothing. [The module](super) lists the
/// method for each kind of polygon; nothing panics.
///
/// Allocates only for more than four corners; a [`Triangulator`] avoids even that.
pub fn triangulate_3d(corners: &[Vec3], out: &mut Vec<[u32; 3]>) {
    Triangulator::new().triangulate_3d(corners, out);
}

/// Appends the triangles of a polygon in the plane to `out`, as indices into `corners`.
///
/// As [`triangulate_3d`], for either winding.
pub fn triangulate_2d(corners: &[Vec2], out: &mut Vec<[u32; 3]>) {
    Triangulator::new().triangulate_2d(corners, out);
}

/// Triangulates polygon after polygon with the same scratch memory.
pub struct Triangulator {
    earcut: Earcut<f64>,
    ring: Vec<Point>,
    ears: Vec<u32>,
    active_edges: Vec<SweptEdge>,
    pub(super) work_left: u64,
}

impl Default for Triangulator {
    fn default() -> Self {
        Self {
            earcut: Earcut::new(),
            ring: Vec::new(),
            ears: Vec::new(),
            active_edges: Vec::new(),
            work_left: Self::WORK_BUDGET,
        }
    }
}

impl fmt::Debug for Triangulator {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Triangulator").finish_non_exhaustive()
    }
}

impl Triangulator {
    /// Concave polygons with more corners than this become fans, because clipping them takes too
    /// long.
    pub const MAX_CONCAVE_CORNERS: usize = 1 << 14;

    /// The sum of n² over the concave polygons of more than 64 corners that one triangulator clips
    /// with care; later ones become fans. Half a minute at the very worst (32 polygons of the most
    /// corners, all needles: 1 s each), and no limit for real models: 200,000 outlines of 200
    /// corners.
    pub const WORK_BUDGET: u64 = 1 << 33;

    /// Concave polygons of up to this many corners are always clipped.
    const SMALL: usize = 64;

    /// A triangulator without scratch memory yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Like the function [`triangulate_3d`].
    pub fn triangulate_3d(&mut self, corners: &[Vec3], out: &mut Vec<[u32; 3]>) {
        if let &[a, b, c, d] = corners {
            return split_quad_3d([a, b, c, d], out);
        }
        let plane = if corners.len() > 4 {
            DominantPlane::of(corners)
        } else {
            None
        };
        let Some(plane) = plane else {
            return fan(corners.len(), 0, out);
        };
        self.ring.clear();
        self.ring.extend(plane.flatten(corners));
        self.triangulate_ring(out);
    }

    /// Like the function [`triangulate_2d`].
    pub fn triangulate_2d(&mut self, corners: &[Vec2], out: &mut Vec<[u32; 3]>) {
        if corners.len() < 4 || corners.iter().any(|corner| !corner.is_finite()) {
            return fan(corners.len(), 0, out);
        }
        self.ring.clear();
        self.ring.extend(relative_to_first(corners));
        if let &[a, b, c, d] = self.ring.as_slice() {
            return split_quad_2d([a, b, c, d], out);
        }
        self.triangulate_ring(out);
    }

    /// Triangulates `self.ring`, of more than four finite corners.
    fn triangulate_ring(&mut self, out: &mut Vec<[u32; 3]>) {
        let count = self.ring.len();
        let area = doubled_area(&self.ring);
        match convexity(&self.ring) {
            Convexity::Strict => return fan(count, 0, out),
            Convexity::Weak => {
                if let Some(apex) = fan_apex(&self.ring) {
                    return fan(count, apex, out);
                }
            }
            Convexity::Concave => {}
        }
        if count > Self::SMALL && !self.is_worth_clipping() {
            return fan(count, 0, out);
        }

        self.ears.clear();
        self.earcut
            .earcut_slice::<u32>(&self.ring, &[], &mut self.ears);
        if self.ears.is_empty() {
            return fan(count, 0, out);
        }
        // earcut's output is counter-clockwise for either input winding.
        let triangles = self.ears.as_chunks::<3>().0.iter();
        if area < 0.0 {
            out.extend(triangles.map(|&[a, b, c]| [a, c, b]));
        } else {
            out.extend(triangles);
        }
    }

    /// True if ear clipping `self.ring` ends in acceptable time; adds the work to the sum.
    fn is_worth_clipping(&mut self) -> bool {
        let count = self.ring.len();
        if count > Self::MAX_CONCAVE_CORNERS {
            return false;
        }
        let Some(work_left) = self.work_left.checked_sub((count * count) as u64) else {
            return false;
        };
        self.work_left = work_left;
        // Bridges to holes, repeated corners and small overlaps are all far below this.
        !crossings::exceed(&self.ring, 4 * count, &mut self.active_edges)
    }
}

/// Splits a quad in space. It may be bent: each triangle is measured along the quad's own normal,
/// the cross product of the diagonals.
fn split_quad_3d(corners: [Vec3; 4], out: &mut Vec<[u32; 3]>) {
    let [a, b, c, d] = corners.map(|corner| corner.as_dvec3());
    let normal = (c - a).cross(d - b);
    let area = |p: DVec3, q: DVec3, r: DVec3| (q - p).cross(r - p).dot(normal);
    let first = Diagonal {
        smaller_area: area(a, b, c).min(area(a, c, d)),
        squared_length: a.distance_squared(c),
    };
    let second = Diagonal {
        smaller_area: area(a, b, d).min(area(b, c, d)),
        squared_length: b.distance_squared(d),
    };
    split_quad(first, second, out);
}

/// Splits a quad of either winding in the plane.
fn split_quad_2d([a, b, c, d]: [Point; 4], out: &mut Vec<[u32; 3]>) {
    let sign = if doubled_area(&[a, b, c, d]) < 0.0 {
        -1.0
    } else {
        1.0
    };
    let area = |p: Point, q: Point, r: Point| sign * turn(p, q, r);
    let squared = |p: Point, q: Point| {
        let (x, y) = (q[0] - p[0], q[1] - p[1]);
        x * x + y * y
    };
    let first = Diagonal {
        smaller_area: area(a, b, c).min(area(a, c, d)),
        squared_length: squared(a, c),
    };
    let second = Diagonal {
        smaller_area: area(a, b, d).min(area(b, c, d)),
        squared_length: squared(b, d),
    };
    split_quad(first, second, out);
}

/// One of a quad's two diagonals.
#[derive(Clone, Copy)]
struct Diagonal {
    /// The area of the smaller of the two triangles beside it, negative if wound the wrong way.
    smaller_area: f64,
    squared_length: f64,
}

/// Splits a quad along a diagonal that lies inside, the shorter one if both do.
///
/// ```text
///   d───────c    first,  a c:  a b c + a c d
///   │╲     ╱│    second, b d:  a b d + b c d
///   │  ╲ ╱  │
///   │  ╱ ╲  │    if the quad is concave only the diagonal from its reflex corner is inside:
///   │╱     ╲│    the other one leaves a triangle that is wound the wrong way
///   a───────b
/// ```
fn split_quad(first: Diagonal, second: Diagonal, out: &mut Vec<[u32; 3]>) {
    let takes_second = match (first.smaller_area > 0.0, second.smaller_area > 0.0) {
        (true, true) => second.squared_length < first.squared_length,
        (false, true) => true,
        (true, false) => false,
        // The quad crosses itself or has no area: take the diagonal with less area of the wrong
        // winding.
        (false, false) => second.smaller_area > first.smaller_area,
    };
    out.extend(if takes_second {
        [[0, 1, 3], [1, 2, 3]]
    } else {
        [[0, 1, 2], [0, 2, 3]]
    });
}

/// A corner from which a fan of a weakly convex ring has no triangle without area: one whose
/// neighbours are both real corners.
fn fan_apex(ring: &[Point]) -> Option<usize> {
    let count = ring.len();
    let at = |i: usize| ring[i % count];
    let is_real = |i: usize| turn(at(i + count - 1), at(i), at(i + 1)) != 0.0;
    (0..count).find(|&i| is_real(i + count - 1) && is_real(i + 1))
}

/// The triangles (apex, i, i + 1) around a ring of `count` corners.
fn fan(count: usize, apex: usize, out: &mut Vec<[u32; 3]>) {
    // Meshes index vertices by u32, so a larger face is invalid.
    let Ok(count) = u32::try_from(count) else {
        return;
    };
    let Ok(apex) = u32::try_from(apex) else {
        return;
    };
    let corner = |step: u32| {
        if step < count - apex {
            apex + step
        } else {
            step - (count - apex)
        }
    };
    out.extend((1..count.saturating_sub(1)).map(|i| [apex, corner(i), corner(i + 1)]));
}
