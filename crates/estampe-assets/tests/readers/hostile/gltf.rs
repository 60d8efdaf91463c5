//! glTF files with most features.

use crate::gltf::builder::{Builder, F32, U8};
use estampe_assets::image::{ImageFormat, encode};
use estampe_scene::Image;
use serde_json::json;

/// A file with most features.
pub(super) fn fixture() -> Builder {
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
