//! Feature edges: sharp edges, borders, borders of materials, and silhouettes.
//!
//! ```text
//!   meshes ── topology: edges with the faces at them, over vertices of equal positions
//!               └── kinds: which of them are features, some of them by the view ── strokes
//! ```
//!
//! | edge | is drawn |
//! |---|---|
//! | of one face | always: a border |
//! | of two faces | if their normals differ by more than the angle, or their materials differ |
//! | of two faces on the same side of it in the window | always: a silhouette |
//! | of more faces | if two of them differ by more than the angle |
//!
//! Faces without area have no normal: an edge of such a face is no feature.

mod flat;
mod topology;

#[cfg(test)]
mod tests;

pub(crate) use flat::is_one_face;

use crate::strokes::{Stroke, Window, WindowPoint};
use estampe_scene::{Mesh, Workers};
use glam::{DVec3, Vec3};
use topology::{EdgeFaces, Topology};

/// The edges that are drawn over shaded surfaces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FeatureEdges {
    /// The angle between the normals of two faces, in degrees, beyond which their edge is sharp.
    /// Default 30.
    pub angle_deg: f64,
    /// The width in pixels. `None` (default) is in proportion to the picture.
    pub width_px: Option<f32>,
}

impl Default for FeatureEdges {
    fn default() -> Self {
        Self {
            angle_deg: 30.0,
            width_px: None,
        }
    }
}

/// The length in pixels from which on an edge among many sharp ones is drawn at full strength.
const FULL_LENGTH_PX: f64 = 8.0;
/// The least strength: rough scans become darker, and not black.
const LEAST_STRENGTH: f32 = 0.1;

/// The strokes of a mesh's feature edges. `unit_from_object` maps its positions to the window's
/// unit space.
pub(crate) fn strokes(
    mesh: &Mesh,
    options: &FeatureEdges,
    unit_from_object: impl Fn(Vec3) -> DVec3 + Sync,
    window: &Window,
    workers: Workers,
) -> Vec<Stroke> {
    let topology = Topology::new(mesh, workers);
    let units: Vec<DVec3> = { topology.positions.iter() }
        .map(|&position| unit_from_object(position))
        .collect();
    let points: Vec<Option<WindowPoint>> = units.iter().map(|&unit| window.point(unit)).collect();
    let sharp = Sharpness::new(options.angle_deg);
    let features: Vec<&EdgeFaces> = { topology.edges.iter() }
        .filter(|edge| {
            is_feature(edge, &topology, sharp) || is_silhouette(edge, &topology, &points)
        })
        .collect();
    // The features at each vertex: more than two are corners, or a rough surface.
    let mut degrees = vec![0_u32; units.len()];
    for edge in &features {
        for vertex in edge.ends {
            degrees[vertex as usize] += 1;
        }
    }
    let stroke = |edge: &&EdgeFaces| {
        let [a, b] = edge.ends.map(|vertex| vertex as usize);
        let is_rough = degrees[a] > 2 && degrees[b] > 2;
        let alpha = match (is_rough, points[a], points[b]) {
            (true, Some(from), Some(to)) => strength((to.at_px - from.at_px).length()),
            _ => 1.0,
        };
        let third = |face: u32| units[topology.third_corner(face, edge.ends) as usize];
        Stroke {
            ends: [units[a], units[b]],
            faces: edge.faces().map(|face| face.map(third)),
            alphas: [alpha; 2],
        }
    };
    features.iter().map(stroke).collect()
}

/// The strength of an edge of this length among others.
fn strength(length_px: f64) -> f32 {
    crate::transforms::round_to_f32(length_px / FULL_LENGTH_PX).clamp(LEAST_STRENGTH, 1.0)
}

/// The angle beyond which an edge is sharp, by its cosine.
#[derive(Debug, Clone, Copy)]
struct Sharpness(f64);

impl Sharpness {
    fn new(angle_deg: f64) -> Self {
        Self(libm::cos(angle_deg.clamp(0.0, 180.0).to_radians()))
    }

    fn separates(self, a: DVec3, b: DVec3) -> bool {
        a.dot(b) < self.0
    }
}

/// True if an edge is drawn from every view.
fn is_feature(edge: &EdgeFaces, topology: &Topology, sharp: Sharpness) -> bool {
    let faces = topology.faces_at(edge);
    let normals = || { faces.iter() }.map(|&face| topology.normals[face as usize]);
    if normals().any(|normal| normal == DVec3::ZERO) {
        return false;
    }
    match *faces {
        [] => false,
        [_] => true,
        [a, b] => {
            let [first, second] = [a, b].map(|face| topology.normals[face as usize]);
            // Both faces run along the edge in the same direction if one is turned over.
            let second = second * if edge.is_turned { -1.0 } else { 1.0 };
            let materials = [a, b].map(|face| topology.materials[face as usize]);
            sharp.separates(first, second) || materials[0] != materials[1]
        }
        [first, ..] => {
            let first = topology.normals[first as usize];
            normals()
                .any(|normal| sharp.separates(first, normal) && sharp.separates(first, -normal))
        }
    }
}

/// True if both faces of an edge are on the same side of it in the window.
fn is_silhouette(edge: &EdgeFaces, topology: &Topology, points: &[Option<WindowPoint>]) -> bool {
    let [Some(first), Some(second)] = edge.faces() else {
        return false;
    };
    let at = |vertex: u32| points[vertex as usize].map(|point| point.at_px);
    let [Some(a), Some(b)] = edge.ends.map(at) else {
        return false;
    };
    let side = |face: u32| {
        let third = at(topology.third_corner(face, edge.ends))?;
        Some((b - a).perp_dot(third - a))
    };
    match (side(first), side(second)) {
        (Some(first), Some(second)) => first * second > 0.0,
        _ => false,
    }
}
