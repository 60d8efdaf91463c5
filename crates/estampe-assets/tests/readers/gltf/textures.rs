//! Textures and images: samplers, transforms, the places that images come from, and images that are
//! left out.

use super::builder::{base64, with_files};
use super::materials::{first, image_of, png, with_material};
use super::{error, load};
use estampe_assets::Limits;
use estampe_assets::image::{ImageFormat, encode};
use estampe_scene::{AddressMode, Image, TextureFilter, TextureSampler, UvTransform};
use glam::Vec2;
use serde_json::{Value, json};

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
