//! glTF files: how they are recognised, and what is chosen of them.

use crate::support::picture::Picture;
use crate::support::{Folder, estampe, estampe_fed};
use serde_json::{Value, json};

/// A triangle as glTF with a data URI.
const GLTF: &str = r#"{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5121,"count":3,"type":"VEC3"}],
"bufferViews":[{"buffer":0,"byteLength":12,"byteStride":4}],
"buffers":[{"byteLength":12,"uri":"data:;base64,AAAAAAIAAAAAAQAA"}]}"#;

#[test]
fn gltf_is_read_by_name_by_content_and_from_standard_input() {
    let folder = Folder::new();
    let named = folder.with_file("m.gltf", GLTF);
    let unnamed = folder.with_file("m", GLTF);
    for model in [&named, &unnamed] {
        let run = estampe("info {} --json", &[model]);
        assert_eq!(run.code, 0, "{}", run.err);
        let report: serde_json::Value = serde_json::from_slice(&run.out).expect("one object");
        assert_eq!(report["format"], "glTF");
        assert_eq!(report["bounds"]["max"], serde_json::json!([2.0, 1.0, 0.0]));
    }
    let out = folder.path("m.png");
    for format in ["gltf", "glb"] {
        let command = format!("render - --format {format} -o {{}} --size 32x32");
        let run = estampe_fed(&command, &[&out], GLTF.as_bytes());
        assert_eq!(run.code, 0, "{}", run.err);
    }
    let broken = folder.with_file("broken.gltf", GLTF.replace("5121", "1"));
    let run = estampe("info {}", &[&broken]);
    assert_eq!(run.code, 1);
    let place = "broken.gltf, /accessors/0/componentType: 1 is not the type of a component";
    assert!(run.err.contains(place), "{}", run.err);
    // Shapes are not written as glTF.
    let run = estampe("shape --explicit x -o {}", &[&folder.path("shape.glb")]);
    assert_eq!(run.code, 2, "{}", run.err);
}

/// Bytes as a data URI.
fn data_uri(bytes: &[u8]) -> String {
    let escaped = bytes.iter().map(|byte| format!("%{byte:02X}"));
    format!(
        "data:application/octet-stream,{}",
        escaped.collect::<String>()
    )
}

/// A triangle that slides by 4 in two seconds, in two scenes, with two cameras and two variants.
pub(crate) fn with_choices() -> String {
    let times = [0.0_f32, 2.0];
    let translations = [0.0_f32, 0.0, 0.0, 4.0, 0.0, 0.0];
    let positions = [-1.0_f32, -1.0, 0.0, 1.0, -1.0, 0.0, 0.0, 1.0, 0.0];
    let floats = times.iter().chain(&translations).chain(&positions);
    let bytes: Vec<u8> = floats.flat_map(|number| number.to_le_bytes()).collect();
    let variants = "KHR_materials_variants";
    let color = |color: [f32; 4]| json!({ "pbrMetallicRoughness": { "baseColorFactor": color } });
    json!({
        "asset": { "version": "2.0" },
        "extensionsUsed": [variants],
        "extensions": { variants: { "variants": [{ "name": "day" }, { "name": "night" }] } },
        "scene": 0,
        "scenes": [{ "name": "near", "nodes": [0, 2, 3] }, { "name": "far", "nodes": [1] }],
        "nodes": [
            { "mesh": 0 },
            { "mesh": 0, "translation": [10, 0, 0] },
            { "camera": 0, "translation": [0, 0, 5] },
            { "camera": 1, "translation": [0, 0, 5] },
        ],
        // Half of the height is 2.5 at a distance of 5.
        "cameras": [
            { "name": "wide", "type": "perspective", "perspective": { "yfov": 0.927_295_2, "znear": 0.1 } },
            { "type": "orthographic", "orthographic": { "xmag": 2, "ymag": 2, "znear": 0.1, "zfar": 9 } },
        ],
        "materials": [color([1.0, 0.0, 0.0, 1.0]), color([0.0, 1.0, 0.0, 1.0])],
        "meshes": [{ "primitives": [{
            "attributes": { "POSITION": 2 },
            "material": 0,
            "extensions": { variants: { "mappings": [{ "material": 1, "variants": [1] }] } },
        }] }],
        "animations": [{
            "name": "slide",
            "channels": [{ "sampler": 0, "target": { "node": 0, "path": "translation" } }],
            "samplers": [{ "input": 0, "output": 1 }],
        }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 2, "type": "SCALAR", "min": [0], "max": [2] },
            { "bufferView": 1, "componentType": 5126, "count": 2, "type": "VEC3" },
            { "bufferView": 2, "componentType": 5126, "count": 3, "type": "VEC3",
              "min": [-1, -1, 0], "max": [1, 1, 0] },
        ],
        "bufferViews": [
            { "buffer": 0, "byteLength": 8 },
            { "buffer": 0, "byteOffset": 8, "byteLength": 24 },
            { "buffer": 0, "byteOffset": 32, "byteLength": 36 },
        ],
        "buffers": [{ "byteLength": bytes.len(), "uri": data_uri(&bytes) }],
    })
    .to_string()
}

