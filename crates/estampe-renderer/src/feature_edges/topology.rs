//! The edges of a mesh and the faces at them.

use estampe_scene::{Mesh, Workers, pieces};
use glam::{DVec3, Vec3};
use std::collections::HashMap;

/// The faces and edges of a mesh, over vertices of equal positions: files such as STL, and meshes
/// with sharp edges, repeat positions.
#[derive(Debug, Default)]
pub(super) struct Topology {
    /// Different from each other.
    pub(super) positions: Vec<Vec3>,
    /// Triangles over these positions.
    triangles: Vec<[u32; 3]>,
    /// Unit normals of the triangles, zero for those without area.
    pub(super) normals: Vec<DVec3>,
    /// Materials of the triangles.
    pub(super) materials: Vec<Option<usize>>,
    pub(super) edges: Vec<EdgeFaces>,
    /// The faces of all edges.
    faces: Vec<u32>,
}

/// An edge.
#[derive(Debug, Clone, Copy)]
pub(super) struct EdgeFaces {
    /// The lower position first.
    pub(super) ends: [u32; 2],
    /// The range of [`Topology::faces`].
    first: u32,
    count: u32,
    /// The first two faces.
    two: [u32; 2],
    /// True if the first two faces run along the edge in the same direction.
    pub(super) is_turned: bool,
}

impl EdgeFaces {
    /// Up to two of its faces.
    pub(super) fn faces(&self) -> [Option<u32>; 2] {
        [
            (self.count > 0).then_some(self.two[0]),
            (self.count > 1).then_some(self.two[1]),
        ]
    }
}

impl Topology {
    pub(super) fn new(mesh: &Mesh, workers: Workers) -> Self {
        let mut topology = Self::default();
        topology.weld(mesh);
        topology.find_normals(workers);
        topology.find_edges();
        topology
    }

    /// The faces of an edge.
    pub(super) fn faces_at(&self, edge: &EdgeFaces) -> &[u32] {
        &self.faces[edge.first as usize..(edge.first + edge.count) as usize]
    }

    /// The corner of a face that is not on its edge.
    pub(super) fn third_corner(&self, face: u32, ends: [u32; 2]) -> u32 {
        let corners = self.triangles[face as usize];
        { corners.into_iter() }
            .find(|corner| !ends.contains(corner))
            .unwrap_or(corners[0])
    }

    /// The triangles of the mesh's surfaces over positions that differ.
    fn weld(&mut self, mesh: &Mesh) {
        let mut numbers: HashMap<[u32; 3], u32> = HashMap::with_capacity(mesh.positions.len() / 2);
        // −0 is 0.
        let number_of = |position: &Vec3| {
            let bits = (*position + Vec3::ZERO).to_array().map(f32::to_bits);
            *numbers.entry(bits).or_insert_with(|| {
                self.positions.push(*position);
                u32::try_from(self.positions.len() - 1).unwrap_or(u32::MAX)
            })
        };
        let of_vertex: Vec<u32> = mesh.positions.iter().map(number_of).collect();
        let whole = [(None, 0..mesh.triangles.len())];
        let surfaces = mesh.surfaces.iter();
        let named = surfaces.map(|surface| (surface.material, surface.triangles.clone()));
        let runs = whole.into_iter().filter(|_| mesh.surfaces.is_empty());
        for (material, triangles) in runs.chain(named) {
            let end = triangles.end.min(mesh.triangles.len());
            for triangle in &mesh.triangles[triangles.start.min(end)..end] {
                let corners = triangle.map(|corner| of_vertex.get(corner as usize).copied());
                if let [Some(a), Some(b), Some(c)] = corners
                    && a != b
                    && b != c
                    && c != a
                {
                    self.triangles.push([a, b, c]);
                    self.materials.push(material);
                }
            }
        }
    }

    fn find_normals(&mut self, workers: Workers) {
        /// Triangles of a piece: some hundred microseconds of work.
        const PIECE: usize = 1 << 14;
        let normals = workers.map(pieces(self.triangles.len(), PIECE), |range| {
            let normal = |triangle: &[u32; 3]| {
                let [a, b, c] = triangle.map(|corner| self.positions[corner as usize].as_dvec3());
                (b - a).cross(c - a).normalize_or_zero()
            };
            self.triangles[range].iter().map(normal).collect::<Vec<_>>()
        });
        self.normals = normals.concat();
    }

    fn find_edges(&mut self) {
        /// A face at an edge; true if it runs from the higher to the lower position.
        type Side = ([u32; 2], u32, bool);
        let mut sides: Vec<Side> = Vec::with_capacity(self.triangles.len() * 3);
        for (&[a, b, c], face) in self.triangles.iter().zip(0_u32..) {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                sides.push(([from.min(to), from.max(to)], face, from > to));
            }
        }
        sides.sort_unstable();
        for group in sides.chunk_by(|a, b| a.0 == b.0) {
            let first = u32::try_from(self.faces.len()).unwrap_or(u32::MAX);
            self.faces.extend(group.iter().map(|side| side.1));
            let second = group.get(1).unwrap_or(&group[0]);
            self.edges.push(EdgeFaces {
                ends: group[0].0,
                first,
                count: u32::try_from(group.len()).unwrap_or(u32::MAX),
                two: [group[0].1, second.1],
                is_turned: group.len() > 1 && group[0].2 == second.2,
            });
        }
    }
}
