//! Rung 7: the z-buffer, 800×800 each: forgotten, right, and what is in it.
//!
//! Look at the upper end of the handle and at the rim below the lid: the left panel shows faces
//! there that lie behind others.
//!
//! `cargo run --release --example ladder_07_z_buffer -- --model head.obj`

use estampe_ladder::{Course, LadderError, Model, Picture};
use estampe_reference::scan_conversion::bounding_box;

const SIZE: usize = Course::SIZE as usize;

/// Twice the signed area of the triangle a, b, p.
fn cross(a: [i32; 2], b: [i32; 2], p: [i32; 2]) -> i32 {
    (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
}

/// The barycentric weights of p: the areas of the triangles opposite each corner, as fractions of
/// the whole. They add up to 1, and any value of the corners is interpolated by them.
fn weights([a, b, c]: [[i32; 2]; 3], p: [i32; 2]) -> [f32; 3] {
    let whole = cross(a, b, c) as f32;
    [cross(b, c, p), cross(c, a, p), cross(a, b, p)].map(|part| part as f32 / whole)
}

/// The model by flat shading, with a z-buffer: the greatest z that each pixel has seen.
struct Drawing {
    picture: Picture,
    z_buffer: Vec<f32>,
}

/// z grows towards the eye, so the buffer begins at −∞ and a pixel is drawn if its z is greater:
///
/// ```text
///   z = w₀·z₀ + w₁·z₁ + w₂·z₂;   if z > buffer[pixel] { buffer[pixel] = z; draw }
/// ```
fn drawing(course: &Course, is_buffer_written: bool) -> Drawing {
    let mut picture = Picture::new(Course::SIZE, Course::SIZE);
    let mut z_buffer = vec![f32::NEG_INFINITY; SIZE * SIZE];
    for corners in course.model.triangles() {
        let intensity = Model::face_normal(corners)[2]; // n · l with l = (0, 0, 1)
        if intensity <= 0.0 {
            continue;
        }
        let pixels = corners.map(Course::pixel);
        for p in bounding_box::printed(pixels) {
            let [Ok(x), Ok(y)] = p.map(usize::try_from) else {
                continue;
            };
            if x >= SIZE || y >= SIZE {
                continue;
            }
            let [w0, w1, w2] = weights(pixels, p);
            let z = w0 * corners[0][2] + w1 * corners[1][2] + w2 * corners[2][2];
            if z > z_buffer[y * SIZE + x] {
                if is_buffer_written {
                    z_buffer[y * SIZE + x] = z;
                }
                picture.set(p, [Picture::code(intensity); 3]);
            }
        }
    }
    Drawing { picture, z_buffer }
}

/// From left to right: a buffer that is compared and never written, which hides nothing; the right
/// one; its contents, from black (z = −1 and farther) to white (z = 1).
///
/// # Errors
/// None.
pub fn draw(course: &Course) -> Result<Picture, LadderError> {
    let wrong = drawing(course, false);
    let right = drawing(course, true);
    let mut depths = Picture::new(Course::SIZE, Course::SIZE);
    for (y, row) in (0..).zip(right.z_buffer.chunks(SIZE)) {
        for (x, &z) in (0..).zip(row) {
            depths.set([x, y], [Picture::code((z + 1.0) / 2.0); 3]);
        }
    }
    let panels = [wrong.picture, right.picture, depths].map(|panel| panel.flipped());
    Ok(Picture::side_by_side(&panels))
}

fn main() -> std::process::ExitCode {
    estampe_ladder::run(7, draw)
}
