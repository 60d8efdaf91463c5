//! Facing and face culling of snapped triangles, after clipping.
//!
//! In · Out: three snapped positions · front, back or no area. Precision: exact. Spec: NUMERICS.md,
//! *Triangles*.

use estampe_types::state::{CullMode, FrontFace};

/// The side of a triangle that faces the viewer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Face {
    /// The front face.
    Front,
    /// The back face.
    Back,
}

/// Twice the signed area of a snapped triangle, in (1/256 pixel)²: negative where the vertices run
/// counter-clockwise on the image, because y points down in the window.
#[must_use]
pub fn doubled_area([a, b, c]: [[i32; 2]; 3]) -> i64 {
    let minus = |p: [i32; 2], q: [i32; 2]| [0, 1].map(|k| i64::from(p[k]) - i64::from(q[k]));
    let ([dx1, dy1], [dx2, dy2]) = (minus(b, a), minus(c, a));
    dx1 * dy2 - dx2 * dy1
}

/// The side of a triangle that faces the viewer; `None` if it has no area.
#[must_use]
pub fn face(corners: [[i32; 2]; 3], front_face: FrontFace) -> Option<Face> {
    let is_counter_clockwise = match doubled_area(corners) {
        0 => return None,
        area => area < 0,
    };
    let is_front = is_counter_clockwise == (front_face == FrontFace::Ccw);
    Some(if is_front { Face::Front } else { Face::Back })
}

/// Returns true if face culling drops a triangle with this facing.
#[must_use]
pub fn is_culled(face: Face, mode: CullMode) -> bool {
    match mode {
        CullMode::None => false,
        CullMode::Front => face == Face::Front,
        CullMode::Back => face == Face::Back,
    }
}

/// The classic facing test before the division: the determinant of the rows (x, y, w), in f64, and
/// a bound of its error. If the magnitude is greater than the bound, the sign is right: positive
/// where the triangle is counter-clockwise on the image, also with vertices behind the eye.
///
/// With w = 1 the determinant is twice the area in NDC; each w > 0 multiplies it by w. Clipping
/// does not change its sign, because it is the volume that the triangle spans with the eye. The
/// pipeline does not use this test: in f32 its sign would be wrong on 1.5 % of half-pixel
/// triangles, and snapping may reverse a triangle's winding.
#[must_use]
pub fn clip_space_determinant(positions: [[f32; 4]; 3]) -> (f64, f64) {
    let [a, b, c] = positions.map(|[x, y, _, w]| [x, y, w].map(f64::from));
    // Six products of three f32 numbers: each product of two is exact, the third rounds once, and
    // so do the five sums; each rounding is at most 2⁻⁵³ of the sum of all magnitudes.
    let term = |i: usize, j: usize, k: usize| a[i] * b[j] * c[k];
    let plus = [term(0, 1, 2), term(1, 2, 0), term(2, 0, 1)];
    let minus = [term(2, 1, 0), term(1, 0, 2), term(0, 2, 1)];
    let determinant = plus.iter().sum::<f64>() - minus.iter().sum::<f64>();
    let magnitude: f64 = plus.iter().chain(&minus).map(|term| term.abs()).sum();
    (determinant, magnitude * 8.0 * f64::EPSILON)
}
