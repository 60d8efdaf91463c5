//! Meshes: vertices with their attributes, and the primitives that connect them.

use crate::Bounds;
use glam::{Vec2, Vec3};

/// One mesh: parallel vertex arrays and primitives that index them.
///
/// `normals`, `uvs` and `colors` are either empty or as long as `positions`.
#[derive(Debug, Clone, Default)]
pub struct Mesh {
    /// Name of the object or group; may be empty.
    pub name: String,
    /// Vertex positions in the file's space. Non-finite if the file's values are.
    pub positions: Vec<Vec3>,
    /// Unit vertex normals, or empty. A zero normal means that the vertex has none.
    pub normals: Vec<Vec3>,
    /// Texture coordinates with v = 0 at the image's top row, or empty.
    pub uvs: Vec<Vec2>,
    /// Linear RGB vertex colours and alpha, or empty.
    pub colors: Vec<[f32; 4]>,
    /// Further attributes by name, such as a tangent or a temperature. Names differ from each
    /// other, and each has a value for every vertex.
    pub attributes: Vec<MeshAttribute>,
    /// Triangles, each three vertex indices below `positions.len()`.
    pub triangles: Vec<Triangle>,
    /// Line segments, each two vertex indices.
    pub lines: Vec<LineSegment>,
    /// Points, each a vertex index.
    pub points: Vec<u32>,
    /// Runs of triangles with one material, in order, covering `triangles` without gaps; may be
    /// empty, which means the default material throughout.
    pub surfaces: Vec<Surface>,
    /// World units in a unit of the file's mesh, if `positions` were scaled; `None` is 1. Lengths
    /// of materials that are given in the mesh's space, such as [`Volume`](crate::Volume)'s
    /// thickness, are multiplied by it.
    pub scale: Option<f32>,
}

/// A named attribute of each vertex: one to four numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshAttribute {
    /// The name by which a program asks for it.
    pub name: String,
    /// Numbers per vertex, 1 to 4.
    pub components: usize,
    /// The numbers of the first vertex, then of the second, and so on.
    pub values: Vec<f32>,
}

/// Three vertex indices, counter-clockwise as seen from the front.
pub type Triangle = [u32; 3];
/// Two vertex indices.
pub type LineSegment = [u32; 2];

/// A run of triangles that share a material.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Surface {
    /// Index into `Scene::materials`; `None` is the default material.
    pub material: Option<usize>,
    /// Range of triangle indices, half-open.
    pub triangles: std::ops::Range<usize>,
}

/// The axis that points up in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum UpAxis {
    /// Y, as in most formats.
    #[default]
    Y,
    /// Z, as usual in STL files.
    Z,
}

impl Mesh {
    /// Name of the attribute that holds a second set of texture coordinates: 2 components, v = 0 at
    /// the image's top row.
    pub const UV1: &'static str = "uv1";
    /// Name of the attribute that holds tangents: 4 components, a unit vector or zero, and the sign
    /// of the bitangent, cross(normal, tangent) · sign.
    pub const TANGENT: &'static str = "tangent";

    /// The attribute with this name among [`attributes`](Self::attributes). `None` if there is none,
    /// or if it has not its number of components for each vertex.
    #[must_use]
    pub fn attribute(&self, name: &str) -> Option<&MeshAttribute> {
        let named = self.attributes.iter().find(|found| found.name == name)?;
        let len = self.positions.len().checked_mul(named.components)?;
        ((1..=4).contains(&named.components) && named.values.len() == len).then_some(named)
    }

    /// The box around all finite positions that a primitive uses.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        let corners = self.triangles.iter().flatten();
        let ends = self.lines.iter().flatten();
        let used = corners.chain(ends).chain(&self.points);
        Bounds::of(used.map(|&index| self.positions[index as usize]))
    }
}
