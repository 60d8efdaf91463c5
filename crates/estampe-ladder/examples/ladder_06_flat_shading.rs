//! Rung 6: flat shading, 800×800, the light from the eye.
//!
//! Look at the parts that stand before others, as the spout before the body: where the hidden face
//! comes later in the file, it is drawn over the visible one.
//!
//! `cargo run --release --example ladder_06_flat_shading -- --model head.obj`

use estampe_ladder::{Course, LadderError, Model, Picture};
use estampe_reference::scan_conversion::bounding_box;

/// Lambert's law: a surface receives light in proportion to the cosine of the angle between its
/// normal and the direction towards the light.
///
/// ```text
///   I = n · l        n = (b − a) × (c − a), normalized; l = (0, 0, 1)
/// ```
///
/// A face with I ≤ 0 faces away from the light, and here from the eye too: it is not drawn
/// (back-face culling). That hides most of what lies behind, but not where one front face covers
/// another.
///
/// # Errors
/// None.
pub fn draw(course: &Course) -> Result<Picture, LadderError> {
    let mut picture = Picture::new(Course::SIZE, Course::SIZE);
    for corners in course.model.triangles() {
        let [nx, ny, nz] = Model::face_normal(corners);
        let [lx, ly, lz] = Course::TOWARDS_LIGHT;
        let intensity = nx * lx + ny * ly + nz * lz;
        if intensity <= 0.0 {
            continue;
        }
        let gray = Picture::code(intensity);
        for pixel in bounding_box::printed(corners.map(Course::pixel)) {
            picture.set(pixel, [gray; 3]);
        }
    }
    Ok(picture.flipped())
}

fn main() -> std::process::ExitCode {
    estampe_ladder::run(6, draw)
}
