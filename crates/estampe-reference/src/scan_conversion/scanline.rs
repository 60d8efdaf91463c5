//! Scan conversion by edge equations: three values that are stepped from pixel to pixel and from
//! row to row.
//!
//! ```text
//!   E(x, y) = A·x + B·y + C,   A = ay − by,   B = bx − ax,   C = −(A·ax + B·ay)
//!   one pixel to the right: E += A;  one row down: E += B;  inside where all three are ≥ 0
//! ```

use super::{CENTER, Corner, PIXEL};
use crate::viewport::PixelBounds;

/// The equation of an edge.
#[derive(Debug, Clone, Copy)]
struct Equation {
    a: i64,
    b: i64,
    c: i64,
}

impl Equation {
    fn new(from: Corner, to: Corner) -> Self {
        let (a, b) = (from[1] - to[1], to[0] - from[0]);
        let c = -(a * from[0] + b * from[1]);
        Self { a, b, c }
    }

    fn at(&self, [x, y]: Corner) -> i64 {
        self.a * x + self.b * y + self.c
    }

    /// The equation with the fill rule: minus 1 if points on the edge do not belong to the
    /// triangle, so that 0 becomes negative. They belong to it if the triangle is right of the edge
    /// (A > 0, the edge runs up) or below it (A = 0 and B > 0).
    fn owning(self) -> Self {
        let owns = self.a > 0 || self.a == 0 && self.b > 0;
        Self {
            c: self.c - i64::from(!owns),
            ..self
        }
    }
}

/// The edge equations of a triangle, wound so that its inside is positive; `None` if it has no
/// area.
fn equations([a, b, c]: [Corner; 3]) -> Option<[Equation; 3]> {
    let area = Equation::new(a, b).at(c);
    let [a, b, c] = match area {
        0 => return None,
        area if area > 0 => [a, b, c],
        _ => [a, c, b],
    };
    Some([[a, b], [b, c], [c, a]].map(|[from, to]| Equation::new(from, to)))
}

/// The pixels of a box that are inside, found by stepping from the pixel `first`, whose centre is
/// at `center`.
fn sweep(
    equations: [Equation; 3],
    first: [i64; 2],
    size: [i64; 2],
    center: Corner,
    step: i64,
) -> Vec<[i64; 2]> {
    let mut pixels = Vec::new();
    let mut row = equations.map(|equation| equation.at(center));
    for y in 0..size[1] {
        let mut values = row;
        for x in 0..size[0] {
            if values.iter().all(|&value| value >= 0) {
                pixels.push([first[0] + x, first[1] + y]);
            }
            for (value, equation) in values.iter_mut().zip(&equations) {
                *value += equation.a * step;
            }
        }
        for (value, equation) in row.iter_mut().zip(&equations) {
            *value += equation.b * step;
        }
    }
    pixels
}

/// The textbook form: whole coordinates, all edges.
#[must_use]
pub fn printed(corners: [[i32; 2]; 3]) -> Vec<[i32; 2]> {
    let corners = corners.map(|corner| corner.map(i64::from));
    let Some(equations) = equations(corners) else {
        return Vec::new();
    };
    let of_axis = |axis: usize| corners.map(|corner| corner[axis]);
    let least = [0, 1].map(|axis| of_axis(axis).into_iter().fold(i64::MAX, i64::min));
    let greatest = [0, 1].map(|axis| of_axis(axis).into_iter().fold(i64::MIN, i64::max));
    let size = [0, 1].map(|axis| greatest[axis] - least[axis] + 1);
    let narrow = |at: i64| i32::try_from(at).expect("between the corners");
    let pixels = sweep(equations, least, size, least, 1);
    pixels.into_iter().map(|pixel| pixel.map(narrow)).collect()
}

/// The repaired form: centres at ½, the top-left rule; corners in 1/256 pixel. It steps through all
/// pixels of the bounds.
#[must_use]
pub fn repaired(corners: [[i32; 2]; 3], bounds: &PixelBounds) -> Vec<[u32; 2]> {
    let Some(equations) = equations(corners.map(|corner| corner.map(i64::from))) else {
        return Vec::new();
    };
    let first = [&bounds.x, &bounds.y].map(|range| i64::from(range.start));
    let size = [&bounds.x, &bounds.y].map(|range| i64::from(range.end) - i64::from(range.start));
    let center = first.map(|at| at * PIXEL + CENTER);
    let pixels = sweep(equations.map(Equation::owning), first, size, center, PIXEL);
    let narrow = |at: i64| u32::try_from(at).expect("within bounds");
    pixels.into_iter().map(|pixel| pixel.map(narrow)).collect()
}
