//! 3MF: packages, meshes, components, materials, damaged and hostile files.

pub(crate) mod archive;
mod hostile;

use archive::{full, model, package, square, zip};
use estampe_assets::model::NoResources;
use estampe_assets::{AssetError, Limits, Loaded, ModelFormat, parse_model};
use estampe_scene::{AlphaMode, Image, UpAxis};
use glam::{Vec2, Vec3};
use std::path::Path;

fn try_read(bytes: &[u8]) -> Result<Loaded, AssetError> {
    let limits = Limits::default();
    parse_model(
        bytes,
        ModelFormat::ThreeMf,
        "test.3mf",
        &NoResources,
        &limits,
    )
}

fn read(model: &str) -> Loaded {
    let bytes = package(model.as_bytes(), &[], true);
    try_read(&bytes).unwrap_or_else(|error| panic!("{model}: {error}"))
}

/// Reads an object with a square of this content.
fn read_square(attributes: &str, build: &str) -> Loaded {
    let object = format!(r#"<object id="1">{}</object>"#, square([""; 2]));
    read(&model(attributes, &object, build))
}

fn png() -> Vec<u8> {
    let image = Image::filled(2, 2, [10, 20, 30, 255]);
    estampe_assets::image::encode_png(&image, estampe_assets::image::AlphaChannel::WhenNeeded)
        .unwrap()
}

const CORNERS: [Vec3; 4] = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y];

/// Rows: M7.
#[test]
fn objects_are_placed_with_their_properties() {
    let texture = png();
    for is_deflated in [false, true] {
        let parts = [("3D/Textures/T.png", texture.as_slice())];
        let bytes = package(full().as_bytes(), &parts, is_deflated);
        let loaded = try_read(&bytes).unwrap();
        assert_eq!(loaded.warnings, []);
        let scene = loaded.scene;
        assert_eq!(scene.up, UpAxis::Z);
        let names: Vec<_> = scene.meshes.iter().map(|mesh| mesh.name.as_str()).collect();
        assert_eq!(names, ["first", "second", "second"]);
        let [first, second, mirrored] = scene.meshes.as_slice() else {
            panic!("three meshes");
        };
        // Centimetres become millimetres.
        assert_eq!(first.positions, CORNERS.map(|corner| corner * 10.0));
        assert_eq!(first.triangles, [[0, 1, 2], [0, 2, 3]]);
        assert!(first.colors.is_empty());
        let materials: Vec<_> = { first.surfaces.iter() }
            .map(|surface| &scene.materials[surface.material.unwrap()])
            .collect();
        assert_eq!(materials[0].name, "a&b");
        assert_eq!(materials[0].base_color, Vec3::X);
        assert_eq!(materials[0].alpha_mode, AlphaMode::Opaque);
        assert_eq!(materials[1].base_color, Vec3::Y);
        assert_eq!(materials[1].opacity, 128.0 / 255.0);
        assert_eq!(materials[1].alpha_mode, AlphaMode::Blend);
        // Colours of corners, without a material, come first.
        assert_eq!(second.surfaces.len(), 2);
        let [colored, textured] = [0, 1].map(|at| second.triangles[at].map(|at| at as usize));
        let blue = [0.0, 0.0, 1.0, 1.0];
        let half = [1.0, 1.0, 1.0, 128.0 / 255.0];
        assert_eq!(colored.map(|at| second.colors[at]), [blue, half, blue]);
        assert_eq!(textured.map(|at| second.colors[at]), [[1.0; 4]; 3]);
        let uvs = [
            Vec2::new(0.0, 1.0),
            Vec2::new(1.0, 0.75),
            Vec2::new(0.0, 1.0),
        ];
        assert_eq!(textured.map(|at| second.uvs[at]), uvs);
        let material = &scene.materials[second.surfaces[1].material.unwrap()];
        let image = &scene.images[material.base_color_texture.unwrap()];
        assert_eq!(image.texel(1, 1), [10, 20, 30, 255]);
        assert_eq!(material.base_color, Vec3::ONE);
        // A mirroring transform keeps the front in front.
        assert!(second.positions.iter().all(|position| position.z == 20.0));
        let xs = mirrored.triangles[0].map(|at| mirrored.positions[at as usize].x);
        assert_eq!(xs, [50.0, 40.0, 40.0]);
        for mesh in [first, second, mirrored] {
            assert!(
                mesh.normals.iter().all(|normal| *normal == Vec3::Z),
                "{}",
                mesh.name
            );
        }
    }
}

