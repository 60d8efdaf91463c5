//! The cube.

use glam::{Vec2, Vec3};

use crate::mesh::ShapeMesh;

/// The faces: outward normal, and the direction of the image's u.
///
/// The image's top points to +Y on the four sides; seen from the front, the top continues the front
/// face upwards and the bottom continues it downwards.
const FACES: [(Vec3, Vec3); 6] = [
    (Vec3::Z, Vec3::X),
    (Vec3::X, Vec3::NEG_Z),
    (Vec3::NEG_Z, Vec3::NEG_X),
    (Vec3::NEG_X, Vec3::Z),
    (Vec3::Y, Vec3::X),
    (Vec3::NEG_Y, Vec3::X),
];

/// The axis-parallel cube of the given edge length around the origin.
///
/// 24 vertices, so that every face has its own normals and shows the whole image.
///
/// ```text
///        ┌─────────┐      0───3   each face: u to the right,
///       ╱  top    ╱│      │ ╲ │   v = 0 at the top
///      ┌─────────┐ │      1───2
///      │  front  │ │
///      │   +Z    │╱ right +X
///      └─────────┘
/// ```
#[must_use]
pub fn cube(edge: f32) -> ShapeMesh {
    let mut mesh = ShapeMesh::named("cube");
    let half = 0.5 * edge;
    for (normal, right) in FACES {
        let up = normal.cross(right);
        let corners = [(-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (1.0, 1.0)];
        let [a, b, c, d] = corners.map(|(x, y)| {
            // Adding zero turns −0 into 0.
            let position = (normal + right * x + up * y) * half + Vec3::ZERO;
            mesh.push_vertex(position, normal + Vec3::ZERO, Vec2::new(x, -y) * 0.5 + 0.5)
        });
        mesh.push_triangle([a, b, c]);
        mesh.push_triangle([a, c, d]);
    }
    mesh
}
