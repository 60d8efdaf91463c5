//! The hierarchy: transforms, scenes, instances, cameras, lights.

use super::{Builder, error, load, mesh};
use estampe_assets::model::ModelOptions;
use estampe_scene::{Mesh, Projection, PunctualLightKind};
use glam::Vec3;
use serde_json::json;
use std::f32::consts::{FRAC_1_SQRT_2, FRAC_PI_4, FRAC_PI_6};

/// A quarter turn around z: x becomes y.
const QUARTER: [f32; 4] = [0.0, 0.0, FRAC_1_SQRT_2, FRAC_1_SQRT_2];

fn assert_near(actual: &[Vec3], expected: &[Vec3]) {
    assert_eq!(actual.len(), expected.len());
    for (actual, expected) in actual.iter().zip(expected) {
        assert!(
            (*actual - *expected).length() < 1e-5,
            "{actual} for {expected}"
        );
    }
}

#[test]
fn transforms_of_parents_and_children_are_combined() {
    let file = Builder::triangle().with(
        "/nodes",
        json!([
            { "translation": [10, 0, 0], "rotation": QUARTER, "children": [1] },
            { "scale": [2, 3, 4], "translation": [1, 0, 0], "mesh": 0, "name": "child" },
        ]),
    );
    let mesh = mesh(&file);
    assert_eq!(mesh.name, "child");
    // Child: p ↦ (2x + 1, 3y, 4z); parent: (x, y) ↦ (10 − y, x).
    let expected = [[10.0, 1.0, 0.0], [10.0, 3.0, 0.0], [7.0, 1.0, 0.0]];
    assert_near(&mesh.positions, &expected.map(Vec3::from_array));
}

#[test]
fn a_matrix_is_the_same_as_its_parts() {
    // Columns of a quarter turn around z with scales 2, 3, 4 and a translation.
    let matrix = [
        0.0, 2.0, 0.0, 0.0, -3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 4.0, 0.0, 5.0, 6.0, 7.0, 1.0,
    ];
    let by_matrix = Builder::triangle().with("/nodes/0/matrix", json!(matrix));
    let mut by_parts = Builder::triangle();
    by_parts.set("/nodes/0/scale", json!([2, 3, 4]));
    by_parts.set("/nodes/0/rotation", json!(QUARTER));
    by_parts.set("/nodes/0/translation", json!([5, 6, 7]));
    let expected = [[5.0, 6.0, 7.0], [5.0, 8.0, 7.0], [2.0, 6.0, 7.0]];
    for file in [by_matrix, by_parts] {
        assert_near(&mesh(&file).positions, &expected.map(Vec3::from_array));
    }
}

#[test]
fn normals_and_tangents_stay_perpendicular_and_mirrors_turn_the_winding() {
    let mut file = Builder::triangle();
    let slope = FRAC_1_SQRT_2;
    let normals = file.vec3s(&[[slope, slope, 0.0]; 3]);
    let tangents = file.floats(&[[slope, -slope, 0.0, 1.0]; 3]);
    let attributes = json!({ "POSITION": 0, "NORMAL": normals, "TANGENT": tangents });
    file.set("/meshes/0/primitives/0/attributes", attributes);
    file.set("/nodes/0/scale", json!([2, 1, 1]));
    let scaled = mesh(&file);
    // The inverse transpose halves x: (½, 1) as a unit vector. The tangent is (2, −1).
    let unit = 1.0 / 5.0_f32.sqrt();
    assert_near(&scaled.normals, &[Vec3::new(unit, 2.0 * unit, 0.0); 3]);
    let tangent = &scaled.attribute(Mesh::TANGENT).unwrap().values[..4];
    assert_near(
        &[Vec3::from_slice(tangent)],
        &[Vec3::new(2.0 * unit, -unit, 0.0)],
    );
    assert_eq!((tangent[3], scaled.triangles[0]), (1.0, [0, 1, 2]));

    file.set("/nodes/0/scale", json!([-2, 1, 1]));
    let mirrored = mesh(&file);
    assert_near(&mirrored.normals, &[Vec3::new(-unit, 2.0 * unit, 0.0); 3]);
    assert_eq!(mirrored.triangles, [[0, 2, 1]]);
    assert_eq!(mirrored.attribute(Mesh::TANGENT).unwrap().values[3], -1.0);
}

