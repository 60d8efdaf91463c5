//! Tangents of meshes that bring none, for normal maps: MikkTSpace (M. Mikkelsen, "Simulation of
//! Wrinkled Surfaces Revisited", 2008), the frame in which tools bake such maps.
//!
//! A vertex whose faces want different tangents is divided; the new vertices come after the mesh's
//! own, so that lines and points keep theirs.

use super::vertex_data::attribute;
use bevy_mikktspace::{Geometry, Ops, TangentSpace, generate_tangents};
use estampe_scene::{Mesh, MeshAttribute, Triangle};
use glam::{Vec2, Vec3};
use std::collections::HashMap;

/// The mesh with tangents for a set of texture coordinates (1 for the second one); `None` if it has
/// no normals or no such coordinates.
pub(crate) fn with_tangents(mesh: &Mesh, uv_set: u8) -> Option<Mesh> {
    let uvs: Vec<Vec2> = match uv_set {
        1 => attribute::<2>(mesh, Mesh::UV1)
            .iter()
            .map(|&uv| uv.into())
            .collect(),
        _ => mesh.uvs.clone(),
    };
    if mesh.normals.is_empty() || uvs.is_empty() || mesh.triangles.is_empty() {
        return None;
    }
    let mut faces = Faces::new(mesh, &uvs);
    // The error has no variant.
    let Ok(()) = generate_tangents(&mut faces) else {
        return None;
    };
    Some(divided(mesh, &faces))
}

/// The triangles of a mesh as MikkTSpace reads them.
struct Faces<'a> {
    mesh: &'a Mesh,
    uvs: &'a [Vec2],
    /// Numbers of the triangles whose corners are finite.
    numbers: Vec<usize>,
    /// The tangent of each corner with the sign of the bitangent; zeros if there is none.
    tangents: Vec<[[f32; 4]; 3]>,
}

impl<'a> Faces<'a> {
    fn new(mesh: &'a Mesh, uvs: &'a [Vec2]) -> Self {
        let is_finite = |triangle: &Triangle| {
            triangle.iter().all(|&index| {
                let index = index as usize;
                let known = |values: &[Vec3]| values.get(index).is_some_and(|v| v.is_finite());
                known(&mesh.positions)
                    && known(&mesh.normals)
                    && uvs.get(index).is_some_and(|uv| uv.is_finite())
            })
        };
        let triangles = mesh.triangles.iter().enumerate();
        let finite = triangles.filter(|(_, triangle)| is_finite(triangle));
        Self {
            mesh,
            uvs,
            numbers: finite.map(|(number, _)| number).collect(),
            tangents: vec![[[0.0; 4]; 3]; mesh.triangles.len()],
        }
    }

    fn corner(&self, face: usize, corner: usize) -> usize {
        self.mesh.triangles[self.numbers[face]][corner] as usize
    }
}

/// Functions that give the same bits on every system.
struct Portable;

impl Ops for Portable {
    fn sqrt(x: f32) -> f32 {
        libm::sqrtf(x)
    }

    #[expect(
        clippy::cast_possible_truncation,
        reason = "an angle, rounded to the nearest f32"
    )]
    fn acos(x: f32) -> f32 {
        libm::acos(f64::from(x)) as f32
    }
}

impl Geometry<Portable> for Faces<'_> {
    fn num_faces(&self) -> usize {
        self.numbers.len()
    }

    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.positions[self.corner(face, corner)].to_array()
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.normals[self.corner(face, corner)].to_array()
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        let uv = self.uvs[self.corner(face, corner)];
        // MikkTSpace's v points up.
        [uv.x, 1.0 - uv.y]
    }

    fn set_tangent(&mut self, tangent: Option<TangentSpace>, face: usize, corner: usize) {
        if let Some(tangent) = tangent {
            self.tangents[self.numbers[face]][corner] = tangent.tangent_encoded();
        }
    }
}

/// The mesh with a vertex for each vertex and tangent.
fn divided(mesh: &Mesh, faces: &Faces<'_>) -> Mesh {
    let count = mesh.positions.len();
    // The vertex that each new one is a copy of; the mesh's own come first.
    let mut sources: Vec<u32> = (0..).take(count).collect();
    let mut tangents: Vec<Option<[f32; 4]>> = vec![None; count];
    let mut copies: HashMap<(u32, [u32; 4]), u32> = HashMap::new();
    let mut triangles = mesh.triangles.clone();
    let corners = triangles.as_flattened_mut().iter_mut();
    for (index, &tangent) in corners.zip(faces.tangents.as_flattened()) {
        let Some(own) = tangents.get_mut(*index as usize) else {
            continue;
        };
        if own.is_none_or(|known| known.map(f32::to_bits) == tangent.map(f32::to_bits)) {
            *own = Some(tangent);
            continue;
        }
        let key = (*index, tangent.map(f32::to_bits));
        *index = *copies.entry(key).or_insert_with(|| {
            sources.push(*index);
            tangents.push(Some(tangent));
            u32::try_from(sources.len() - 1).unwrap_or(u32::MAX)
        });
    }
    let added = || sources[count..].iter().map(|&source| source as usize);
    let mut made = Mesh {
        triangles,
        ..mesh.clone()
    };
    extend(&mut made.positions, added());
    extend(&mut made.normals, added());
    extend(&mut made.uvs, added());
    extend(&mut made.colors, added());
    for MeshAttribute {
        components, values, ..
    } in &mut made.attributes
    {
        for source in added() {
            let first = source * *components;
            if first + *components <= values.len() {
                values.extend_from_within(first..first + *components);
            }
        }
    }
    let tangents = tangents.into_iter().map(Option::unwrap_or_default);
    made.attributes.push(MeshAttribute {
        name: Mesh::TANGENT.to_owned(),
        components: 4,
        values: tangents.flatten().collect(),
    });
    made
}

/// Appends copies of elements; an empty array stays empty.
fn extend<T: Copy>(values: &mut Vec<T>, sources: impl Iterator<Item = usize>) {
    if !values.is_empty() {
        let copies: Vec<T> = sources.map(|source| values[source]).collect();
        values.extend(copies);
    }
}
