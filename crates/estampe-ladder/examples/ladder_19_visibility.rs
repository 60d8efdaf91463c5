//! Rung 19: three answers to what hides what, 300×300 each: painter's algorithm, BSP tree and
//! z-buffer, and the z-buffer seen from above.
//!
//! Look at the beams and the squares in the first panel: the painter draws the blue beam and the
//! violet square wholly before their neighbours.
//!
//! `cargo run --release --example ladder_19_visibility`

use estampe_ladder::{Course, LadderError, Picture, Polygon};
use glam::{Vec3, vec3};

const SIZE: u32 = 300;

/// Fuchs, Kedem and Naylor (1980): the plane of a polygon divides space; polygons on both sides are
/// cut. Back to front for any eye: what is on the other side of the plane than the eye, the
/// polygon, what is on the eye's side.
fn back_to_front(mut polygons: Vec<Polygon>, ordered: &mut Vec<Polygon>) {
    let Some(root) = polygons.pop() else {
        return;
    };
    let [mut front, mut back] = [Vec::new(), Vec::new()];
    for polygon in &polygons {
        let [positive, negative] = polygon.split(|point| root.side(point));
        front.extend(Some(positive).filter(|part| part.corners.len() > 2));
        back.extend(Some(negative).filter(|part| part.corners.len() > 2));
    }
    // The eye is at z = ∞: in front if the normal points there.
    let is_eye_in_front = root.normal().z > 0.0;
    let [far, near] = if is_eye_in_front {
        [back, front]
    } else {
        [front, back]
    };
    back_to_front(far, ordered);
    ordered.push(root);
    back_to_front(near, ordered);
}

fn painted(polygons: &[Polygon]) -> Picture {
    let mut picture = Picture::new(SIZE, SIZE);
    for polygon in polygons {
        polygon.fill(SIZE, |pixel, _| picture.set(pixel, polygon.color));
    }
    picture
}

/// The picture by z-buffer; and from above, a point at (x, z) for each pixel, the nearest at the
/// bottom.
fn z_buffered(polygons: &[Polygon]) -> [Picture; 2] {
    let [mut picture, mut above] = [(); 2].map(|()| Picture::new(SIZE, SIZE));
    let mut buffer = [[f32::NEG_INFINITY; SIZE as usize]; SIZE as usize];
    for polygon in polygons {
        polygon.fill(SIZE, |[x, y], z| {
            let nearest = &mut buffer[y.cast_unsigned() as usize][x.cast_unsigned() as usize];
            if z > *nearest {
                *nearest = z;
                picture.set([x, y], polygon.color);
            }
        });
    }
    for (y, row) in (0..).zip(&buffer) {
        for (x, z) in (0..).zip(row).filter(|(_, z)| z.is_finite()) {
            #[expect(clippy::cast_possible_truncation, reason = "z is −1 to 1")]
            let line = ((z + 1.0) * SIZE as f32 / 2.0) as i32;
            above.set([x, line], picture.pixel([x, y]));
        }
    }
    [picture, above]
}

/// Three beams, each before the next and behind the one before it; and two squares that cross.
fn scene() -> Vec<Polygon> {
    let mut polygons = Vec::new();
    let mut push = |corners: [Vec3; 4], middle: Vec3, color| {
        let corners = corners.map(|corner| corner + middle).to_vec();
        polygons.push(Polygon { corners, color });
    };
    // A third of a turn: cos = −½, sin = √3/2.
    let turn = |p: Vec3| vec3(-0.5 * p.x - 0.866 * p.y, 0.866 * p.x - 0.5 * p.y, p.z);
    let ends = [(-0.5, -0.3), (0.5, -0.3), (0.5, -0.14), (-0.5, -0.14)];
    let mut beam = ends.map(|(x, y)| vec3(x, y, x / 2.0));
    for color in [[220, 60, 50], [60, 180, 80], [70, 110, 230]] {
        push(beam, vec3(-0.42, 0.35, 0.3), color);
        beam = beam.map(turn);
    }
    let square = [(-0.45, -0.3), (0.45, -0.3), (0.45, 0.3), (-0.45, 0.3)];
    let slanted = |slope: f32, height: f32| square.map(|(x, y)| vec3(x, y * height, x * slope));
    push(slanted(0.6, 1.2), vec3(0.45, -0.45, -0.4), [240, 200, 60]);
    push(slanted(-0.6, 0.7), vec3(0.45, -0.45, -0.4), [160, 90, 200]);
    polygons
}

/// From left to right:
///
/// - painter: sorted by their mean z, drawn from the farthest on. No order is right for beams that
///   overlap in a cycle, nor for squares that cross;
/// - BSP tree: cut where they cross, then in exact order;
/// - z-buffer: no order is needed, each pixel keeps what is nearest;
/// - the z-buffer from above: the nearest surface at each pixel, and nothing behind it.
///
/// # Errors
/// None.
pub fn draw(_course: &Course) -> Result<Picture, LadderError> {
    let mut sorted = scene();
    sorted.sort_by(|a, b| a.mean_z().total_cmp(&b.mean_z()));
    let mut ordered = Vec::new();
    back_to_front(scene(), &mut ordered);
    let [z_buffer, above] = z_buffered(&scene());
    let panels = [painted(&sorted), painted(&ordered), z_buffer, above];
    Ok(Picture::side_by_side(&panels))
}

fn main() -> std::process::ExitCode {
    estampe_ladder::run(19, draw)
}