#[test]
fn scenes_are_chosen() {
    let file = Builder::triangle()
        .with(
            "/nodes",
            json!([{ "mesh": 0, "name": "a" }, { "mesh": 0, "name": "b" }, {}]),
        )
        .with(
            "/scenes",
            json!([{ "nodes": [0], "name": "first" }, { "nodes": [1, 0] }]),
        );
    let names = |file: &Builder, scene| {
        let options = ModelOptions {
            scene,
            ..ModelOptions::default()
        };
        let loaded = file.load_with(&options);
        let names = loaded.scene.meshes.iter().map(|mesh| mesh.name.clone());
        names.collect::<Vec<_>>()
    };
    assert_eq!(names(&file, None), ["a"]);
    assert_eq!(names(&file, Some(1)), ["b", "a"]);
    let second = file.clone().with("/scene", json!(1));
    assert_eq!(names(&second, None), ["b", "a"]);
    assert_eq!(load(&file.glb()).choices.scenes, ["first", ""]);
    // Without scenes all nodes are read.
    let mut without = file;
    without.set("/scenes", json!([]));
    without.json.as_object_mut().unwrap().remove("scene");
    assert_eq!(names(&without, None), ["a", "b"]);
}

#[test]
fn a_hierarchy_may_be_deep() {
    const DEPTH: usize = 100_000;
    let mut nodes: Vec<_> = (1..=DEPTH)
        .map(|child| json!({ "children": [child], "translation": [1, 0, 0] }))
        .collect();
    nodes.push(json!({ "mesh": 0 }));
    let file = Builder::triangle().with("/nodes", json!(nodes));
    assert_eq!(mesh(&file).positions[0], Vec3::X * DEPTH as f32);
}

#[test]
fn hierarchies_that_are_no_trees_are_refused() {
    let nodes = |nodes| error(&Builder::triangle().with("/nodes", nodes));
    let cycle = nodes(json!([{}, { "children": [2] }, { "children": [1] }]));
    assert!(
        cycle.contains("/nodes/1: the node is its own ancestor"),
        "{cycle}"
    );
    let own = nodes(json!([{}, { "children": [1] }]));
    assert!(
        own.contains("/nodes/1: the node is its own ancestor"),
        "{own}"
    );
    let shared = nodes(json!([{ "children": [2] }, { "children": [2] }, {}]));
    assert!(
        shared.contains("/nodes/1/children/0: node 2 is a child of node 0 too"),
        "{shared}"
    );
    let missing = nodes(json!([{ "children": [7] }]));
    assert!(
        missing.contains("/nodes/0/children/0: node 7 does not exist; the file has 1"),
        "{missing}"
    );
    let scene = |scene, count: usize| {
        let nodes = vec![json!({ "children": [] }); count];
        let mut file = Builder::triangle().with("/nodes", json!(nodes));
        if count > 1 {
            file.set("/nodes/0/children", json!([1]));
        }
        error(&file.with("/scenes/0/nodes", scene))
    };
    let inner = scene(json!([1]), 2);
    assert!(
        inner.contains("/scenes/0/nodes/0: node 1 is a child of node 0, not a root"),
        "{inner}"
    );
    let twice = scene(json!([0, 0]), 1);
    assert!(
        twice.contains("/scenes/0/nodes/1: node 0 is in the scene twice"),
        "{twice}"
    );
    let missing = error(&Builder::triangle().with("/scene", json!(3)));
    assert!(
        missing.contains("/scene: scene 3 does not exist; the file has 1"),
        "{missing}"
    );
}

