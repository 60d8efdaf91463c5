//! Rules of versions, extensions, accessors and limits: what is an error, what a warning, and the
//! messages.

use super::builder::{F32, U8, U16, bytes_of, with_files};
use super::{Builder, error, load, mesh};
use estampe_assets::Limits;
use serde_json::{Value, json};

#[test]
fn other_versions_are_refused() {
    let version = |asset: Value| error(&Builder::triangle().with("/asset", asset));
    let one = version(json!({ "version": "1.0" }));
    assert!(
        one.contains("/asset/version: version 1.0 of glTF is not read"),
        "{one}"
    );
    let newer = version(json!({ "version": "2.1", "minVersion": "2.1" }));
    assert!(newer.contains("/asset/minVersion: version 2.1"), "{newer}");
    let minor =
        Builder::triangle().with("/asset", json!({ "version": "2.7", "minVersion": "2.0" }));
    assert_eq!(mesh(&minor).triangles.len(), 1);
}

/// Rows: M7.
#[test]
fn required_extensions_must_be_known() {
    let required =
        |name: &str| error(&Builder::triangle().with("/extensionsRequired", json!([name])));
    for (name, advice) in [
        (
            "KHR_draco_mesh_compression",
            "export the file again without Draco compression",
        ),
        ("ACME_magic", "export the file again without it"),
    ] {
        let expected = format!(
            "a.glb, /extensionsRequired/0: the file requires the extension `{name}`, which is not read; \
             {advice}"
        );
        assert_eq!(required(name), expected);
        let used = Builder::triangle().with("/extensionsUsed", json!([name]));
        let loaded = load(&used.glb());
        assert_eq!(loaded.scene.meshes.len(), 1);
        let warning = loaded.warnings[0].to_string();
        let expected = format!("a.glb, /extensionsUsed/0: the extension `{name}` is not read; ");
        assert!(warning.starts_with(&expected), "{warning}");
    }
    let known = json!([
        "KHR_mesh_quantization",
        "KHR_texture_transform",
        "EXT_meshopt_compression"
    ]);
    let file = Builder::triangle().with("/extensionsRequired", known.clone());
    assert_eq!(
        mesh(&file.with("/extensionsUsed", known)).triangles.len(),
        1
    );
}

/// Rows: M7.
#[test]
fn wrong_accessors_are_refused() {
    let check = |pointer: &str, value: Value, message: &str| {
        let error = error(&Builder::triangle().with(pointer, value));
        assert!(error.contains(message), "{error}");
    };
    check(
        "/accessors/0/bufferView",
        json!(1),
        "a.glb, /accessors/0/bufferView: buffer view 1 does not exist; the file has 1; export",
    );
    check(
        "/accessors/0/count",
        json!(4),
        "/accessors/0: 4 elements of 12 bytes every 12 from byte 0 do not fit into the 36 bytes",
    );
    check(
        "/accessors/0/byteOffset",
        json!(4),
        "/accessors/0: 3 elements of 12 bytes",
    );
    check(
        "/accessors/0/byteOffset",
        json!(u64::MAX),
        "/accessors/0: 3 elements of 12 bytes",
    );
    check(
        "/accessors/0/count",
        json!(u64::MAX / 2),
        "the limit of 50000000",
    );
    check(
        "/accessors/0/componentType",
        json!(5124),
        "/accessors/0/componentType: 5124 is not the type",
    );
    check(
        "/accessors/0/type",
        json!("VEC5"),
        "/accessors/0/type: the type `VEC5` is not one",
    );
    check(
        "/accessors/0/type",
        json!("MAT3"),
        "/accessors/0/type: the type `MAT3` is not one",
    );
    check(
        "/accessors/0/type",
        json!("VEC2"),
        "/accessors/0/type: the type must be VEC3 for this use",
    );
    check(
        "/bufferViews/0/byteStride",
        json!(8),
        "/bufferViews/0/byteStride: elements of 12 bytes overlap, the stride is 8",
    );
    check(
        "/bufferViews/0/byteStride",
        json!(16),
        "/accessors/0: 3 elements of 12 bytes every 16",
    );
    check(
        "/bufferViews/0/buffer",
        json!(1),
        "/bufferViews/0/buffer: buffer 1 does not exist",
    );
    check(
        "/bufferViews/0/byteLength",
        json!(37),
        "/bufferViews/0: bytes 0 to 37 are outside of buffer 0, which has 36",
    );
    check(
        "/bufferViews/0/byteOffset",
        json!(u64::MAX),
        "/bufferViews/0: bytes",
    );
    check(
        "/meshes/0/primitives/0/attributes/POSITION",
        json!(9),
        "/meshes/0/primitives/0/attributes/POSITION: accessor 9 does not exist; the file has 1",
    );
    check(
        "/meshes/0/primitives/0/indices",
        json!(9),
        "/meshes/0/primitives/0/indices: accessor 9",
    );
    check(
        "/meshes/0/primitives/0/indices",
        json!(0),
        "/accessors/0/type: the type must be SCALAR",
    );
    check(
        "/nodes/0/mesh",
        json!(1),
        "/nodes/0/mesh: mesh 1 does not exist; the file has 1",
    );
    check(
        "/nodes/0/camera",
        json!(0),
        "/nodes/0/camera: camera 0 does not exist; the file has 0",
    );
}

