//! Rung 4: three filled triangles in 200×200, y up, by two scan conversions.
//!
//! Look at the left edges of the triangles, where the two scan conversions differ: the third panel
//! has those pixels alone.
//!
//! `cargo run --release --example ladder_04_triangles`

use estampe_ladder::{Color, Course, LadderError, Picture};
use estampe_reference::scan_conversion::{bounding_box, line_sweep};

/// Three corners: pixels, x to the right, y up.
type Triangle = [[i32; 2]; 3];

const TRIANGLES: [(Triangle, Color); 3] = [
    ([[10, 70], [50, 160], [70, 80]], Picture::RED),
    ([[180, 50], [150, 1], [70, 180]], Picture::WHITE),
    ([[180, 150], [120, 160], [130, 180]], Picture::GREEN),
];

fn filled(pixels: impl Fn(Triangle) -> Vec<[i32; 2]>) -> Picture {
    let mut picture = Picture::new(200, 200);
    for (triangle, color) in TRIANGLES {
        for pixel in pixels(triangle) {
            picture.set(pixel, color);
        }
    }
    picture.flipped()
}

/// The pixels that one picture has and the other has not, in their colour.
fn difference(a: &Picture, b: &Picture) -> Picture {
    let mut picture = Picture::filled(a.width(), a.height(), [40, 40, 40]);
    for y in 0..200 {
        for x in 0..200 {
            let (of_a, of_b) = (a.pixel([x, y]), b.pixel([x, y]));
            if of_a != of_b {
                picture.set([x, y], if of_a == Picture::BLACK { of_b } else { of_a });
            }
        }
    }
    picture
}

/// From left to right, magnified twice:
///
/// - line sweep: the corners are sorted by y; each row is filled from the long side to the two
///   short ones, whose x is rounded down to a pixel;
/// - bounding box: each pixel of the box is tested by its barycentric weights, and kept if none is
///   negative. Every pixel is decided alone, which is why hardware does it so;
/// - the pixels in which the two differ. Rounding down widens the left sides: the same triangle has
///   different pixels, and neighbours overlap. Rung 17 has the rule that settles it.
///
/// # Errors
/// None.
pub fn draw(_course: &Course) -> Result<Picture, LadderError> {
    let sweep = filled(line_sweep::printed);
    let bounding_box = filled(bounding_box::printed);
    let difference = difference(&sweep, &bounding_box);
    let panels = [sweep, bounding_box, difference].map(|panel| panel.magnified(2));
    Ok(Picture::side_by_side(&panels))
}

fn main() -> std::process::ExitCode {
    estampe_ladder::run(4, draw)
}
