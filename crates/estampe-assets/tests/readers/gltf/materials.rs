//! Materials: factors, textures, defaults, and what stands in for them in the Phong model.

use super::{Builder, error, load};
use estampe_assets::Loaded;
use estampe_assets::image::{ImageFormat, encode};
use estampe_scene::{AlphaMode, Image, Material, PbrMaterial, TextureRef};
use glam::{Vec3, Vec4};
use serde_json::{Value, json};

pub(super) fn png(size: u32, rgba: [u8; 4]) -> Vec<u8> {
    encode(&Image::filled(size, size, rgba), ImageFormat::Png).expect("an image")
}

/// The triangle with two sets of texture coordinates, a material, five textures of five images,
/// and one sampler. The images are one texel each: image i has i in red.
pub(super) fn with_material(material: Value) -> Builder {
    let mut file = Builder::triangle();
    let uvs = file.floats(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    file.set(
        "/meshes/0/primitives/0/attributes",
        json!({ "POSITION": 0, "TEXCOORD_0": uvs, "TEXCOORD_1": uvs }),
    );
    file.set("/meshes/0/primitives/0/material", json!(0));
    file.set("/materials", json!([material]));
    let images = (0..5_u8).map(|i| {
        let view = file.view(&png(1, [i, 100, 200, 255]));
        json!({ "bufferView": view, "mimeType": "image/png" })
    });
    let images: Vec<Value> = images.collect();
    file.set("/images", json!(images));
    let textures: Vec<Value> = (0..5).map(|i| json!({ "source": i })).collect();
    file.set("/textures", json!(textures));
    file.set("/samplers", json!([{}]));
    file
}

pub(super) fn first(loaded: &Loaded) -> (&Material, &PbrMaterial) {
    let material = &loaded.scene.materials[0];
    (
        material,
        material
            .pbr
            .as_deref()
            .expect("glTF's are physically based"),
    )
}

/// Red of the image that a texture refers to, which is the image's index in the file.
pub(super) fn image_of(loaded: &Loaded, texture: Option<TextureRef>) -> u8 {
    loaded.scene.images[texture.expect("a texture").image].rgba[0]
}

#[test]
fn factors_and_textures_are_read() {
    let file = with_material(json!({
        "name": "paint",
        "pbrMetallicRoughness": {
            "baseColorFactor": [0.25, 0.5, 1, 0.5],
            "baseColorTexture": { "index": 4 },
            "metallicFactor": 0.25,
            "roughnessFactor": 0.75,
            "metallicRoughnessTexture": { "index": 3, "texCoord": 1 },
        },
        "normalTexture": { "index": 2, "scale": -2 },
        "occlusionTexture": { "index": 1, "strength": 0.5 },
        "emissiveTexture": { "index": 0 },
        "emissiveFactor": [1, 0.5, 0],
        "alphaMode": "MASK",
        "alphaCutoff": 0.25,
        "doubleSided": true,
    }));
    let loaded = load(&file.glb());
    assert_eq!(loaded.warnings, []);
    assert_eq!(loaded.scene.images.len(), 5);
    let (material, pbr) = first(&loaded);
    assert_eq!(material.name, "paint");
    assert_eq!(pbr.base_color, Vec4::new(0.25, 0.5, 1.0, 0.5));
    assert_eq!((pbr.metallic, pbr.roughness), (0.25, 0.75));
    let normal = pbr.normal_texture.unwrap();
    assert_eq!(
        (image_of(&loaded, Some(normal.texture)), normal.scale),
        (2, -2.0)
    );
    assert_eq!(image_of(&loaded, pbr.base_color_texture), 4);
    assert_eq!(image_of(&loaded, pbr.metallic_roughness_texture), 3);
    assert_eq!(pbr.metallic_roughness_texture.unwrap().uv_set, 1);
    assert_eq!(image_of(&loaded, pbr.occlusion_texture), 1);
    assert_eq!(pbr.occlusion_strength, 0.5);
    assert_eq!(image_of(&loaded, pbr.emissive_texture), 0);
    assert_eq!(pbr.emissive, Vec3::new(1.0, 0.5, 0.0));
    assert_eq!(
        (pbr.alpha_cutoff, pbr.is_double_sided, pbr.is_unlit),
        (0.25, true, false)
    );
    // The Phong model's fields.
    assert_eq!(material.base_color, Vec3::new(0.25, 0.5, 1.0));
    assert_eq!(
        (material.alpha_mode, material.opacity),
        (AlphaMode::Mask, 0.5)
    );
    assert_eq!(
        material.base_color_texture,
        pbr.base_color_texture.map(|t| t.image)
    );
    // The emitted light has a texture, which the Phong model does not read.
    assert_eq!(material.emissive, Vec3::ZERO);
}

#[test]
fn defaults_are_those_of_the_specification() {
    let loaded = load(&with_material(json!({})).glb());
    let (material, pbr) = first(&loaded);
    assert_eq!(*pbr, PbrMaterial::default());
    assert_eq!(
        (pbr.base_color, pbr.metallic, pbr.roughness),
        (Vec4::ONE, 1.0, 1.0)
    );
    assert_eq!(
        (pbr.ior, pbr.alpha_cutoff, pbr.emissive),
        (1.5, 0.5, Vec3::ZERO)
    );
    assert_eq!(
        (material.alpha_mode, material.opacity),
        (AlphaMode::Opaque, 1.0)
    );
    // Textures that no material has are not decoded.
    assert!(loaded.scene.images.is_empty());
    let empty = |extension: &str| {
        let extensions = json!({ "extensions": { extension: {} } });
        load(&with_material(extensions).glb()).scene.materials[0]
            .pbr
            .clone()
            .unwrap()
    };
    let specular = empty("KHR_materials_specular").specular.unwrap();
    assert_eq!((specular.factor, specular.color), (1.0, Vec3::ONE));
    assert_eq!(
        empty("KHR_materials_transmission")
            .transmission
            .unwrap()
            .factor,
        0.0
    );
    let volume = empty("KHR_materials_volume").volume.unwrap();
    assert_eq!(
        (volume.thickness, volume.attenuation_distance),
        (0.0, f32::INFINITY)
    );
    assert_eq!(volume.attenuation_color, Vec3::ONE);
    let coat = empty("KHR_materials_clearcoat").clearcoat.unwrap();
    assert_eq!((coat.factor, coat.roughness), (0.0, 0.0));
    let sheen = empty("KHR_materials_sheen").sheen.unwrap();
    assert_eq!((sheen.color, sheen.roughness), (Vec3::ZERO, 0.0));
    let anisotropy = empty("KHR_materials_anisotropy").anisotropy.unwrap();
    assert_eq!((anisotropy.strength, anisotropy.rotation_rad), (0.0, 0.0));
    let film = empty("KHR_materials_iridescence").iridescence.unwrap();
    assert_eq!((film.factor, film.ior), (0.0, 1.3));
    assert_eq!(
        (film.thickness_min_nm, film.thickness_max_nm),
        (100.0, 400.0)
    );
}

#[test]
fn factors_outside_of_their_range_are_clamped() {
    let loaded = load(&with_material(json!({
        "pbrMetallicRoughness":
            { "baseColorFactor": [-1, 2, 3e38, 0.5], "metallicFactor": 7, "roughnessFactor": -7 },
        "emissiveFactor": [3e38, -1, 0],
        "extensions": {
            "KHR_materials_emissive_strength": { "emissiveStrength": 3e38 },
            "KHR_materials_ior": { "ior": 0.5 },
            "KHR_materials_volume": { "attenuationDistance": 0 },
        },
    })).glb());
    let (material, pbr) = first(&loaded);
    assert_eq!(pbr.base_color, Vec4::new(0.0, 1.0, 1.0, 0.5));
    assert_eq!((pbr.metallic, pbr.roughness, pbr.ior), (1.0, 0.0, 1.0));
    assert_eq!(pbr.volume.unwrap().attenuation_distance, f32::INFINITY);
    assert!(material.emissive.is_finite() && material.shininess.is_finite());
    let zero = json!({ "extensions": { "KHR_materials_ior": { "ior": 0 } } });
    assert_eq!(first(&load(&with_material(zero).glb())).1.ior, 0.0);
}

#[test]
fn the_phong_model_follows_roughness_and_metal() {
    let phong = |metallic: f32, roughness: f32| {
        let factors = json!({ "baseColorFactor": [1, 0.5, 0, 1], "metallicFactor": metallic,
                              "roughnessFactor": roughness });
        let file = with_material(json!({ "pbrMetallicRoughness": factors }));
        let material = load(&file.glb()).scene.materials.swap_remove(0);
        (material.specular, material.shininess)
    };
    let near = |a: Vec3, b: Vec3| (a - b).length() < 1e-6;
    let (specular, shininess) = phong(0.0, 0.5);
    // 2 ÷ ½⁴ − 2.
    assert!(near(specular, Vec3::splat(0.15)) && shininess == 30.0);
    assert!(near(phong(1.0, 0.5).0, Vec3::new(0.15, 0.075, 0.0)));
    assert_eq!(phong(0.0, 1.0), (Vec3::ZERO, 1.0));
    assert_eq!(phong(0.0, 0.0).1, 1000.0);
}

#[test]
fn alpha_modes_are_those_of_the_file() {
    for (mode, alpha_mode, opacity) in [
        ("OPAQUE", AlphaMode::Opaque, 1.0),
        ("MASK", AlphaMode::Mask, 0.25),
        ("BLEND", AlphaMode::Blend, 0.25),
    ] {
        let factors = json!({ "baseColorFactor": [1, 1, 1, 0.25] });
        let file = with_material(json!({ "alphaMode": mode, "pbrMetallicRoughness": factors }));
        let material = load(&file.glb()).scene.materials.swap_remove(0);
        assert_eq!(
            (material.alpha_mode, material.opacity),
            (alpha_mode, opacity)
        );
    }
}

#[test]
fn wrong_materials_are_refused() {
    let refused = |pointer: &str, value: Value, message: &str| {
        let base = json!({ "baseColorTexture": { "index": 0 } });
        let file = with_material(json!({ "pbrMetallicRoughness": base }));
        let error = error(&file.with(pointer, value));
        assert!(error.contains(message), "{error}");
    };
    refused(
        "/meshes/0/primitives/0/material",
        json!(1),
        "/meshes/0/primitives/0/material: material 1 does not exist; the file has 1",
    );
    refused(
        "/materials/0/normalTexture",
        json!({ "index": 5 }),
        "/materials/0/normalTexture/index: texture 5 does not exist; the file has 5",
    );
    refused(
        "/materials/0/extensions",
        json!({ "KHR_materials_sheen": { "sheenColorTexture": { "index": 9 } } }),
        "/materials/0/extensions/KHR_materials_sheen/sheenColorTexture/index: texture 9",
    );
    refused(
        "/textures/0/source",
        json!(5),
        "/textures/0/source: image 5 does not exist",
    );
    refused(
        "/textures/0/sampler",
        json!(1),
        "/textures/0/sampler: sampler 1 does not exist",
    );
}
