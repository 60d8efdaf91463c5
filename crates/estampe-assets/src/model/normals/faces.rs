//! The unit normal and the area of every triangle.

use crate::zeros::zeros;
use estampe_scene::{Bounds, Mesh, Workers};
use glam::{DVec3, Vec3};

/// A triangle's contribution to the normals around it: a unit normal, zero for a triangle without
/// area; and its area in units of the square of the mesh's size, more than 0 unless the normal is
/// zero.
///
/// Plain numbers, because a vector of them starts as zeroed memory that each thread is first to
/// touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Face<'a>(&'a [f32; 4]);

impl Face<'_> {
    #[inline]
    pub(super) fn normal(self) -> Vec3 {
        let &[x, y, z, _] = self.0;
        Vec3::new(x, y, z)
    }

    #[inline]
    pub(super) fn area(self) -> f32 {
        self.0[3]
    }

    #[inline]
    pub(super) fn weighted(self) -> Vec3 {
        self.normal() * self.area()
    }
}

/// The faces of all triangles.
#[derive(Debug)]
pub(super) struct Faces(Vec<[f32; 4]>);

impl Faces {
    #[inline]
    pub(super) fn of_corner(&self, corner: u32) -> Face<'_> {
        Face(&self.0[corner as usize / 3])
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = Face<'_>> {
        self.0.iter().map(Face)
    }

    /// The faces from one triangle on.
    pub(super) fn starting_at(&self, triangle: usize) -> impl Iterator<Item = Face<'_>> {
        self.0[triangle..].iter().map(Face)
    }
}

/// Triangles in a piece of some hundred microseconds of work.
pub(super) const PIECE: usize = 1 << 14;

/// The faces of all meshes, one after the other.
pub(super) fn all(meshes: &[Mesh], workers: Workers) -> Faces {
    let bounds = meshes.iter().fold(Bounds::EMPTY, |all, mesh| {
        all.union(&Bounds::of(mesh.positions.iter().copied()))
    });
    // A power of two, so that the size of the model changes no bit of a normal.
    let size = (f64::from(bounds.max.x) - f64::from(bounds.min.x))
        .max(f64::from(bounds.max.y) - f64::from(bounds.min.y))
        .max(f64::from(bounds.max.z) - f64::from(bounds.min.z));
    let exponent = if size > 0.0 { libm::frexp(size).1 } else { 0 };
    let scale = libm::ldexp(1.0, -2 * exponent);
    let count = meshes.iter().map(|mesh| mesh.triangles.len()).sum();
    let mut faces: Vec<[f32; 4]> = zeros(count);
    let mut rest = faces.as_mut_slice();
    let mut parts = Vec::new();
    for mesh in meshes {
        let (own, others) = rest.split_at_mut(mesh.triangles.len());
        rest = others;
        let positions = mesh.positions.as_slice();
        let own = own.chunks_mut(PIECE).zip(mesh.triangles.chunks(PIECE));
        parts.extend(own.map(|(faces, triangles)| (faces, triangles, positions)));
    }
    workers.map(parts, |(faces, triangles, positions)| {
        for (out, triangle) in faces.iter_mut().zip(triangles) {
            let [a, b, c] = triangle.map(|vertex| positions[vertex as usize].as_dvec3());
            *out = face(a, b, c, scale);
        }
    });
    Faces(faces)
}

/// In f64: the fourth powers of f32 neither overflow nor underflow there.
#[inline]
fn face(a: DVec3, b: DVec3, c: DVec3, scale: f64) -> [f32; 4] {
    let cross = (b - a).cross(c - a);
    let squared = cross.length_squared();
    if !(squared > 0.0 && squared.is_finite()) {
        return [0.0; 4];
    }
    let doubled_area = squared.sqrt();
    #[expect(
        clippy::cast_possible_truncation,
        reason = "precision is to spare in a weight"
    )]
    let area = (doubled_area * scale) as f32;
    // The smallest slivers have a small weight, so that they still have a normal when alone.
    const LEAST: f32 = 1e-30;
    let normal = (cross * (1.0 / doubled_area)).as_vec3();
    [normal.x, normal.y, normal.z, area.max(LEAST)]
}
