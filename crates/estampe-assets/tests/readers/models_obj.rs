//! OBJ and MTL: the effect of every statement, tolerated errors, limits.

use estampe_assets::model::{
    ModelOptions, NoResources, ResourceError, Resources, TextureAlpha, parse_model_with,
};
use estampe_assets::{AssetError, Limits, Loaded, Location, ModelFormat, ModelInput, parse_model};
use estampe_scene::{AlphaMode, Mesh};
use glam::{Vec2, Vec3};
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

fn read(text: &str) -> Loaded {
    read_with(text, &NoResources)
}

fn read_with(text: &str, resources: &dyn Resources) -> Loaded {
    let limits = Limits::default();
    parse_model(
        text.as_bytes(),
        ModelFormat::Obj,
        "test.obj",
        resources,
        &limits,
    )
    .unwrap()
}

/// The only mesh of a file without warnings.
fn mesh(text: &str) -> Mesh {
    let loaded = read(text);
    assert_eq!(loaded.warnings, [], "{text}");
    assert_eq!(loaded.scene.meshes.len(), 1);
    loaded.scene.meshes.into_iter().next().unwrap()
}

fn messages(loaded: &Loaded) -> Vec<String> {
    loaded.warnings.iter().map(ToString::to_string).collect()
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

/// An uncompressed 2×1 TGA of 32 bits; B, G, R, A of the left and the right pixel.
fn tga(pixels: [[u8; 4]; 2]) -> Vec<u8> {
    let mut bytes = vec![0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 1, 0, 32, 0x28];
    bytes.extend(pixels.concat());
    bytes
}

/// Rows: M2.
#[test]
fn the_four_forms_of_faces_are_read() {
    let attributes = "vt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 2\n";
    let one = mesh(&format!("{SQUARE}{attributes}f 1 2 3\n"));
    assert!(one.uvs.is_empty());
    assert_eq!(one.triangles, [[0, 1, 2]]);
    assert!(
        one.normals[..3].iter().all(|&normal| normal == Vec3::Z),
        "made, as it has none"
    );
    let two = mesh(&format!("{SQUARE}{attributes}f 1/1 2/2 3/3\n"));
    assert_eq!(
        two.uvs,
        [
            Vec2::new(0.0, 1.0),
            Vec2::new(1.0, 1.0),
            Vec2::new(1.0, 0.0)
        ]
    );
    let three = mesh(&format!("{SQUARE}{attributes}f 1//1 2//1 3//1\n"));
    assert_eq!(three.normals, [Vec3::Z; 3], "made unit");
    let four = mesh(&format!("{SQUARE}{attributes}f 1/1/1 2/2/1 3/3/1\n"));
    assert_eq!((four.uvs.len(), four.normals.len()), (3, 3));
}

/// Rows: M2.
#[test]
fn negative_indices_count_back() {
    let relative = mesh("v 0 0 0\nv 1 0 0\nv 1 1 0\nf -3 -2 -1\nv 0 1 0\nf -4 -2 -1\n");
    assert_eq!(relative.triangles, [[0, 1, 2], [0, 2, 3]]);
}

#[test]
fn vertices_may_follow_the_faces_that_use_them() {
    let ahead = mesh("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 1 1 0\n");
    assert_eq!(ahead.triangles, [[0, 1, 2]]);
}

#[test]
fn faces_with_impossible_indices_are_omitted_with_a_warning() {
    let loaded = read(&format!(
        "{SQUARE}f 1 2 9\nf 0 1 2\nf -5 1 2\nf 1 2 3\nf 1/7 2 3\n"
    ));
    assert_eq!(
        loaded.scene.meshes[0].triangles.len(),
        2,
        "the last lacks a texture coordinate only"
    );
    let lines: Vec<Option<Location>> = loaded.warnings.iter().map(|one| one.location).collect();
    let line = |number| Some(Location::Line(number));
    assert_eq!(
        lines,
        [line(6), line(7), line(5), line(9)],
        "{:?}",
        messages(&loaded)
    );
    assert_eq!(loaded.warning_count, 4);
    let text = &messages(&loaded)[2];
    assert!(
        text.starts_with("test.obj, line 5: the vertex does not exist (number 9 of 4)"),
        "{text}"
    );
}

#[test]
fn malformed_corners_and_short_faces_are_omitted() {
    let loaded = read(&format!("{SQUARE}f 1 2 x\nf 1 2 3q\nf 1 2\nf\nf 1 2 3\n"));
    assert_eq!(loaded.scene.meshes[0].triangles.len(), 1);
    assert_eq!(loaded.warning_count, 4);
}

/// An L: as a fan from its first corner one triangle would be inside out.
///
/// Rows: M2.
#[test]
fn concave_polygons_are_split_inside() {
    let shape = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n";
    for first in 0..6 {
        let corners: Vec<String> = (0..6).map(|i| ((first + i) % 6 + 1).to_string()).collect();
        let mesh = mesh(&format!("{shape}f {}\n", corners.join(" ")));
        let doubled_areas = mesh.triangles.iter().map(|triangle| {
            let [a, b, c] = triangle.map(|vertex| mesh.positions[vertex as usize]);
            (b - a).cross(c - a).z
        });
        let doubled_areas: Vec<f32> = doubled_areas.collect();
        assert!(
            doubled_areas.iter().all(|&area| area > 0.0),
            "{doubled_areas:?}"
        );
        assert_eq!(doubled_areas.iter().sum::<f32>(), 6.0);
        assert!(mesh.normals.iter().all(|&normal| normal == Vec3::Z));
    }
}

/// Rows: M2.
#[test]
fn lines_and_points_are_kept() {
    let both = mesh(&format!("{SQUARE}l 1 2/1 3\np 4 1\np 2\nvt 0 0\n"));
    assert_eq!(both.lines.len(), 2);
    assert_eq!(both.points.len(), 3);
    assert_eq!(both.triangles.len(), 0);
    assert!(both.normals.is_empty(), "only triangles need normals");
    let position = |vertex: u32| both.positions[vertex as usize];
    assert_eq!(position(both.lines[1][1]), Vec3::new(1.0, 1.0, 0.0));
    assert_eq!(position(both.points[0]), Vec3::Y);
    let only = read("v 1 2 3\nv 4 5 6\n");
    assert_eq!(only.scene.meshes[0].points, [0, 1]);
    assert_eq!(only.warning_count, 1);
}

/// Rows: M2.
#[test]
fn defaults_and_extra_numbers_of_vertices() {
    let weights = mesh("v 0 0 0 0.5\nv 1 0 0 0.5\nv 0 1 0 0.5\nvt 0.25\nvt\nf 1/1 2/2 3/1\n");
    assert_eq!(weights.positions[1], Vec3::X, "w is no divisor");
    assert_eq!(
        weights.uvs[..2],
        [Vec2::new(0.25, 1.0), Vec2::new(0.0, 1.0)]
    );
    let loaded = read("v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0\nf 1 2 3\nvp 1\nvp 1 2 3\n");
    assert_eq!(loaded.scene.meshes[0].colors[0], [1.0, 0.0, 0.0, 1.0]);
    assert_eq!(loaded.scene.meshes[0].colors[2], [1.0; 4]);
    assert_eq!(
        loaded.parameter_points,
        [Vec3::new(1.0, 0.0, 1.0), Vec3::new(1.0, 2.0, 3.0)]
    );
    let material = loaded.scene.meshes[0].surfaces[0].material.unwrap();
    assert_eq!(
        loaded.scene.materials[material].base_color,
        Vec3::ONE,
        "colours are seen as they are"
    );
    let bytes = read("v 0 0 0 255 0 0\nv 1 0 0 0 255 0\nv 0 1 0 188 0 0\nf 1 2 3\n");
    assert!((bytes.scene.meshes[0].colors[2][0] - 0.502_886_6).abs() < 1e-5);
}

/// Rows: M2.
#[test]
fn every_way_to_end_lines_reads_the_same() {
    let text =
        "# a \\\nv 0 0 0\nv 1 0 0 # comment\n\tv 1 1 0\nv  0 \\\n 1 0  \n\nf 1 2 \\\n  3 4\n";
    let reference = mesh(text);
    assert_eq!(reference.triangles.len(), 2);
    for (name, variant) in [
        ("CRLF", text.replace('\n', "\r\n")),
        ("CR", text.replace('\n', "\r")),
        ("BOM", format!("\u{feff}{text}")),
        ("no end", text.trim_end().to_owned()),
        ("tabs", text.replace(' ', "\t")),
    ] {
        let other = mesh(&variant);
        assert_eq!(other.positions, reference.positions, "{name}");
        assert_eq!(other.triangles, reference.triangles, "{name}");
    }
    let loaded = read("v 0 0 0\r\nv 1 0 0\r\n\\\r\nv 1 1 0\r\nf 1 2 7\r\n");
    assert_eq!(
        loaded.warnings[0].location,
        Some(Location::Line(5)),
        "continued lines count"
    );
}

#[test]
fn non_finite_coordinates_drop_only_their_faces() {
    let loaded = read(
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nv 1e999 0 0\nv 1 x 0\nv 1\nf 1 2 3\n\
         f 1 2 4\nf 1 2 5\nf 1 2 6\nf 1 2 7\nl 1 2 4\np 4\n",
    );
    assert_eq!(loaded.scene.meshes[0].triangles.len(), 1);
    assert_eq!(loaded.scene.meshes[0].lines.len(), 1);
    assert!(loaded.scene.meshes[0].points.is_empty());
    assert_eq!(loaded.warning_count, 5, "{:?}", messages(&loaded));
    assert!(
        messages(&loaded)[4].contains("6 elements"),
        "{:?}",
        messages(&loaded)
    );
    assert!(!loaded.scene.meshes[0].bounds().is_empty());
}

/// Rows: M2.
#[test]
fn meshes_are_objects_or_else_groups() {
    let faces = |a: &str, b: &str| format!("{SQUARE}{a}\nf 1 2 3\n{b}\nf 1 3 4\n{a}\nf 1 2 4\n");
    let names = |text: &str| {
        let meshes = read(text).scene.meshes;
        meshes
            .iter()
            .map(|mesh| (mesh.name.clone(), mesh.triangles.len()))
            .collect::<Vec<_>>()
    };
    let expected = [("left one".to_owned(), 2), ("right".to_owned(), 1)];
    assert_eq!(names(&faces("o left one", "o right")), expected);
    assert_eq!(names(&faces("g left one", "g right")), expected);
    assert_eq!(
        names(&faces("o a\ng left one", "g right")),
        [("a".to_owned(), 3)]
    );
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

/// Rows: M2.
#[test]
fn smoothing_groups_override_the_crease_angle() {
    // Two squares at a right angle.
    let shape = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 0 1 1\n";
    let count = |faces: &str| mesh(&format!("{shape}{faces}")).positions.len();
    assert_eq!(count("f 1 2 3 4\nf 1 4 6 5\n"), 8, "by angle");
    assert_eq!(count("s 1\nf 1 2 3 4\nf 1 4 6 5\n"), 6, "smooth as told");
    assert_eq!(count("s 1\nf 1 2 3 4\ns 2\nf 1 4 6 5\n"), 8);
    assert_eq!(
        count("f 1 2 3 4\ns 3\nf 1 4 6 5\n"),
        8,
        "none is flat where others are"
    );
    assert_eq!(count("s off\nf 1 2 3 4\ns 0\nf 1 4 6 5\n"), 8, "by angle");
}

/// Rows: M2.
#[test]
fn edges_sharper_than_forty_degrees_stay_sharp() {
    // A strip along the y axis, folded there by an angle.
    let corners = |degrees: f32| {
        let (s, c) = libm::sincosf(degrees.to_radians());
        format!(
            "v 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 0\nv {0} 0 {s}\nv {0} 1 {s}\n",
            -c
        )
    };
    let count = |degrees: f32| {
        let text = format!("{}f 4 1 2 3\nf 5 4 3 6\n", corners(degrees));
        mesh(&text).positions.len()
    };
    for degrees in [0.0, 20.0, 39.9] {
        assert_eq!(count(degrees), 6, "{degrees}° is smooth");
    }
    for degrees in [40.1, 60.0, 90.0, 170.0] {
        assert_eq!(count(degrees), 8, "{degrees}° is an edge");
    }
}

/// Rows: M2.
#[test]
fn warnings_are_bounded_and_unknown_statements_reported_once() {
    let text = format!(
        "{SQUARE}{}f 1 2 3\n",
        "nonsense 1 2\ncurv 0 1 1 2\nvw 1 2\n".repeat(500)
    );
    assert_eq!(read(&text).warning_count, 2);
    let text = format!("{SQUARE}{}", "f 1 2 99\n".repeat(5000));
    let loaded = read(&text);
    assert_eq!((loaded.warnings.len(), loaded.warning_count), (100, 5001));
}

#[test]
fn files_that_are_not_obj_are_errors() {
    let fails = |bytes: &[u8]| {
        let limits = Limits::default();
        parse_model(bytes, ModelFormat::Obj, "a.obj", &NoResources, &limits).unwrap_err()
    };
    assert!(matches!(fails(b""), AssetError::Malformed(_)));
    assert!(matches!(
        fails(b"\x7fELF\x01\x00\x00"),
        AssetError::Malformed(_)
    ));
    assert!(fails(b"hello").to_string().starts_with("a.obj: "));
}

#[test]
fn limits_hold() {
    let fails = |text: &str, limits: &Limits| {
        let result = parse_model(text.as_bytes(), ModelFormat::Obj, "a", &NoResources, limits);
        assert!(
            matches!(result, Err(AssetError::LimitExceeded(_))),
            "{result:?}"
        );
        result.unwrap_err().to_string()
    };
    let text = format!("{SQUARE}f 1 2 3 4\n");
    let few = Limits {
        max_vertices: 3,
        ..Limits::default()
    };
    assert_eq!(
        fails(&text, &few),
        "a, line 4: 4 vertices are more than the limit of 3; split the file, or raise the limit if you trust it"
    );
    fails(
        &text,
        &Limits {
            max_triangles: 1,
            ..Limits::default()
        },
    );
    fails(
        &text,
        &Limits {
            max_file_bytes: 30,
            ..Limits::default()
        },
    );
    let small = Limits {
        max_polygon_corners: 3,
        ..Limits::default()
    };
    let loaded = parse_model(text.as_bytes(), ModelFormat::Obj, "a", &NoResources, &small).unwrap();
    assert_eq!(
        loaded.scene.meshes[0].triangles.len(),
        0,
        "polygons above it are omitted"
    );
    let one = Limits {
        max_meshes: 1,
        max_materials: 1,
        ..Limits::default()
    };
    let text = format!("{SQUARE}o a\nf 1 2 3\no b\nf 1 2 3\no c\nf 1 2 3\n");
    let loaded = parse_model(text.as_bytes(), ModelFormat::Obj, "a", &NoResources, &one).unwrap();
    assert_eq!(loaded.scene.meshes.len(), 1);
}

/// One position with a million texture coordinates, and a million objects: linear, not quadratic.
#[test]
fn hostile_sharing_takes_no_quadratic_time() {
    let start = std::time::Instant::now();
    let mut text = SQUARE.to_owned();
    for i in 0..100_000 {
        text += &format!("vt {i} 0\nf 1/-1 2/-1 3/-1\n");
    }
    assert_eq!(mesh(&text).positions.len(), 300_000);
    let mut text = SQUARE.to_owned();
    for i in 0..100_000 {
        text += &format!("o {i}\nusemtl {i}\nf 1 2 3\n");
    }
    assert_eq!(read(&text).scene.meshes.len(), 65_536);
    assert!(start.elapsed().as_secs() < 20, "{:?}", start.elapsed());
}

/// Plain lines of large files are read ahead by several threads. A blank at the start of a line
/// makes it not plain and has no other effect.
#[test]
fn plain_lines_read_ahead_give_the_same_model() {
    let rows = 14_000_u32;
    let mut text = String::from("# large\nmtllib none.mtl\no first\n");
    for row in 0..rows {
        let line = |text: &mut String, line: String| {
            text.push_str(&line);
            text.push_str(if row % 1500 < 700 { "\n" } else { "\r\n" });
        };
        let at = row as f32 * 0.125;
        for corner in 0..3_u8 {
            let (x, y) = (f32::from(corner), f32::from(corner % 2));
            line(&mut text, format!("v {x} {y} {at}"));
            line(&mut text, format!("vn {at} 1e-3 {x}"));
        }
        line(&mut text, format!("vt {at} .5"));
        let [a, b, c] = [row * 3 + 1, row * 3 + 2, row * 3 + 3];
        let (d, uv) = (a.saturating_sub(1).max(1), row + 1);
        line(
            &mut text,
            format!("f {a}/{uv}/{a} {b}/{uv}/{b} {c}/{uv}/{c}"),
        );
        match row {
            1000 => line(&mut text, format!("f {a} {b} {c} {d}")),
            1500 => line(&mut text, "g second\nusemtl red # not here".to_owned()),
            2000 => line(&mut text, "f -1 -2 -3".to_owned()),
            2500 => line(&mut text, format!("f 1 2 {}", rows * 3)),
            3000 => line(&mut text, "s 3".to_owned()),
            3500 => line(&mut text, "v 1 2 3 1 0 0\nv 1 2 nan\nv 1 2 3 4".to_owned()),
            3501 => line(
                &mut text,
                "f 1//2 2//3 3//4\nf 1/2 2/3 3/4\nf 1 2 3".to_owned(),
            ),
            4000 => line(&mut text, "v 1 2 3 \\\n4 5 6\nwhat is this".to_owned()),
            4500 => line(
                &mut text,
                "f 1 2 0\nf 1 2 99999999\nf 1 2 3/ # odd".to_owned(),
            ),
            5000 => line(&mut text, "s off\no third\nvp 1 2\nl 1 2 3\np 4".to_owned()),
            5500 => line(
                &mut text,
                "v 1 2 3 5\nf 1 2 3 # triangle\n# comment \\".to_owned(),
            ),
            _ => {}
        }
    }
    assert!(text.len() > 2 << 20, "several pieces: {}", text.len());
    // Comments and continued lines are kept.
    let lines = text.split_inclusive('\n');
    let odd: String = lines.flat_map(|line| [" ", line]).collect();
    let parse = |text: &str, limits: &Limits| {
        parse_model(
            text.as_bytes(),
            ModelFormat::Obj,
            "large",
            &NoResources,
            limits,
        )
    };
    for threads in [1, 2, 7] {
        let limits = Limits {
            threads,
            ..Limits::default()
        };
        let [ahead, expected] = [&text, &odd].map(|text| parse(text, &limits).unwrap());
        assert!(ahead.warning_count > 4);
        assert_eq!(ahead.warnings, expected.warnings);
        assert_eq!(ahead.warning_count, expected.warning_count);
        let (ahead, expected) = (ahead.scene.meshes, expected.scene.meshes);
        assert_eq!((ahead.len(), expected.len()), (2, 2));
        for (ahead, expected) in ahead.iter().zip(&expected) {
            assert_eq!(ahead.name, expected.name);
            // Compare bits: one of the values is NaN, which equals nothing.
            let bits = |mesh: &Mesh| -> Vec<[u32; 3]> {
                let positions = mesh.positions.iter();
                positions.map(|p| p.to_array().map(f32::to_bits)).collect()
            };
            assert!(bits(ahead) == bits(expected));
            assert!(ahead.normals == expected.normals);
            assert!(ahead.uvs == expected.uvs);
            assert!(ahead.colors == expected.colors);
            assert!(ahead.triangles == expected.triangles);
            assert_eq!(ahead.lines, expected.lines);
            assert_eq!(ahead.points, expected.points);
            assert_eq!(ahead.surfaces, expected.surfaces);
        }
        // Limits apply at the same line.
        let few = Limits {
            max_vertices: 20_000,
            ..limits.clone()
        };
        let [ahead, expected] = [&text, &odd].map(|text| parse(text, &few).unwrap_err());
        assert_eq!(ahead.to_string(), expected.to_string());
    }
}
