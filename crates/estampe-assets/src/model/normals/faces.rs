//! The unit normal and the area of every triangle.

use estampe_scene::{Bounds, Mesh};
use glam::{DVec3, Vec3};

/// What a triangle contributes to the normals around it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Face {
    /// Unit normal; zero for a triangle without area.
    pub(super) normal: Vec3,
    /// Area in units of the square of the mesh's size; more than 0 unless the normal is zero.
    pub(super) area: f32,
}

impl Face {
    pub(super) fn weighted(&self) -> Vec3 {
        self.normal * self.area
    }
}

/// The faces of all meshes, one after the other.
pub(super) fn all(meshes: &[Mesh]) -> Vec<Face> {
    let bounds = meshes.iter().fold(Bounds::EMPTY, |all, mesh| {
        all.union(&Bounds::of(mesh.positions.iter().copied()))
    });
    // A power of two, so that the size of the model changes no normal by a bit.
    let size = (f64::from(bounds.max.x) - f64::from(bounds.min.x))
        .max(f64::from(bounds.max.y) - f64::from(bounds.min.y))
        .max(f64::from(bounds.max.z) - f64::from(bounds.min.z));
    let exponent = if size > 0.0 { libm::frexp(size).1 } else { 0 };
    let scale = libm::ldexp(1.0, -2 * exponent);
    let mut faces = Vec::with_capacity(meshes.iter().map(|mesh| mesh.triangles.len()).sum());
    for mesh in meshes {
        let positions = mesh.positions.as_slice();
        faces.extend(mesh.triangles.iter().map(|triangle| {
            let [a, b, c] = triangle.map(|vertex| positions[vertex as usize].as_dvec3());
            face(a, b, c, scale)
        }));
    }
    faces
}

/// In f64: the fourth powers of f32 neither overflow nor underflow there.
#[inline]
fn face(a: DVec3, b: DVec3, c: DVec3, scale: f64) -> Face {
    let cross = (b - a).cross(c - a);
    let squared = cross.length_squared();
    if !(squared > 0.0 && squared.is_finite()) {
        return Face {
            normal: Vec3::ZERO,
            area: 0.0,
        };
    }
    let doubled_area = squared.sqrt();
    #[expect(
        clippy::cast_possible_truncation,
        reason = "precision is to spare in a weight"
    )]
    let area = (doubled_area * scale) as f32;
    // The smallest slivers weigh a little, so that they still have a normal when alone.
    const LEAST: f32 = 1e-30;
    Face {
        normal: (cross * (1.0 / doubled_area)).as_vec3(),
        area: area.max(LEAST),
    }
}
