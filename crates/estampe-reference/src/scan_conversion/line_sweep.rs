//! Scan conversion by line sweep: corners sorted by y, then rows between the long side and the two
//! short ones.
//!
//! ```text
//!        0          long side 0─2, short sides 0─1 and 1─2
//!       ╱ ╲
//!      ╱   1        upper half: between 0─2 and 0─1
//!     ╱  ╱          lower half: between 0─2 and 1─2
//!    2
//! ```

use super::{fill, first_column, rows};
use crate::viewport::PixelBounds;

/// The textbook form: whole coordinates, rows and columns with both ends, x along the sides
/// truncated to whole pixels.
#[must_use]
pub fn printed(mut corners: [[i32; 2]; 3]) -> Vec<[i32; 2]> {
    corners.sort_by_key(|corner| corner[1]);
    let [a, b, c] = corners;
    let total_height = c[1] - a[1];
    let mut pixels = Vec::new();
    if total_height == 0 {
        return pixels;
    }
    let along = |from: [i32; 2], to: [i32; 2], y: i32| {
        let t = (y - from[1]) as f32 / (to[1] - from[1]) as f32;
        whole(from[0] as f32 + (to[0] - from[0]) as f32 * t)
    };
    for y in a[1]..=c[1] {
        let is_lower = y > b[1] || b[1] == a[1];
        let long = along(a, c, y);
        let short = if is_lower && c[1] == b[1] {
            b[0]
        } else if is_lower {
            along(b, c, y)
        } else {
            along(a, b, y)
        };
        for x in long.min(short)..=long.max(short) {
            pixels.push([x, y]);
        }
    }
    pixels
}

/// The repaired form: centres at ½, the top-left rule; corners in 1/256 pixel.
#[must_use]
pub fn repaired(corners: [[i32; 2]; 3], bounds: &PixelBounds) -> Vec<[u32; 2]> {
    let mut corners = corners.map(|corner| corner.map(i64::from));
    corners.sort_by_key(|corner| corner[1]);
    let [a, b, c] = corners;
    let mut pixels = Vec::new();
    for [upper, lower] in [[a, b], [b, c]] {
        // A half without height has no rows, so no edge here is horizontal.
        for row in rows(upper[1], lower[1], bounds) {
            let long = first_column(a, c, row);
            let short = first_column(upper, lower, row);
            pixels.extend(fill(long.min(short)..long.max(short), row, bounds));
        }
    }
    pixels
}

#[expect(clippy::cast_possible_truncation, reason = "as it is printed")]
fn whole(value: f32) -> i32 {
    value as i32
}