#[test]
fn elements_that_do_not_fit_each_other_are_refused() {
    let mut file = Builder::triangle();
    let indices = file.indices(&[0, 1, 3]);
    file.set("/meshes/0/primitives/0/indices", json!(indices));
    let outside = error(&file);
    assert!(
        outside.contains("/accessors/1: index 3 at 2 is outside of the 3 vertices"),
        "{outside}"
    );
    let mut file = Builder::triangle();
    let two = file.vec3s(&[[0.0; 3]; 2]);
    file.set("/meshes/0/primitives/0/attributes/NORMAL", json!(two));
    let few = error(&file);
    assert!(
        few.contains("/meshes/0/primitives/0/attributes/NORMAL: 2 elements for 3 vertices"),
        "{few}"
    );
    file.set(
        "/meshes/0/primitives/0/attributes",
        json!({ "POSITION": 0 }),
    );
    file.set(
        "/meshes/0/primitives/0/targets",
        json!([{ "POSITION": two }]),
    );
    file.set("/meshes/0/weights", json!([1]));
    let few = error(&file);
    assert!(
        few.contains("/meshes/0/primitives/0/targets/0/POSITION: 2 elements"),
        "{few}"
    );
}

#[test]
fn wrong_sparse_accessors_are_refused() {
    let file = |indices: &[u8], change: Option<(&str, Value)>| {
        let mut file = Builder::triangle();
        let sparse = json!({
            "count": indices.len(),
            "indices": { "bufferView": file.view(indices), "componentType": U8 },
            "values": { "bufferView": file.view(&bytes_of(&[0.0; 6])) },
        });
        file.set("/accessors/0/sparse", sparse);
        if let Some((property, value)) = change {
            file.set(&format!("/accessors/0/sparse/{property}"), value);
        }
        error(&file)
    };
    for indices in [[1, 1], [2, 1], [0, 3]] {
        let error = file(&indices, None);
        assert!(
            error.contains("/accessors/0/sparse/indices: index") && error.contains("at 1"),
            "{error}"
        );
    }
    for (property, value, message) in [
        (
            "count",
            json!(4),
            "/accessors/0/sparse/count: 4 elements replace some of 3",
        ),
        (
            "indices/bufferView",
            json!(9),
            "/accessors/0/sparse/indices/bufferView: buffer view 9",
        ),
        (
            "values/bufferView",
            json!(9),
            "/accessors/0/sparse/values/bufferView: buffer view 9",
        ),
        (
            "indices/componentType",
            json!(1),
            "/accessors/0/sparse/indices/componentType: 1 is not",
        ),
        (
            "indices/componentType",
            json!(U16),
            "/accessors/0/sparse/indices: 2 elements of 2 bytes",
        ),
        (
            "values/byteOffset",
            json!(4),
            "/accessors/0/sparse/values: 2 elements of 12 bytes",
        ),
    ] {
        let error = file(&[0, 1], Some((property, value)));
        assert!(error.contains(message), "{error}");
    }
}

