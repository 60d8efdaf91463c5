//! Rung 19: three answers to what hides what, 300×300 each: painter's algorithm, BSP tree and
//! z-buffer, and the z-buffer seen from above.
//!
//! `cargo run --release --example ladder_19_visibility`

use estampe_ladder::{Color, Course, LadderError, Picture};
use estampe_reference::scan_conversion::bounding_box;
use estampe_reference::viewport::{PixelBounds, snap};
use glam::{Vec3, vec3};

const SIZE: u32 = 300;

/// A convex polygon in the cube −1..1, seen along −z by a parallel projection.
#[derive(Debug, Clone)]
struct Polygon {
    corners: Vec<Vec3>,
    color: Color,
}

impl Polygon {
    fn normal(&self) -> Vec3 {
        let [a, b, c] = [0, 1, 2].map(|k: usize| self.corners[k]);
        (b - a).cross(c - a)
    }

    /// The signed distance of a point to the polygon's plane, times ‖n‖: n·(p − a).
    fn side(&self, point: Vec3) -> f32 {
        self.normal().dot(point - self.corners[0])
    }

    /// Calls `plot` with each pixel that the polygon covers, and its z there.
    fn fill(&self, mut plot: impl FnMut([i32; 2], f32)) {
        let half = SIZE as f32 / 2.0;
        let window = |p: Vec3| [snap((p.x + 1.0) * half), snap((1.0 - p.y) * half)];
        let (n, a) = (self.normal(), self.corners[0]);
        let (x, y) = (0..SIZE, 0..SIZE);
        let bounds = PixelBounds { x, y };
        for k in 2..self.corners.len() {
            let triangle = [0, k - 1, k].map(|corner| window(self.corners[corner]));
            for pixel in bounding_box::repaired(triangle, &bounds) {
                // From the equation of the plane: z = a_z − (n_x·(x − a_x) + n_y·(y − a_y)) / n_z.
                let [x, y] = pixel.map(|at| (at as f32 + 0.5) / half - 1.0);
                let z = a.z - (n.x * (x - a.x) + n.y * (-y - a.y)) / n.z;
                plot(pixel.map(u32::cast_signed), z);
            }
        }
    }

    /// The parts on the positive and on the negative side of a plane, without area or not.
    fn split(&self, side: impl Fn(Vec3) -> f32) -> [Self; 2] {
        let [mut front, mut back] = [(); 2].map(|()| Self {
            corners: Vec::new(),
            color: self.color,
        });
        for (k, &a) in self.corners.iter().enumerate() {
            let b = self.corners[(k + 1) % self.corners.len()];
            let (side_a, side_b) = (side(a), side(b));
            let parts = [(&mut front, side_a >= 0.0), (&mut back, side_a <= 0.0)];
            for (part, _) in parts.into_iter().filter(|(_, owns)| *owns) {
                part.corners.push(a);
            }
            if side_a * side_b < 0.0 {
                let crossing = a + (b - a) * (side_a / (side_a - side_b));
                front.corners.push(crossing);
                back.corners.push(crossing);
            }
        }
        [front, back]
    }
}

/// Fuchs, Kedem and Naylor (1980): a polygon divides space by its plane; what lies on both sides is
/// cut. The order for any eye: what is on the other side of the plane than the eye, the polygon,
/// what is on the eye's side.
fn back_to_front(mut polygons: Vec<Polygon>, ordered: &mut Vec<Polygon>) {
    let Some(root) = polygons.pop() else {
        return;
    };
    let [mut front, mut back] = [Vec::new(), Vec::new()];
    // Distances below a millionth are rounding: the point is on the plane.
    let side = |p| Some(root.side(p)).filter(|d| d.abs() > 1e-6).unwrap_or(0.0);
    for polygon in &polygons {
        let [before, behind] = polygon.split(side);
        front.extend(Some(before).filter(|part| part.corners.len() > 2));
        back.extend(Some(behind).filter(|part| part.corners.len() > 2));
    }
    // The eye is at z = ∞: on the side to which the normal points if n_z > 0.
    let [far, near] = if root.normal().z > 0.0 {
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
        polygon.fill(|pixel, _| picture.set(pixel, polygon.color));
    }
    picture
}

