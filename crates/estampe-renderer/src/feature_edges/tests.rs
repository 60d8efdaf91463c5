//! Feature edges of meshes whose edges are known.

use super::{FeatureEdges, strokes};
use crate::strokes::{Stroke, Window};
use estampe_scene::{Mesh, Surface, Workers};
use glam::{DMat4, DVec2, Vec3};

/// Two squares that share an edge: the second is turned up by an angle, in degrees.
fn folded(angle_deg: f32) -> Mesh {
    let (sin, cos) = (
        libm::sinf(angle_deg.to_radians()),
        libm::cosf(angle_deg.to_radians()),
    );
    let at = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    Mesh {
        positions: vec![
            at(-0.5, -0.5, 0.5),
            at(0.0, -0.5, 0.5),
            at(0.0, 0.5, 0.5),
            at(-0.5, 0.5, 0.5),
            at(0.5 * cos, -0.5, 0.5 - 0.5 * sin),
            at(0.5 * cos, 0.5, 0.5 - 0.5 * sin),
        ],
        triangles: vec![[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]],
        ..Mesh::default()
    }
}

/// The edges from the front: positions are clip coordinates.
fn edges(mesh: &Mesh, angle_deg: f64) -> Vec<Stroke> {
    let window = Window {
        clip_from_unit: DMat4::IDENTITY,
        size_px: DVec2::splat(100.0),
    };
    let options = FeatureEdges {
        angle_deg,
        ..FeatureEdges::default()
    };
    strokes(mesh, &options, |p| p.as_dvec3(), &window, Workers::new(1))
}

#[test]
fn edges_are_sharp_beyond_the_angle() {
    // The border has six edges; the fold is the seventh, and diagonals are none.
    assert_eq!(edges(&folded(20.0), 30.0).len(), 6);
    assert_eq!(edges(&folded(40.0), 30.0).len(), 7);
    assert_eq!(edges(&folded(40.0), 50.0).len(), 6);
    let fold = edges(&folded(40.0), 30.0);
    let is_fold = |stroke: &&Stroke| stroke.faces.iter().all(Option::is_some);
    let fold: Vec<&Stroke> = fold.iter().filter(is_fold).collect();
    assert_eq!(fold.len(), 1);
    assert!(fold[0].ends.iter().all(|end| end.x == 0.0));
}

#[test]
fn equal_positions_are_one_vertex_and_windings_may_differ() {
    let mut mesh = folded(20.0);
    let corners: Vec<u32> = mesh.triangles.iter().flatten().copied().collect();
    mesh.positions = { corners.iter() }
        .map(|&corner| mesh.positions[corner as usize])
        .collect();
    mesh.triangles = vec![[0, 1, 2], [3, 4, 5], [6, 7, 8], [9, 10, 11]];
    assert_eq!(edges(&mesh, 30.0).len(), 6);
    mesh.triangles[1].swap(0, 1);
    assert_eq!(edges(&mesh, 30.0).len(), 6);
}

#[test]
fn borders_of_materials_and_silhouettes_are_edges() {
    let mut mesh = folded(20.0);
    mesh.surfaces = vec![
        Surface {
            material: Some(0),
            triangles: 0..2,
        },
        Surface {
            material: Some(1),
            triangles: 2..4,
        },
    ];
    assert_eq!(edges(&mesh, 30.0).len(), 7);
    // Folded back, both squares are on the same side.
    assert_eq!(edges(&folded(150.0), 170.0).len(), 7);
}

#[test]
fn faces_without_area_and_invalid_ones_make_no_edges() {
    let mut mesh = folded(0.0);
    // The first triangle's diagonal is repeated by a sliver over its middle.
    mesh.positions.push(Vec3::new(-0.25, 0.0, 0.5));
    mesh.triangles[0] = [0, 1, 6];
    mesh.triangles.push([1, 2, 6]);
    mesh.triangles.push([0, 6, 2]);
    mesh.triangles.push([0, 1, 77]);
    mesh.triangles.push([0, 0, 1]);
    assert_eq!(edges(&mesh, 30.0).len(), 6);
}
