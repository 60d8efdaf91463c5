//! MTL and the materials of OBJ: the effect of every statement, tolerated errors, side files.

use super::models_obj::{SQUARE, messages, read_with};
use estampe_assets::model::{
    ModelOptions, ResourceError, Resources, TextureAlpha, parse_model_with,
};
use estampe_assets::{Limits, ModelFormat, ModelInput, parse_model};
use estampe_scene::AlphaMode;
use glam::Vec3;
use std::collections::HashMap;

/// Side files, by name.
#[derive(Default)]
struct Files(HashMap<&'static str, Vec<u8>>);

impl Files {
    fn with(mut self, name: &'static str, bytes: &[u8]) -> Self {
        self.0.insert(name, bytes.to_vec());
        self
    }
}

impl Resources for Files {
    fn resolve(&self, name: &str) -> Result<String, ResourceError> {
        if self.0.contains_key(name) {
            Ok(name.to_owned())
        } else {
            Err(ResourceError::NotFound)
        }
    }

    fn read(&self, resolved: &str, _max_bytes: u64) -> Result<Vec<u8>, ResourceError> {
        Ok(self.0[resolved].clone())
    }
}

/// An uncompressed 2×1 TGA of 32 bits; B, G, R, A of the left and the right pixel.
fn tga(pixels: [[u8; 4]; 2]) -> Vec<u8> {
    let mut bytes = vec![0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 1, 0, 32, 0x28];
    bytes.extend(pixels.concat());
    bytes
}

/// Rows: M2.
#[test]
fn materials_become_one_surface_each() {
    let library = b"newmtl red\nKd 1 0 0\nnewmtl grey\nKd 0.5\nNs 10\nKs 0 0 0\nKe 0 1 0\n";
    let files = Files::default().with("a b.mtl", library);
    let text = format!(
        "mtllib a b.mtl\n{SQUARE}f 1 2 3\nusemtl red\nf 1 2 4\nusemtl grey\nf 2 3 4\nusemtl red\nf 1 3 4\n"
    );
    let loaded = read_with(&text, &files);
    assert_eq!(messages(&loaded), Vec::<String>::new());
    let surfaces: Vec<_> = loaded.scene.meshes[0]
        .surfaces
        .iter()
        .map(|surface| (surface.material, surface.triangles.clone()))
        .collect();
    assert_eq!(surfaces, [(None, 0..1), (Some(0), 1..3), (Some(1), 3..4)]);
    let [red, grey] = &loaded.scene.materials[..] else {
        panic!()
    };
    assert_eq!((red.name.as_str(), red.base_color), ("red", Vec3::X));
    assert!(
        (grey.base_color.x - 0.214_041_14).abs() < 1e-6,
        "sRGB becomes linear"
    );
    assert_eq!(
        (grey.shininess, grey.specular, grey.emissive),
        (10.0, Vec3::ZERO, Vec3::Y)
    );
}

#[test]
fn missing_materials_are_reported_where_they_are_used() {
    let files = Files::default().with("b.mtl", b"newmtl x\nKd spectral a.rfl\nmap_Kd gone.png\n");
    let text = format!("{SQUARE}mtllib a.mtl b.mtl\nusemtl x\nf 1 2 3\nusemtl y\nf 1 3 4\n");
    let loaded = read_with(&text, &files);
    let messages = messages(&loaded);
    assert_eq!(messages.len(), 4, "{messages:?}");
    assert!(messages[0].starts_with("test.obj, line 5: the material library `a.mtl`"));
    assert!(messages[1].starts_with("b.mtl, line 2: this form of colour"));
    assert!(messages[2].starts_with("test.obj, line 8: no library defines the material `y`"));
    assert!(
        messages[3].starts_with("b.mtl, line 3: the texture `gone.png`"),
        "{messages:?}"
    );
    assert_eq!(loaded.scene.meshes[0].triangles.len(), 2);
}

/// Rows: M2.
#[test]
fn textures_are_loaded_once_and_their_alpha_is_classified() {
    let opaque = tga([[1, 2, 3, 255], [4, 5, 6, 255]]);
    let mask = tga([[1, 2, 3, 255], [4, 5, 6, 0]]);
    let glass = tga([[1, 2, 3, 255], [4, 5, 6, 100]]);
    let files = Files::default()
        .with(
            "lib/m.mtl",
            b"newmtl a\nmap_Kd -s 1 1 -o 0 0 0 -bm 2 -clamp on old wood.tga\n\
            newmtl b\nKd 0 0 0\nmap_Kd \"old wood.tga\"\nnewmtl c\nKd 1 0 0\nmap_Kd mask.tga\n\
            newmtl d\nd 0.5\nmap_Kd glass.tga\nnewmtl e\nmap_Kd old wood.tga\nmap_d mask.tga\n\
            newmtl unused\nmap_Kd gone.tga\n",
        )
        .with("lib/old wood.tga", &opaque)
        .with("mask.tga", &mask)
        .with("glass.tga", &glass);
    let mut text = format!("{SQUARE}mtllib lib/m.mtl\n");
    for name in ["a", "b", "c", "d", "e"] {
        text += &format!("usemtl {name}\nf 1 2 3\n");
    }
    let loaded = read_with(&text, &files);
    assert_eq!(messages(&loaded), Vec::<String>::new());
    let materials = &loaded.scene.materials;
    let textures: Vec<_> = materials.iter().map(|one| one.base_color_texture).collect();
    assert_eq!(
        textures,
        [Some(0), Some(0), Some(1), Some(2), Some(3), None]
    );
    let modes: Vec<_> = materials.iter().map(|one| one.alpha_mode).collect();
    use AlphaMode::{Blend, Mask, Opaque};
    assert_eq!(modes, [Opaque, Opaque, Opaque, Blend, Mask, Opaque]);
    assert_eq!(
        materials[1].base_color,
        Vec3::ONE,
        "black would hide the texture"
    );
    assert_eq!(materials[2].base_color, Vec3::X);
    assert_eq!(loaded.scene.images[0].texel(0, 0), [3, 2, 1, 255]);
    assert_eq!(loaded.scene.images[3].texel(1, 0), [6, 5, 4, 0]);
}

/// Many textures have an alpha that means something else, such as a gloss: models became ghosts.
///
/// Rows: M2.
#[test]
fn the_alpha_of_a_texture_counts_where_the_material_is_transparent_or_an_option_says_so() {
    let mask = tga([[1, 2, 3, 255], [4, 5, 6, 0]]);
    let glass = tga([[1, 2, 3, 255], [4, 5, 6, 100]]);
    let library = "newmtl a\nd 1\nmap_Kd glass.tga\nnewmtl b\nmap_Kd mask.tga\n\
        newmtl c\nTr 0.5\nmap_Kd glass.tga\nnewmtl d\nmap_Kd glass.tga\nmap_d mask.tga\n";
    let files = Files::default()
        .with("m.mtl", library.as_bytes())
        .with("mask.tga", &mask)
        .with("glass.tga", &glass);
    let mut text = format!("{SQUARE}mtllib m.mtl\n");
    for name in ["a", "b", "c", "d"] {
        text += &format!("usemtl {name}\nf 1 2 3\n");
    }
    let modes = |alpha| {
        let options = ModelOptions {
            alpha,
            ..ModelOptions::default()
        };
        let input = ModelInput {
            bytes: text.as_bytes(),
            format: ModelFormat::Obj,
            name: "test.obj",
            resources: &files,
        };
        let loaded = parse_model_with(&input, &options, &Limits::default()).expect("valid");
        let materials = loaded.scene.materials.iter();
        let of = |one: &estampe_scene::Material| (one.alpha_mode, one.opacity);
        materials.map(of).collect::<Vec<_>>()
    };
    use AlphaMode::{Blend, Mask, Opaque};
    let solid = [(Opaque, 1.0), (Opaque, 1.0)];
    let auto = modes(TextureAlpha::Auto);
    assert_eq!(
        (&auto[..2], auto[2], auto[3].0),
        (&solid[..], (Blend, 0.5), Mask)
    );
    assert!(
        modes(TextureAlpha::Opaque)
            .iter()
            .all(|&mode| mode == (Opaque, 1.0))
    );
    let cut_out = modes(TextureAlpha::Mask);
    assert_eq!([cut_out[0].0, cut_out[1].0], [Mask; 2]);
    let blended = modes(TextureAlpha::Blend);
    assert_eq!([blended[0].0, blended[1].0], [Blend; 2]);
}

/// Exporters write `Ks 1` with `Ns 0`, which would be a highlight over the whole surface.
///
/// Rows: M2.
#[test]
fn an_exponent_below_one_is_no_highlight() {
    let library =
        "newmtl a\nKs 1 1 1\nNs 0\nnewmtl b\nKs 1 1 1\nNs 0.5\nnewmtl c\nKs 1 1 1\nNs 1\n";
    let files = Files::default().with("m.mtl", library.as_bytes());
    let loaded = read_with(&format!("mtllib m.mtl\n{SQUARE}f 1 2 3\n"), &files);
    let materials = loaded.scene.materials.iter();
    let specular: Vec<Vec3> = materials.map(|one| one.specular).collect();
    assert_eq!(specular, [Vec3::ZERO, Vec3::ZERO, Vec3::ONE]);
}

/// Rows: M2.
#[test]
fn bump_maps_are_read_with_their_multiplier() {
    let files = Files::default()
        .with(
            "m.mtl",
            b"newmtl a\nbump -bm 2.5 a b.tga\nnewmtl b\nmap_Bump -o 1 1 -BM -0.5 -clamp on a b.tga\n\
            newmtl c\nmap_bump a b.tga\nmap_Kd a b.tga\nnewmtl d\nbump -bm inf a b.tga\n\
            newmtl e\nbump -bm 1e30 a b.tga\nnewmtl f\nbump -bm a b.tga\nnewmtl g\n",
        )
        .with("a b.tga", &tga([[1, 2, 3, 255], [4, 5, 6, 255]]));
    let mut text = format!("{SQUARE}mtllib m.mtl\n");
    for name in ["a", "b", "c", "d", "e", "f", "g"] {
        text += &format!("usemtl {name}\nf 1 2 3\n");
    }
    let loaded = read_with(&text, &files);
    let materials = &loaded.scene.materials;
    let scales: Vec<f32> = materials.iter().map(|one| one.bump_scale).collect();
    assert_eq!(scales[..5], [2.5, -0.5, 1.0, 1.0, 1000.0]);
    let maps: Vec<_> = materials.iter().map(|one| one.bump_texture).collect();
    let all = Some(0);
    assert_eq!(maps, [all, all, all, all, all, None, None]);
    assert_eq!(materials[2].base_color_texture, all, "one image for both");
    assert_eq!(loaded.scene.images.len(), 1);
    // `-bm` takes the first word of the name.
    let messages = messages(&loaded);
    assert_eq!(messages.len(), 1, "{messages:?}");
    assert!(messages[0].contains("the texture `b.tga`"), "{messages:?}");
}

#[test]
fn opacity_comes_from_d_before_tr() {
    let library = "newmtl a\nd 0.75\nTr 0.5\nnewmtl b\nTr 0.25\nnewmtl c\nTr 1\nnewmtl d\nd 1\nTr 1\n\
        newmtl e\nd -halo 0.5\nnewmtl f\nd nan\n";
    let files = Files::default().with("m.mtl", library.as_bytes());
    let loaded = read_with(&format!("mtllib m.mtl\n{SQUARE}f 1 2 3\n"), &files);
    let opacities: Vec<f32> = loaded
        .scene
        .materials
        .iter()
        .map(|one| one.opacity)
        .collect();
    assert_eq!(opacities, [0.75, 0.75, 1.0, 1.0, 0.5, 1.0]);
    assert_eq!(loaded.scene.materials[0].alpha_mode, AlphaMode::Blend);
    assert_eq!(loaded.scene.materials[3].alpha_mode, AlphaMode::Opaque);
    assert_eq!(loaded.warning_count, 2, "{:?}", messages(&loaded));
}

#[test]
fn broken_textures_and_hostile_libraries_are_warnings() {
    let files = Files::default()
        .with(
            "m.mtl",
            b"Kd 1 1 1\nnewmtl\nmap_Kd\nnewmtl x\nKd\nd\nNs abc\nmap_Kd t.png\n\x00\xff\xfe",
        )
        .with("t.png", b"\x89PNG\r\n\x1a\nbroken");
    let loaded = read_with(
        &format!("mtllib m.mtl m.mtl\nusemtl x\n{SQUARE}f 1 2 3\n"),
        &files,
    );
    assert_eq!(loaded.scene.materials.len(), 2);
    assert_eq!(loaded.scene.images.len(), 0);
    assert!(
        messages(&loaded).iter().any(|text| text.contains("t.png")),
        "{:?}",
        messages(&loaded)
    );
}

#[test]
fn side_files_are_bounded() {
    let mut text = SQUARE.to_owned();
    for i in 0..50 {
        text += &format!("mtllib {i}.mtl\n");
    }
    let limits = Limits {
        max_side_files: 10,
        max_warnings: 100,
        ..Limits::default()
    };
    let loaded = parse_model(
        text.as_bytes(),
        ModelFormat::Obj,
        "a",
        &Files::default(),
        &limits,
    )
    .unwrap();
    let refused = messages(&loaded)
        .iter()
        .filter(|text| text.contains("more than 10"))
        .count();
    assert_eq!(refused, 45, "two look-ups for each of the first five");
}
