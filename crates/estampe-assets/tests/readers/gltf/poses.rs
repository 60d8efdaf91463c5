//! Animations, morph targets and skins.

use super::builder::{U8, U16};
use super::{Builder, error, load, mesh};
use estampe_assets::model::{AnimationName, ModelOptions};
use estampe_scene::Mesh;
use glam::{Vec2, Vec3};
use serde_json::{Value, json};
use std::f32::consts::FRAC_1_SQRT_2;

fn at_time(time_s: f32) -> ModelOptions {
    ModelOptions {
        animation: Some(AnimationName::Index(0)),
        time_s,
        ..ModelOptions::default()
    }
}

/// A triangle whose node has one animated property; `output` is the accessor of its values.
fn animated(path: &str, times: &[f32], interpolation: Option<&str>) -> Builder {
    let mut file = Builder::triangle();
    let input = file.scalars(times);
    let mut sampler = json!({ "input": input, "output": input + 1 });
    if let Some(name) = interpolation {
        sampler["interpolation"] = json!(name);
    }
    let channel = json!({ "sampler": 0, "target": { "node": 0, "path": path } });
    let animation = json!({ "name": "move", "channels": [channel], "samplers": [sampler] });
    file.set("/animations", json!([animation]));
    file
}

fn first_position(file: &Builder, time_s: f32) -> Vec3 {
    file.load_with(&at_time(time_s)).scene.meshes[0].positions[0]
}

