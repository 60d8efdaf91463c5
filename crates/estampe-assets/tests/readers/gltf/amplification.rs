//! Small files that name large things many times end soon, with an error.

use super::Builder;
use super::builder::{F32, U16};
use crate::hostile::peak_bytes;
use estampe_assets::model::{AnimationName, ModelOptions, NoResources};
use estampe_assets::{Limits, ModelFormat, ModelInput, parse_model_with};
use serde_json::{Value, json};
use std::time::{Duration, Instant};

/// Reads a file that must end with an error, or must be read, well within the time.
fn ends_soon(file: &Builder, message: Option<&str>) {
    let options = ModelOptions {
        animation: file.json.get("animations").map(|_| AnimationName::Index(0)),
        ..ModelOptions::default()
    };
    let limits = Limits {
        max_vertices: 1_000_000,
        ..Limits::default()
    };
    let bytes = file.glb();
    let input = ModelInput {
        bytes: &bytes,
        format: ModelFormat::Gltf,
        name: "a.glb",
        resources: &NoResources,
    };
    let start = Instant::now();
    let result = parse_model_with(&input, &options, &limits);
    // Each of these took minutes or more memory than there is before there were limits.
    assert!(
        start.elapsed() < Duration::from_secs(10),
        "{:?}",
        start.elapsed()
    );
    match (result, message) {
        (Ok(_), None) => {}
        (Err(error), Some(message)) => {
            let error = error.to_string();
            assert!(error.contains(message), "{error}");
        }
        (result, _) => panic!("{:?}", result.map(|loaded| loaded.warning_count)),
    }
}

/// `count` nodes of the scene.
fn nodes(file: &mut Builder, node: Value, count: usize) {
    file.set("/nodes", json!(vec![node; count]));
    let roots: Vec<usize> = (0..count).collect();
    file.set("/scenes/0/nodes", json!(roots));
}

/// An accessor without bytes.
fn zeros(count: usize, kind: &str) -> Value {
    json!({ "componentType": F32, "count": count, "type": kind })
}

#[test]
fn many_nodes_with_one_large_mesh() {
    let mut file = Builder::with_mesh(json!({ "attributes": { "POSITION": 0 } }));
    file.set("/accessors", json!([zeros(200_000, "VEC3")]));
    nodes(&mut file, json!({ "mesh": 0 }), 6);
    ends_soon(
        &file,
        Some("1200000 vertices are more than the limit of 1000000"),
    );
}

#[test]
fn many_nodes_with_many_empty_primitives() {
    let mut file = Builder::new();
    let primitives = vec![json!({ "attributes": {} }); 60_000];
    file.set("/meshes", json!([{ "primitives": primitives }]));
    nodes(&mut file, json!({ "mesh": 0 }), 60_000);
    ends_soon(
        &file,
        Some(
            "1000001 primitives, morph targets and variants of nodes are more than the limit of 1000000",
        ),
    );
}

#[test]
fn many_nodes_with_many_instances_of_nothing() {
    let mut file = Builder::new();
    file.set("/meshes", json!([{ "primitives": [] }]));
    file.set("/accessors", json!([zeros(400_000, "VEC3")]));
    let attributes = json!({ "attributes": { "TRANSLATION": 0 } });
    let node = json!({ "mesh": 0, "extensions": { "EXT_mesh_gpu_instancing": attributes } });
    nodes(&mut file, node, 1000);
    ends_soon(
        &file,
        Some("1200000 instances are more than the limit of 1000000"),
    );
}

#[test]
fn many_nodes_with_a_large_skin() {
    let mut file = Builder::new();
    file.set("/meshes", json!([{ "primitives": [] }]));
    file.set("/skins", json!([{ "joints": vec![0; 200_000] }]));
    nodes(&mut file, json!({ "mesh": 0, "skin": 0 }), 60_000);
    // Computed once.
    ends_soon(&file, None);
}

#[test]
fn many_skins_with_large_sparse_matrices() {
    let mut file = Builder::new();
    let indices: Vec<u8> = (0..1_u16 << 15).flat_map(u16::to_le_bytes).collect();
    let indices = json!({ "bufferView": file.view(&indices), "componentType": U16 });
    let values = json!({ "bufferView": file.view(&vec![0; 64 << 15]) });
    let mut matrices = zeros(1 << 16, "MAT4");
    matrices["sparse"] = json!({ "count": 1 << 15, "indices": indices, "values": values });
    file.set("/accessors", json!([matrices]));
    let skins: Vec<Value> = vec![json!({ "joints": [], "inverseBindMatrices": 0 }); 100_000];
    file.set("/skins", json!(skins));
    file.set("/meshes", json!([{ "primitives": [] }]));
    let place: Vec<Value> = (0..100_000)
        .map(|skin| json!({ "mesh": 0, "skin": skin }))
        .collect();
    file.set("/nodes", json!(place));
    let roots: Vec<usize> = (0..100_000).collect();
    file.set("/scenes/0/nodes", json!(roots));
    ends_soon(
        &file,
        Some("/skins/30: 1015808 joints are more than the limit of 1000000"),
    );
}

