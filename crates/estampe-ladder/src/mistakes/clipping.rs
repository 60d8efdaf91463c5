//! Mistakes of Sutherland and Hodgman's loop.

use crate::{Color, Course, LadderError, Picture};
use glam::{Vec2, vec2};

const SIZE: u32 = 220;

/// The sides of the window −½..½: inside where n·p ≤ ½.
const SIDES: [Vec2; 4] = [Vec2::X, Vec2::Y, Vec2::NEG_X, Vec2::NEG_Y];

/// The version of the loop over the edges of the polygon, for each side of the window.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Loop {
    /// A crossing is added wherever the first end of an edge is outside.
    TestsOneEnd,
    /// Each side sees as many edges as the polygon had at first.
    InputLength,
    /// Crossings where the signs differ, and all edges of the current polygon.
    Right,
}

fn clipped(triangle: &[Vec2], version: Loop) -> Vec<Vec2> {
    let mut polygon = triangle.to_vec();
    for side in SIDES {
        let distance = |p: Vec2| 0.5 - side.dot(p);
        let count = match version {
            Loop::InputLength => triangle.len().min(polygon.len()),
            _ => polygon.len(),
        };
        let mut kept = Vec::new();
        for k in 0..count {
            let (a, b) = (polygon[k], polygon[(k + 1) % polygon.len()]);
            let (at_a, at_b) = (distance(a), distance(b));
            if at_a >= 0.0 {
                kept.push(a);
            }
            let crosses = match version {
                Loop::TestsOneEnd => at_a < 0.0,
                _ => (at_a >= 0.0) != (at_b >= 0.0),
            };
            if crosses && at_a != at_b {
                kept.push(a + (b - a) * (at_a / (at_a - at_b)));
            }
        }
        polygon = kept;
    }
    polygon
}

fn panel(version: Loop) -> Picture {
    const GRAY: Color = [90, 90, 90];
    const WINDOW: Color = [80, 140, 255];
    let triangle = [vec2(-0.85, -0.6), vec2(0.8, -0.2), vec2(0.1, 0.85)];
    let square = [
        vec2(-0.5, -0.5),
        vec2(0.5, -0.5),
        vec2(0.5, 0.5),
        vec2(-0.5, 0.5),
    ];
    let mut picture = Picture::new(SIZE, SIZE);
    picture.outline(&triangle, GRAY);
    picture.outline(&square, WINDOW);
    picture.outline(&clipped(&triangle, version), Picture::WHITE);
    picture.flipped().magnified(2)
}

/// A triangle (grey) that is clipped by a window (blue): a loop that tests one end of an edge; one
/// that runs to the length of the input; the right one.
pub(super) fn clip_loop(_: &Course) -> Result<Picture, LadderError> {
    let panels = [Loop::TestsOneEnd, Loop::InputLength, Loop::Right].map(panel);
    Ok(Picture::side_by_side(&panels))
}
