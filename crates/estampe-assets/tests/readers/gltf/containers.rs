//! Containers, the JSON, buffers and their files, detection.

use super::builder::{base64, glb, with_files};
use super::{Builder, error, load, mesh};
use estampe_assets::model::NoResources;
use estampe_assets::{AssetError, Limits, Location, ModelFormat, encode_model, parse_model};
use serde_json::json;
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
    assert_eq!(&*inside.fault().json_pointer, "/asset");
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
    // The path leads back to the folder.
    assert!(read("../inner/b.bin").is_ok());
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