#[test]
fn units_are_converted_to_millimetres() {
    let item = r#"<item objectid="1" transform="0 1 0 -1 0 0 0 0 1 2 0 0"/>"#;
    for (unit, millimetres) in [
        ("", 1.0),
        (r#"unit="micron""#, 0.001),
        (r#"unit="millimeter""#, 1.0),
        (r#"unit="centimeter""#, 10.0),
        (r#"unit="inch""#, 25.4),
        (r#"unit="foot""#, 304.8),
        (r#"unit="meter""#, 1000.0),
    ] {
        let mesh = &read_square(unit, item).scene.meshes[0];
        // A quarter of a turn, then 2 along x.
        let expected = [[2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 0.0]];
        for (found, [x, y]) in mesh.positions.iter().zip(expected) {
            let expected = Vec3::new(x, y, 0.0) * millimetres;
            assert!(
                (found - expected).length() < 1e-4 * millimetres,
                "{unit}: {found}"
            );
        }
    }
}

#[test]
fn transforms_of_components_come_before_those_of_items() {
    let object = format!(
        r#"<object id="1">{}</object>
<object id="2"><components><component objectid="1" transform="2 0 0 0 2 0 0 0 2 0 0 0"/></components></object>
<object id="3"><components><component objectid="2" transform="1 0 0 0 1 0 0 0 1 1 0 0"/></components></object>"#,
        square([""; 2])
    );
    let item = r#"<item objectid="3" transform="0 0 1 0 1 0 1 0 0 0 5 0"/>"#;
    let scene = read(&model("", &object, item)).scene;
    // (1, 1, 0) · 2 = (2, 2, 0); + (1, 0, 0) = (3, 2, 0); x and z change places: (0, 2, 3).
    assert_eq!(scene.meshes[0].positions[2], Vec3::new(0.0, 7.0, 3.0));
}

#[test]
fn objects_may_be_in_other_parts() {
    let inner = format!(r#"<object id="1">{}</object>"#, square([""; 2]));
    let inner = model(r#"unit="meter""#, &inner, r#"<item objectid="1"/>"#);
    let outer = r#"<object id="1"><components>
<component objectid="1" p:path="/3D/Objects/a%20b.model"/></components></object>"#;
    let outer = model(
        r#"requiredextensions="p""#,
        outer,
        r#"<item objectid="1"/>"#,
    );
    let parts = [("3D/Objects/a b.model", inner.as_bytes())];
    let loaded = try_read(&package(outer.as_bytes(), &parts, true)).unwrap();
    assert_eq!(loaded.scene.meshes.len(), 1);
    assert_eq!(loaded.scene.meshes[0].positions[1], Vec3::X * 1000.0);
}

#[test]
fn packages_may_lack_relationships_and_parts_be_utf16() {
    let object = format!(r#"<object id="1" name="é">{}</object>"#, square([""; 2]));
    let text = model("", &object, r#"<item objectid="1"/>"#);
    let utf16: Vec<u8> = "\u{feff}"
        .encode_utf16()
        .chain(text.encode_utf16())
        .flat_map(u16::to_le_bytes)
        .collect();
    let loaded = try_read(&zip(&[("3D/a.model", &utf16)], true)).unwrap();
    assert_eq!(loaded.scene.meshes[0].name, "é");
    assert!(
        loaded.warnings[0]
            .message
            .contains("does not name its model")
    );
    let loaded = read(&format!("\u{feff}{text}"));
    assert_eq!(loaded.scene.meshes[0].positions, CORNERS);
}

#[test]
fn missing_properties_and_textures_are_warnings() {
    let loaded = try_read(&package(full().as_bytes(), &[], true)).unwrap();
    assert_eq!(
        loaded.warnings[0].to_string(),
        "test.3mf, 3D/3dmodel.model, line 9, column 1: the texture `3D/Textures/t.png` is omitted: \
         the package has no such part; export the file again"
    );
    let object = format!(
        r#"<basematerials id="2"><base name="n" displaycolor="red"/></basematerials>
<object id="1" pid="2" pindex="0">{}</object>"#,
        square([r#"p1="7""#, r#"pid="8" p1="0""#])
    );
    let loaded = read(&model("", &object, r#"<item objectid="1"/>"#));
    let warnings: Vec<_> = loaded.warnings.iter().map(ToString::to_string).collect();
    assert!(
        warnings[0].contains("line 6, column 23: the material `n` has no colour"),
        "{warnings:?}"
    );
    assert!(warnings[1].contains("have 1 entries only"), "{warnings:?}");
    assert!(
        warnings[2].contains("properties 8 do not exist"),
        "{warnings:?}"
    );
    assert_eq!(loaded.scene.meshes[0].triangles.len(), 2);
}

#[test]
fn the_format_is_found_by_extension_and_by_content() {
    let found = ModelFormat::from_extension(Path::new("a/b.3MF"));
    assert_eq!(found, Some(ModelFormat::ThreeMf));
    let whole = package(full().as_bytes(), &[], true);
    let bare = zip(&[("a.txt", b"a"), ("3D/x.model", b"")], false);
    for bytes in [&whole[..], &whole[..100], &bare] {
        assert_eq!(ModelFormat::from_content(bytes), Some(ModelFormat::ThreeMf));
    }
    let other = zip(&[("a.txt", b"a")], false);
    assert_ne!(
        ModelFormat::from_content(&other),
        Some(ModelFormat::ThreeMf)
    );
}
