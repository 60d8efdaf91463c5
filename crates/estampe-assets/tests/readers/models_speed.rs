//! Speed of reading models. Run in release, by hand: `cargo test --release -p estampe-assets --test
//! models_speed -- --ignored --nocapture`

use estampe_assets::model::{NoResources, NormalMode, normals};
use estampe_assets::{Limits, ModelFormat, parse_model};
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

/// The grid's triangles: two for each cell of a wavy square.
fn grid(cells: usize) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
    let side = cells + 1;
    let at = |i: usize| i as f32 / cells as f32;
    let height = |x: f32, y: f32| {
        libm::sinf(x * 31.0) * libm::cosf(y * 29.0) * 0.05 + libm::sinf(x * 5.0) * 0.2
    };
    let points = (0..side * side).map(|i| {
        let (x, y) = (at(i % side), at(i / side));
        [x, height(x, y), y]
    });
    let index = |x: usize, y: usize| u32::try_from(y * side + x).unwrap();
    let triangles = (0..cells * cells).flat_map(|i| {
        let (x, y) = (i % cells, i / cells);
        let [a, b] = [index(x, y), index(x + 1, y)];
        let [c, d] = [index(x, y + 1), index(x + 1, y + 1)];
        [[a, c, b], [b, c, d]]
    });
    (points.collect(), triangles.collect())
}

fn obj(cells: usize, with_attributes: bool) -> Vec<u8> {
    let (points, triangles) = grid(cells);
    let mut text = String::new();
    for [x, y, z] in &points {
        writeln!(text, "v {x:.6} {y:.6} {z:.6}").unwrap();
    }
    if with_attributes {
        for [x, y, z] in &points {
            writeln!(text, "vt {x:.6} {z:.6}\nvn {y:.4} 1.0000 {y:.4}").unwrap();
        }
    }
    for [a, b, c] in triangles.iter().map(|t| t.map(|i| i + 1)) {
        if with_attributes {
            writeln!(text, "f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}").unwrap();
        } else {
            writeln!(text, "f {a} {b} {c}").unwrap();
        }
    }
    text.into_bytes()
}

fn stl(cells: usize) -> Vec<u8> {
    let (points, triangles) = grid(cells);
    let mut bytes = vec![0; 80];
    bytes.extend(u32::try_from(triangles.len()).unwrap().to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        bytes.extend(
            triangle
                .iter()
                .flat_map(|&i| points[i as usize])
                .flat_map(f32::to_le_bytes),
        );
        bytes.extend([0; 2]);
    }
    bytes
}

fn ply(cells: usize) -> Vec<u8> {
    let (points, triangles) = grid(cells);
    let mut bytes = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\n\
         property float y\nproperty float z\nelement face {}\n\
         property list uchar int vertex_indices\nend_header\n",
        points.len(),
        triangles.len()
    )
    .into_bytes();
    bytes.extend(
        points
            .iter()
            .flatten()
            .flat_map(|value| value.to_le_bytes()),
    );
    for triangle in triangles {
        bytes.push(3);
        bytes.extend(triangle.iter().flat_map(|index| index.to_le_bytes()));
    }
    bytes
}

/// A GLB file, with normals and texture coordinates or with positions alone.
fn glb(cells: usize, with_attributes: bool) -> Vec<u8> {
    let (points, triangles) = grid(cells);
    let indices: Vec<u8> = triangles
        .as_flattened()
        .iter()
        .flat_map(|index| index.to_le_bytes())
        .collect();
    let numbers = |values: &[f32]| -> Vec<u8> {
        values
            .iter()
            .flat_map(|value| value.to_le_bytes())
            .collect()
    };
    let count = points.len();
    let mut parts = vec![
        ("SCALAR", 5125, triangles.len() * 3, indices),
        ("VEC3", 5126, count, numbers(points.as_flattened())),
    ];
    let mut attributes = serde_json::json!({ "POSITION": 1 });
    if with_attributes {
        let uvs: Vec<f32> = points.iter().flat_map(|&[x, _, z]| [x, z]).collect();
        let normals = vec![[0.0, 1.0, 0.0]; count];
        parts.push(("VEC3", 5126, count, numbers(normals.as_flattened())));
        parts.push(("VEC2", 5126, count, numbers(&uvs)));
        attributes = serde_json::json!({ "POSITION": 1, "NORMAL": 2, "TEXCOORD_0": 3 });
    }
    let mut bin = Vec::new();
    let mut views = Vec::new();
    let mut accessors = Vec::new();
    for (view, (kind, component, count, bytes)) in parts.iter().enumerate() {
        views.push(
            serde_json::json!({ "buffer": 0, "byteOffset": bin.len(), "byteLength": bytes.len() }),
        );
        accessors.push(
            serde_json::json!({ "bufferView": view, "componentType": component,
            "count": count, "type": kind }),
        );
        bin.extend(bytes);
    }
    let json = serde_json::json!({
        "asset": { "version": "2.0" },
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0, "translation": [1, 2, 3], "rotation": [0, 1, 0, 0] }],
        "meshes": [{ "primitives": [{ "attributes": attributes, "indices": 0 }] }],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{ "byteLength": bin.len() }],
    });
    crate::gltf::builder::glb(json.to_string().as_bytes(), &bin)
}

fn measure(name: &str, bytes: &[u8], format: ModelFormat) {
    let limits = Limits::default();
    let mut times = Vec::new();
    let mut count = 0;
    let mut meshes = Vec::new();
    for _ in 0..7 {
        let start = Instant::now();
        let loaded = parse_model(bytes, format, name, &NoResources, &limits).unwrap();
        times.push(start.elapsed().as_secs_f64());
        count = loaded
            .scene
            .meshes
            .iter()
            .map(|mesh| mesh.triangles.len())
            .sum();
        meshes = loaded.scene.meshes;
    }
    times.sort_by(f64::total_cmp);
    let start = Instant::now();
    normals::replace(&mut meshes, NormalMode::default());
    let normals_ms = start.elapsed().as_secs_f64() * 1e3;
    let megabytes = bytes.len() as f64 / 1e6;
    eprintln!(
        "{name}: {count} triangles, {megabytes:.1} MB, {:.1} ms, {:.0} MB/s; normals alone {normals_ms:.1} ms",
        times[3] * 1e3,
        megabytes / times[3]
    );
}

#[test]
#[ignore = "a measurement, not a check"]
fn speed() {
    measure("grid 1 M, obj v", &obj(707, false), ModelFormat::Obj);
    measure("grid 1 M, obj v/vt/vn", &obj(707, true), ModelFormat::Obj);
    measure("grid 1 M, glb", &glb(707, true), ModelFormat::Gltf);
    measure("grid 1 M, glb flat", &glb(707, false), ModelFormat::Gltf);
    measure("grid 70 k, stl", &stl(187), ModelFormat::Stl);
    measure("grid 1 M, stl", &stl(707), ModelFormat::Stl);
    measure("grid 70 k, ply", &ply(187), ModelFormat::Ply);
    measure("grid 1 M, ply", &ply(707), ModelFormat::Ply);
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data/models");
    for (file, format) in [
        ("stanford-bunny.obj", ModelFormat::Obj),
        ("african_head/african_head.obj", ModelFormat::Obj),
        ("ply/bunny.ply", ModelFormat::Ply),
    ] {
        if let Ok(bytes) = std::fs::read(data.join(file)) {
            measure(file, &bytes, format);
        }
    }
}
