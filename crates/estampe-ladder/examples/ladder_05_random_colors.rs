//! Rung 5: the faces of a model filled in random colours, 800×800.
//!
//! Look for faces of the far side: where they come later in the file, they cover those of the near
//! side.
//!
//! `cargo run --release --example ladder_05_random_colors -- --model head.obj`

use estampe_ladder::{Color, Course, LadderError, Picture};
use estampe_reference::scan_conversion::bounding_box;

/// A colour that looks random and is the same on every machine: a hash of the face's index.
///
/// Each step spreads the bits of the number over all others (the finalizer of MurmurHash3).
fn color_of(face: u32) -> Color {
    let mut hash = face + 1;
    for factor in [0x85EB_CA6B, 0xC2B2_AE35, 0x9E37_79B1] {
        hash = (hash ^ hash >> 15).wrapping_mul(factor);
    }
    let [_, r, g, b] = hash.to_be_bytes();
    [r, g, b]
}

/// Fills each face in the order of the file. Faces that are drawn later cover earlier ones, even
/// where they lie behind them: rung 7 mends that.
///
/// # Errors
/// None.
pub fn draw(course: &Course) -> Result<Picture, LadderError> {
    let mut picture = Picture::new(Course::SIZE, Course::SIZE);
    for (face, corners) in (0..).zip(course.model.triangles()) {
        for pixel in bounding_box::printed(corners.map(Course::pixel)) {
            picture.set(pixel, color_of(face));
        }
    }
    Ok(picture.flipped())
}

fn main() -> std::process::ExitCode {
    estampe_ladder::run(5, draw)
}
