//! The mesh of one object in its own space, with its properties as surfaces, colours and texture
//! coordinates.

use super::document::{Document, Group, Object, Property, Triangles};
use super::textures::Textures;
use crate::model::vertex_copies::VertexCopies;
use estampe_scene::{Mesh, Surface};
use glam::Vec2;

/// The colour and the texture coordinates of a corner.
type Corner = ([f32; 4], Vec2);

/// What a corner without either has.
const PLAIN: Corner = ([1.0; 4], Vec2::ZERO);

/// Makes the mesh of an object.
pub(super) fn mesh(object: &Object, document: &Document, textures: &Textures) -> Mesh {
    let Triangles {
        positions,
        triangles,
        properties,
    } = &object.triangles;
    let mut mesh = Mesh {
        name: object.name.clone(),
        positions: positions.clone(),
        triangles: triangles.clone(),
        ..Mesh::default()
    };
    let property = |at: usize| properties.get(at).copied().flatten();
    let material = |at: usize| material(property(at)?, document, textures);
    let mut order: Vec<usize> = (0..triangles.len()).collect();
    if !properties.is_empty() {
        order.sort_by_key(|&at| material(at));
        mesh.triangles = order.iter().map(|&at| triangles[at]).collect();
    }
    let mut first = 0;
    for run in order.chunk_by(|&a, &b| material(a) == material(b)) {
        let end = first + run.len();
        mesh.surfaces.push(Surface {
            material: material(run[0]),
            triangles: first..end,
        });
        first = end;
    }
    let groups = { properties.iter().flatten() }.map(|property| group(*property, document));
    let has_colors = { groups.clone() }.any(|group| matches!(group, Group::Colors(_)));
    let has_uvs = { groups }.any(|group| matches!(group, Group::Coordinates { .. }));
    if has_colors || has_uvs {
        let corner = |at: usize, corner: usize| {
            property(order[at]).map_or(PLAIN, |property| value(property, corner, document))
        };
        split(&mut mesh, corner);
        if !has_colors {
            mesh.colors = Vec::new();
        }
        if !has_uvs {
            mesh.uvs = Vec::new();
        }
    }
    mesh
}

fn group(property: Property, document: &Document) -> &Group {
    &document.groups[property.group as usize]
}

/// The material of a triangle, which is that of its first corner.
fn material(property: Property, document: &Document, textures: &Textures) -> Option<usize> {
    match group(property, document) {
        Group::Base { first, .. } => Some(first + property.corners[0] as usize),
        Group::Coordinates { texture, .. } => textures.material_of[(*texture)?],
        Group::Colors(_) | Group::Other => None,
    }
}

fn value(property: Property, corner: usize, document: &Document) -> Corner {
    let index = property.corners[corner] as usize;
    match group(property, document) {
        Group::Colors(colors) => (colors[index], PLAIN.1),
        Group::Coordinates { coordinates, .. } => (PLAIN.0, coordinates[index]),
        Group::Base { .. } | Group::Other => PLAIN,
    }
}

/// Gives all vertices colours and texture coordinates, and splits those whose corners differ.
fn split(mesh: &mut Mesh, corner: impl Fn(usize, usize) -> Corner) {
    let count = mesh.positions.len();
    mesh.colors = vec![PLAIN.0; count];
    mesh.uvs = vec![PLAIN.1; count];
    let vertices = u32::try_from(count).expect("limits keep vertices below 2^32");
    let mut copies = VertexCopies::identity(vertices);
    let mut is_taken = vec![false; count];
    for at in 0..mesh.triangles.len() {
        for number in 0..3 {
            let (color, uv) = corner(at, number);
            let vertex = mesh.triangles[at][number];
            // The first corner of a vertex needs no copy.
            let target = if std::mem::replace(&mut is_taken[vertex as usize], true) {
                let is_same = |copy: usize| mesh.colors[copy] == color && mesh.uvs[copy] == uv;
                let (copy, is_new) = copies.find_or_add(vertex, is_same);
                if is_new {
                    mesh.positions.push(mesh.positions[vertex as usize]);
                    mesh.colors.push(color);
                    mesh.uvs.push(uv);
                }
                copy
            } else {
                mesh.colors[vertex as usize] = color;
                mesh.uvs[vertex as usize] = uv;
                vertex
            };
            mesh.triangles[at][number] = target;
        }
    }
}
