//! Every prefix and thousands of random mutations of files with all features end with a scene or an
//! error.

use super::Builder;
use super::builder::{F32, U8, glb};
use crate::models_hostile::check;
use estampe_assets::image::{ImageFormat, encode};
use estampe_assets::model::{AnimationName, ModelOptions, NoResources};
use estampe_assets::{Limits, ModelFormat, ModelInput, parse_model_with};
use estampe_scene::Image;
use fastrand::Rng;
use serde_json::json;

/// A file with most features.
fn fixture() -> Builder {
    let mut file = Builder::triangle();
    let normals = file.vec3s(&[[0.0, 0.0, 1.0]; 3]);
    let tangents = file.floats(&[[1.0, 0.0, 0.0, 1.0]; 3]);
    let uvs = file.accessor("VEC2", U8, 3, &[0, 0, 0, 0, 255, 0, 0, 0, 0, 255]);
    file.set("/bufferViews/3/byteStride", json!(4));
    file.set(&format!("/accessors/{uvs}/normalized"), json!(true));
    let joints = file.accessor("VEC4", U8, 3, &[0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0]);
    let weights = file.floats(&[[0.5, 0.5, 0.0, 0.0]; 3]);
    let indices = file.indices(&[0, 1, 2, 2, 1, 0]);
    let change = file.vec3s(&[[0.0, 0.0, 1.0]; 3]);
    let sparse_indices = file.view(&[0, 2]);
    let sparse_values = file.view(&[1; 24]);
    file.set(
        "/accessors/7/sparse",
        json!({ "count": 2,
        "indices": { "bufferView": sparse_indices, "componentType": U8 },
        "values": { "bufferView": sparse_values } }),
    );
    let places = file.vec3s(&[[0.0; 3], [5.0, 0.0, 0.0]]);
    let times = file.scalars(&[0.0, 1.0]);
    let turns = file.floats(&[[0.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 0.0]]);
    let morphs = file.scalars(&[0.0, 1.0, 0.5, 1.0, 0.5, 0.5]);
    let image = encode(&Image::filled(2, 2, [9, 8, 7, 255]), ImageFormat::Png).unwrap();
    let image = file.view(&image);
    let attributes = json!({ "POSITION": 0, "NORMAL": normals, "TANGENT": tangents, "TEXCOORD_0": uvs,
        "TEXCOORD_1": uvs, "JOINTS_0": joints, "WEIGHTS_0": weights });
    file.set(
        "/meshes",
        json!([
            { "primitives": [
                { "attributes": attributes, "indices": indices, "material": 0,
                  "targets": [{ "POSITION": change, "NORMAL": change }] },
                { "attributes": { "POSITION": 0 }, "mode": 6 },
                { "attributes": { "POSITION": 0, "COLOR_0": normals }, "mode": 2, "material": 1 },
            ], "weights": [0.5] },
        ]),
    );
    file.set(
        "/materials",
        json!([
            { "pbrMetallicRoughness": { "baseColorTexture": { "index": 0, "texCoord": 1,
                "extensions": { "KHR_texture_transform": { "scale": [2, 2] } } } },
              "extensions": { "KHR_materials_volume": { "thicknessFactor": 1 } } },
            { "alphaMode": "BLEND", "extensions": { "KHR_materials_pbrSpecularGlossiness": {
                "specularGlossinessTexture": { "index": 0 } } } },
        ]),
    );
    file.set("/textures", json!([{ "source": 0, "sampler": 0 }]));
    file.set("/samplers", json!([{ "wrapS": 33071, "minFilter": 9984 }]));
    file.set(
        "/images",
        json!([{ "bufferView": image, "mimeType": "image/png" }]),
    );
    file.set("/skins", json!([{ "joints": [1, 2] }]));
    file.set(
        "/cameras",
        json!([{ "type": "perspective", "perspective": { "yfov": 1, "znear": 1 } }]),
    );
    file.set(
        "/extensionsUsed",
        json!(["KHR_lights_punctual", "KHR_materials_volume"]),
    );
    file.set(
        "/extensions",
        json!({ "KHR_lights_punctual":
        { "lights": [{ "type": "spot", "spot": {} }] } }),
    );
    let light = json!({ "KHR_lights_punctual": { "light": 0 } });
    let instances =
        json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": places } } });
    file.set(
        "/nodes",
        json!([
            { "mesh": 0, "skin": 0, "children": [1] },
            { "children": [2], "rotation": [0, 0, 1, 0], "camera": 0 },
            { "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, 4, 5, 1], "extensions": light },
            { "mesh": 0, "extensions": instances, "scale": [1, -1, 1], "weights": [1] },
        ]),
    );
    file.set("/scenes/0/nodes", json!([0, 3]));
    let channel = |sampler: u32, node: u32, path: &str| json!({ "sampler": sampler, "target": { "node": node, "path": path } });
    file.set(
        "/animations",
        json!([{
            "channels": [channel(0, 1, "rotation"), channel(1, 0, "weights")],
            "samplers": [{ "input": times, "output": turns },
                         { "input": times, "output": morphs, "interpolation": "CUBICSPLINE" }],
        }]),
    );
    // Not aligned, which is a warning.
    file.set(
        "/accessors/12",
        json!({ "bufferView": 0, "byteOffset": 2, "componentType": F32,
        "count": 1, "type": "SCALAR" }),
    );
    file
}

/// Reads a file and checks the scene. Returns true if there was one.
fn read(bytes: &[u8]) -> bool {
    let limits = Limits {
        max_image_pixels: 1 << 12,
        max_vertices: 1 << 12,
        max_triangles: 1 << 12,
        threads: 1,
        ..Limits::default()
    };
    let options = ModelOptions {
        animation: Some(AnimationName::Index(0)),
        time_s: 0.25,
        ..ModelOptions::default()
    };
    let input = ModelInput {
        bytes,
        format: ModelFormat::Gltf,
        name: "a.glb",
        resources: &NoResources,
    };
    match parse_model_with(&input, &options, &limits) {
        Ok(loaded) => {
            check(&loaded.scene);
            true
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            false
        }
    }
}

#[test]
fn the_fixture_has_what_is_mutated() {
    for bytes in [fixture().glb(), fixture().gltf()] {
        assert!(read(&bytes));
    }
    let mesh_count = fixture()
        .load_with(&ModelOptions::default())
        .scene
        .meshes
        .len();
    assert_eq!(mesh_count, 6);
}

/// Rows: M7.
#[test]
fn every_prefix_ends_well() {
    for bytes in [
        fixture().glb(),
        fixture().gltf(),
        Builder::triangle().glb(),
        Builder::triangle().gltf(),
    ] {
        for length in 0..bytes.len() {
            read(&bytes[..length]);
        }
    }
}

/// Rows: M7.
#[test]
fn mutations_of_the_bytes_end_well() {
    let glb = fixture().glb();
    let gltf = fixture().gltf();
    let mut random = Rng::with_seed(1);
    let mut survivors = 0;
    for round in 0..10_000 {
        let mut bytes = if round % 2 == 0 {
            glb.clone()
        } else {
            gltf.clone()
        };
        for _ in 0..=random.usize(..4) {
            let at = random.usize(..bytes.len());
            match random.u8(..4) {
                0 => bytes[at] ^= 1 << random.u8(..8),
                1 => bytes[at] = random.u8(..),
                2 => {
                    let end = bytes.len().min(at + random.usize(..40));
                    drop(bytes.drain(at..end));
                }
                _ => {
                    let end = bytes.len().min(at + random.usize(..40));
                    let part = bytes[at..end].to_vec();
                    bytes.splice(at..at, part);
                }
            }
        }
        survivors += usize::from(read(&bytes));
    }
    assert!(survivors > 100, "{survivors}");
}

/// Replaces numbers and names in the JSON, which leaves it valid and reaches all later stages.
///
/// Rows: M7.
#[test]
fn mutations_of_the_json_end_well() {
    let file = fixture();
    let mut whole = file.json.clone();
    whole["buffers"] = json!([{ "byteLength": file.bin.len() }]);
    let text = whole.to_string();
    let numbers: Vec<std::ops::Range<usize>> = number_ranges(&text);
    let words = [
        "0",
        "1",
        "2",
        "3",
        "7",
        "-1",
        "255",
        "65535",
        "4294967295",
        "18446744073709551615",
        "0.5",
        "1e39",
        "5120",
        "5123",
        "5125",
        "5126",
        "null",
        "\"\"",
        "{}",
        "[]",
    ];
    let mut random = Rng::with_seed(2);
    let mut survivors = 0;
    for _ in 0..10_000 {
        let mut json = text.clone();
        // From the end, so that earlier ranges stay valid.
        let mut chosen: Vec<_> = (0..=random.usize(..3))
            .map(|_| random.usize(..numbers.len()))
            .collect();
        chosen.sort_unstable();
        chosen.dedup();
        for &number in chosen.iter().rev() {
            json.replace_range(numbers[number].clone(), words[random.usize(..words.len())]);
        }
        let mut bin = file.bin.clone();
        if random.bool() {
            let at = random.usize(..bin.len());
            bin[at] = random.u8(..);
        }
        survivors += usize::from(read(&glb(json.as_bytes(), &bin)));
    }
    assert!(survivors > 1000, "{survivors}");
}

fn number_ranges(text: &str) -> Vec<std::ops::Range<usize>> {
    let is_part = |c: u8| c.is_ascii_digit() || matches!(c, b'.' | b'-');
    let bytes = text.as_bytes();
    let starts = (1..bytes.len())
        .filter(|&at| is_part(bytes[at]) && matches!(bytes[at - 1], b':' | b',' | b'['));
    starts
        .map(|start| {
            let length = bytes[start..].iter().position(|&c| !is_part(c));
            start..start + length.unwrap_or(0)
        })
        .collect()
}