#[test]
fn instances_are_placed() {
    let mut file = Builder::triangle();
    let translations = file.vec3s(&[[0.0, 0.0, 5.0], [10.0, 0.0, 0.0]]);
    let scales = file.vec3s(&[[1.0; 3], [-1.0, 1.0, 1.0]]);
    // Signed bytes, normalized: no turn, and half a turn around z.
    let rotations = file.accessor("VEC4", super::builder::I8, 2, &[0, 0, 0, 127, 0, 0, 127, 0]);
    file.set(&format!("/accessors/{rotations}/normalized"), json!(true));
    let attributes = json!({ "TRANSLATION": translations, "ROTATION": rotations, "SCALE": scales, "_ID": scales });
    file.set(
        "/nodes/0/extensions",
        json!({ "EXT_mesh_gpu_instancing": { "attributes": attributes } }),
    );
    file.set("/nodes/0/translation", json!([0, 100, 0]));
    let placed = mesh(&file);
    let expected = [
        [0.0, 100.0, 5.0],
        [1.0, 100.0, 5.0],
        [0.0, 101.0, 5.0],
        [10.0, 100.0, 0.0],
        [11.0, 100.0, 0.0],
        [10.0, 99.0, 0.0],
    ];
    assert_near(&placed.positions, &expected.map(Vec3::from_array));
    // The second instance is mirrored.
    assert_eq!(placed.triangles, [[0, 1, 2], [3, 5, 4]]);

    let more = file.vec3s(&[[0.0; 3]; 3]);
    let pointer = "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes";
    file.set(&format!("{pointer}/SCALE"), json!(more));
    assert!(error(&file).contains(&format!("{pointer}: the attributes have different numbers")));
}

#[test]
fn cameras_are_in_world_space() {
    let mut file = Builder::triangle();
    file.set(
        "/nodes",
        json!([
            { "mesh": 0, "children": [1, 2] },
            // A quarter turn around y: −z becomes −x.
            { "camera": 0, "translation": [1, 2, 3], "scale": [5, 5, 5], "name": "left",
              "rotation": [0, FRAC_1_SQRT_2, 0, FRAC_1_SQRT_2] },
            { "camera": 1 },
        ]),
    );
    file.set(
        "/cameras",
        json!([
            { "type": "perspective", "perspective": { "yfov": 0.5, "znear": 0.1, "aspectRatio": 1.5 } },
            { "type": "orthographic", "name": "flat",
              "orthographic": { "xmag": 4, "ymag": 2, "znear": 0, "zfar": 9 } },
        ]),
    );
    let [left, flat] = <[_; 2]>::try_from(load(&file.glb()).scene.cameras).unwrap();
    assert_eq!((&*left.name, left.aspect), ("left", Some(1.5)));
    assert_eq!(left.camera.eye_world, Vec3::new(1.0, 2.0, 3.0));
    assert_near(&[left.camera.target_world], &[Vec3::new(0.0, 2.0, 3.0)]);
    assert_near(&[left.camera.up_world], &[Vec3::Y]);
    let infinite = Projection::Perspective {
        fov_y_rad: 0.5,
        near: 0.1,
        far: f32::INFINITY,
    };
    assert_eq!(left.camera.projection, infinite);
    assert_eq!((&*flat.name, flat.aspect), ("flat", Some(2.0)));
    assert_eq!(flat.camera.target_world, Vec3::NEG_Z);
    let projection = Projection::Orthographic {
        half_height: 2.0,
        near: 0.0,
        far: 9.0,
    };
    assert_eq!(flat.camera.projection, projection);

    for (pointer, value, message) in [
        (
            "perspective/yfov",
            json!(0),
            "/cameras/0/perspective/yfov: the angle 0 is not",
        ),
        (
            "perspective/znear",
            json!(0),
            "/cameras/0/perspective/znear: the range from 0",
        ),
        (
            "perspective/zfar",
            json!(0.05),
            "/cameras/0/perspective/znear: the range",
        ),
    ] {
        let error = error(&file.clone().with(&format!("/cameras/0/{pointer}"), value));
        assert!(error.contains(message), "{error}");
    }
    let neither = error(&file.with("/cameras/0", json!({ "type": "perspective" })));
    assert!(
        neither.contains("/cameras/0: the camera has neither"),
        "{neither}"
    );
}

