//! Textures that are not where the model says.

use estampe_assets::image::{ImageFormat, encode};
use estampe_assets::{Limits, Loaded, load_model};
use estampe_scene::Image;
use serde_json::json;
use std::fs;
use std::path::PathBuf;

/// A temporary folder with `textures/a.png` and an empty `source`.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let root = std::env::temp_dir().join(format!("estampe-{name}-{}", std::process::id()));
        for folder in ["source", "textures"] {
            fs::create_dir_all(root.join(folder)).unwrap();
        }
        let image = encode(&Image::filled(1, 1, [1, 2, 3, 255]), ImageFormat::Png).unwrap();
        fs::write(root.join("textures/a.png"), image).unwrap();
        Self(root)
    }

    fn load(&self, name: &str, text: &str) -> Loaded {
        let path = self.0.join("source").join(name);
        fs::write(&path, text).unwrap();
        load_model(&path, None, &Limits::default()).unwrap()
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

#[test]
fn names_of_another_machine_are_searched_by_their_last_part() {
    let scratch = Scratch::new("elsewhere-obj");
    let obj = "mtllib m.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let load = |texture: &str| {
        let mtl = format!("newmtl m\nmap_Kd {texture}\n");
        fs::write(scratch.0.join("source/m.mtl"), mtl).unwrap();
        scratch.load("m.obj", obj)
    };
    for texture in [
        "../textures/a.png",
        "D:\\work\\textures\\A.PNG",
        "/tmp/none/a.png",
    ] {
        let loaded = load(texture);
        assert_eq!(loaded.warnings, [], "{texture}");
        assert_eq!(loaded.scene.images[0].rgba, [1, 2, 3, 255]);
    }
    let loaded = load("D:\\work\\b.png");
    assert_eq!(loaded.scene.images, []);
    let expected = "m.mtl, line 2: the texture `D:\\work\\b.png` is omitted: there is no file `b.png` in \
        the model's folder or `../textures`, or below; copy it there, or add its folder as a root";
    let warning = loaded.warnings[0].to_string();
    assert!(warning.ends_with(expected), "{warning}");
}

#[test]
fn images_of_gltf_are_searched_and_its_buffers_are_not() {
    let scratch = Scratch::new("elsewhere-gltf");
    fs::write(scratch.0.join("textures/b.bin"), [0; 12]).unwrap();
    let gltf = |uri: &str, buffer: &str| {
        let base = json!({ "baseColorTexture": { "index": 0 } });
        let view = json!({ "bufferView": 0, "componentType": 5121, "count": 3, "type": "VEC3" });
        let primitive = json!({ "attributes": { "POSITION": 0 }, "material": 0 });
        json!({ "asset": { "version": "2.0" }, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
            "meshes": [{ "primitives": [primitive] }], "accessors": [view],
            "bufferViews": [{ "buffer": 0, "byteLength": 12, "byteStride": 4 }],
            "buffers": [{ "byteLength": 12, "uri": buffer }],
            "images": [{ "uri": uri }], "textures": [{ "source": 0 }],
            "materials": [{ "pbrMetallicRoughness": base }] })
        .to_string()
    };
    let data = "data:;base64,AAAAAAIAAAAAAQAA";
    for uri in ["%2e%2e/textures/a.png", "file:///D:/textures/a.png"] {
        let loaded = scratch.load("m.gltf", &gltf(uri, data));
        let is_of_image = |pointer: &str| pointer.starts_with("/images");
        let pointers = loaded.warnings.iter().map(|warning| &*warning.json_pointer);
        assert_eq!(
            pointers.filter(|pointer| is_of_image(pointer)).count(),
            0,
            "{uri}"
        );
        assert_eq!(loaded.scene.images.len(), 1);
    }
    let path = scratch.0.join("source/m.gltf");
    fs::write(&path, gltf("a.png", "../textures/b.bin")).unwrap();
    let error = load_model(&path, None, &Limits::default()).unwrap_err();
    assert!(
        error.to_string().contains("outside the model's folder"),
        "{error}"
    );
}
