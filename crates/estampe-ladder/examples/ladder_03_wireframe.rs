//! Rung 3: a model in wireframe, 800×800: the three edges of each face as Bresenham's lines.
//!
//! Look at the far side of the model: its edges are visible through the near side, for nothing
//! hides anything yet.
//!
//! `cargo run --release --example ladder_03_wireframe -- --model head.obj`

use estampe_ladder::{Course, LadderError, Picture};
use estampe_reference::bresenham;

/// Draws x and y of each corner, and leaves z out: a parallel projection along the z axis.
///
/// # Errors
/// None.
pub fn draw(course: &Course) -> Result<Picture, LadderError> {
    let mut picture = Picture::new(Course::SIZE, Course::SIZE);
    for corners in course.model.triangles() {
        let [a, b, c] = corners.map(Course::pixel);
        for [from, to] in [[a, b], [b, c], [c, a]] {
            for pixel in bresenham::line(from, to) {
                picture.set(pixel, Picture::WHITE);
            }
        }
    }
    Ok(picture.flipped())
}

fn main() -> std::process::ExitCode {
    estampe_ladder::run(3, draw)
}
