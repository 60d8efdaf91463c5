//! Poles and seams of a grid: vertices that are the same point but for rounding.

use glam::DVec3;

use super::draft::Vertex;
use crate::continuity::is_defined;

/// Distance, relative to the surface's extent, up to which vertices are the same point: far above
/// the rounding errors of f64, far below those of f32.
const SAME: f64 = 1e-9;

/// Cosine of normals up to which two sides of a seam are one smooth surface: 0.8°.
const SMOOTH_COSINE: f64 = 0.9999;

/// The vertices that coincide, after [`close`] has given them equal positions.
#[derive(Debug)]
pub(super) struct Closed {
    columns: usize,
    /// For each vertex the first one that is the same point of the same smooth surface.
    first_of: Vec<u32>,
    /// Rows that are a single point.
    is_pole_row: Vec<bool>,
}

impl Closed {
    /// The vertex that stands for the one in this column and row.
    pub(super) fn joined(&self, column: usize, row: usize) -> u32 {
        self.first_of[row * self.columns + column]
    }

    /// Moves u at the first and last row, if it is a pole, to the middle of the cell that uses the
    /// vertex, so that images are not sheared there. The triangle below a pole uses the cell's
    /// right vertex, the one above it the left.
    pub(super) fn move_pole_uvs(&self, vertices: &mut [Vertex], [cells_s, cells_t]: [u32; 2]) {
        let half = 0.5 / cells_s as f32;
        for (row, shift) in [(0, half), (cells_t as usize, -half)] {
            if self.is_pole_row[row] {
                for vertex in &mut vertices[row * self.columns..][..self.columns] {
                    vertex.uv.x = (vertex.uv.x + shift).clamp(0.0, 1.0);
                }
            }
        }
    }
}

/// Finds poles and seams, and gives their vertices equal positions, and equal normals where they
/// nearly agree.
pub(super) fn close(vertices: &mut [Vertex], [cells_s, cells_t]: [u32; 2]) -> Closed {
    let (columns, rows) = (cells_s as usize + 1, cells_t as usize + 1);
    let defined = || {
        let positions = vertices.iter().map(|vertex| vertex.position);
        positions.filter(|position| is_defined(*position))
    };
    let low = defined().reduce(DVec3::min).unwrap_or_default();
    let high = defined().reduce(DVec3::max).unwrap_or_default();
    let tolerance = SAME * (high - low).length();
    let number = |column: usize, row: usize| row * columns + column;

    let mut is_pole_row = Vec::with_capacity(rows);
    let mut first_of: Vec<u32> = (0..).take(vertices.len()).collect();
    for row in 0..rows {
        let line: Vec<usize> = (0..columns).map(|column| number(column, row)).collect();
        is_pole_row.push(collapse(vertices, &line, tolerance, &mut first_of));
    }
    for column in 0..columns {
        let line: Vec<usize> = (0..rows).map(|row| number(column, row)).collect();
        collapse(vertices, &line, tolerance, &mut first_of);
    }
    let sides: Vec<_> = (0..rows)
        .map(|row| (number(0, row), number(columns - 1, row)))
        .collect();
    merge(vertices, &sides, tolerance, &mut first_of);
    let ends: Vec<_> = (0..columns)
        .map(|column| (number(column, 0), number(column, rows - 1)))
        .collect();
    merge(vertices, &ends, tolerance, &mut first_of);

    // A vertex may stand for others and be replaced itself: follow to the last one.
    for vertex in 0..first_of.len() {
        let mut first = first_of[vertex];
        while first_of[first as usize] != first {
            first = first_of[first as usize];
        }
        first_of[vertex] = first;
    }
    Closed {
        columns,
        first_of,
        is_pole_row,
    }
}

/// If a row or column is a single point, makes it exactly one; returns true if it is.
fn collapse(vertices: &mut [Vertex], line: &[usize], tolerance: f64, first_of: &mut [u32]) -> bool {
    let first = vertices[line[0]];
    let is_same = |&at: &usize| vertices[at].position.distance(first.position) <= tolerance;
    if !is_defined(first.position) || !line.iter().all(is_same) {
        return false;
    }
    for &at in line {
        unite(vertices, line[0], at, first_of);
    }
    true
}

/// If two borders coincide, makes them exactly equal.
fn merge(vertices: &mut [Vertex], pairs: &[(usize, usize)], tolerance: f64, first_of: &mut [u32]) {
    let is_same = |&(a, b): &(usize, usize)| {
        let [a, b] = [a, b].map(|at| vertices[at].position);
        a.distance(b) <= tolerance || !is_defined(a) && !is_defined(b)
    };
    if pairs.iter().all(is_same) {
        for &(a, b) in pairs {
            unite(vertices, a, b, first_of);
        }
    }
}

/// Gives a vertex the position of another, and its normal if it nearly agrees.
fn unite(vertices: &mut [Vertex], first: usize, other: usize, first_of: &mut [u32]) {
    let (position, normal) = (vertices[first].position, vertices[first].normal);
    vertices[other].position = position;
    let other_normal = vertices[other].normal;
    let is_unknown = normal == DVec3::ZERO || other_normal == DVec3::ZERO;
    if is_unknown || normal.dot(other_normal) > SMOOTH_COSINE {
        let normal = if normal == DVec3::ZERO {
            other_normal
        } else {
            normal
        };
        (vertices[first].normal, vertices[other].normal) = (normal, normal);
        let (mut root, mut leaf) = (first, other);
        // The first of each group, so that there are no circles.
        for vertex in [&mut root, &mut leaf] {
            while first_of[*vertex] as usize != *vertex {
                *vertex = first_of[*vertex] as usize;
            }
        }
        let (low, high) = (root.min(leaf), root.max(leaf));
        first_of[high] = first_of[low];
    }
}
