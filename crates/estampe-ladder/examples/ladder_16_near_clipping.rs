//! Rung 16: clipping by the near plane, 400×400: a floor that runs on behind the eye, without and
//! with it.
//!
//! Look above the horizon on the left: the blue tiles lie behind the eye, and are drawn upside
//! down.
//!
//! `cargo run --release --example ladder_16_near_clipping`

use estampe::state::Viewport;
use estampe::{Mat4, Vec3};
use estampe_ladder::{Color, Course, LadderError, Picture};
use estampe_reference::ClipVertex;
use estampe_reference::clip::Plane;
use estampe_reference::scan_conversion::bounding_box;
use estampe_reference::viewport::{PixelBounds, ViewportTransform};

const SIZE: u32 = 400;
const SKY: Color = [70, 90, 130];

/// Sutherland and Hodgman (1974): walks around the polygon, keeps the vertices inside, and adds a
/// vertex wherever an edge crosses the plane.
///
/// ```text
///   d(p) = p_z ≥ 0 inside;   t = d(a) / (d(a) − d(b));   crossing = a + t·(b − a)
/// ```
///
/// It works in clip space, before the division by w, where a plane through the eye is still far
/// from it. The number of vertices grows by one at most.
fn clip(polygon: &[ClipVertex]) -> Vec<ClipVertex> {
    let mut kept = Vec::new();
    for (k, a) in polygon.iter().enumerate() {
        let b = &polygon[(k + 1) % polygon.len()];
        let are_inside = [a, b].map(|vertex| Plane::Near.distance(vertex) >= 0.0);
        if are_inside[0] {
            kept.push(a.clone());
        }
        match are_inside {
            [true, false] => kept.push(Plane::Near.crossing(a, b)),
            [false, true] => kept.push(Plane::Near.crossing(b, a)),
            _ => {}
        }
    }
    kept
}

/// Divides by w and fills the triangles (0, 1, 2), (0, 2, 3), … of a polygon.
fn fill(picture: &mut Picture, polygon: &[ClipVertex], color: Color) {
    let viewport = ViewportTransform::new(&Viewport::of_target(SIZE, SIZE));
    let bounds = PixelBounds {
        x: 0..SIZE,
        y: 0..SIZE,
    };
    for k in 2..polygon.len() {
        let corners = [0, k - 1, k].map(|corner| viewport.place(&polygon[corner]).snapped);
        for pixel in bounding_box::repaired(corners, &bounds) {
            picture.set(pixel.map(u32::cast_signed), color);
        }
    }
}

/// Tiles at y = −1, from z = −12 before the eye to z = 3 behind it; the eye is at the origin and
/// looks down −z. Tiles behind the eye are blue.
fn floor(clips: bool) -> Picture {
    let clip_from_view = Mat4::perspective(1.2, 1.0, 0.5, 50.0);
    let mut picture = Picture::filled(SIZE, SIZE, SKY);
    for row in -12..3 {
        for column in -4..4 {
            let corner = |x: i32, z: i32| ClipVertex {
                position: clip_from_view
                    .transform_point(Vec3::new(x as f32, -1.0, z as f32 + 0.25))
                    .into(),
                varyings: Vec::new(),
                point_size: 1.0,
                clip_distances: Vec::new(),
                cull_distances: Vec::new(),
            };
            let (x, z) = (column, row);
            let tile = [
                corner(x, z),
                corner(x, z + 1),
                corner(x + 1, z + 1),
                corner(x + 1, z),
            ];
            let color = match ((row + column).rem_euclid(2), row < 0) {
                (0, true) => [230, 220, 190],
                (_, true) => [150, 70, 50],
                (0, false) => [120, 190, 255],
                (_, false) => [40, 100, 200],
            };
            if clips {
                fill(&mut picture, &clip(&tile), color);
            } else {
                fill(&mut picture, &tile, color);
            }
        }
    }
    picture
}

/// On the left without clipping: behind the eye w is negative, and the division turns the floor
/// upside down above the horizon; a tile with corners on both sides is torn. On the right what lies
/// before the near plane, and nothing else.
///
/// # Errors
/// None.
pub fn draw(_course: &Course) -> Result<Picture, LadderError> {
    Ok(Picture::side_by_side(&[floor(false), floor(true)]))
}

fn main() -> std::process::ExitCode {
    estampe_ladder::run(16, draw)
}
