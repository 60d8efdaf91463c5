//! Extensions of materials, and variants, which replace materials.

use super::load;
use super::materials::{first, image_of, png, with_material};
use estampe_assets::AssetError;
use estampe_assets::model::ModelOptions;
use estampe_scene::AlphaMode;
use glam::{Vec3, Vec4};
use serde_json::{Value, json};

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