#[test]
fn scenes_animations_and_variants_are_chosen() {
    let folder = Folder::new();
    let model = folder.with_file("m.gltf", with_choices());
    let run = estampe("info {}", &[&model]);
    assert_eq!(run.code, 0, "{}", run.err);
    let text = String::from_utf8(run.out).expect("text");
    for said in [
        "camera     0 \"wide\": perspective",
        "camera     1: orthographic",
        "scene      1 \"far\"",
        "animation  0 \"slide\": 2 s",
        "variant    \"night\"",
    ] {
        assert!(text.contains(said), "{said}: {text}");
    }
    for (options, max) in [
        ("", [1.0, 1.0, 0.0]),
        ("--scene 1", [11.0, 1.0, 0.0]),
        ("--time 1", [3.0, 1.0, 0.0]),
        ("--animation slide --time 1.5", [4.0, 1.0, 0.0]),
        ("--animation 0", [1.0, 1.0, 0.0]),
        ("--animation 0 --time 9", [5.0, 1.0, 0.0]),
    ] {
        let run = estampe(&format!("info {{}} --json {options}"), &[&model]);
        assert_eq!(run.code, 0, "{options}: {}", run.err);
        let report: Value = serde_json::from_slice(&run.out).expect("one object");
        assert_eq!(report["bounds"]["max"], json!(max), "{options}");
        assert_eq!(
            report["animations"],
            json!([{ "name": "slide", "duration": 2.0 }])
        );
        assert_eq!(report["variants"], json!(["day", "night"]));
    }
    let run = estampe("info {} --json --variant night", &[&model]);
    let report: Value = serde_json::from_slice(&run.out).expect("one object");
    let used = &report["meshes"][0]["materials"][0];
    let used = used
        .as_u64()
        .and_then(|at| usize::try_from(at).ok())
        .expect("a material");
    assert_eq!(
        report["materials"][used]["base_color"],
        json!([0.0, 1.0, 0.0])
    );
    for (options, code, said) in [
        ("--scene 2", 1, "scene"),
        ("--animation walk", 1, "walk"),
        ("--variant dusk", 1, "dusk"),
        ("--time soon", 2, "write a time in seconds"),
    ] {
        let run = estampe(&format!("info {{}} {options}"), &[&model]);
        assert_eq!(run.code, code, "{options}: {}", run.err);
        assert!(run.err.contains(said), "{options}: {}", run.err);
    }
}

#[test]
fn cameras_of_the_file_are_used() {
    let folder = Folder::new();
    let model = folder.with_file("m.gltf", with_choices());
    let out = folder.path("m.png");
    // The triangle is 2 high; the pictures show 5 and 4.
    for (camera, extent) in [("wide", [30, 30, 70, 70]), ("1", [25, 25, 75, 75])] {
        let command = format!("render {{}} -o {{}} --camera {camera} --size 100x100 --samples 1");
        let run = estampe(&command, &[&model, &out]);
        assert_eq!(run.code, 0, "{}", run.err);
        let found = Picture::open(&out).extent();
        let near = |(a, b): (&usize, &usize)| a.abs_diff(*b) <= 1;
        assert!(found.iter().zip(&extent).all(near), "{camera}: {found:?}");
    }
    let run = estampe("render {} -o {} --camera 7", &[&model, &out]);
    assert_eq!(run.code, 2);
    let said = "--camera 7: there is no such camera; the model has 0 (wide), 1";
    assert!(run.err.contains(said), "{}", run.err);
    let run = estampe("render builtin:cube -o {} --camera 0", &[&out]);
    assert!(run.err.contains("the model has no cameras"), "{}", run.err);
    let run = estampe("render {} -o {} --camera 0 --fov 20", &[&model, &out]);
    assert_eq!(run.code, 2, "{}", run.err);
}

/// A panorama of one colour lights as uniform surroundings do, a broken one is an error with its
/// place.
#[test]
fn panoramas_light_models() {
    let folder = Folder::new();
    let header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n";
    let texels = [128, 0, 0, 129].repeat(8);
    let red = folder.with_file("red.hdr", [header.as_bytes(), &texels].concat());
    let picture = folder.path("red.png");
    let words = "render builtin:sphere -o {} --size 32x32 --shading pbr --hdri {}";
    let run = estampe(words, &[&picture, &red]);
    assert_eq!(run.code, 0, "{}", run.err);
    let bytes = std::fs::read(&picture).expect("drawn");
    let image = estampe_assets::image::decode(&bytes, &estampe_assets::Limits::default());
    let [r, g, b, _] = image.expect("a PNG").texel(16, 16);
    assert!(r > 150 && g == 0 && b == 0, "{r} {g} {b}");
    let short = folder.with_file("short.hdr", header);
    let run = estampe(words, &[&picture, &short]);
    assert_eq!(run.code, 1);
    assert!(
        run.err.contains("short.hdr") && run.err.contains("byte"),
        "{}",
        run.err
    );
}

