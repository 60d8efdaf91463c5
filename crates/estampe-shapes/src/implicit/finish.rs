//! From the triangles of all tetrahedra to a mesh: jumps removed, roots improved, normals.

use std::collections::HashMap;

use glam::{DVec3, Vec3};

use super::axis::Axis;
use super::surface::{ImplicitSurface, Vertex};
use crate::mesh::ShapeMesh;

/// The vertices and triangles of all tetrahedra.
#[derive(Debug)]
pub(super) struct Draft {
    pub(super) vertices: Vec<Vertex>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// Tetrahedra that were left out although the surface passes them.
    pub(super) skipped: u64,
}

impl Draft {
    /// Makes the mesh.
    pub(super) fn finish(
        mut self,
        axes: &[Axis; 3],
        function: impl Fn(DVec3) -> f64,
        gradient: impl Fn(DVec3) -> DVec3,
    ) -> ImplicitSurface {
        let jumps = self.vertices.iter().filter(|vertex| vertex.is_jump).count() as u64;
        if jumps > 0 {
            let vertices = &self.vertices;
            let is_jump = |vertex: u32| vertices[vertex as usize].is_jump;
            self.triangles
                .retain(|triangle| !triangle.map(is_jump).contains(&true));
        }
        if jumps + self.skipped > 0 {
            self.split_bow_ties();
            self.remove_unused();
        }
        self.move_to_roots(axes, &function, &gradient);
        let normals = self.normals(gradient);
        let mesh = ShapeMesh {
            name: "implicit".to_owned(),
            positions: self
                .vertices
                .iter()
                .map(|vertex| rounded(vertex.position))
                .collect(),
            normals,
            uvs: Vec::new(),
            triangles: self.triangles,
        };
        ImplicitSurface {
            mesh,
            interruptions: jumps + self.skipped,
        }
    }

    /// Gives each fan of triangles around a vertex a vertex of its own. Where triangles were left
    /// out, two fans may meet in one vertex, like the wings of a bow tie.
    fn split_bow_ties(&mut self) {
        // For each vertex and the next one in a triangle, that triangle's third.
        let mut third_of: HashMap<(u32, u32), u32> = HashMap::new();
        for &[a, b, c] in &self.triangles {
            third_of.extend([((a, b), c), ((b, c), a), ((c, a), b)]);
        }
        // Looked up under the numbers from before the splitting.
        let whole = self.triangles.clone();
        let fans = Fans::of(self.vertices.len(), &whole);
        for vertex in 0..fans.first.len() - 1 {
            let mut corners: Vec<(u32, u8)> = fans.corners(vertex).to_vec();
            let mut is_first_fan = true;
            while let Some(&(triangle, corner)) = corners.first() {
                let here = index(vertex);
                let start = whole[triangle as usize][(usize::from(corner) + 1) % 3];
                // Turn one way around the vertex, and then the other from the start.
                let mut fan = vec![start];
                let mut next = third_of.get(&(here, start)).copied();
                while let Some(at) = next.filter(|at| *at != start) {
                    fan.push(at);
                    next = third_of.get(&(here, at)).copied();
                }
                let is_ring = next == Some(start);
                let mut before = third_of.get(&(start, here)).copied();
                while let Some(at) = before.filter(|_| !is_ring) {
                    fan.push(at);
                    before = third_of.get(&(at, here)).copied();
                }
                let new = if is_first_fan {
                    here
                } else {
                    self.vertices.push(self.vertices[vertex]);
                    index(self.vertices.len() - 1)
                };
                is_first_fan = false;
                let triangles = &mut self.triangles;
                corners.retain(|&(triangle, corner)| {
                    let next = whole[triangle as usize][(usize::from(corner) + 1) % 3];
                    let is_in_fan = fan.contains(&next);
                    if is_in_fan {
                        triangles[triangle as usize][usize::from(corner)] = new;
                    }
                    !is_in_fan
                });
            }
        }
    }

    /// Removes vertices of no triangle.
    fn remove_unused(&mut self) {
        let mut number_of = vec![u32::MAX; self.vertices.len()];
        let mut used = Vec::new();
        for corner in self.triangles.as_flattened_mut() {
            let number = &mut number_of[*corner as usize];
            if *number == u32::MAX {
                *number = index(used.len());
                used.push(self.vertices[*corner as usize]);
            }
            *corner = *number;
        }
        self.vertices = used;
    }

