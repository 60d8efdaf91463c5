//! Rung 17: the top-left rule, magnified: four triangles whose edges run through pixel centres.
//!
//! Look at the pixels under the white edges: black ones are missing, yellow ones are drawn twice.
//!
//! `cargo run --release --example ladder_17_top_left_rule`

use estampe_ladder::{Color, Course, LadderError, Picture};
use estampe_reference::scan_conversion::bounding_box;
use estampe_reference::viewport::PixelBounds;

/// A corner in pixels; the centre of pixel (x, y) is (x, y) + ½.
type Corner = [f32; 2];

/// The middle and the corners of a square. They are centres of pixels, and so the edges, which are
/// diagonal, horizontal and vertical, run through centres too.
const MIDDLE: Corner = [8.5, 8.5];
const RING: [Corner; 4] = [[2.5, 2.5], [14.5, 2.5], [14.5, 14.5], [2.5, 14.5]];
const SIDE: u32 = 17;
const MAGNIFIED: u32 = 24;

/// The edge function: positive on one side of the edge from a to b, negative on the other, 0 on it.
fn edge(a: Corner, b: Corner, p: Corner) -> f32 {
    (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
}

/// All pixels whose three edge functions satisfy a condition.
fn pixels(triangle: [Corner; 3], is_inside: fn(f32) -> bool) -> Vec<[u32; 2]> {
    let [a, b, c] = triangle;
    let all = (0..SIDE * SIDE).map(|at| [at % SIDE, at / SIDE]);
    all.filter(|pixel| {
        let p = pixel.map(|at| at as f32 + 0.5);
        [edge(a, b, p), edge(b, c, p), edge(c, a, p)]
            .into_iter()
            .all(is_inside)
    })
    .collect()
}

/// The top-left rule: a pixel whose centre lies on an edge belongs to the triangle if the edge is a
/// left one (the triangle is to its right) or a horizontal one at the top. Of two triangles that
/// share an edge, one has it on its left or top, the other on its right or bottom: the pixel has
/// one owner.
fn top_left(triangle: [Corner; 3]) -> Vec<[u32; 2]> {
    let in_256ths = |corner: Corner| {
        corner.map(|at| {
            #[expect(clippy::cast_possible_truncation, reason = "a whole number below 2¹³")]
            let at = (at * 256.0) as i32;
            at
        })
    };
    let bounds = PixelBounds {
        x: 0..SIDE,
        y: 0..SIDE,
    };
    bounding_box::repaired(triangle.map(in_256ths), &bounds)
}

/// Each triangle in its colour, pixels of two or more in yellow, and the edges as lines.
fn panel(rule: impl Fn([Corner; 3]) -> Vec<[u32; 2]>) -> Picture {
    const COLORS: [Color; 4] = [
        [90, 120, 170],
        [90, 150, 110],
        [150, 110, 150],
        [130, 130, 130],
    ];
    const TWICE: Color = [255, 220, 0];
    let mut picture = Picture::new(SIDE, SIDE);
    let triangles = [0, 1, 2, 3].map(|k| [MIDDLE, RING[k], RING[(k + 1) % 4]]);
    for (triangle, color) in triangles.into_iter().zip(COLORS) {
        for pixel in rule(triangle) {
            let pixel = pixel.map(u32::cast_signed);
            let is_free = picture.pixel(pixel) == Picture::BLACK;
            picture.set(pixel, if is_free { color } else { TWICE });
        }
    }
    let mut picture = picture.magnified(MAGNIFIED);
    for [a, b, _] in triangles
        .into_iter()
        .flat_map(|[m, a, b]| [[m, a, b], [a, b, m]])
    {
        #[expect(clippy::cast_possible_truncation, reason = "pixels of the picture")]
        let place = |corner: Corner| corner.map(|at| (at * MAGNIFIED as f32) as i32);
        picture.line(place(a), place(b), Picture::WHITE);
    }
    picture
}

/// Pixels whose centres lie strictly inside: holes along the edges. Pixels inside or on an edge:
/// some are drawn twice, which shows as soon as colours are blended. The top-left rule: each once.
///
/// # Errors
/// None.
pub fn draw(_course: &Course) -> Result<Picture, LadderError> {
    Ok(Picture::side_by_side(&[
        panel(|triangle| pixels(triangle, |edge| edge > 0.0)),
        panel(|triangle| pixels(triangle, |edge| edge >= 0.0)),
        panel(top_left),
    ]))
}

fn main() -> std::process::ExitCode {
    estampe_ladder::run(17, draw)
}