#[test]
fn many_nodes_with_many_morph_targets_of_no_weight() {
    let mut file = Builder::triangle();
    let targets = vec![json!({}); 100_000];
    file.set("/meshes/0/primitives/0/targets", json!(targets));
    file.set("/meshes/0/weights", json!(vec![0; 100_000]));
    nodes(&mut file, json!({ "mesh": 0 }), 60_000);
    let message = "1000010 primitives, morph targets and variants of nodes are more than the limit of 1000000";
    ends_soon(&file, Some(message));
}

#[test]
fn a_long_name_of_many_meshes() {
    let mut file = Builder::triangle();
    let primitives = vec![json!({ "attributes": { "POSITION": 0 } }); 30_000];
    file.set("/meshes", json!([{ "primitives": primitives }]));
    file.set("/nodes/0/name", json!("ä".repeat(1 << 20)));
    ends_soon(&file, None);
    let loaded = file.load_with(&ModelOptions::default());
    assert_eq!(loaded.scene.meshes[29_999].name, "ä".repeat(256));
}

/// The report of the tree has two names for each node.
#[test]
fn a_long_name_of_the_mesh_of_many_nodes() {
    let mut file = Builder::with_mesh(json!({ "attributes": {} }));
    file.set("/meshes/0/name", json!("ä".repeat(1 << 16)));
    nodes(&mut file, json!({ "mesh": 0 }), 20_000);
    let (loaded, peak) = peak_bytes(|| file.load_with(&ModelOptions::default()));
    let contents = &loaded.contents;
    assert_eq!(
        (contents.nodes.len(), contents.node_count),
        (10_000, 20_000)
    );
    assert_eq!(contents.nodes[9_999].mesh, Some("ä".repeat(256)));
    assert!(peak < 64 << 20, "{peak}");
}

#[test]
fn many_channels_with_many_weights() {
    let mut file = Builder::triangle();
    let targets = vec![json!({}); 100_000];
    file.set("/meshes/0/primitives/0/targets", json!(targets));
    file.set("/accessors/1", zeros(1, "SCALAR"));
    file.set("/accessors/2", zeros(100_000, "SCALAR"));
    let channel = json!({ "sampler": 0, "target": { "node": 0, "path": "weights" } });
    let channels = vec![channel; 100_000];
    let sampler = json!({ "input": 1, "output": 2 });
    file.set(
        "/animations",
        json!([{ "channels": channels, "samplers": [sampler] }]),
    );
    ends_soon(&file, Some("keyframes are more than the limit of"));
}

#[test]
fn many_images_of_one_large_view() {
    let mut file = Builder::triangle();
    let image = estampe_scene::Image::filled(1, 1, [1; 4]);
    let png = estampe_assets::image::ImageFormat::Png;
    let mut bytes = estampe_assets::image::encode(&image, png).unwrap();
    bytes.resize(1 << 20, 0);
    file.view(&bytes);
    // Views that differ and have the same bytes.
    let view = file.json["bufferViews"][1].clone();
    for at in 1..=2000 {
        file.set(&format!("/bufferViews/{at}"), view.clone());
    }
    let images: Vec<Value> = (1..=2000)
        .map(|view| json!({ "bufferView": view }))
        .collect();
    file.set("/images", json!(images));
    let textures: Vec<Value> = (0..2000).map(|image| json!({ "source": image })).collect();
    file.set("/textures", json!(textures));
    let materials: Vec<Value> = (0..2000)
        .map(|texture| json!({ "emissiveTexture": { "index": texture } }))
        .collect();
    file.set("/materials", json!(materials));
    let primitives: Vec<Value> = (0..2000)
        .map(|material| json!({ "attributes": { "POSITION": 0 }, "material": material }))
        .collect();
    file.set("/meshes", json!([{ "primitives": primitives }]));
    let loaded = file.load_with(&ModelOptions::default());
    // 1 GiB of encoded images, the rest are warnings.
    assert_eq!(loaded.scene.images.len(), 1024);
    assert!(loaded.warning_count >= 2000 - 1024);
}