    /// Moves vertices that had to keep their distance from a node onto the surface, by Newton's
    /// method along the gradient, where no triangle around them turns over or loses its extent.
    fn move_to_roots(
        &mut self,
        axes: &[Axis; 3],
        function: impl Fn(DVec3) -> f64,
        gradient: impl Fn(DVec3) -> DVec3,
    ) {
        if !self.vertices.iter().any(|vertex| vertex.is_moved) {
            return;
        }
        let fans = Fans::of(self.vertices.len(), &self.triangles);
        let cell = axes.iter().map(Axis::cell).fold(f64::INFINITY, f64::min);
        for vertex in 0..self.vertices.len() {
            let from = self.vertices[vertex].position;
            if !self.vertices[vertex].is_moved {
                continue;
            }
            // Vertices on the box stay on it.
            let free = DVec3::from_array([0, 1, 2].map(|i| {
                let is_on_box = from[i] == axes[i].low || from[i] == axes[i].high;
                if is_on_box { 0.0 } else { 1.0 }
            }));
            let mut to = from;
            for _ in 0..4 {
                let slope = gradient(to) * free;
                to -= slope * (function(to) / slope.length_squared());
            }
            // A comparison with NaN is false.
            if !(to.distance(from) <= 0.05 * cell && function(to).abs() <= function(from).abs()) {
                continue;
            }
            let face = |triangle: u32, corner: u8, at: DVec3| {
                let mut corners = self.triangles[triangle as usize]
                    .map(|corner| rounded(self.vertices[corner as usize].position).as_dvec3());
                corners[usize::from(corner)] = rounded(at).as_dvec3();
                let [a, b, c] = corners;
                (b - a).cross(c - a)
            };
            let keeps_side = |&(triangle, corner): &(u32, u8)| {
                let (before, after) = (face(triangle, corner, from), face(triangle, corner, to));
                after.dot(before) > 0.5 * after.length() * before.length()
                    && after.length() > 0.1 * before.length()
            };
            if fans.corners(vertex).iter().all(keeps_side) {
                self.vertices[vertex].position = to;
            }
        }
    }

    /// The direction of the gradient at each vertex; where there is none, or it opposes the
    /// triangles around the vertex, as at a crease, their mean normal.
    fn normals(&self, gradient: impl Fn(DVec3) -> DVec3) -> Vec<Vec3> {
        let mut means = vec![DVec3::ZERO; self.vertices.len()];
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|corner| self.vertices[corner as usize].position);
            let face = (b - a).cross(c - a);
            for &corner in triangle {
                means[corner as usize] += face;
            }
        }
        let vertices = self.vertices.iter().zip(means);
        vertices
            .map(|(vertex, mean)| {
                let slope = gradient(vertex.position);
                let largest = slope.abs().max_element();
                let is_usable = largest > 0.0 && slope.is_finite() && slope.dot(mean) > 0.0;
                let normal = if is_usable { slope / largest } else { mean };
                (normal.normalize_or(DVec3::Z) + DVec3::ZERO).as_vec3()
            })
            .collect()
    }
}

/// The position in f32; zero has no sign.
fn rounded(position: DVec3) -> Vec3 {
    (position + DVec3::ZERO).as_vec3()
}

fn index(number: usize) -> u32 {
    u32::try_from(number).expect("a surface has at most 2²³ triangles, and three corners each")
}

/// The triangles around each vertex.
#[derive(Debug)]
struct Fans {
    /// For each vertex the first of its corners; one more at the end.
    first: Vec<usize>,
    /// A triangle and the number of the corner, sorted by vertex.
    corners: Vec<(u32, u8)>,
}

impl Fans {
    fn of(vertices: usize, triangles: &[[u32; 3]]) -> Self {
        let mut first = vec![0; vertices + 1];
        for &corner in triangles.as_flattened() {
            first[corner as usize + 1] += 1;
        }
        for vertex in 0..vertices {
            first[vertex + 1] += first[vertex];
        }
        let mut next = first.clone();
        let mut corners = vec![(0, 0); triangles.len() * 3];
        for (triangle, own) in (0..).zip(triangles) {
            for (corner, &vertex) in (0..).zip(own) {
                corners[next[vertex as usize]] = (triangle, corner);
                next[vertex as usize] += 1;
            }
        }
        Self { first, corners }
    }

    fn corners(&self, vertex: usize) -> &[(u32, u8)] {
        &self.corners[self.first[vertex]..self.first[vertex + 1]]
    }
}
