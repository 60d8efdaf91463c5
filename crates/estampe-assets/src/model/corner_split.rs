//! Conversion of corner and face attributes to vertex attributes.

use crate::model::vertex_copies::VertexCopies;
use estampe_scene::{Mesh, Surface};
use glam::Vec2;

/// Attributes per triangle corner; each is empty, or as long as the triangles.
#[derive(Debug)]
pub(super) struct Corners {
    pub(super) uvs: Vec<[Vec2; 3]>,
    pub(super) colors: Vec<[f32; 4]>,
}

/// Creates the mesh's surfaces by texture, and splits vertices whose corners differ.
pub(super) fn split(mesh: &mut Mesh, mut corners: Corners, textures: &[u32], texture_count: usize) {
    let count = mesh.triangles.len();
    if texture_count > 0 && count > 0 {
        mesh.surfaces = if textures.is_empty() {
            vec![Surface {
                material: Some(0),
                triangles: 0..count,
            }]
        } else {
            sort_by_texture(mesh, &mut corners, textures, texture_count)
        };
    }
    if corners.uvs.is_empty() && corners.colors.is_empty() {
        return;
    }
    let vertex_count = mesh.positions.len();
    if !corners.uvs.is_empty() {
        mesh.uvs = vec![Vec2::ZERO; vertex_count];
    }
    if !corners.colors.is_empty() {
        mesh.colors = vec![[1.0; 4]; vertex_count];
    }
    let vertices = u32::try_from(vertex_count).expect("limits keep vertices below 2^32");
    let mut copies = VertexCopies::identity(vertices);
    let mut is_taken = vec![false; vertex_count];
    for index in 0..count {
        let color = corners.colors.get(index).copied();
        for corner in 0..3 {
            let uv = corners.uvs.get(index).map(|uvs| uvs[corner]);
            let vertex = mesh.triangles[index][corner];
            // The first corner of a vertex needs no copy.
            let target = if std::mem::replace(&mut is_taken[vertex as usize], true) {
                let is_same = |copy: usize| {
                    uv.is_none_or(|uv| mesh.uvs[copy] == uv)
                        && color.is_none_or(|color| mesh.colors[copy] == color)
                };
                let (copy, is_new) = copies.find_or_add(vertex, is_same);
                if is_new {
                    append_copy(mesh, vertex as usize);
                }
                copy
            } else {
                vertex
            };
            if let Some(uv) = uv {
                mesh.uvs[target as usize] = uv;
            }
            if let Some(color) = color {
                mesh.colors[target as usize] = color;
            }
            mesh.triangles[index][corner] = target;
        }
    }
}

fn append_copy(mesh: &mut Mesh, vertex: usize) {
    mesh.positions.push(mesh.positions[vertex]);
    if let Some(&normal) = mesh.normals.get(vertex) {
        mesh.normals.push(normal);
    }
    if let Some(&uv) = mesh.uvs.get(vertex) {
        mesh.uvs.push(uv);
    }
    if let Some(&color) = mesh.colors.get(vertex) {
        mesh.colors.push(color);
    }
}

/// Sorts the triangles by texture; one surface each.
fn sort_by_texture(
    mesh: &mut Mesh,
    corners: &mut Corners,
    textures: &[u32],
    texture_count: usize,
) -> Vec<Surface> {
    // A texture that does not exist becomes the first.
    let texture = |index: usize| {
        let number = textures[index] as usize;
        if number < texture_count { number } else { 0 }
    };
    let mut order: Vec<usize> = (0..textures.len()).collect();
    order.sort_by_key(|&index| texture(index));
    mesh.triangles = order.iter().map(|&index| mesh.triangles[index]).collect();
    if !corners.uvs.is_empty() {
        corners.uvs = order.iter().map(|&index| corners.uvs[index]).collect();
    }
    if !corners.colors.is_empty() {
        corners.colors = order.iter().map(|&index| corners.colors[index]).collect();
    }
    let mut surfaces = Vec::new();
    let mut first = 0;
    for run in order.chunk_by(|&a, &b| texture(a) == texture(b)) {
        let triangles = first..first + run.len();
        first = triangles.end;
        surfaces.push(Surface {
            material: Some(texture(run[0])),
            triangles,
        });
    }
    surfaces
}
