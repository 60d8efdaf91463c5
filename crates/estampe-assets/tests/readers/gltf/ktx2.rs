//! Images in KTX2; those in Basis Universal are replaced, left out or refused.

use super::builder::with_files;
use super::materials::{first, image_of, with_material};
use super::{Builder, error, load};
use estampe_assets::Limits;
use serde_json::{Value, json};

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
