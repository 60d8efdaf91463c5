//! The unit space fits models of any size; drawing order and face normals are correct.

use super::faces::{face_normal, normals_oppose_winding};
use super::order::{DistantTriangle, back_to_front};
use super::unit_space::{UnitSpace, UsedVertices, used_vertices};
use estampe_scene::{Mesh, Scene, Workers};
use glam::{DMat3, DVec3, Vec3};

fn scene_of(positions: &[Vec3], points: &[u32]) -> Scene {
    let mesh = Mesh {
        positions: positions.to_vec(),
        points: points.to_vec(),
        ..Mesh::default()
    };
    Scene {
        meshes: vec![mesh],
        ..Scene::default()
    }
}

fn space_of(scene: &Scene) -> UnitSpace {
    let workers = Workers::new(2);
    let meshes = scene.meshes.iter();
    let is_used: Vec<_> = meshes.map(|mesh| used_vertices(mesh, workers)).collect();
    let used = UsedVertices::of_scene(scene, &is_used);
    UnitSpace::new(&used, DMat3::IDENTITY, workers)
}

#[test]
fn models_of_any_size_fill_the_cube() {
    for size in [1.0, 1e30, 1e-30, 3.4e38, 1e-44] {
        let corners = [
            Vec3::new(-size, 0.0, 0.0),
            Vec3::new(size, size, size * 0.5),
        ];
        let scene = scene_of(&corners, &[0, 1]);
        let space = space_of(&scene);
        let a = space.unit_from_object(corners[0]);
        let b = space.unit_from_object(corners[1]);
        assert!(
            (a - Vec3::new(-1.0, -0.5, -0.25)).length() < 0.3,
            "{size:e}: {a}"
        );
        assert!(
            (a.x + 1.0).abs() < 1e-6 && (b.x - 1.0).abs() < 1e-6,
            "{size:e}: {a} {b}"
        );
        let back = space.world_from_unit(b.as_dvec3());
        assert!(
            (back.x / f64::from(size) - 1.0).abs() < 1e-6,
            "{size:e}: {back}"
        );
    }
}

#[test]
fn models_far_from_the_origin_keep_their_precision() {
    let corners = [Vec3::new(1e7, 0.0, 0.0), Vec3::new(1e7 + 4.0, 1.0, 0.0)];
    let space = space_of(&scene_of(&corners, &[0, 1]));
    assert_eq!(space.unit_from_object(corners[0]).x, -1.0);
    assert_eq!(space.unit_from_object(corners[1]).x, 1.0);
}

#[test]
fn unused_and_broken_vertices_do_not_count() {
    let positions = [
        Vec3::ZERO,
        Vec3::ONE,
        Vec3::splat(1e9),
        Vec3::new(f32::NAN, 0.0, 0.0),
        Vec3::new(f32::INFINITY, 0.0, 0.0),
    ];
    let scene = scene_of(&positions, &[0, 1, 3, 4, 99]);
    let is_used = [used_vertices(&scene.meshes[0], Workers::ONE)];
    assert_eq!(is_used[0], [true, true, false, true, true]);
    let used = UsedVertices::of_scene(&scene, &is_used);
    assert_eq!(used[0].positions().count(), 2);
    let space = space_of(&scene);
    assert_eq!(space.unit_from_world(DVec3::ONE), DVec3::ONE);
    let empty = space_of(&Scene::default());
    assert_eq!(empty.unit_from_world(DVec3::ONE), DVec3::ONE);
}

#[test]
fn face_normals_are_unit_at_any_size() {
    for size in [1.0, 1e-38, 3e38] {
        let corners = [Vec3::ZERO, Vec3::X * size, Vec3::Y * size];
        assert_eq!(face_normal(corners), Vec3::Z, "{size:e}");
    }
    assert_eq!(face_normal([Vec3::ONE; 3]), Vec3::ZERO);
    assert_eq!(face_normal([Vec3::NAN, Vec3::X, Vec3::Y]), Vec3::ZERO);
}

#[test]
fn transparent_triangles_go_back_to_front_in_runs() {
    let triangle = |distance: f32, surface: u32, corner: u32| DistantTriangle {
        distance,
        surface,
        corners: [corner; 3],
    };
    let runs = back_to_front(vec![
        triangle(1.0, 0, 1),
        triangle(5.0, 1, 2),
        triangle(4.0, 1, 3),
        triangle(3.0, 0, 4),
        triangle(f32::NAN, 1, 5),
    ]);
    let order: Vec<_> = runs
        .iter()
        .map(|run| (run.surface, run.indices.clone()))
        .collect();
    assert_eq!(
        order,
        [
            (1, vec![5, 5, 5, 2, 2, 2, 3, 3, 3]),
            (0, vec![4, 4, 4, 1, 1, 1])
        ]
    );
    // Two surfaces that alternate ten thousand times are drawn one after the other.
    let many = (0..20_000u16).map(|i| triangle(f32::from(i), u32::from(i % 2), u32::from(i)));
    let runs = back_to_front(many.collect());
    assert_eq!(runs.len(), 2);
    assert_eq!((runs[0].surface, runs[0].indices[0]), (1, 19_999));
    assert_eq!(runs[1].indices.len(), 30_000);
}

#[test]
fn normals_that_contradict_the_winding_are_detected() {
    let mut mesh = Mesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ONE],
        normals: vec![Vec3::Z; 4],
        triangles: vec![[0, 1, 2], [1, 3, 2], [0, 0, 0]],
        ..Mesh::default()
    };
    assert!(!normals_oppose_winding(&mesh));
    for triangle in &mut mesh.triangles {
        triangle.swap(0, 1);
    }
    assert!(normals_oppose_winding(&mesh));
    mesh.normals.clear();
    assert!(!normals_oppose_winding(&mesh));
}