/// The picture by z-buffer, and for each pixel a point at (x, z), the nearest at the bottom.
fn z_buffered(polygons: &[Polygon]) -> [Picture; 2] {
    let [mut picture, mut above] = [(); 2].map(|()| Picture::new(SIZE, SIZE));
    let mut buffer = vec![f32::NEG_INFINITY; (SIZE * SIZE) as usize];
    let at = |[x, y]: [i32; 2]| (y.cast_unsigned() * SIZE + x.cast_unsigned()) as usize;
    for polygon in polygons {
        polygon.fill(|pixel, z| {
            if z > buffer[at(pixel)] {
                buffer[at(pixel)] = z;
                picture.set(pixel, polygon.color);
            }
        });
    }
    for y in 0..SIZE.cast_signed() {
        for x in 0..SIZE.cast_signed() {
            let z = buffer[at([x, y])];
            if z.is_finite() {
                #[expect(clippy::cast_possible_truncation, reason = "z is −1 to 1")]
                let row = ((z + 1.0) * SIZE as f32 / 2.0) as i32;
                above.set([x, row], picture.pixel([x, y]));
            }
        }
    }
    [picture, above]
}

/// Three beams, each before the next and behind the one before it; and two crossing squares.
fn scene() -> Vec<Polygon> {
    let mut polygons = Vec::new();
    // A third of a turn: cos = −½, sin = √3/2.
    let turn = |p: Vec3| vec3(-0.5 * p.x - 0.866 * p.y, 0.866 * p.x - 0.5 * p.y, p.z);
    let mut beam = [
        [-0.5, -0.3, -0.25],
        [0.5, -0.3, 0.25],
        [0.5, -0.14, 0.25],
        [-0.5, -0.14, -0.25],
    ]
    .map(Vec3::from);
    for color in [[220, 60, 50], [60, 180, 80], [70, 110, 230]] {
        let corners = beam.map(|p| p + vec3(-0.42, 0.35, 0.3)).to_vec();
        polygons.push(Polygon { corners, color });
        beam = beam.map(turn);
    }
    for (slope, color) in [(0.6, [240, 200, 60]), (-0.6, [160, 90, 200])] {
        let (x, y) = (0.45, 0.4 + slope * 0.2);
        let corners = [[-x, -y], [x, -y], [x, y], [-x, y]]
            .map(|[x, y]| vec3(x + 0.45, y * 0.7 - 0.4, slope * x - 0.4))
            .to_vec();
        polygons.push(Polygon { corners, color });
    }
    polygons
}

/// From left to right:
///
/// - painter: sorted by their mean z, drawn from the farthest on. No order is right for beams that
///   overlap in a cycle, nor for squares that cross each other;
/// - BSP tree: cut where they cross, then exactly ordered;
/// - z-buffer: no order is needed, each pixel keeps what is nearest;
/// - the z-buffer from above: the nearest surface at each pixel, and nothing behind it.
///
/// # Errors
/// None.
pub fn draw(_course: &Course) -> Result<Picture, LadderError> {
    let mut sorted = scene();
    let mean_z = |polygon: &Polygon| {
        let sum: f32 = polygon.corners.iter().map(|p| p.z).sum();
        sum / polygon.corners.len() as f32
    };
    sorted.sort_by(|a, b| mean_z(a).total_cmp(&mean_z(b)));
    let mut ordered = Vec::new();
    back_to_front(scene(), &mut ordered);
    let [z_buffer, above] = z_buffered(&scene());
    let panels = [painted(&sorted), painted(&ordered), z_buffer, above];
    Ok(Picture::side_by_side(&panels))
}

fn main() -> std::process::ExitCode {
    estampe_ladder::run(19, draw)
}
