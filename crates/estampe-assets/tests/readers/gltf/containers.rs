//! Containers, the JSON, buffers, extensions, detection, limits: what is refused, and with which message.

use super::builder::{F32, U8, U16, base64, bytes_of, glb, with_files};
use super::{Builder, error, load, mesh};
use estampe_assets::model::NoResources;
use estampe_assets::{AssetError, Limits, Location, ModelFormat, encode_model, parse_model};
use serde_json::{Value, json};
use std::path::Path;

fn refused(bytes: &[u8]) -> AssetError {
    let limits = Limits::default();
    parse_model(bytes, ModelFormat::Gltf, "a.glb", &NoResources, &limits)
        .expect_err("the file is wrong")
}

#[test]
fn damaged_containers_are_refused_with_the_byte() {
    let whole = Builder::triangle().glb();
    let json_length = u32::from_le_bytes(whole[12..16].try_into().unwrap()) as usize;
    let cut = |length: usize| refused(&whole[..length]).to_string();
    assert!(cut(11).contains("byte 11: the file ends within the header of a GLB file"));
    assert!(cut(40).contains("byte 40: the file ends within the file; its header states"));
    let change = |at: usize, word: u32| {
        let mut bytes = whole.clone();
        bytes[at..at + 4].copy_from_slice(&word.to_le_bytes());
        bytes
    };
    let stated = |length: usize| {
        let bytes = change(8, u32::try_from(length).unwrap());
        refused(&bytes[..length]).to_string()
    };
    assert!(stated(15).contains("byte 15: the file ends within the header of a chunk"));
    assert!(stated(12).contains("byte 12: the first chunk is not JSON"));
    let one = refused(&change(4, 1));
    assert!(matches!(one, AssetError::Unsupported(_)));
    assert!(
        one.to_string()
            .contains("byte 4: version 1 of the GLB format is not read")
    );
    let long = refused(&change(12, u32::MAX)).to_string();
    assert!(
        long.contains("byte 12: the file ends within a chunk, which states 4294967295"),
        "{long}"
    );
    let binary_first = refused(&change(16, u32::from_le_bytes(*b"BIN\0"))).to_string();
    assert!(
        binary_first.contains("byte 12: the first chunk is not JSON"),
        "{binary_first}"
    );
    // Chunks of other types are skipped.
    let other = change(20 + json_length + 4, 0x4242_4242);
    assert!(refused(&other).to_string().contains("no binary chunk"));
}

#[test]
fn small_faults_of_containers_are_warnings() {
    let mut bytes = Builder::triangle().glb();
    let length = bytes.len() as u64;
    bytes.extend([0; 3]);
    let loaded = load(&bytes);
    assert_eq!(loaded.warnings[0].location, Some(Location::Byte(length)));
    assert_eq!(
        loaded.warnings[0].to_string(),
        format!("a.glb, byte {length}: 3 bytes after the end are ignored")
    );

    let json = br#"{"asset":{"version":"2.0"},"a":0}"#;
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    bytes.extend(u32::try_from(20 + json.len()).unwrap().to_le_bytes());
    bytes.extend(u32::try_from(json.len()).unwrap().to_le_bytes());
    bytes.extend(b"JSON");
    bytes.extend(json);
    let messages: Vec<String> = load(&bytes)
        .warnings
        .iter()
        .map(ToString::to_string)
        .collect();
    assert_eq!(
        messages[0],
        "a.glb, byte 12: the chunk's length of 33 bytes is not a multiple of 4"
    );
    assert_eq!(messages[1], "a.glb: it has nothing to draw");
}

