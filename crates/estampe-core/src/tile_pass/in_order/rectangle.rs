//! Rectangles: two triangles whose pixels are a box, and whose values are the same planes.
//!
//! Sprites and glyphs are rectangles with level sides, of two triangles that share the diagonal
//! from the upper left to the lower right corner. Both have the first sorted vertex A, at which
//! their planes begin:
//!
//! ```text
//!     A───B     upper triangle: A B D
//!     │ ╲ │     lower triangle: A C D
//!     C───D
//! ```
//!
//! A varying that changes along x alone (A = C, B = D) or along y alone (A = B, C = D) has slopes
//! of the same bits in both: with e = D − A, width W and height H, along x `(e·H − e·0)·r` in the
//! upper one and `(0·H − e·H)·(−r)` in the lower one, along y `(e·W − e·W)·r` and
//! `(e·0 − 0·W)·(−r)`. Zeros may differ in sign, which is lost when they are added to anything but
//! −0. So the two may be drawn as one box. Rectangles with the other diagonal begin at different
//! vertices, where sums are rounded otherwise.

use crate::bounds::plane::Plane;
use crate::bounds::primitives::PackedTriangle;
use crate::fragment::interpolate::VaryingSource;

/// Varyings of a rectangle are smaller, so that no product overflows: W and H are below 2¹⁶.
const MOST: f32 = 1e30;

/// Returns true if the triangles, none of whose varyings are flat, may be drawn as one box.
#[inline(always)]
pub(super) fn is_rectangle(
    first: &PackedTriangle,
    second: &PackedTriangle,
    source: &VaryingSource<'_>,
) -> bool {
    let are_level = |upper: &PackedTriangle, lower: &PackedTriangle| {
        let ([ax, bx, dx], [ay, by, dy]) = (upper.x, upper.y);
        let ([_, cx, _], [_, cy, _]) = (lower.x, lower.y);
        [ay, bx] == [by, dx] && [cx, cy] == [ax, dy]
    };
    let ends =
        |triangle: &PackedTriangle| [triangle.x[0], triangle.y[0], triangle.x[2], triangle.y[2]];
    if ends(first) != ends(second) || !first.has_equal_w() || !second.has_equal_w() {
        return false;
    }
    let (upper, lower) = match (are_level(first, second), are_level(second, first)) {
        (true, _) => (first, second),
        (_, true) => (second, first),
        _ => return false,
    };
    upper.is_front() == lower.is_front()
        && upper.iw_at[0].to_bits() == lower.iw_at[0].to_bits()
        && are_same(&upper.z, &lower.z)
        && have_same_planes(upper, lower, source)
}

/// Returns true if two planes with the same origin have the same bits everywhere.
#[inline(always)]
fn are_same(a: &Plane, b: &Plane) -> bool {
    let slopes = a.dx == b.dx && a.dy == b.dy;
    slopes && a.origin.to_bits() == b.origin.to_bits() && !is_negative_zero(a.origin)
}

#[inline(always)]
fn have_same_planes(
    upper: &PackedTriangle,
    lower: &PackedTriangle,
    source: &VaryingSource<'_>,
) -> bool {
    let of = |triangle: &PackedTriangle, corner: usize| source.of(triangle.vertex[corner]);
    let begins = of(upper, 0).iter().zip(of(lower, 0));
    let ends = of(upper, 2).iter().zip(of(lower, 2));
    let sides = of(upper, 1).iter().zip(of(lower, 1));
    let mut all = true;
    for (((a, other_a), (b, c)), (d, other_d)) in begins.zip(sides).zip(ends) {
        let along_one = (a == c) & (b == d) | (a == b) & (c == d);
        let are_small = (a.abs() < MOST) & (d.abs() < MOST);
        all &= along_one & are_small & !is_negative_zero(*a);
        all &= (a.to_bits() == other_a.to_bits()) & (d == other_d);
    }
    all
}

#[inline(always)]
fn is_negative_zero(value: f32) -> bool {
    value.to_bits() == 1 << 31
}
