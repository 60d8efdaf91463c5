//! Rung 2: the line (13, 20)–(80, 40) in white and (20, 13)–(40, 80) in red, 100×100, y up: three
//! naive versions, then Bresenham's.
//!
//! Look at the gaps on the left, and at the blue pixels above right: the red line, drawn from its
//! other end, covers other pixels. Bresenham's lines, below right, have neither.
//!
//! `cargo run --release --example ladder_02_lines`

use estampe_ladder::{Color, Course, LadderError, Picture};
use estampe_reference::bresenham;

/// A pixel: x to the right, y up.
type Pixel = [i32; 2];

/// Points at equal steps of t: p(t) = a + t·(b − a), t = 0, step, 2·step … 1.
///
/// A step of 0.1 leaves gaps; 0.01 sets most pixels of these lines twice, and would leave gaps in
/// longer ones. No fixed step is right.
fn by_steps(a: Pixel, b: Pixel, steps: i32) -> Vec<Pixel> {
    let at = |k: i32| [0, 1].map(|axis: usize| a[axis] + (b[axis] - a[axis]) * k / steps);
    (0..=steps).map(at).collect()
}

/// One pixel in each column: y(x) = y₀ + (x − x₀)·Δy/Δx, from left to right.
///
/// A steep line has fewer columns than rows, and therefore gaps; a line from right to left has no
/// pixel at all.
fn by_columns(a: Pixel, b: Pixel) -> Vec<Pixel> {
    let y = |x: i32| a[1] + (x - a[0]) * (b[1] - a[1]) / (b[0] - a[0]);
    (a[0]..=b[0]).map(|x| [x, y(x)]).collect()
}

/// Bresenham's line: one pixel for each step along the longer axis, decided by the sign of an
/// integer; both ends, the same pixels in both directions, no gap in any octant.
fn by_bresenham(a: Pixel, b: Pixel) -> Vec<Pixel> {
    bresenham::line(a, b).collect()
}

/// Both lines in one of the versions. The red one is drawn again from its other end: it must cover
/// the same pixels, so the blue pixels that are visible are those that it misses.
fn lines(version: impl Fn(Pixel, Pixel) -> Vec<Pixel>) -> Picture {
    const BLUE: Color = [64, 96, 255];
    let mut picture = Picture::new(100, 100);
    for (a, b, color) in [
        ([13, 20], [80, 40], Picture::WHITE),
        ([40, 80], [20, 13], BLUE),
        ([20, 13], [40, 80], Picture::RED),
    ] {
        for pixel in version(a, b) {
            picture.set(pixel, color);
        }
    }
    picture.flipped().magnified(3)
}

/// In reading order: steps of 0.1, steps of 0.01, columns from left to right, Bresenham.
///
/// # Errors
/// None.
pub fn draw(_course: &Course) -> Result<Picture, LadderError> {
    let versions = [
        lines(|a, b| by_steps(a, b, 10)),
        lines(|a, b| by_steps(a, b, 100)),
        lines(by_columns),
        lines(by_bresenham),
    ];
    Ok(Picture::in_columns(2, &versions))
}

fn main() -> std::process::ExitCode {
    estampe_ladder::run(2, draw)
}
