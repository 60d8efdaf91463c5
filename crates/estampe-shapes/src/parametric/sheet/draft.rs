//! The vertices and triangles of a sheet before they become a mesh.

use std::cell::Cell;

use glam::{DVec3, Vec2};

use super::seams::{Closed, close};
use super::{Grid, Seams};
use crate::continuity::{SEARCH_BUDGET, Sample, find_break, is_defined};
use crate::mesh::ShapeMesh;
use crate::parametric::MAX_CELLS;
use crate::parametric::grid::between;
use crate::parametric::jet::SurfaceJet;

/// A vertex; its parameters are fractions of the ranges, 0 to 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vertex {
    pub(super) at: [f64; 2],
    pub(super) position: DVec3,
    /// Zero if the derivatives do not tell it.
    pub(super) normal: DVec3,
    pub(super) uv: Vec2,
    /// The parameters from which a cut along an edge came here.
    pub(super) cut_from: Option<[f64; 2]>,
}

/// Fractions of a range or edge at which a normal is tried that does not exist at a vertex itself.
pub(super) const NEARBY: [f64; 4] = [1e-9, 1e-6, 1e-4, 1e-3];

/// A sheet in the making.
pub(crate) struct Draft<F> {
    grid: Grid,
    point: F,
    pub(super) vertices: Vec<Vertex>,
    pub(super) triangles: Vec<[u32; 3]>,
}

/// Edges of a cell that cross a jump.
#[derive(Clone, Copy, Debug, Default)]
struct BrokenEdges {
    bottom: bool,
    left: bool,
    diagonal: bool,
}

impl<F: Fn(f64, f64) -> SurfaceJet> Draft<F> {
    /// Samples the grid and connects it.
    pub(crate) fn new(grid: &Grid, point: F) -> Self {
        let mut draft = Self {
            grid: Grid {
                cells: grid.cells.map(|count| count.clamp(1, MAX_CELLS)),
                ..grid.clone()
            },
            point,
            vertices: Vec::new(),
            triangles: Vec::new(),
        };
        let broken = draft.sample();
        let closed = close(&mut draft.vertices, draft.grid.cells);
        draft.connect(&broken, &closed);
        draft
    }

    /// The surface at fractions of the ranges, with derivatives by these fractions.
    pub(super) fn jet(&self, [u, v]: [f64; 2]) -> SurfaceJet {
        let (s, t) = (&self.grid.s, &self.grid.t);
        let mix = |range: &std::ops::Range<f64>, f: f64| range.start * (1.0 - f) + range.end * f;
        (self.point)(mix(s, u), mix(t, v)).per_step(s.end - s.start, t.end - t.start)
    }

    /// The surface at a vertex of the grid.
    fn grid_jet(&self, i: u32, j: u32) -> SurfaceJet {
        let (s, t) = (&self.grid.s, &self.grid.t);
        let [cells_s, cells_t] = self.grid.cells;
        (self.point)(between(s, i, cells_s), between(t, j, cells_t))
            .per_step(s.end - s.start, t.end - t.start)
    }

    /// A vertex of the surface.
    pub(super) fn vertex(&self, at: [f64; 2], jet: &SurfaceJet) -> Vertex {
        let [u, v] = at;
        Vertex {
            at,
            position: jet.position,
            normal: self.normal(at, jet),
            uv: glam::DVec2::new(u, 1.0 - v).as_vec2(),
            cut_from: None,
        }
    }

    /// The normal; zero if neither the derivatives here nor those nearby tell it.
    fn normal(&self, at: [f64; 2], jet: &SurfaceJet) -> DVec3 {
        if !is_defined(jet.position) {
            return DVec3::ZERO;
        }
        // Into the grid, whichever border the vertex is on.
        let towards = at.map(|f| if f < 0.5 { 1.0 } else { -1.0 });
        let near = |step: f64| {
            let moved = [at[0] + step * towards[0], at[1] + step * towards[1]];
            self.jet(moved).normal(towards)
        };
        // Nearby where derivatives are infinite, or even the second ones vanish, as at the tip of
        // (t³ cos s, t³ sin s, t⁴).
        jet.normal(towards)
            .or_else(|| NEARBY.into_iter().find_map(near))
            .unwrap_or(DVec3::ZERO)
    }

