//! The part of a mesh on the side of a plane that is kept.

use super::HalfSpace;
use crate::transforms::round_to_f32;
use estampe_scene::{Mesh, MeshAttribute, Surface};
use glam::Vec3;
use std::collections::HashMap;

/// The mesh without what the plane cuts away. Vertices keep their numbers, and those of cut edges
/// follow; triangles with positions that are not finite are left out.
pub(super) fn clip(mesh: &Mesh, plane: &HalfSpace) -> Mesh {
    let distances = mesh.positions.iter().map(|&p| plane.distance(p)).collect();
    let mut cut = CutMesh {
        plane,
        of: mesh,
        distances,
        vertices: Mesh {
            name: mesh.name.clone(),
            positions: mesh.positions.clone(),
            normals: mesh.normals.clone(),
            uvs: mesh.uvs.clone(),
            colors: mesh.colors.clone(),
            attributes: mesh.attributes.clone(),
            ..Mesh::default()
        },
        vertex_of_edge: HashMap::new(),
    };
    let whole = [Surface {
        material: None,
        triangles: 0..mesh.triangles.len(),
    }];
    let surfaces = if mesh.surfaces.is_empty() {
        &whole[..]
    } else {
        &mesh.surfaces
    };
    for surface in surfaces {
        let end = surface.triangles.end.min(mesh.triangles.len());
        let first = cut.vertices.triangles.len();
        for triangle in &mesh.triangles[surface.triangles.start.min(end)..end] {
            cut.triangle(*triangle);
        }
        cut.vertices.surfaces.push(Surface {
            material: surface.material,
            triangles: first..cut.vertices.triangles.len(),
        });
    }
    for line in &mesh.lines {
        cut.line(*line);
    }
    let points = mesh.points.iter().copied();
    let points = points.filter(|&point| cut.is_kept(point) == Some(true));
    let points = points.collect();
    Mesh {
        points,
        ..cut.vertices
    }
}

/// A mesh that is being cut.
struct CutMesh<'a> {
    plane: &'a HalfSpace,
    of: &'a Mesh,
    /// Of each vertex.
    distances: Vec<f64>,
    /// The vertices, old and new, and the primitives that are complete.
    vertices: Mesh,
    vertex_of_edge: HashMap<[u32; 2], u32>,
}

impl CutMesh<'_> {
    /// True if a vertex is kept; `None` if there is no such vertex, or nowhere.
    fn is_kept(&self, vertex: u32) -> Option<bool> {
        let distance = *self.distances.get(vertex as usize)?;
        distance.is_finite().then_some(distance < 0.0)
    }

    fn triangle(&mut self, triangle: [u32; 3]) {
        let [Some(a), Some(b), Some(c)] = triangle.map(|corner| self.is_kept(corner)) else {
            return;
        };
        let kept = [a, b, c];
        if kept == [true; 3] {
            self.vertices.triangles.push(triangle);
        } else if kept != [false; 3] {
            let mut polygon = Vec::with_capacity(4);
            for corner in 0..3 {
                let next = (corner + 1) % 3;
                if kept[corner] {
                    polygon.push(triangle[corner]);
                }
                if kept[corner] != kept[next] {
                    polygon.push(self.vertex_between(triangle[corner], triangle[next]));
                }
            }
            let fan = (2..polygon.len()).map(|k| [polygon[0], polygon[k - 1], polygon[k]]);
            self.vertices.triangles.extend(fan);
        }
    }

    fn line(&mut self, [a, b]: [u32; 2]) {
        let line = match (self.is_kept(a), self.is_kept(b)) {
            (Some(true), Some(true)) => [a, b],
            (Some(true), Some(false)) => [a, self.vertex_between(a, b)],
            (Some(false), Some(true)) => [self.vertex_between(a, b), b],
            _ => return,
        };
        self.vertices.lines.push(line);
    }

    /// The vertex at which the plane crosses an edge, with interpolated attributes.
    fn vertex_between(&mut self, a: u32, b: u32) -> u32 {
        let (a, b) = (a.min(b), a.max(b));
        if let Some(&vertex) = self.vertex_of_edge.get(&[a, b]) {
            return vertex;
        }
        let (p, q) = (a as usize, b as usize);
        let positions = &self.of.positions;
        let (position, share) = self.plane.crossing(positions[p], positions[q]);
        let share = round_to_f32(share);
        let made = &mut self.vertices;
        // An index that does not fit is out of range, and such triangles are left out.
        let vertex = u32::try_from(made.positions.len()).unwrap_or(u32::MAX);
        made.positions.push(position);
        if let (Some(&a), Some(&b)) = (self.of.normals.get(p), self.of.normals.get(q)) {
            made.normals.push(blended(a, b, share).normalize_or_zero());
        }
        if let (Some(&a), Some(&b)) = (self.of.uvs.get(p), self.of.uvs.get(q)) {
            made.uvs.push(a + (b - a) * share);
        }
        if let (Some(a), Some(b)) = (self.of.colors.get(p), self.of.colors.get(q)) {
            let channel = |k: usize| a[k] + (b[k] - a[k]) * share;
            made.colors.push(std::array::from_fn(channel));
        }
        for (made, of) in made.attributes.iter_mut().zip(&self.of.attributes) {
            extend(made, of, (p, q), share);
        }
        self.vertex_of_edge.insert([a, b], vertex);
        vertex
    }
}

fn blended(a: Vec3, b: Vec3, share: f32) -> Vec3 {
    a + (b - a) * share
}

/// Adds the value between two vertices to an attribute.
fn extend(made: &mut MeshAttribute, of: &MeshAttribute, (p, q): (usize, usize), share: f32) {
    for component in 0..of.components {
        let at = |vertex: usize| of.values.get(vertex * of.components + component);
        if let (Some(a), Some(b)) = (at(p), at(q)) {
            // The sign of a tangent's bitangent is that of one of the vertices.
            let is_sign = of.name == Mesh::TANGENT && component == 3;
            made.values
                .push(if is_sign { *a } else { a + (b - a) * share });
        }
    }
}
