//! Materials, their extensions, textures and images.

use super::builder::{base64, with_files};
use super::{Builder, error, load};
use estampe_assets::image::{ImageFormat, encode};
use estampe_assets::model::ModelOptions;
use estampe_assets::{AssetError, Limits, Loaded};
use estampe_scene::{
    AddressMode, AlphaMode, Image, Material, PbrMaterial, TextureFilter, TextureRef,
    TextureSampler, UvTransform,
};
use glam::{Vec2, Vec3, Vec4};
use serde_json::{Value, json};

fn png(size: u32, rgba: [u8; 4]) -> Vec<u8> {
    encode(&Image::filled(size, size, rgba), ImageFormat::Png).expect("an image")
}

/// The triangle with two sets of texture coordinates, a material, five textures of five images,
/// and one sampler. The images are one texel each: image i has i in red.
fn with_material(material: Value) -> Builder {
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

fn first(loaded: &Loaded) -> (&Material, &PbrMaterial) {
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
fn image_of(loaded: &Loaded, texture: Option<TextureRef>) -> u8 {
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
fn every_extension_of_materials_is_read() {
    let texture = |index: u32| json!({ "index": index });
    let file = with_material(json!({
        "emissiveFactor": [0.5, 0.5, 1],
        "extensions": {
            "KHR_materials_unlit": {},
            "KHR_materials_emissive_strength": { "emissiveStrength": 4 },
            "KHR_materials_ior": { "ior": 1.33 },
            "KHR_materials_dispersion": { "dispersion": 0.1 },
            "KHR_materials_specular": {
                "specularFactor": 0.5, "specularTexture": texture(0),
                "specularColorFactor": [2, 1, 0], "specularColorTexture": texture(1),
            },
            "KHR_materials_transmission":
                { "transmissionFactor": 0.5, "transmissionTexture": texture(2) },
            "KHR_materials_volume": {
                "thicknessFactor": 2, "thicknessTexture": texture(3),
                "attenuationDistance": 10, "attenuationColor": [1, 0.5, 0.25],
            },
            "KHR_materials_clearcoat": {
                "clearcoatFactor": 0.75, "clearcoatTexture": texture(4),
                "clearcoatRoughnessFactor": 0.125, "clearcoatRoughnessTexture": texture(3),
                "clearcoatNormalTexture": { "index": 2, "scale": 0.5 },
            },
            "KHR_materials_sheen": {
                "sheenColorFactor": [0.25, 0.5, 0.75], "sheenColorTexture": texture(1),
                "sheenRoughnessFactor": 0.25, "sheenRoughnessTexture": texture(0),
            },
            "KHR_materials_anisotropy": {
                "anisotropyStrength": 0.5, "anisotropyRotation": 1.5, "anisotropyTexture": texture(4),
            },
            "KHR_materials_iridescence": {
                "iridescenceFactor": 1, "iridescenceTexture": texture(2), "iridescenceIor": 1.8,
                "iridescenceThicknessMinimum": 50, "iridescenceThicknessMaximum": 700,
                "iridescenceThicknessTexture": texture(1),
            },
        },
    }));
    let loaded = load(&file.glb());
    let (material, pbr) = first(&loaded);
    let image = |texture| image_of(&loaded, texture);
    assert!(pbr.is_unlit);
    assert_eq!(
        (pbr.emissive_strength, pbr.ior, pbr.dispersion),
        (4.0, 1.33, 0.1)
    );
    assert_eq!(material.emissive, Vec3::new(2.0, 2.0, 4.0));
    let specular = pbr.specular.unwrap();
    assert_eq!(
        (specular.factor, specular.color),
        (0.5, Vec3::new(2.0, 1.0, 0.0))
    );
    assert_eq!(
        (image(specular.texture), image(specular.color_texture)),
        (0, 1)
    );
    let transmission = pbr.transmission.unwrap();
    assert_eq!((transmission.factor, image(transmission.texture)), (0.5, 2));
    let volume = pbr.volume.unwrap();
    assert_eq!(
        (volume.thickness, image(volume.thickness_texture)),
        (2.0, 3)
    );
    assert_eq!(volume.attenuation_distance, 10.0);
    assert_eq!(volume.attenuation_color, Vec3::new(1.0, 0.5, 0.25));
    let coat = pbr.clearcoat.unwrap();
    assert_eq!((coat.factor, image(coat.texture)), (0.75, 4));
    assert_eq!((coat.roughness, image(coat.roughness_texture)), (0.125, 3));
    let normal = coat.normal_texture.unwrap();
    assert_eq!((normal.scale, image(Some(normal.texture))), (0.5, 2));
    let sheen = pbr.sheen.unwrap();
    assert_eq!(
        (sheen.color, sheen.roughness),
        (Vec3::new(0.25, 0.5, 0.75), 0.25)
    );
    assert_eq!(
        (image(sheen.color_texture), image(sheen.roughness_texture)),
        (1, 0)
    );
    let anisotropy = pbr.anisotropy.unwrap();
    assert_eq!((anisotropy.strength, anisotropy.rotation_rad), (0.5, 1.5));
    assert_eq!(image(anisotropy.texture), 4);
    let film = pbr.iridescence.unwrap();
    assert_eq!((film.factor, film.ior), (1.0, 1.8));
    assert_eq!(
        (film.thickness_min_nm, film.thickness_max_nm),
        (50.0, 700.0)
    );
    assert_eq!((image(film.texture), image(film.thickness_texture)), (2, 1));
    // The Phong model: half of the light passes, no highlight without light.
    assert_eq!(
        (material.alpha_mode, material.opacity),
        (AlphaMode::Blend, 0.625)
    );
    assert_eq!(material.specular, Vec3::ZERO);
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
fn specular_and_glossiness_become_metal_and_roughness() {
    let extension = |textures: Value| {
        let mut extension = json!({
            "diffuseFactor": [0.5, 0.25, 1, 0.75],
            "specularFactor": [0.25, 0.5, 0.75],
            "glossinessFactor": 0.5,
        });
        extension
            .as_object_mut()
            .unwrap()
            .extend(textures.as_object().unwrap().clone());
        let base = json!({ "baseColorTexture": { "index": 0 }, "metallicFactor": 1 });
        with_material(json!({
            "pbrMetallicRoughness": base,
            "extensions": { "KHR_materials_pbrSpecularGlossiness": extension },
        }))
    };
    let loaded = load(&extension(json!({})).glb());
    let (_, pbr) = first(&loaded);
    assert_eq!(pbr.base_color, Vec4::new(0.5, 0.25, 1.0, 0.75));
    assert_eq!((pbr.metallic, pbr.roughness, pbr.ior), (0.0, 0.5, 0.0));
    let specular = pbr.specular.unwrap();
    assert_eq!(
        (specular.factor, specular.color),
        (1.0, Vec3::new(0.25, 0.5, 0.75))
    );
    assert_eq!(
        (pbr.base_color_texture, pbr.metallic_roughness_texture),
        (None, None)
    );

    let textures =
        json!({ "diffuseTexture": { "index": 1 }, "specularGlossinessTexture": { "index": 2 } });
    let mut file = extension(textures);
    let view = file.view(&png(2, [10, 20, 30, 102]));
    file.set("/images/2", json!({ "bufferView": view }));
    let loaded = load(&file.glb());
    let (_, pbr) = first(&loaded);
    assert_eq!(image_of(&loaded, pbr.base_color_texture), 1);
    assert_eq!(image_of(&loaded, pbr.specular.unwrap().color_texture), 10);
    assert_eq!(pbr.roughness, 1.0);
    let roughness = &loaded.scene.images[pbr.metallic_roughness_texture.unwrap().image];
    // 255 − ½ · 102 in green, no metal in blue.
    assert_eq!(
        (roughness.width, &roughness.rgba[..4]),
        (2, &[0, 204, 0, 255][..])
    );
}

#[test]
fn samplers_and_transforms_are_read() {
    use TextureFilter::{Linear, Nearest};
    let transform = json!({ "KHR_texture_transform":
        { "offset": [0.25, 0.5], "rotation": 1, "scale": [2, 3], "texCoord": 1 } });
    let base = json!({ "baseColorTexture": { "index": 0, "extensions": transform } });
    let mut file = with_material(json!({ "pbrMetallicRoughness": base }));
    file.set("/textures/0/sampler", json!(0));
    let read = |sampler: Value| {
        let loaded = load(&file.clone().with("/samplers/0", sampler).glb());
        first(&loaded).1.base_color_texture.unwrap()
    };
    let texture =
        read(json!({ "wrapS": 33071, "wrapT": 33648, "magFilter": 9728, "minFilter": 9986 }));
    assert_eq!(
        texture.sampler,
        TextureSampler {
            wrap_u: AddressMode::ClampToEdge,
            wrap_v: AddressMode::MirrorRepeat,
            magnify: Nearest,
            minify: Nearest,
            mipmap: Some(Linear),
        }
    );
    assert_eq!(texture.uv_set, 1);
    let expected = UvTransform {
        offset: Vec2::new(0.25, 0.5),
        rotation_rad: 1.0,
        scale: Vec2::new(2.0, 3.0),
    };
    assert_eq!(texture.transform, expected);
    assert_eq!(read(json!({})).sampler, TextureSampler::default());
    for (code, minify, mipmap) in [
        (9728, Nearest, None),
        (9729, Linear, None),
        (9984, Nearest, Some(Nearest)),
        (9985, Linear, Some(Nearest)),
        (9987, Linear, Some(Linear)),
    ] {
        let sampler = read(json!({ "minFilter": code, "wrapS": 10497 })).sampler;
        assert_eq!((sampler.minify, sampler.mipmap), (minify, mipmap), "{code}");
    }
    for property in ["wrapS", "wrapT", "magFilter", "minFilter"] {
        let loaded = load(
            &file
                .clone()
                .with("/samplers/0", json!({ property: 5 }))
                .glb(),
        );
        let texture = first(&loaded).1.base_color_texture.unwrap();
        assert_eq!(texture.sampler, TextureSampler::default());
        let warning = loaded.warnings[0].to_string();
        let expected = format!("/samplers/0/{property}: 5 is not a value");
        assert!(warning.contains(&expected), "{warning}");
    }
}

#[test]
fn variants_replace_materials() {
    let mut file = with_material(json!({ "name": "own" }));
    file.set(
        "/materials",
        json!([{ "name": "own" }, { "name": "red" }, { "name": "blue" }]),
    );
    let variants =
        json!({ "variants": [{ "name": "warm" }, { "name": "cold" }, { "name": "none" }] });
    file.set("/extensions", json!({ "KHR_materials_variants": variants }));
    let mappings = json!([{ "material": 1, "variants": [0] }, { "material": 2, "variants": [1] }]);
    let primitive = "/meshes/0/primitives/0/extensions";
    file.set(
        primitive,
        json!({ "KHR_materials_variants": { "mappings": mappings } }),
    );
    let name = |variant: Option<&str>| {
        let options = ModelOptions {
            variant: variant.map(str::to_owned),
            ..ModelOptions::default()
        };
        let scene = file.load_with(&options).scene;
        let material = scene.meshes[0].surfaces[0].material.unwrap();
        scene.materials[material].name.clone()
    };
    assert_eq!(name(None), "own");
    assert_eq!(name(Some("warm")), "red");
    assert_eq!(name(Some("cold")), "blue");
    assert_eq!(name(Some("none")), "own");
    assert_eq!(load(&file.glb()).choices.variants, ["warm", "cold", "none"]);
}

#[test]
fn images_come_from_files_and_uris_and_each_file_is_decoded_once() {
    let base =
        json!({ "baseColorTexture": { "index": 0 }, "metallicRoughnessTexture": { "index": 1 } });
    let mut file = with_material(json!({ "pbrMetallicRoughness": base,
        "emissiveTexture": { "index": 2 }, "occlusionTexture": { "index": 3 } }));
    let uri = format!("data:image/png;base64,{}", base64(&png(1, [77, 0, 0, 255])));
    let jpeg = encode(&Image::filled(8, 8, [200; 4]), ImageFormat::Jpeg).unwrap();
    file.set(
        "/images",
        json!([{ "uri": "a%20b.png" }, { "uri": "a b.png" }, { "uri": uri }, { "uri": "c%2d.jpg" }]),
    );
    file.set("/textures/4", json!({ "source": 0 }));
    let files = [("a b.png", png(3, [55, 0, 0, 255])), ("c%2d.jpg", jpeg)];
    let loaded = with_files(&file.glb(), &files, &Limits::default()).unwrap();
    assert_eq!(loaded.warnings, []);
    let (_, pbr) = first(&loaded);
    assert_eq!(image_of(&loaded, pbr.base_color_texture), 55);
    assert_eq!(
        pbr.base_color_texture.unwrap().image,
        pbr.metallic_roughness_texture.unwrap().image
    );
    assert_eq!(image_of(&loaded, pbr.emissive_texture), 77);
    assert!(image_of(&loaded, pbr.occlusion_texture).abs_diff(200) < 4);
    assert_eq!(loaded.scene.images.len(), 3);
}

/// Four texels of (0, 0, 255) in a lossless WebP of libwebp.
const WEBP: [u8; 36] =
    *b"RIFF\x1c\0\0\0WEBPVP8L\x0f\0\0\0/\x03@\0\0\x07\x10\xd1\xff\xfe\x07\"\xa2\xff\x01\0";

#[test]
fn images_of_extensions_are_preferred() {
    let base =
        json!({ "baseColorTexture": { "index": 0 }, "metallicRoughnessTexture": { "index": 1 } });
    let mut file = with_material(json!({ "pbrMetallicRoughness": base }));
    let webp = file.view(&WEBP);
    file.set(
        "/images/1",
        json!({ "bufferView": webp, "mimeType": "image/webp" }),
    );
    let webp = json!({ "EXT_texture_webp": { "source": 1 } });
    file.set("/textures/0", json!({ "source": 0, "extensions": webp }));
    file.set(
        "/textures/1",
        json!({ "extensions": { "MSFT_texture_dds": { "source": 2 } } }),
    );
    let names = json!(["EXT_texture_webp", "MSFT_texture_dds"]);
    file.set("/extensionsUsed", names.clone());
    file.set("/extensionsRequired", names);
    let loaded = load(&file.glb());
    assert_eq!(loaded.warnings, []);
    let (_, pbr) = first(&loaded);
    let webp = &loaded.scene.images[pbr.base_color_texture.expect("a texture").image];
    assert_eq!(
        (webp.width, webp.height, webp.texel(3, 1)),
        (4, 2, [0, 0, 255, 255])
    );
    assert_eq!(image_of(&loaded, pbr.metallic_roughness_texture), 2);

    file.set("/textures/0/extensions/EXT_texture_webp/source", json!(9));
    let error = error(&file);
    assert!(
        error.contains("/textures/0/extensions/EXT_texture_webp/source"),
        "{error}"
    );
}

/// A KTX2 texture of one texel.
fn ktx2(format: u32, color_model: u32, texel: [u8; 4]) -> Vec<u8> {
    let mut out = b"\xabKTX 20\xbb\r\n\x1a\n".to_vec();
    let header = [format, 1, 1, 1, 0, 0, 1, 1, 0, 104, 28, 132, 0];
    out.extend(header.into_iter().flat_map(u32::to_le_bytes));
    out.extend([0; 16]);
    out.extend([132, 4, 4].into_iter().flat_map(u64::to_le_bytes));
    let descriptor = [28, 0, 24 << 16 | 2, 0x2_0100 | color_model, 0, 0, 0];
    out.extend(descriptor.into_iter().flat_map(u32::to_le_bytes));
    out.extend(texel);
    out
}

/// The triangle whose texture is a KTX2 image, number 1, and a side file if it has a name.
fn with_ktx2(image: &[u8], side_file: Option<&str>) -> Builder {
    let base = json!({ "baseColorTexture": { "index": 0 } });
    let mut file = with_material(json!({ "pbrMetallicRoughness": base }));
    let view = file.view(image);
    let image = match side_file {
        Some(name) => json!({ "uri": name }),
        None => json!({ "bufferView": view, "mimeType": "image/ktx2" }),
    };
    file.set("/images/1", image);
    let basisu = json!({ "KHR_texture_basisu": { "source": 1 } });
    file.set("/textures/0", json!({ "extensions": basisu }));
    file
}

/// Rows: I5.
#[test]
fn ktx2_is_read_also_where_its_extension_is_required() {
    let mut file = with_ktx2(&ktx2(43, 1, [1, 2, 3, 4]), None);
    for other in [Value::Null, json!(0)] {
        file.set("/extensionsRequired", json!(["KHR_texture_basisu"]));
        file.set("/textures/0/source", other);
        let loaded = load(&file.glb());
        assert_eq!(loaded.warnings, []);
        assert_eq!(loaded.scene.images.len(), 1);
        assert_eq!(loaded.scene.images[0].texel(0, 0), [1, 2, 3, 4]);
    }
}

#[test]
fn basis_universal_is_replaced_left_out_or_refused() {
    const ADVICE: &str = "ktx transcode --target bc7";
    for (model, name) in [(163, "ETC1S"), (166, "UASTC"), (167, "UASTC HDR")] {
        let basis = ktx2(0, model, [0; 4]);
        let mut file = with_ktx2(&basis, None);
        // Alone, and used.
        let loaded = load(&file.glb());
        let warning = loaded.warnings[0].to_string();
        let left_out = format!(
            "a.glb, /images/1: the image is left out: the image is Basis Universal ({name}), which is not read"
        );
        assert!(
            warning.starts_with(&left_out) && warning.contains(ADVICE),
            "{warning}"
        );
        assert_eq!(first(&loaded).1.base_color_texture, None);
        // Required.
        file.set("/extensionsRequired", json!(["KHR_texture_basisu"]));
        let refused = error(&file);
        let named =
            format!("a.glb, /images/1: the image is Basis Universal ({name}), which is not read");
        assert!(
            refused.starts_with(&named) && refused.contains(ADVICE),
            "{refused}"
        );
        // With another image, of blue 200 as all of the builder's.
        file.set("/textures/0/source", json!(3));
        let loaded = load(&file.glb());
        let warning = loaded.warnings[0].to_string();
        assert!(
            warning.contains("the texture's other image, /images/3, is used"),
            "{warning}"
        );
        assert_eq!(loaded.warnings.len(), 1);
        assert_eq!(loaded.scene.images.len(), 1);
        assert_eq!(image_of(&loaded, first(&loaded).1.base_color_texture), 3);
    }
    // A side file has its name.
    let mut file = with_ktx2(&[0; 4], Some("wood.ktx2"));
    file.set("/extensionsRequired", json!(["KHR_texture_basisu"]));
    let basis = ktx2(0, 166, [0; 4]);
    let read = with_files(
        &file.glb(),
        &[("wood.ktx2", basis.clone())],
        &Limits::default(),
    );
    let refused = read.expect_err("Basis Universal").to_string();
    assert!(
        refused.contains("`wood.ktx2` is Basis Universal (UASTC)"),
        "{refused}"
    );
    // An image that stands for itself is left out.
    file.set("/extensionsRequired", json!([]));
    file.set("/textures/0/source", json!(1));
    let read = with_files(
        &file.glb(),
        &[("wood.ktx2", basis.clone())],
        &Limits::default(),
    );
    assert_eq!(read.expect("a triangle").scene.images.len(), 0);
}

/// Each image is Basis Universal, and the next one stands in its place.
#[test]
fn a_long_row_of_replaced_images_takes_no_stack() {
    const COUNT: usize = 20_000;
    let mut file = with_ktx2(&ktx2(0, 166, [0; 4]), None);
    let view = file.json["images"][1]["bufferView"]
        .as_u64()
        .expect("a view");
    let view = file.json["bufferViews"][usize::try_from(view).expect("small")].clone();
    let first = file.json["bufferViews"].as_array().map_or(0, Vec::len);
    let mut views = file.json["bufferViews"]
        .as_array()
        .cloned()
        .unwrap_or_default();
    views.extend((0..COUNT).map(|_| view.clone()));
    let images = { 0..COUNT }.map(|at| json!({ "bufferView": first + at }));
    let textures = { 0..COUNT }.map(|at| {
        let basisu = json!({ "KHR_texture_basisu": { "source": at } });
        json!({ "source": (at + 1) % COUNT, "extensions": basisu })
    });
    file.set("/bufferViews", json!(views));
    file.set("/images", json!(images.collect::<Vec<_>>()));
    file.set("/textures", json!(textures.collect::<Vec<_>>()));
    let loaded = load(&file.glb());
    assert_eq!(loaded.scene.images.len(), 0);
    assert!(loaded.warning_count >= COUNT as u64);
}

#[test]
fn a_view_that_two_images_name_is_decoded_once() {
    let base = json!({ "baseColorTexture": { "index": 0 } });
    let material = json!({ "pbrMetallicRoughness": base, "emissiveTexture": { "index": 1 } });
    let mut file = with_material(material);
    let view = file.json["images"][0].clone();
    file.set("/images/1", view);
    let loaded = load(&file.glb());
    assert_eq!(loaded.scene.images.len(), 1);
    let (_, pbr) = first(&loaded);
    assert_eq!(pbr.base_color_texture, pbr.emissive_texture);
}

#[test]
fn textures_that_cannot_be_read_are_left_out_with_a_warning() {
    let base = json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } });
    let check = |pointer: &str, value: Value, message: &str| {
        let mut file = with_material(base.clone());
        let bytes = file.view(&[1, 2, 3]);
        let damaged = file.view(&png(1, [1; 4])[..40]);
        let value = match value.as_str() {
            Some("damaged") => json!({ "bufferView": damaged }),
            Some("garbage") => json!({ "bufferView": bytes }),
            _ => value,
        };
        file.set(pointer, value);
        let loaded = load(&file.glb());
        let (material, pbr) = first(&loaded);
        assert_eq!(
            (material.base_color_texture, pbr.base_color_texture),
            (None, None)
        );
        let [warning, ..] = &loaded.warnings[..] else {
            panic!("{:?}", loaded.warnings)
        };
        assert!(warning.to_string().contains(message), "{warning}");
    };
    check(
        "/images/0",
        json!({ "uri": "none.png" }),
        "a.glb, /images/0: the image is left out: `none.png`: side files are not available",
    );
    check(
        "/images/0",
        json!({ "uri": "data:image/png;base64,?" }),
        "/images/0: the image is left out",
    );
    check(
        "/images/0",
        json!({}),
        "the image has neither `uri` nor `bufferView`",
    );
    check(
        "/images/0",
        json!({ "bufferView": 99 }),
        "buffer view 99 does not exist",
    );
    check(
        "/images/0",
        json!("garbage"),
        "an image that is neither PNG, JPEG, WebP, BMP, DDS nor KTX2 cannot be read",
    );
    check("/images/0", json!("damaged"), "the PNG is not valid");
    check(
        "/textures/0",
        json!({}),
        "/textures/0: the texture has no image in PNG, JPEG, WebP, DDS or KTX2",
    );
    check(
        "/materials/0/pbrMetallicRoughness/baseColorTexture",
        json!({ "index": 0, "texCoord": 2 }),
        "/materials/0/pbrMetallicRoughness/baseColorTexture: texture coordinates TEXCOORD_2",
    );
}

#[test]
fn images_are_limited_together() {
    let textures = json!({
        "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } },
        "emissiveTexture": { "index": 1 },
        "extensions": { "KHR_materials_clearcoat": {
            "clearcoatTexture": { "index": 1 }, "clearcoatNormalTexture": { "index": 1 } } },
    });
    let file = with_material(textures);
    let limits = Limits {
        max_total_image_pixels: 1,
        ..Limits::default()
    };
    let loaded = with_files(&file.glb(), &[], &limits).unwrap();
    let (_, pbr) = first(&loaded);
    assert!(pbr.base_color_texture.is_some() && pbr.emissive_texture.is_none());
    let coat = pbr.clearcoat.unwrap();
    assert!(coat.texture.is_none() && coat.normal_texture.is_none());
    assert_eq!(loaded.warning_count, 1);
    let warning = loaded.warnings[0].to_string();
    assert!(
        warning.contains("/images/1: the image is left out: 1 pixels are more"),
        "{warning}"
    );
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

#[test]
fn a_variants_material_must_exist() {
    let mut file = with_material(json!({}));
    let variants = json!({ "variants": [{ "name": "a" }] });
    file.set("/extensions", json!({ "KHR_materials_variants": variants }));
    let mappings = json!([{ "material": 8, "variants": [0] }]);
    let primitive = "/meshes/0/primitives/0/extensions";
    file.set(
        primitive,
        json!({ "KHR_materials_variants": { "mappings": mappings } }),
    );
    // Not chosen, so the picture does not need it.
    let [warning] = &load(&file.glb()).warnings[..] else {
        panic!("one warning")
    };
    assert!(warning.message.contains("material 8 does not exist"));
    let options = ModelOptions {
        variant: Some("a".to_owned()),
        ..ModelOptions::default()
    };
    let error = file.try_load_with(&options).unwrap_err();
    let place = "/meshes/0/primitives/0/extensions/KHR_materials_variants/mappings/0/material";
    assert_eq!(&*error.fault().json_pointer, place);
    assert!(matches!(error, AssetError::Malformed(_)), "{error}");
    assert!(error.fault().what.contains("material 8 does not exist"));
}
