//! Normals for meshes that lack them.
//!
//! ```text
//! meshes -> points   (positions equal to the bit are one point, across all meshes)
//!        -> faces    (unit normal and area of every triangle)
//!        -> sums     (area-weighted, per point: sufficient for a smooth surface)
//!        -> creases  (points whose faces do not all share a normal: a normal per corner)
//!        -> split    (a vertex with several normals becomes several vertices)
//! ```
//!
//! The normal of a corner is the sum of the area-weighted normals of those faces around its point
//! that make no more than the crease angle with the corner's own face. (Rejected: growing groups
//! over shared edges. It rounds a cone's tip and requires edges, which triangle soups lack.)
//!
//! A point is smooth, and needs one sum only, if each face's normal lies within half the crease
//! angle of the sum: any two of them are then within the whole angle. Only the other points pay for
//! comparing pairs. With more than `fan::MAX_PAIRED` faces around a point, faces are first
//! grouped into cells of similar direction, and pairs of cells are compared; so the time is linear
//! in the number of triangles, even if all of them share one vertex.

mod creases;
mod faces;
mod fan;

use super::vertex_copies::VertexCopies;
use super::weld;
use creases::CornerNormals;
use estampe_scene::{Mesh, Workers};
use fan::Grouping;
use glam::Vec3;
use std::borrow::Cow;

/// Rule by which faces share a normal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NormalMode<'a> {
    /// Faces around a point share a normal if they are within an angle of each other.
    CreaseAngle {
        /// The largest angle between the normals of two faces of a smooth surface, in degrees.
        degrees: f32,
    },
    /// No sharing: each triangle has its own normal.
    Flat,
    /// Faces around a point share a normal if they have the same smoothing group, at any angle: one
    /// list per mesh, one number per triangle. Group 0, and triangles beyond a list, are flat.
    SmoothingGroups(&'a [Vec<u32>]),
}

impl Default for NormalMode<'_> {
    /// A crease angle of 40°.
    fn default() -> Self {
        Self::CreaseAngle { degrees: 40.0 }
    }
}

/// Computes the normal of every triangle corner that has none.
///
/// Vertices with a normal keep it. A vertex whose corners need different normals is split: copies
/// of it, with all attributes, are appended. Smoothing crosses the borders of meshes that share
/// positions. Triangles without area get their neighbours' normal, or (0, 0, 0).
pub fn fill_missing(meshes: &mut [Mesh], mode: NormalMode<'_>) {
    fill_missing_by(meshes, mode, Positions::Any, Workers::default());
}

/// Knowledge of the positions of vertices, over all meshes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Positions {
    /// Vertices may have the same position: equal positions are searched for.
    Any,
    /// Each vertex has a position of its own.
    Distinct,
}

/// [`fill_missing`] with these threads.
pub(super) fn fill_missing_by(
    meshes: &mut [Mesh],
    mode: NormalMode<'_>,
    positions: Positions,
    workers: Workers,
) {
    let lacks = |mesh: &Mesh| {
        !mesh.triangles.is_empty()
            && (mesh.normals.is_empty() || mesh.normals.contains(&Vec3::ZERO))
    };
    if !meshes.iter().any(lacks) {
        return;
    }
    // `Mesh` guarantees valid indices; an invalid one is an error in this crate.
    let corner_total: usize = meshes.iter().map(|mesh| mesh.triangles.len() * 3).sum();
    assert!(
        u32::try_from(corner_total).is_ok(),
        "limits keep corners below 2^32"
    );
    let is_missing: Vec<Vec<bool>> = meshes.iter().map(missing_normals).collect();
    let mut corners = corner_normals(meshes, mode, positions, workers);
    if let [mesh] = &mut *meshes
        && mesh.normals.is_empty()
    {
        // The points' normals are in the order of the vertices already.
        mesh.normals = corners.take_vertex_normals();
        split_creased(mesh, |_| true, &corners.of_mesh(0, 0));
        return;
    }
    let mut first_triangle = 0;
    let mut first_vertex = 0;
    for (mesh, is_missing) in meshes.iter_mut().zip(&is_missing) {
        let (triangles, vertices) = (mesh.triangles.len(), mesh.positions.len());
        if triangles > 0 {
            apply(
                mesh,
                is_missing,
                &corners.of_mesh(first_triangle, first_vertex),
            );
        }
        first_triangle += triangles;
        first_vertex += vertices;
    }
}

/// Replaces all normals.
///
/// Equals [`fill_missing`] on meshes without normals; vertices that were split before stay split.
pub fn replace(meshes: &mut [Mesh], mode: NormalMode<'_>) {
    for mesh in &mut *meshes {
        mesh.normals = Vec::new();
    }
    fill_missing(meshes, mode);
}

/// The unit vector in the direction of `vector`, or zero if that is undefined (zero or not finite).
///
/// In f64, where neither the square of the largest f32 overflows nor that of the smallest
/// underflows.
#[must_use]
pub fn unit_or_zero(vector: Vec3) -> Vec3 {
    let wide = vector.as_dvec3();
    let squared = wide.length_squared();
    if squared > 0.0 && squared.is_finite() {
        (wide * (1.0 / squared.sqrt())).as_vec3()
    } else {
        Vec3::ZERO
    }
}