/// The output that `docs/info.md` shows, and the same as JSON.
#[test]
fn info_lists_all_that_a_file_has() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let model = "crates/estampe-assets/tests/data/gltf-rules/extensions.gltf";
    let bytes = std::fs::read(root.join(model)).expect("the model is there");
    let folder = Folder::new();
    let model = folder.with_file("lamp.gltf", bytes);
    let page = std::fs::read_to_string(root.join("docs/info.md")).expect("the page is there");
    let (_, shown) = page.split_once("```text\n").expect("an example");
    let (shown, _) = shown.split_once("```").expect("its end");
    let run = estampe("info {}", &[&model]);
    assert_eq!(run.code, 0, "{}", run.err);
    let text = String::from_utf8(run.out).expect("text");
    // The page names the file without its folder.
    let (_, text) = text.split_once("lamp.gltf").expect("the file's name");
    assert_eq!(format!("lamp.gltf{text}"), shown);

    let run = estampe("info {} --json", &[&model]);
    let report: Value = serde_json::from_slice(&run.out).expect("one object");
    assert_eq!(report["unit"], "m");
    assert_eq!(report["memory"], json!({ "geometry": 276, "textures": 16 }));
    assert_eq!(report["node_count"], 4);
    let node = &report["nodes"][2];
    assert_eq!((&node["depth"], &node["instances"]), (&json!(1), &json!(2)));
    assert_eq!(report["nodes"][3]["light"], true);
    let sources = |at: usize| report["meshes"][at]["normals"].clone();
    assert_eq!([sources(0), sources(1)], ["file", "made"]);
    let tangents = |at: usize| report["meshes"][at]["tangents"].clone();
    // Anisotropy needs them.
    assert_eq!([tangents(0), tangents(1)], [json!("made"), Value::Null]);
    assert_eq!(report["meshes"][0]["attributes"], json!(["normals", "uvs"]));
    let texture = &report["materials"][0]["textures"][0];
    assert_eq!(
        *texture,
        json!({ "slot": "base color", "texture": 0, "channels": "rgba" })
    );
    assert_eq!(report["materials"][1]["extensions"], json!(["unlit"]));
    assert_eq!(report["textures"][0]["bytes"], 16);
    assert_eq!(report["lights"][0]["intensity"], 10.0);
}

/// No name of a file reaches the terminal's control sequences, nor forges a line.
#[test]
fn info_escapes_all_names_of_a_file() {
    let evil = "\u{1b}[31m\u{9b}2J\nx\u{202e}";
    let mut file: Value = serde_json::from_str(&with_choices()).expect("JSON");
    let names = [
        "scenes",
        "nodes",
        "meshes",
        "materials",
        "cameras",
        "animations",
    ];
    for list in names {
        for entry in file[list].as_array_mut().into_iter().flatten() {
            entry["name"] = json!(evil);
        }
    }
    let used = file["extensionsUsed"].as_array_mut().expect("extensions");
    used.push(json!(evil));
    let variants = &mut file["extensions"]["KHR_materials_variants"]["variants"];
    variants[0]["name"] = json!(evil);
    let folder = Folder::new();
    let model = folder.with_file("m.gltf", file.to_string());
    let run = estampe("info {}", &[&model]);
    assert_eq!(run.code, 0, "{}", run.err);
    let text = String::from_utf8(run.out).expect("text");
    let is_control = |c: char| (c.is_control() && c != '\n') || c == '\u{202e}';
    assert!(!text.contains(is_control), "{text:?}");
    let labels = [
        "extensions",
        "node",
        "mesh",
        "material",
        "camera",
        "scene",
        "animation",
        "variant",
    ];
    for label in labels {
        let shown =
            |line: &str| line.starts_with(&format!("  {label} ")) && line.contains("\\u{1b}[31m");
        assert!(text.lines().any(shown), "{label}: {text}");
    }
    assert!(text.lines().all(|line| !line.starts_with('x')), "{text}");
}

#[test]
fn a_model_without_anything_to_draw_is_refused_with_the_cause() {
    let folder = Folder::new();
    let model = folder.with_file("m.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let run = estampe("render {} -o {}", &[&model, &folder.path("m.png")]);
    assert_eq!(run.code, 1);
    let said = "m.obj: the model has no triangle, line or point to draw; line 1: the vertex does \
                not have three finite coordinates; elements that use it are omitted; check that";
    assert!(run.err.contains(said), "{}", run.err);
    let run = estampe("info {}", &[&model]);
    let text = String::from_utf8(run.out).expect("text");
    assert!(text.contains("bounds     none, nothing to draw"), "{text}");
    assert!(text.contains("(no name): nothing to draw"), "{text}");
}