#[test]
fn wrong_json_is_refused_with_its_place() {
    let message = |json: &str| refused(json.as_bytes()).to_string();
    let syntax = message("{\"asset\":{\"version\":\"2.0\"},\n \"nodes\":[{},{\"mesh\":}]}");
    assert!(
        syntax.starts_with("a.glb, /nodes/1/mesh, byte 49: the JSON is not valid: expected value"),
        "{syntax}"
    );
    let kind = message(r#"{"asset":{"version":"2.0"},"accessors":[{"bufferView":"abc"}]}"#);
    assert!(
        kind.starts_with("a.glb, /accessors/0/bufferView, byte 58: invalid type: string \"abc\""),
        "{kind}"
    );
    let negative = message(r#"{"asset":{"version":"2.0"},"scene":-1}"#);
    assert!(
        negative.contains("/scene, byte") && negative.contains("not negative"),
        "{negative}"
    );
    let missing = message(r#"{"asset":{"version":"2.0"},"accessors":[{},{"count":3}]}"#);
    assert!(
        missing.contains("/accessors/0, byte 41: missing field `componentType`"),
        "{missing}"
    );
    assert!(message("7").contains("invalid type: integer `7`"));
    assert!(message("").contains("the JSON is not valid: EOF"));
    // What is not read may be nested to any depth.
    let [open, close] = ["[", "]"].map(|bracket| bracket.repeat(100_000));
    let deep = format!(r#"{{"asset":{{"version":"2.0"}},"extras":{open}{close}}}"#);
    assert_eq!(load(deep.as_bytes()).scene.meshes.len(), 0);
    // In a GLB the offset is that in the file.
    let inside = refused(&glb(br#"{"asset":7}"#, b""));
    assert_eq!(inside.fault().location, Some(Location::Byte(20 + 9)));
    assert_eq!(inside.fault().json_pointer, "/asset");
    // Whole numbers may be written with a fraction.
    let file = Builder::triangle()
        .with("/scene", json!(0.0))
        .with("/accessors/0/count", json!(3.0));
    assert_eq!(mesh(&file).triangles.len(), 1);
    assert!(
        error(&file.with("/accessors/0/count", json!(2.5))).contains("/accessors/0/count, byte")
    );
}

#[test]
fn many_objects_are_a_limit() {
    let many = "{},".repeat(4_000_000);
    let json = format!(r#"{{"asset":{{"version":"2.0"}},"nodes":[{many}{{}}]}}"#);
    let error = refused(json.as_bytes());
    assert!(matches!(error, AssetError::LimitExceeded(_)), "{error}");
    // Braces in strings are no objects.
    let text = "{".repeat(5_000_000);
    let json = format!(r#"{{"asset":{{"version":"2.0"}},"extras":"\"{text}\\"}}"#);
    assert_eq!(load(json.as_bytes()).scene.meshes.len(), 0);
}

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

#[test]
fn required_extensions_must_be_known() {
    let required =
        |name: &str| error(&Builder::triangle().with("/extensionsRequired", json!([name])));
    for (name, advice) in [
        (
            "KHR_draco_mesh_compression",
            "export the file again without Draco compression",
        ),
        (
            "KHR_texture_basisu",
            "export the file again with PNG or JPEG textures",
        ),
        (
            "EXT_texture_webp",
            "export the file again with PNG or JPEG textures",
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

#[test]
fn buffers_come_from_files_too() {
    let mut file = Builder::triangle();
    let bin = file.bin.clone();
    let length = bin.len();
    file.set(
        "/buffers",
        json!([{ "byteLength": length, "uri": "data%20/a.bin" }]),
    );
    let read = |file: &Builder, bytes: &[u8], limits: &Limits| {
        with_files(
            file.json.to_string().as_bytes(),
            &[("data /a.bin", bytes.to_vec())],
            limits,
        )
        .map(|loaded| loaded.scene.meshes[0].triangles.len())
        .map_err(|error| error.to_string())
    };
    let limits = Limits::default();
    assert_eq!(read(&file, &bin, &limits), Ok(1));
    let short = read(&file, &bin[1..], &limits).unwrap_err();
    assert!(
        short.contains("/buffers/0: the buffer has 35 bytes instead of the 36 of its `byteLength`"),
        "{short}"
    );
    let small = Limits {
        max_file_bytes: 700,
        ..Limits::default()
    };
    file.set("/buffers/0/byteLength", json!(800));
    let large = read(&file, &[0; 800], &small).unwrap_err();
    assert!(
        large.contains(
            "/buffers/0: the file `data%20/a.bin` of the buffer is missing: it is larger"
        ),
        "{large}"
    );
    file.set("/buffers/0/uri", json!("b.bin"));
    let missing = read(&file, &bin, &limits).unwrap_err();
    assert!(
        missing.contains("`b.bin` of the buffer is missing: no such file"),
        "{missing}"
    );
    file.set("/buffers/0/uri", json!("data:;base64,AA*A"));
    let wrong = read(&file, &bin, &limits).unwrap_err();
    assert!(
        wrong.contains("/buffers/0: character 2 of the base64 data"),
        "{wrong}"
    );
    file.set("/buffers/0", json!({ "byteLength": 4 }));
    let none = read(&file, &bin, &limits).unwrap_err();
    assert!(
        none.contains("/buffers/0: the buffer has no `uri`, and the file has no binary chunk"),
        "{none}"
    );
    // A buffer that nothing needs may be missing.
    let unused = Builder::triangle();
    let uri = format!("data:,{}", "%00".repeat(4));
    let good = format!("data:a/b;base64,{}", base64(&unused.bin));
    let buffers = json!([{ "byteLength": length, "uri": good }, { "byteLength": 4, "uri": uri },
                         { "byteLength": 9, "uri": "none.bin" }]);
    assert_eq!(
        read(&unused.with("/buffers", buffers), &bin, &limits),
        Ok(1)
    );
}

#[test]
fn files_stay_below_the_folder_of_the_model() {
    let folder = std::env::temp_dir().join(format!("estampe-gltf-{}", std::process::id()));
    std::fs::create_dir_all(folder.join("inner")).unwrap();
    let mut file = Builder::triangle();
    std::fs::write(folder.join("a.bin"), &file.bin).unwrap();
    std::fs::write(folder.join("inner/b.bin"), &file.bin).unwrap();
    let path = folder.join("inner/model.gltf");
    let mut read = |uri: &str| {
        let buffer = json!({ "byteLength": 36, "uri": uri });
        file.set("/buffers", json!([buffer]));
        std::fs::write(&path, file.json.to_string()).unwrap();
        estampe_assets::load_model(&path, None, &Limits::default())
            .map_err(|error| error.to_string())
    };
    assert_eq!(read("b.bin").unwrap().format, ModelFormat::Gltf);
    assert!(read("../inner/b.bin").is_err());
    for uri in [
        "../a.bin",
        "%2e%2e/a.bin",
        "/etc/passwd",
        "file:///etc/passwd",
        "https://a.b/c.bin",
    ] {
        let error = read(uri).unwrap_err();
        assert!(
            error.contains("/buffers/0") && error.contains("outside the model's folder"),
            "{error}"
        );
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

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
        "/meshes/0/primitives/0/mode",
        json!(7),
        "/meshes/0/primitives/0/mode: 7 is not a mode",
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
        "a.glb: 1 elements with a coordinate that is not finite are omitted"
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
        max_meshes: 2,
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
                max_meshes: 1,
                ..enough.clone()
            },
            "/meshes/0/primitives/0: 2 meshes are more",
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

#[test]
fn the_format_is_found_by_extension_and_by_content() {
    for name in ["a.gltf", "b/C.GLB", "d.GlTf"] {
        assert_eq!(
            ModelFormat::from_extension(Path::new(name)),
            Some(ModelFormat::Gltf),
            "{name}"
        );
    }
    let file = Builder::triangle();
    let padded = [vec![b' '; 10], file.gltf()].concat();
    let last = format!(
        r#"{{"extras":"{}","asset":{{"version":"2.0"}}}}"#,
        "x".repeat(200_000)
    );
    for bytes in [file.glb(), file.gltf(), padded, last.into_bytes()] {
        assert_eq!(ModelFormat::from_content(&bytes), Some(ModelFormat::Gltf));
    }
    let with_mark = ["\u{feff}".as_bytes(), &file.gltf()].concat();
    assert_eq!(
        ModelFormat::from_content(&with_mark),
        Some(ModelFormat::Gltf)
    );
    assert_eq!(load(&with_mark).scene.meshes.len(), 1);
    for other in [&b"{\"a\":1}"[..], b"[\"asset\"]", b"{"] {
        assert_eq!(ModelFormat::from_content(other), None);
    }
    assert_eq!(ModelFormat::Gltf.name(), "glTF");
    let written = encode_model(&load(&file.glb()).scene, ModelFormat::Gltf).unwrap_err();
    assert!(written.to_string().contains("glTF is read, not written"));
}