#[test]
fn lights_are_in_world_space() {
    let lights = json!([
        { "type": "directional", "color": [1, 0.5, 0.25], "intensity": 1000, "name": "sun" },
        { "type": "point", "range": 20 },
        { "type": "spot", "spot": { "innerConeAngle": FRAC_PI_6 }, "intensity": 7 },
    ]);
    let place = |light: u32| json!({ "KHR_lights_punctual": { "light": light } });
    let mut file = Builder::triangle();
    file.set(
        "/extensions",
        json!({ "KHR_lights_punctual": { "lights": lights } }),
    );
    file.set("/extensionsUsed", json!(["KHR_lights_punctual"]));
    file.set(
        "/nodes",
        json!([
            { "mesh": 0, "children": [1, 2, 3], "translation": [0, 5, 0], "name": "root" },
            { "extensions": place(0), "rotation": [-FRAC_1_SQRT_2, 0, 0, FRAC_1_SQRT_2] },
            { "extensions": place(1), "name": "bulb" },
            { "extensions": place(2), "translation": [1, 0, 0] },
        ]),
    );
    let loaded = load(&file.glb());
    assert_eq!(loaded.warnings, []);
    let [sun, bulb, spot] = <[_; 3]>::try_from(loaded.scene.lights).unwrap();
    assert_eq!((&*sun.name, sun.intensity), ("sun", 1000.0));
    assert_eq!(sun.color, Vec3::new(1.0, 0.5, 0.25));
    let PunctualLightKind::Directional { direction_world } = sun.kind else {
        panic!("{sun:?}")
    };
    // −z turned around x by a quarter: downwards.
    assert_near(&[direction_world], &[Vec3::NEG_Y]);
    assert_eq!((&*bulb.name, bulb.color), ("bulb", Vec3::ONE));
    let position_world = Vec3::new(0.0, 5.0, 0.0);
    let range = Some(20.0);
    assert_eq!(
        bulb.kind,
        PunctualLightKind::Point {
            position_world,
            range
        }
    );
    let expected = PunctualLightKind::Spot {
        position_world: Vec3::new(1.0, 5.0, 0.0),
        direction_world: Vec3::NEG_Z,
        range: None,
        inner_cone_rad: FRAC_PI_6,
        outer_cone_rad: FRAC_PI_4,
    };
    assert_eq!((spot.kind, spot.intensity), (expected, 7.0));

    let base = "/extensions/KHR_lights_punctual/lights";
    let narrow = file
        .clone()
        .with(&format!("{base}/2/spot/innerConeAngle"), json!(1));
    let message = format!("{base}/2/spot: the cone's angles 1 and 0.785");
    assert!(error(&narrow).contains(&message));
    let unknown = load(
        &file
            .clone()
            .with(&format!("{base}/0/type"), json!("laser"))
            .glb(),
    );
    assert_eq!(unknown.scene.lights.len(), 2);
    let warning = unknown.warnings[0].to_string();
    assert!(
        warning.contains("`laser` is not one of directional"),
        "{warning}"
    );
    let missing = error(&file.with("/nodes/1/extensions", place(3)));
    assert!(
        missing.contains("light 3 does not exist; the file has 3"),
        "{missing}"
    );
}

/// Nodes of the scene alone count, from its roots on.
#[test]
fn the_tree_has_depths_and_what_is_at_its_nodes() {
    let mut file = Builder::triangle();
    file.set(
        "/cameras",
        json!([{ "type": "orthographic",
        "orthographic": { "xmag": 1, "ymag": 1, "znear": 0, "zfar": 1 } }]),
    );
    file.set(
        "/nodes",
        json!([
            { "name": "a", "children": [2, 1] },
            { "name": "b", "mesh": 0 },
            { "name": "c", "children": [3] },
            { "name": "d", "camera": 0 },
            { "name": "elsewhere" },
        ]),
    );
    let contents = file.load_with(&ModelOptions::default()).contents;
    let shown = contents
        .nodes
        .iter()
        .map(|node| (&*node.name, node.depth, node.instances));
    let shown: Vec<_> = shown.collect();
    assert_eq!(shown, [("a", 0, 0), ("c", 1, 0), ("d", 2, 0), ("b", 1, 1)]);
    assert!(contents.nodes[2].has_camera && !contents.nodes[0].has_camera);
    assert_eq!(contents.nodes[3].mesh.as_deref(), Some(""));
    assert_eq!(contents.has_made_normals, [true]);
}
