//! Meshes: modes, attributes, component types, sparse accessors.

use super::builder::{F32, I8, I16, U8, U16, U32, bytes_of};
use super::{Builder, load, mesh};
use estampe_scene::{AlphaMode, Mesh, UpAxis};
use glam::{Vec2, Vec3};
use serde_json::json;

#[test]
fn a_triangle_is_read_from_glb_and_from_json() {
    let file = Builder::triangle();
    for bytes in [file.glb(), file.gltf()] {
        let loaded = load(&bytes);
        assert_eq!(loaded.warnings, []);
        assert_eq!(loaded.format, estampe_assets::ModelFormat::Gltf);
        let scene = loaded.scene;
        assert_eq!(scene.up, UpAxis::Y);
        let mesh = &scene.meshes[0];
        assert_eq!(mesh.positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
        assert_eq!(mesh.triangles, [[0, 1, 2]]);
        // Without normals the triangles are flat.
        assert_eq!(mesh.normals, [Vec3::Z; 3]);
        // The default material is white and rough.
        let material = &scene.materials[mesh.surfaces[0].material.unwrap()];
        assert_eq!(material.base_color, Vec3::ONE);
        assert_eq!(material.alpha_mode, AlphaMode::Opaque);
        assert_eq!(material.pbr.as_ref().unwrap().metallic, 1.0);
    }
}

/// A file with five vertices on a line, and a primitive of a mode.
fn of_mode(mode: u32) -> Builder {
    let mut file = Builder::with_mesh(json!({ "attributes": { "POSITION": 0 }, "mode": mode }));
    let corners: Vec<[f32; 3]> = [0.0, 1.0, 2.0, 3.0, 4.0].map(|x| [x, x * x, 0.0]).to_vec();
    file.vec3s(&corners);
    file
}

#[test]
fn every_mode_connects_vertices_as_the_specification_says() {
    let read = |mode| {
        let loaded = load(&of_mode(mode).glb());
        let mesh = loaded.scene.meshes.into_iter().next().unwrap();
        // Flat normals split vertices, so corners are compared by their x.
        let xs: Vec<f32> = (0..5_u8).map(f32::from).collect();
        let number = |x: f32| u32::try_from(xs.iter().position(|&own| own == x).unwrap()).unwrap();
        let at = |vertex: u32| number(mesh.positions[vertex as usize].x);
        let triangles: Vec<[u32; 3]> = mesh.triangles.iter().map(|t| t.map(at)).collect();
        (mesh.points, mesh.lines, triangles, loaded.warning_count)
    };
    assert_eq!(read(0), (vec![0, 1, 2, 3, 4], vec![], vec![], 0));
    assert_eq!(read(1), (vec![], vec![[0, 1], [2, 3]], vec![], 1));
    let strip = vec![[0, 1], [1, 2], [2, 3], [3, 4]];
    assert_eq!(read(3), (vec![], strip.clone(), vec![], 0));
    let closed = [strip, vec![[4, 0]]].concat();
    assert_eq!(read(2), (vec![], closed, vec![], 0));
    assert_eq!(read(4), (vec![], vec![], vec![[0, 1, 2]], 1));
    let strip = vec![[0, 1, 2], [1, 3, 2], [2, 3, 4]];
    assert_eq!(read(5), (vec![], vec![], strip, 0));
    let fan = vec![[1, 2, 0], [2, 3, 0], [3, 4, 0]];
    assert_eq!(read(6), (vec![], vec![], fan, 0));
}

#[test]
fn indices_have_three_types() {
    for (component, bytes) in [
        (U8, vec![2, 1, 0]),
        (U16, vec![2, 0, 1, 0, 0, 0]),
        (U32, vec![2, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0]),
    ] {
        let mut file = Builder::triangle();
        let indices = file.accessor("SCALAR", component, 3, &bytes);
        file.set("/meshes/0/primitives/0/indices", json!(indices));
        assert_eq!(mesh(&file).triangles, [[2, 1, 0]], "{component}");
    }
}

#[test]
fn attributes_are_read() {
    let mut file = Builder::triangle();
    let normals = file.vec3s(&[[0.0, 0.0, 2.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]);
    let tangents = file.floats(&[
        [2.0, 0.0, 0.0, 1.0],
        [1.0, 0.0, 0.0, -1.0],
        [0.0, 0.0, 0.0, 1.0],
    ]);
    let uvs = file.floats(&[[0.0, 0.25], [1.0, 0.5], [f32::NAN, 2.0]]);
    let uvs1 = file.floats(&[[0.5, 0.5], [0.0, 0.0], [1.0, f32::INFINITY]]);
    let colors = file.floats(&[[1.0, 0.5, 0.0], [2.0, -1.0, f32::NAN], [0.0; 3]]);
    file.set(
        "/meshes/0/primitives/0/attributes",
        json!({ "POSITION": 0, "NORMAL": normals, "TANGENT": tangents, "TEXCOORD_0": uvs,
                "TEXCOORD_1": uvs1, "COLOR_0": colors, "_OWN": normals }),
    );
    let mesh = mesh(&file);
    assert_eq!(mesh.normals, [Vec3::Z, Vec3::Y, Vec3::Z]);
    assert_eq!(
        mesh.uvs,
        [Vec2::new(0.0, 0.25), Vec2::new(1.0, 0.5), Vec2::ZERO]
    );
    assert_eq!(mesh.colors[0], [1.0, 0.5, 0.0, 1.0]);
    assert_eq!(mesh.colors[1], [1.0, 0.0, 0.0, 1.0]);
    let tangents = mesh.attribute(Mesh::TANGENT).unwrap();
    assert_eq!(
        tangents.values,
        [1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 1.0]
    );
    let uvs1 = mesh.attribute(Mesh::UV1).unwrap();
    assert_eq!(
        (uvs1.components, &*uvs1.values),
        (2, &[0.5, 0.5, 0.0, 0.0, 0.0, 0.0][..])
    );
}

#[test]
fn integers_are_numbers_or_normalized() {
    let read = |component: u32, bytes: &[u8], is_normalized: bool| {
        let mut file = Builder::with_mesh(json!({ "attributes": { "POSITION": 0 }, "mode": 0 }));
        file.accessor("VEC3", component, 1, bytes);
        file.set("/accessors/0/normalized", json!(is_normalized));
        mesh(&file).positions[0].to_array()
    };
    assert_eq!(read(U8, &[0, 51, 255], true), [0.0, 0.2, 1.0]);
    assert_eq!(read(U8, &[0, 51, 255], false), [0.0, 51.0, 255.0]);
    // −128 and −127 are both −1.
    assert_eq!(read(I8, &[0x80, 0x81, 0x7f], true), [-1.0, -1.0, 1.0]);
    assert_eq!(read(I8, &[0x80, 0xff, 0x7f], false), [-128.0, -1.0, 127.0]);
    let words = [0_u16, 13107, 65535].map(u16::to_le_bytes).concat();
    assert_eq!(read(U16, &words, true), [0.0, 0.2, 1.0]);
    assert_eq!(read(U16, &words, false), [0.0, 13107.0, 65535.0]);
    let words = [-32768_i16, -32767, 32767].map(i16::to_le_bytes).concat();
    assert_eq!(read(I16, &words, true), [-1.0, -1.0, 1.0]);
    assert_eq!(read(I16, &words, false), [-32768.0, -32767.0, 32767.0]);
}

#[test]
fn elements_may_be_interleaved() {
    let mut file = Builder::with_mesh(json!({ "attributes": { "POSITION": 0, "TEXCOORD_0": 1 } }));
    let rows = [
        [0.0, 0.0, 0.0, 0.5, 0.5],
        [1.0, 0.0, 0.0, 0.25, 0.0],
        [0.0, 1.0, 0.0, 0.0, 0.75],
    ];
    file.view(&bytes_of(rows.as_flattened()));
    file.set("/bufferViews/0/byteStride", json!(20));
    let accessor = |offset: u32, kind: &str| json!({ "bufferView": 0, "byteOffset": offset, "componentType": F32, "count": 3, "type": kind });
    file.set(
        "/accessors",
        json!([accessor(0, "VEC3"), accessor(12, "VEC2")]),
    );
    let mesh = mesh(&file);
    assert_eq!(mesh.positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
    assert_eq!(
        mesh.uvs,
        [Vec2::splat(0.5), Vec2::new(0.25, 0.0), Vec2::new(0.0, 0.75)]
    );
}

#[test]
fn sparse_accessors_replace_elements() {
    let mut file = Builder::triangle();
    let indices = file.view(&[1, 2]);
    let values = file.view(&bytes_of(&[5.0, 0.0, 0.0, 0.0, 7.0, 0.0]));
    let sparse = json!({
        "count": 2,
        "indices": { "bufferView": indices, "componentType": U8 },
        "values": { "bufferView": values },
    });
    file.set("/accessors/0/sparse", sparse.clone());
    let expected = [Vec3::ZERO, Vec3::X * 5.0, Vec3::Y * 7.0];
    assert_eq!(mesh(&file).positions, expected);
    // Without a buffer view the other elements are 0.
    let zeros = json!({ "componentType": F32, "count": 3, "type": "VEC3", "sparse": sparse });
    file.set("/accessors/0", zeros);
    assert_eq!(mesh(&file).positions, expected);
}

#[test]
fn lines_and_points_have_the_colour_of_their_material() {
    let mut file = of_mode(0);
    let colors = file.floats(&[[1.0, 1.0, 0.5, 1.0]; 5]);
    file.set("/meshes/0/primitives/0/attributes/COLOR_0", json!(colors));
    file.set("/meshes/0/primitives/0/material", json!(0));
    let material = json!({ "pbrMetallicRoughness": { "baseColorFactor": [0.5, 1.0, 1.0, 1.0] } });
    file.set("/materials", json!([material]));
    assert_eq!(mesh(&file).colors, [[0.5, 1.0, 0.5, 1.0]; 5]);
}

#[test]
fn missing_flat_normals_keep_all_attributes() {
    // Two triangles of a strip that share an edge and bend there: its vertices are split.
    let mut file = Builder::with_mesh(
        json!({ "attributes": { "POSITION": 0, "TEXCOORD_0": 1, "TEXCOORD_1": 2 }, "mode": 5 }),
    );
    file.vec3s(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 1.0]]);
    let uvs = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
    file.floats(&uvs);
    file.floats(&uvs);
    let mesh = mesh(&file);
    assert_eq!(mesh.positions.len(), 6);
    let second = mesh.attribute(Mesh::UV1).expect("a value for every vertex");
    for (vertex, uv) in mesh.uvs.iter().enumerate() {
        assert_eq!(uv.to_array(), second.values[vertex * 2..][..2]);
        assert_eq!(uv.x, mesh.positions[vertex].x);
    }
}