/// Flags of the vertices without a normal; empty if all normals are missing.
fn missing_normals(mesh: &Mesh) -> Vec<bool> {
    mesh.normals
        .iter()
        .map(|&normal| normal == Vec3::ZERO)
        .collect()
}

/// The point of each vertex, over all meshes: the first vertex at its position.
fn weld(meshes: &[Mesh], workers: Workers) -> Vec<u32> {
    let owned: Vec<Vec3>;
    let positions = match meshes {
        [mesh] => mesh.positions.as_slice(),
        _ => {
            owned = meshes
                .iter()
                .flat_map(|mesh| &mesh.positions)
                .copied()
                .collect();
            &owned
        }
    };
    let key = |vertex: usize| weld::key(positions[vertex], 0);
    weld::first_equals(positions.len(), positions.len(), key, workers)
}

fn corner_normals(
    meshes: &[Mesh],
    mode: NormalMode<'_>,
    positions: Positions,
    workers: Workers,
) -> CornerNormals {
    let faces = faces::all(meshes, workers);
    let grouping = match mode {
        NormalMode::Flat => return CornerNormals::flat(&faces),
        NormalMode::CreaseAngle { degrees } => Grouping::by_angle(degrees),
        NormalMode::SmoothingGroups(groups) => Grouping::by_group(meshes, groups),
    };
    let point_of_vertex = match positions {
        Positions::Any => weld(meshes, workers),
        Positions::Distinct => {
            let vertices: usize = meshes.iter().map(|mesh| mesh.positions.len()).sum();
            (0..).take(vertices).collect()
        }
    };
    let triangles = match meshes {
        // All vertices are separate points: the usual mesh without texture coordinates.
        [mesh]
            if (0..)
                .zip(&point_of_vertex)
                .all(|(vertex, &point)| point == vertex) =>
        {
            Cow::Borrowed(mesh.triangles.as_slice())
        }
        _ => Cow::Owned(point_triangles(meshes, &point_of_vertex)),
    };
    CornerNormals::smooth(&triangles, point_of_vertex, &faces, &grouping, workers)
}

/// The triangles of all meshes as triples of points.
fn point_triangles(meshes: &[Mesh], point_of_vertex: &[u32]) -> Vec<[u32; 3]> {
    let mut triangles = Vec::with_capacity(meshes.iter().map(|mesh| mesh.triangles.len()).sum());
    let mut first_vertex = 0;
    for mesh in meshes {
        let points = &point_of_vertex[first_vertex..first_vertex + mesh.positions.len()];
        let of_vertices = |vertices: &[u32; 3]| vertices.map(|vertex| points[vertex as usize]);
        triangles.extend(mesh.triangles.iter().map(of_vertices));
        first_vertex += mesh.positions.len();
    }
    triangles
}

/// Writes the normals into a mesh and splits vertices where necessary.
fn apply(mesh: &mut Mesh, is_missing: &[bool], corners: &creases::MeshNormals<'_>) {
    let vertex_count = mesh.positions.len();
    let is_missing = |vertex: u32| is_missing.get(vertex as usize).copied().unwrap_or(true);
    mesh.normals.resize(vertex_count, Vec3::ZERO);
    // Smooth points first: they need no pass over the triangles.
    if let Some(points) = corners.points(vertex_count) {
        for (vertex, normal) in (0..).zip(&mut mesh.normals) {
            if is_missing(vertex) {
                *normal = corners.normal_of_point(points[vertex as usize]);
            }
        }
    }
    split_creased(mesh, is_missing, corners);
}

/// Writes the normals of corners at points that are not smooth.
fn split_creased(
    mesh: &mut Mesh,
    is_missing: impl Fn(u32) -> bool,
    corners: &creases::MeshNormals<'_>,
) {
    if corners.creased(mesh.triangles.len()).next().is_none() {
        return;
    }
    let vertex_count = mesh.positions.len();
    mesh.normals.resize(vertex_count, Vec3::ZERO);
    let count = u32::try_from(vertex_count).expect("limits keep vertices below 2^32");
    let mut copies = VertexCopies::identity(count);
    // The first normal of a vertex needs no copy.
    let mut is_taken = vec![false; vertex_count];
    for (triangle, corner, normal) in corners.creased(mesh.triangles.len()) {
        let vertex = mesh.triangles[triangle][corner];
        if !is_missing(vertex) {
            continue;
        }
        if !std::mem::replace(&mut is_taken[vertex as usize], true) {
            mesh.normals[vertex as usize] = normal;
            continue;
        }
        let normals = &mesh.normals;
        let is_same = |copy: usize| normals[copy] == normal;
        let (copy, is_new) = copies.find_or_add(vertex, is_same);
        if is_new {
            append_copy(mesh, vertex as usize, normal);
        }
        mesh.triangles[triangle][corner] = copy;
    }
}

fn append_copy(mesh: &mut Mesh, vertex: usize, normal: Vec3) {
    mesh.positions.push(mesh.positions[vertex]);
    mesh.normals.push(normal);
    if let Some(&uv) = mesh.uvs.get(vertex) {
        mesh.uvs.push(uv);
    }
    if let Some(&color) = mesh.colors.get(vertex) {
        mesh.colors.push(color);
    }
    for attribute in &mut mesh.attributes {
        let start = vertex * attribute.components;
        attribute
            .values
            .extend_from_within(start..start + attribute.components);
    }
}
