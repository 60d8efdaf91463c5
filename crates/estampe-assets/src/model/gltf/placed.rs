//! A primitive's vertices in world space: once, several times as instances, or moved by a skin.
//!
//! Normals n are transformed by the inverse transpose of the linear part M, whose direction is
//! that of sign(det M) · cof M, which exists for every M. Tangents are transformed by M. A
//! mirroring M turns triangles inside out, so their winding and the bitangent's sign change.

use super::connectivity::Connectivity;
use super::skin::Joint;
use super::vertices::Vertices;
use estampe_scene::{Mesh, MeshAttribute};
use glam::{DAffine3, DMat3, DVec3, Vec3};

/// The mesh that is being made of one primitive.
#[derive(Debug, Default)]
pub(super) struct Placed {
    mesh: Mesh,
    tangents: Vec<f32>,
    uvs1: Vec<f32>,
}

impl Placed {
    /// Room for `instances` times the primitive.
    pub(super) fn new(vertices: &Vertices, connected: &Connectivity, instances: usize) -> Self {
        let mut placed = Self::default();
        let mesh = &mut placed.mesh;
        mesh.positions
            .reserve_exact(vertices.positions.len() * instances);
        mesh.normals
            .reserve_exact(vertices.normals.len() * instances);
        mesh.uvs.reserve_exact(vertices.uvs.len() * instances);
        mesh.colors.reserve_exact(vertices.colors.len() * instances);
        mesh.triangles
            .reserve_exact(connected.triangles.len() * instances);
        mesh.lines.reserve_exact(connected.lines.len() * instances);
        mesh.points
            .reserve_exact(connected.points.len() * instances);
        placed
    }

    /// Appends the primitive with one transform.
    pub(super) fn append(
        &mut self,
        vertices: &Vertices,
        connected: &Connectivity,
        world_from_object: &DAffine3,
    ) {
        let frame = Frame::new(world_from_object.matrix3);
        self.connect(connected, |_| frame.is_mirroring);
        let mesh = &mut self.mesh;
        let positions = vertices.positions.iter();
        if *world_from_object == DAffine3::IDENTITY {
            mesh.positions.extend(positions);
        } else {
            let place = |p: &Vec3| world_from_object.transform_point3(p.as_dvec3()).as_vec3();
            mesh.positions.extend(positions.map(place));
        }
        let normals = vertices.normals.iter();
        mesh.normals
            .extend(normals.map(|&normal| frame.normal(normal)));
        let tangents = vertices.tangents.iter();
        self.tangents
            .extend(tangents.flat_map(|&tangent| frame.tangent(tangent)));
        self.copy_unchanged(vertices);
    }

    /// Appends the primitive with a transform for each vertex.
    pub(super) fn append_skinned(
        &mut self,
        vertices: &Vertices,
        connected: &Connectivity,
        transforms: &[Joint],
    ) {
        let frames = transforms
            .iter()
            .map(|joint| Frame::new(joint.linear.as_dmat3()));
        let is_mirroring: Vec<bool> = frames.clone().map(|frame| frame.is_mirroring).collect();
        self.connect(connected, |vertex| is_mirroring[vertex as usize]);
        let mesh = &mut self.mesh;
        let positions = vertices.positions.iter().zip(transforms);
        let place = |(&p, joint): (&Vec3, &Joint)| joint.linear * p + joint.translation;
        mesh.positions.extend(positions.map(place));
        let normals = vertices.normals.iter().zip(frames.clone());
        mesh.normals
            .extend(normals.map(|(&normal, frame)| frame.normal(normal)));
        let tangents = vertices.tangents.iter().zip(frames);
        self.tangents
            .extend(tangents.flat_map(|(&tangent, frame)| frame.tangent(tangent)));
        self.copy_unchanged(vertices);
    }

    /// Appends the primitives, with indices after the vertices that are there already.
    fn connect(&mut self, connected: &Connectivity, is_mirroring: impl Fn(u32) -> bool) {
        let mesh = &mut self.mesh;
        let first = u32::try_from(mesh.positions.len()).expect("limits keep vertices below 2^32");
        let triangles = connected.triangles.iter().map(|&[a, b, c]| {
            let wound = if is_mirroring(a) {
                [a, c, b]
            } else {
                [a, b, c]
            };
            wound.map(|vertex| first + vertex)
        });
        mesh.triangles.extend(triangles);
        let lines = connected.lines.iter();
        mesh.lines
            .extend(lines.map(|line| line.map(|vertex| first + vertex)));
        let points = connected.points.iter();
        mesh.points.extend(points.map(|&vertex| first + vertex));
    }

    fn copy_unchanged(&mut self, vertices: &Vertices) {
        self.mesh.uvs.extend_from_slice(&vertices.uvs);
        self.mesh.colors.extend_from_slice(&vertices.colors);
        self.uvs1.extend_from_slice(vertices.uvs1.as_flattened());
    }

    /// The mesh with all attributes.
    pub(super) fn into_mesh(self) -> Mesh {
        let mut mesh = self.mesh;
        for (name, components, values) in
            [(Mesh::UV1, 2, self.uvs1), (Mesh::TANGENT, 4, self.tangents)]
        {
            if !values.is_empty() {
                mesh.attributes.push(MeshAttribute {
                    name: name.to_owned(),
                    components,
                    values,
                });
            }
        }
        mesh
    }
}

/// The linear part of a transform, as directions need it.
struct Frame {
    linear: DMat3,
    /// sign(det M) · cof M.
    cofactors: DMat3,
    is_mirroring: bool,
}

impl Frame {
    fn new(linear: DMat3) -> Self {
        let DMat3 {
            x_axis: x,
            y_axis: y,
            z_axis: z,
        } = linear;
        let is_mirroring = x.dot(y.cross(z)) < 0.0;
        let sign = if is_mirroring { -1.0 } else { 1.0 };
        Self {
            linear,
            cofactors: DMat3::from_cols(y.cross(z), z.cross(x), x.cross(y)) * sign,
            is_mirroring,
        }
    }

    fn normal(&self, normal: Vec3) -> Vec3 {
        unit_or_zero(self.cofactors * normal.as_dvec3())
    }

    fn tangent(&self, [x, y, z, sign]: [f32; 4]) -> [f32; 4] {
        let tangent = unit_or_zero(self.linear * Vec3::new(x, y, z).as_dvec3());
        let sign = if self.is_mirroring { -sign } else { sign };
        [tangent.x, tangent.y, tangent.z, sign]
    }
}

/// The unit vector, or zero if that is undefined.
fn unit_or_zero(vector: DVec3) -> Vec3 {
    vector.normalize_or_zero().as_vec3()
}