#[test]
fn what_can_be_read_all_the_same_is_a_warning() {
    let warning = |file: &Builder| {
        let loaded = load(&file.glb());
        assert_eq!(loaded.warnings[0].location, None);
        loaded.warnings[0].to_string()
    };
    let mut shifted = Builder::with_mesh(json!({ "attributes": { "POSITION": 0 } }));
    let bytes = [
        &[0][..],
        &bytes_of(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]),
    ]
    .concat();
    shifted.accessor("VEC3", F32, 3, &bytes);
    shifted.set("/accessors/0/byteOffset", json!(1));
    assert_eq!(
        warning(&shifted),
        "a.glb, /accessors/0: its first byte, 1, is not a multiple of 4"
    );

    let mut odd = Builder::with_mesh(json!({ "attributes": { "POSITION": 0 } }));
    odd.accessor("VEC3", U8, 3, &[0, 0, 0, 9, 9, 1, 0, 0, 9, 9, 0, 1, 0]);
    odd.set("/bufferViews/0/byteStride", json!(5));
    assert_eq!(
        warning(&odd),
        "a.glb, /bufferViews/0/byteStride: the stride 5 is not a multiple of 4 from 4 to 252"
    );
    assert_eq!(load(&odd.glb()).scene.meshes[0].triangles.len(), 1);

    let none = Builder::with_mesh(json!({ "attributes": { "NORMAL": 0 } }));
    assert_eq!(
        warning(&none),
        "a.glb, /meshes/0/primitives/0: a primitive without POSITION is left out"
    );
    let mut four = Builder::triangle();
    let indices = four.indices(&[0, 1, 2, 0]);
    four.set("/meshes/0/primitives/0/indices", json!(indices));
    assert_eq!(
        warning(&four),
        "a.glb, /meshes/0/primitives/0: 4 vertices do not fit the mode; the last ones are left out"
    );
    let mut infinite = Builder::with_mesh(json!({ "attributes": { "POSITION": 0 } }));
    infinite.vec3s(&[[0.0; 3], [f32::INFINITY, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    assert_eq!(
        warning(&infinite),
        "a.glb: 1 element with a coordinate that is not finite is omitted"
    );
}

#[test]
fn meshes_beyond_the_limit_are_joined_to_the_last_one() {
    let mut file = Builder::triangle();
    let normals = file.vec3s(&[[0.0, 0.0, 1.0]; 3]);
    let pairs = file.floats(&[[0.25, 0.5]; 3]);
    let primitive = |attributes: Value, mode: u32| json!({ "attributes": attributes, "mode": mode, "material": mode / 4 });
    file.set(
        "/meshes/0/primitives",
        json!([
            primitive(json!({ "POSITION": 0 }), 4),
            primitive(json!({ "POSITION": 0, "TEXCOORD_1": pairs }), 4),
            primitive(json!({ "POSITION": 0 }), 2),
            primitive(
                json!({ "POSITION": 0, "NORMAL": normals, "TEXCOORD_0": pairs }),
                4
            ),
        ]),
    );
    file.set("/materials", json!([{}, {}]));
    let limits = Limits {
        max_meshes: 2,
        ..Limits::default()
    };
    let scene = with_files(&file.glb(), &[], &limits).unwrap().scene;
    assert_eq!(scene.meshes.len(), 2);
    let mesh = &scene.meshes[1];
    assert_eq!(mesh.positions.len(), 9);
    assert_eq!(mesh.triangles, [[0, 1, 2], [6, 7, 8]]);
    assert_eq!(mesh.lines, [[3, 4], [4, 5], [5, 3]]);
    let ranges: Vec<_> = mesh
        .surfaces
        .iter()
        .map(|s| (s.material, s.triangles.clone()))
        .collect();
    assert_eq!(ranges, [(Some(1), 0..1), (Some(1), 1..2)]);
    assert!(
        mesh.normals[..3]
            .iter()
            .all(|&normal| normal == glam::Vec3::Z)
    );
    assert_eq!(mesh.uvs[6], glam::Vec2::new(0.25, 0.5));
    assert_eq!(mesh.colors, [[1.0; 4]; 9]);
    let second = mesh
        .attribute(estampe_scene::Mesh::UV1)
        .expect("a value for each vertex");
    assert_eq!(
        second.values[..8],
        [0.25, 0.5, 0.25, 0.5, 0.25, 0.5, 0.0, 0.0]
    );
}

#[test]
fn limits_count_what_nodes_and_instances_make() {
    let mut file = Builder::triangle();
    let places = file.vec3s(&[[0.0; 3]; 4]);
    let instancing =
        json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": places } } });
    file.set(
        "/nodes",
        json!([{ "mesh": 0 }, { "mesh": 0, "extensions": instancing }]),
    );
    file.set("/scenes/0/nodes", json!([0, 1]));
    file.set(
        "/meshes/0/primitives/0/targets",
        json!([{ "POSITION": 0 }, { "POSITION": 0 }]),
    );
    file.set("/meshes/0/weights", json!([1, 0]));
    file.set("/meshes/0/primitives/0/material", json!(0));
    file.set("/materials", json!([{}, {}]));
    let read = |limits: Limits| {
        with_files(&file.glb(), &[], &limits)
            .map(drop)
            .map_err(|error| error.to_string())
    };
    let default = Limits::default;
    // 15 vertices and 5 triangles; 6 vertices of morph targets, which are read once for a node.
    let enough = Limits {
        max_vertices: 15,
        max_triangles: 5,
        max_materials: 2,
        ..default()
    };
    assert_eq!(read(enough.clone()), Ok(()));
    for (limits, message) in [
        (
            Limits {
                max_vertices: 14,
                ..enough.clone()
            },
            "/meshes/0/primitives/0: 15 vertices are more than the limit of 14",
        ),
        (
            Limits {
                max_triangles: 4,
                ..enough.clone()
            },
            "/meshes/0/primitives/0: 5 triangles, lines and points are more than the limit of 4",
        ),
        (
            Limits {
                max_materials: 1,
                ..enough.clone()
            },
            "/materials: 2 materials are more",
        ),
        (
            Limits {
                max_vertices: 3,
                ..enough.clone()
            },
            "/nodes/1/extensions/EXT_mesh_gpu_instancing: 4 instances are more than the limit of 3",
        ),
        (
            Limits {
                max_file_bytes: 100,
                ..enough
            },
            "bytes are more than the limit of 100",
        ),
    ] {
        let error = read(limits).unwrap_err();
        assert!(error.contains(message), "{error}");
    }
    let mut morphs = Builder::triangle();
    let targets = vec![json!({ "POSITION": 0 }); 6];
    morphs.set("/meshes/0/primitives/0/targets", json!(targets));
    morphs.set("/meshes/0/weights", json!([1, 1, 1, 1, 0, 1]));
    let small = Limits {
        max_vertices: 14,
        ..default()
    };
    let error = with_files(&morphs.glb(), &[], &small)
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("15 vertices of morph targets are more than the limit of 14"),
        "{error}"
    );
}
