//! The triangle mesh that every shape produces.

use glam::{Vec2, Vec3};

/// An indexed triangle mesh with a normal per vertex, and perhaps texture coordinates.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShapeMesh {
    /// Name of the shape, in lower case.
    pub name: String,
    /// Vertex positions in object space, Y up.
    pub positions: Vec<Vec3>,
    /// Unit normals, outwards, one per position.
    pub normals: Vec<Vec3>,
    /// Texture coordinates, one per position, or none; v = 0 is the image's top row.
    pub uvs: Vec<Vec2>,
    /// Vertex indices, counter-clockwise seen from outside. Never out of range, and no triangle
    /// has two corners at the same position.
    pub triangles: Vec<[u32; 3]>,
}

impl ShapeMesh {
    /// An empty mesh.
    pub(crate) fn named(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            ..Self::default()
        }
    }

    /// Appends a vertex and returns its index.
    pub(crate) fn push_vertex(&mut self, position: Vec3, normal: Vec3, uv: Vec2) -> u32 {
        let index = u32::try_from(self.positions.len()).expect("grids are limited to 2²³ vertices");
        self.positions.push(position);
        self.normals.push(normal);
        self.uvs.push(uv);
        index
    }

    /// Appends a triangle unless two of its corners are at the same position.
    pub(crate) fn push_triangle(&mut self, triangle: [u32; 3]) {
        let [a, b, c] = triangle.map(|index| self.positions[index as usize]);
        if a != b && b != c && c != a {
            self.triangles.push(triangle);
        }
    }
}