    /// Samples all vertices, row by row; returns the broken edges of each cell, and of a last row
    /// and column of which only the bottom and left edges exist.
    fn sample(&mut self) -> Vec<BrokenEdges> {
        let [cells_s, cells_t] = self.grid.cells;
        let columns = cells_s as usize + 1;
        let budget = Cell::new(SEARCH_BUDGET);
        let mut broken = Vec::with_capacity(columns * (cells_t as usize + 1));
        let mut below: Vec<SurfaceJet> = (0..=cells_s).map(|i| self.grid_jet(i, 0)).collect();
        for j in 0..=cells_t {
            let at = |i: u32, j: u32| {
                [(i, cells_s), (j, cells_t)].map(|(step, of)| f64::from(step) / f64::from(of))
            };
            for (i, jet) in (0..=cells_s).zip(&below) {
                let vertex = self.vertex(at(i, j), jet);
                self.vertices.push(vertex);
            }
            let above: Vec<SurfaceJet> = if j < cells_t {
                (0..=cells_s).map(|i| self.grid_jet(i, j + 1)).collect()
            } else {
                Vec::new()
            };
            for i in 0..=cells_s {
                let here = (at(i, j), &below[i as usize]);
                let to = |i: u32, j: u32, row: &[SurfaceJet]| {
                    let jet = row.get(i as usize);
                    jet.is_some_and(|jet| self.is_broken(here, (at(i, j), jet), &budget))
                };
                broken.push(BrokenEdges {
                    bottom: to(i + 1, j, &below),
                    left: to(i, j + 1, &above),
                    diagonal: to(i + 1, j + 1, &above),
                });
            }
            below = above;
        }
        broken
    }

    /// True if the surface jumps between two vertices at which it is defined.
    fn is_broken(
        &self,
        (from, first): ([f64; 2], &SurfaceJet),
        (to, last): ([f64; 2], &SurfaceJet),
        budget: &Cell<u64>,
    ) -> bool {
        let (du, dv) = (to[0] - from[0], to[1] - from[1]);
        let sample = |jet: &SurfaceJet| Sample {
            position: jet.position,
            slope: jet.s * du + jet.t * dv,
        };
        let (first, last) = (sample(first), sample(last));
        let between = |f: f64| sample(&self.jet([from[0] + f * du, from[1] + f * dv]));
        first.is_defined()
            && last.is_defined()
            && find_break(between, (0.0, first), (1.0, last), budget).is_some()
    }

    /// Makes the triangles of all cells.
    fn connect(&mut self, broken: &[BrokenEdges], closed: &Closed) {
        let [cells_s, cells_t] = self.grid.cells;
        let columns = cells_s as usize + 1;
        for j in 0..cells_t as usize {
            for i in 0..cells_s as usize {
                let number = |i: usize, j: usize| j * columns + i;
                let here = broken[number(i, j)];
                let (right, top) = (
                    broken[number(i + 1, j)].left,
                    broken[number(i, j + 1)].bottom,
                );
                let vertex = |i: usize, j: usize| match self.grid.seams {
                    Seams::Split => index(number(i, j)),
                    Seams::Joined => closed.joined(i, j),
                };
                let (p00, p10) = (vertex(i, j), vertex(i + 1, j));
                let (p01, p11) = (vertex(i, j + 1), vertex(i + 1, j + 1));
                if !(here.bottom || right || here.diagonal) {
                    self.triangles.push([p00, p10, p11]);
                }
                if !(here.diagonal || top || here.left) {
                    self.triangles.push([p00, p11, p01]);
                }
            }
        }
        if self.grid.seams == Seams::Split {
            closed.move_pole_uvs(&mut self.vertices, self.grid.cells);
        }
    }

    /// The mesh: its used vertices in f32, without triangles of which two corners coincide.
    pub(crate) fn into_mesh(self, name: &str) -> ShapeMesh {
        let mut mesh = ShapeMesh::named(name);
        let mut mean_normals: Vec<DVec3> = Vec::new();
        let mut number_of: Vec<u32> = vec![u32::MAX; self.vertices.len()];
        for triangle in &self.triangles {
            let corners = triangle.map(|corner| &self.vertices[corner as usize]);
            if corners.iter().any(|corner| !is_defined(corner.position)) {
                continue;
            }
            let [a, b, c] = corners.map(|corner| corner.position.as_vec3());
            if a == b || b == c || c == a {
                continue;
            }
            let [p, q, r] = corners.map(|corner| corner.position);
            let face = (q - p).cross(r - p);
            let numbers = triangle.map(|corner| {
                let number = &mut number_of[corner as usize];
                if *number == u32::MAX {
                    let vertex = &self.vertices[corner as usize];
                    // Adding zero turns −0 into 0.
                    let position = (vertex.position + DVec3::ZERO).as_vec3();
                    let normal = (vertex.normal + DVec3::ZERO).as_vec3();
                    *number = mesh.push_vertex(position, normal, vertex.uv);
                    mean_normals.push(DVec3::ZERO);
                }
                mean_normals[*number as usize] += face;
                *number
            });
            mesh.triangles.push(numbers);
        }
        for (normal, mean) in mesh.normals.iter_mut().zip(mean_normals) {
            if *normal == glam::Vec3::ZERO {
                *normal = mean.normalize_or(DVec3::Z).as_vec3();
            }
        }
        if self.grid.seams == Seams::Joined {
            mesh.uvs.clear();
        }
        mesh
    }
}

fn index(number: usize) -> u32 {
    u32::try_from(number).expect("grids are limited to 2²³ vertices")
}