#[test]
fn steps_hold_their_value() {
    let mut file = animated("translation", &[1.0, 2.0, 4.0], Some("STEP"));
    file.vec3s(&[[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [4.0, 0.0, 0.0]]);
    for (time, x) in [
        (0.0, 1.0),
        (1.0, 1.0),
        (1.9, 1.0),
        (2.0, 2.0),
        (4.0, 4.0),
        (9.0, 4.0),
    ] {
        assert_eq!(first_position(&file, time), Vec3::X * x, "{time}");
    }
    assert_eq!(first_position(&file, f32::NAN), Vec3::X);
    // Without an animation the node stays where it is.
    assert_eq!(mesh(&file).positions[0], Vec3::ZERO);
    let choices = load(&file.glb()).choices;
    assert_eq!(
        (
            &*choices.animations[0].name,
            choices.animations[0].duration_s
        ),
        ("move", 4.0)
    );
}

#[test]
fn vectors_are_interpolated_linearly() {
    let mut file = animated("translation", &[1.0, 3.0], None);
    file.vec3s(&[[0.0, 8.0, 0.0], [4.0, 0.0, 0.0]]);
    assert_eq!(first_position(&file, 1.5), Vec3::new(1.0, 6.0, 0.0));
    let mut file = animated("scale", &[0.0, 1.0], Some("LINEAR"));
    file.vec3s(&[[1.0; 3], [3.0; 3]]);
    let loaded = file.load_with(&at_time(0.5));
    assert_eq!(loaded.scene.meshes[0].positions[1], Vec3::X * 2.0);
}

#[test]
fn rotations_follow_the_shorter_arc() {
    let half = |degrees: f32| degrees.to_radians() / 2.0;
    let turn = |degrees: f32, sign: f32| {
        let (sin, cos) = (libm::sinf(half(degrees)), libm::cosf(half(degrees)));
        [0.0, 0.0, sin * sign, cos * sign]
    };
    // The second file has the negative quaternion, which is the same rotation.
    for sign in [1.0, -1.0] {
        let mut file = animated("rotation", &[0.0, 1.0], None);
        file.floats(&[turn(0.0, 1.0), turn(90.0, sign)]);
        for time in [0.0_f32, 0.25, 0.5, 1.0] {
            let loaded = file.load_with(&at_time(time));
            let x = loaded.scene.meshes[0].positions[1];
            let angle = (90.0 * time).to_radians();
            let expected = Vec3::new(libm::cosf(angle), libm::sinf(angle), 0.0);
            assert!((x - expected).length() < 1e-6, "{time}: {x}");
        }
    }
}

#[test]
fn splines_have_tangents() {
    // Times 0 and 2: value 0 leaving with slope 3, value 10 arriving with slope −1.
    let mut file = animated("translation", &[0.0, 2.0], Some("CUBICSPLINE"));
    let x = |x: f32| [x, 0.0, 0.0];
    file.vec3s(&[x(99.0), x(0.0), x(3.0), x(-1.0), x(10.0), x(99.0)]);
    let hermite = |t: f32| {
        let (t2, t3) = (t * t, t * t * t);
        2.0 * (t3 - 2.0 * t2 + t) * 3.0 + (3.0 * t2 - 2.0 * t3) * 10.0 - 2.0 * (t3 - t2)
    };
    for time in [0.0, 0.5, 1.0, 1.5, 2.0, 5.0] {
        let expected = hermite((time / 2.0_f32).min(1.0));
        let actual = first_position(&file, time);
        assert!(
            (actual - Vec3::X * expected).length() < 1e-5,
            "{time}: {actual}"
        );
    }
    // Rotations are made unit: between 0 and 180° around z without tangents, half-way is 90°.
    let mut file = animated("rotation", &[0.0, 1.0], Some("CUBICSPLINE"));
    let none = [0.0; 4];
    file.floats(&[
        none,
        [0.0, 0.0, 0.0, 1.0],
        none,
        none,
        [0.0, 0.0, 1.0, 0.0],
        none,
    ]);
    let loaded = file.load_with(&at_time(0.5));
    let x = loaded.scene.meshes[0].positions[1];
    assert!((x - Vec3::Y).length() < 1e-6, "{x}");
}

/// The triangle with two morph targets, weights ½ and 0 by the mesh.
fn morphing() -> Builder {
    let mut file = Builder::triangle();
    let normals = file.vec3s(&[[0.0, 0.0, 1.0]; 3]);
    let uvs = file.floats(&[[0.0, 0.0]; 3]);
    let up = file.vec3s(&[[0.0, 0.0, 2.0]; 3]);
    let tilt = file.vec3s(&[[2.0, 0.0, -2.0]; 3]);
    let uv_shift = file.floats(&[[0.5, 1.0]; 3]);
    let right = file.vec3s(&[[4.0, 0.0, 0.0]; 3]);
    let attributes = json!({ "POSITION": 0, "NORMAL": normals, "TEXCOORD_0": uvs });
    let targets =
        json!([{ "POSITION": up, "NORMAL": tilt, "TEXCOORD_0": uv_shift }, { "POSITION": right }]);
    file.set(
        "/meshes/0",
        json!({
            "primitives": [{ "attributes": attributes, "targets": targets }],
            "weights": [0.5, 0.0],
        }),
    );
    file
}

#[test]
fn morph_targets_are_weighted_by_animation_node_or_mesh() {
    let mut file = morphing();
    let own = mesh(&file);
    assert_eq!(own.positions[0], Vec3::Z);
    // (0, 0, 1) + ½ (2, 0, −2) = (1, 0, 0).
    assert_eq!(own.normals[0], Vec3::X);
    assert_eq!(own.uvs[0], Vec2::new(0.25, 0.5));
    file.set("/nodes/0/weights", json!([0, 1]));
    assert_eq!(mesh(&file).positions[0], Vec3::X * 4.0);

    let input = file.scalars(&[0.0, 1.0]);
    let output = file.scalars(&[0.0, 0.0, 1.0, 0.5]);
    let channel = json!({ "sampler": 0, "target": { "node": 0, "path": "weights" } });
    let sampler = json!({ "input": input, "output": output });
    file.set(
        "/animations",
        json!([{ "channels": [channel], "samplers": [sampler] }]),
    );
    // Half-way the weights are ½ and ¼.
    let position = first_position(&file, 0.5);
    assert_eq!(position, Vec3::new(1.0, 0.0, 1.0));
}

/// Three vertices that two joints move: the first by joint 0, the second by joint 1, the third by
/// both. The joints are nodes 1 and 2.
fn skinned() -> Builder {
    let mut file = Builder::triangle();
    let joints = file.accessor("VEC4", U8, 3, &[0, 9, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0]);
    let weights = file.floats(&[
        [1.0, 0.0, 0.0, 0.0],
        [2.0, 0.0, 0.0, 0.0],
        [0.5, 0.5, 0.0, 0.0],
    ]);
    let shift = |x: f32| -> [f32; 16] {
        let mut matrix = [0.0; 16];
        for at in [0, 5, 10, 15] {
            matrix[at] = 1.0;
        }
        matrix[12] = x;
        matrix
    };
    let matrices = file.floats(&[shift(0.0), shift(-1.0)]);
    let attributes = json!({ "POSITION": 0, "JOINTS_0": joints, "WEIGHTS_0": weights });
    file.set("/meshes/0/primitives/0/attributes", attributes);
    file.set(
        "/skins",
        json!([{ "joints": [1, 2], "inverseBindMatrices": matrices }]),
    );
    file.set(
        "/nodes",
        json!([
            // The transform of the node with the mesh does not count.
            { "mesh": 0, "skin": 0, "translation": [100, 100, 100] },
            { "children": [2], "translation": [0, 0, 5] },
            { "translation": [1, 0, 0], "rotation": [0, 0, FRAC_1_SQRT_2, FRAC_1_SQRT_2] },
        ]),
    );
    file.set("/scenes/0/nodes", json!([0, 1]));
    file
}

#[test]
fn joints_move_vertices() {
    let mesh = mesh(&skinned());
    // Joint 0 moves by (0, 0, 5). Joint 1 turns around (1, 0) by a quarter and moves with joint 0:
    // (1, 0) stays, and (0, 1) ↦ (0, −1).
    let expected = [[0.0, 0.0, 5.0], [1.0, 0.0, 5.0], [0.0, 0.0, 5.0]];
    for (actual, expected) in mesh.positions.iter().zip(expected) {
        assert!(
            (*actual - Vec3::from_array(expected)).length() < 1e-6,
            "{actual}"
        );
    }
}

#[test]
fn a_mirroring_skin_turns_the_winding() {
    let file = skinned().with("/nodes/1/scale", json!([1, -1, 1]));
    let corners = |mesh: &Mesh| mesh.triangles[0].map(|vertex| mesh.positions[vertex as usize]);
    let [a, b, c] = corners(&mesh(&file));
    let [x, y, z] = corners(&mesh(&skinned()));
    assert_eq!((x.y, y.y, z.y), (0.0, 0.0, 0.0));
    assert_eq!([a.x, b.x, c.x], [0.0, 0.0, 1.0]);
}

#[test]
fn vertices_without_weights_stay_with_their_node() {
    let mut file = skinned();
    let weights = file.floats(&[[0.0; 4], [f32::NAN, -1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]]);
    let attribute = "/meshes/0/primitives/0/attributes/WEIGHTS_0";
    file.set(attribute, json!(weights));
    let mesh = mesh(&file);
    assert_eq!(mesh.positions[0], Vec3::splat(100.0));
    assert_eq!(mesh.positions[1], Vec3::new(101.0, 100.0, 100.0));
    assert_eq!(mesh.positions[2], Vec3::new(0.0, 1.0, 5.0));
}

#[test]
fn a_second_set_of_joints_counts() {
    let mut file = skinned();
    let joints: Vec<u8> = [[1_u16, 0, 0, 0]; 3]
        .as_flattened()
        .iter()
        .flat_map(|j| j.to_le_bytes())
        .collect();
    let joints = file.accessor("VEC4", U16, 3, &joints);
    let weights = file.floats(&[[1.0, 0.0, 0.0, 0.0]; 3]);
    let attributes = "/meshes/0/primitives/0/attributes";
    file.set(&format!("{attributes}/JOINTS_1"), json!(joints));
    file.set(&format!("{attributes}/WEIGHTS_1"), json!(weights));
    // Vertex 0: half by joint 0, (0, 0), half by joint 1, which turns it to (1, −1).
    let moved = mesh(&file).positions[0];
    assert!(
        (moved - Vec3::new(0.5, -0.5, 5.0)).length() < 1e-6,
        "{moved}"
    );
}

#[test]
fn animated_joints_move_their_skin() {
    let mut file = skinned();
    let input = file.scalars(&[0.0, 1.0]);
    let output = file.vec3s(&[[0.0; 3], [0.0, 8.0, 0.0]]);
    let channel = json!({ "sampler": 0, "target": { "node": 1, "path": "translation" } });
    let sampler = json!({ "input": input, "output": output });
    file.set(
        "/animations",
        json!([{ "channels": [channel], "samplers": [sampler] }]),
    );
    assert_eq!(first_position(&file, 0.5), Vec3::Y * 4.0);
}

#[test]
fn wrong_poses_are_refused() {
    let change = |mut file: Builder, pointer: &str, value: Value, message: &str| {
        file.set(pointer, value);
        let error = error_with(&file);
        assert!(error.contains(message), "{error}");
    };
    let spline = || {
        let mut file = animated("translation", &[0.0, 1.0], Some("CUBICSPLINE"));
        file.vec3s(&[[0.0; 3]; 6]);
        file
    };
    let sampler = "/animations/0/samplers/0";
    change(
        spline(),
        &format!("{sampler}/interpolation"),
        json!("LINEAR"),
        "/accessors/2/count: 2 keyframes need 2 values, there are 6",
    );
    change(
        spline(),
        "/animations/0/channels/0/target/node",
        json!(4),
        "/animations/0/channels/0/target/node: node 4 does not exist",
    );
    change(
        spline(),
        "/animations/0/channels/0/sampler",
        json!(1),
        "/animations/0/channels/0/sampler: sampler 1 does not exist",
    );
    change(
        spline(),
        &format!("{sampler}/input"),
        json!(9),
        "/animations/0/samplers/0/input: accessor 9 does not exist",
    );
    change(
        spline(),
        &format!("{sampler}/output"),
        json!(1),
        "/accessors/1/count: 2 keyframes need 6",
    );
    change(
        spline(),
        "/accessors/1/count",
        json!(0),
        "/accessors/1: an animation without keyframes",
    );
    for times in [[1.0, 1.0], [2.0, 1.0], [f32::NAN, 1.0]] {
        let mut file = animated("translation", &times, None);
        file.vec3s(&[[0.0; 3]; 2]);
        let error = error_with(&file);
        assert!(
            error.contains("/accessors/1: the time of keyframe 1 is not after"),
            "{error}"
        );
    }

    let refused = |pointer: &str, value: Value, message: &str| {
        let error = error(&skinned().with(pointer, value));
        assert!(error.contains(message), "{error}");
    };
    refused(
        "/skins/0/joints",
        json!([1]),
        "/meshes/0/primitives/0/attributes/JOINTS_0: vertex 1 is moved by joint 1; the skin has 1",
    );
    refused(
        "/skins/0/joints",
        json!([1, 9]),
        "/skins/0/joints/1: node 9 does not exist",
    );
    refused(
        "/skins/0/joints",
        json!([1, 2, 0]),
        "/skins/0/inverseBindMatrices: 2 matrices for 3 joints",
    );
    refused(
        "/nodes/0/skin",
        json!(1),
        "/nodes/0/skin: skin 1 does not exist; the file has 1",
    );
    refused(
        "/skins/0/inverseBindMatrices",
        json!(0),
        "/accessors/0/type: the type must be MAT4",
    );
    refused(
        "/accessors/1/componentType",
        json!(5120),
        "/accessors/1/componentType: unsigned integers are needed here",
    );
}

/// The message of a file whose animation is wrong.
fn error_with(file: &Builder) -> String {
    file.try_load_with(&at_time(0.0))
        .expect_err("the file is wrong")
        .to_string()
}

#[test]
fn what_the_options_name_must_exist() {
    let mut file = animated("translation", &[0.0], None);
    file.vec3s(&[[7.0, 0.0, 0.0]]);
    let with = |options: ModelOptions| {
        file.try_load_with(&options)
            .map(|loaded| loaded.scene.meshes[0].positions[0].x)
    };
    let animation = |name: &str| ModelOptions {
        animation: Some(AnimationName::Name(name.to_owned())),
        ..ModelOptions::default()
    };
    assert_eq!(with(animation("move")), Ok(7.0));
    for (options, message) in [
        (
            animation("run"),
            "a.glb: the file has no animation `run`; it has `move`",
        ),
        (
            ModelOptions {
                animation: Some(AnimationName::Index(1)),
                ..ModelOptions::default()
            },
            "a.glb: the file has no animation `1`; it has `move`",
        ),
        (
            ModelOptions {
                scene: Some(1),
                ..ModelOptions::default()
            },
            "a.glb: the file has no scene 1; it has 1, counted from 0",
        ),
        (
            ModelOptions {
                variant: Some("red".to_owned()),
                ..ModelOptions::default()
            },
            "a.glb: the file has no variant `red`; it has none",
        ),
    ] {
        assert_eq!(with(options).unwrap_err().to_string(), message);
    }
}
