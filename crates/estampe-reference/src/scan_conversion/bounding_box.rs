//! Scan conversion by bounding box: each pixel of the box is tested by its barycentric weights.
//!
//! ```text
//!   weight of c at p:  (b − a) × (p − a) ÷ ((b − a) × (c − a)), cyclically for the other two;
//!   p lies inside where no weight is negative
//! ```

use super::{CENTER, Corner, PIXEL, pixel_at_or_after};
use crate::viewport::PixelBounds;

/// The textbook form: whole coordinates, weights in f32, all edges.
#[must_use]
pub fn printed(corners: [[i32; 2]; 3]) -> Vec<[i32; 2]> {
    let cross = |a: [i32; 2], b: [i32; 2], p: [i32; 2]| {
        let minus = |p: [i32; 2], q: [i32; 2]| [0, 1].map(|k| p[k] as f32 - q[k] as f32);
        let ([ux, uy], [vx, vy]) = (minus(b, a), minus(p, a));
        ux * vy - uy * vx
    };
    let [a, b, c] = corners;
    let doubled_area = cross(a, b, c);
    if doubled_area == 0.0 {
        return Vec::new();
    }
    let least = |axis: usize| a[axis].min(b[axis]).min(c[axis]);
    let greatest = |axis: usize| a[axis].max(b[axis]).max(c[axis]);
    let mut pixels = Vec::new();
    for y in least(1)..=greatest(1) {
        for x in least(0)..=greatest(0) {
            let weights = [[b, c], [c, a], [a, b]].map(|[p, q]| cross(p, q, [x, y]) / doubled_area);
            if weights.iter().all(|&weight| weight >= 0.0) {
                pixels.push([x, y]);
            }
        }
    }
    pixels
}

/// The repaired form: centres at ½, the top-left rule; corners in 1/256 pixel.
#[must_use]
pub fn repaired(corners: [[i32; 2]; 3], bounds: &PixelBounds) -> Vec<[u32; 2]> {
    let [a, b, c] = corners.map(|corner| corner.map(i64::from));
    // Reverse the winding if needed, so that the area, and with it every weight inside, is
    // positive.
    let [a, b, c] = match cross(a, b, c) {
        0 => return Vec::new(),
        area if area > 0 => [a, b, c],
        _ => [a, c, b],
    };
    let range = |axis: usize, limits: &std::ops::Range<u32>| {
        let places = [a, b, c].map(|corner| corner[axis]);
        let least = places[0].min(places[1]).min(places[2]);
        let greatest = places[0].max(places[1]).max(places[2]);
        let first = pixel_at_or_after(least).max(i64::from(limits.start));
        first..pixel_at_or_after(greatest + 1).min(i64::from(limits.end))
    };
    let mut pixels = Vec::new();
    for row in range(1, &bounds.y) {
        for column in range(0, &bounds.x) {
            let center = [column, row].map(|at| at * PIXEL + CENTER);
            let owns = |[p, q]: [Corner; 2]| match cross(p, q, center) {
                0 => is_top_or_left(p, q),
                weight => weight > 0,
            };
            if [[b, c], [c, a], [a, b]].into_iter().all(owns) {
                pixels.push([column, row].map(|at| u32::try_from(at).expect("within bounds")));
            }
        }
    }
    pixels
}

fn cross(a: Corner, b: Corner, p: Corner) -> i64 {
    (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
}

/// Returns true if points on the edge belong to the triangle: the triangle lies below a
/// left-to-right edge or right of an upward edge.
fn is_top_or_left(from: Corner, to: Corner) -> bool {
    let runs_right = from[1] == to[1] && from[0] < to[0];
    let runs_up = to[1] < from[1];
    runs_right || runs_up
}
