//! STL, binary and ASCII: geometry, colours, damaged files, detection of the format.

use estampe_assets::model::NoResources;
use estampe_assets::{AssetError, Limits, Loaded, Location, ModelFormat, parse_model};
use estampe_scene::UpAxis;
use glam::Vec3;

fn try_read(bytes: &[u8]) -> Result<Loaded, AssetError> {
    parse_model(
        bytes,
        ModelFormat::Stl,
        "test.stl",
        &NoResources,
        &Limits::default(),
    )
}

fn read(bytes: &[u8]) -> Loaded {
    try_read(bytes).unwrap()
}

/// A binary file of triangles of the tetrahedron, each with its attribute, whose header states
/// `announced` triangles.
fn binary(header: &[u8], attributes: &[u16], announced: u32) -> Vec<u8> {
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
    let mut bytes = vec![0; 80];
    bytes[..header.len()].copy_from_slice(header);
    bytes.extend(announced.to_le_bytes());
    for (i, attribute) in attributes.iter().enumerate() {
        bytes.extend([0xff; 12]);
        for corner in (0..4).filter(|&corner| corner != i % 4) {
            bytes.extend(
                corners[corner]
                    .to_array()
                    .into_iter()
                    .flat_map(f32::to_le_bytes),
            );
        }
        bytes.extend(attribute.to_le_bytes());
    }
    bytes
}

const FACET: &str = "facet normal 0 0 nan\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  \
                     vertex 0 1e0 0\n endloop\nendfacet\n";

/// Rows: M7.
#[test]
fn binary_corners_are_joined_and_get_normals() {
    let loaded = read(&binary(b"solid not ASCII at all", &[0; 4], 4));
    assert_eq!(loaded.warnings, []);
    assert_eq!(loaded.scene.up, UpAxis::Z);
    let [mesh] = &loaded.scene.meshes[..] else {
        panic!()
    };
    assert_eq!(mesh.name, "solid not ASCII at all");
    assert_eq!(mesh.triangles.len(), 4);
    assert_eq!(
        mesh.positions.len(),
        12,
        "4 positions, each with 3 sharp sides"
    );
    assert!(
        mesh.normals
            .iter()
            .all(|normal| (normal.length() - 1.0).abs() < 1e-6)
    );
    assert!(mesh.colors.is_empty());
}

#[test]
fn wrong_numbers_of_triangles_are_warnings() {
    let loaded = read(&binary(b"", &[0; 2], 4));
    assert_eq!(loaded.scene.meshes[0].triangles.len(), 2);
    assert_eq!(loaded.warnings[0].location, Some(Location::Byte(184)));
    let loaded = read(&binary(b"", &[0; 4], 3));
    assert_eq!(loaded.scene.meshes[0].triangles.len(), 3);
    assert_eq!(loaded.warning_count, 1);
    let loaded = read(&binary(b"", &[0; 2], u32::MAX));
    assert_eq!(loaded.scene.meshes[0].triangles.len(), 2);
    let mut cut = binary(b"", &[0; 2], 2);
    cut.truncate(150);
    assert_eq!(read(&cut).scene.meshes[0].triangles.len(), 1);
    cut.truncate(120);
    assert!(matches!(try_read(&cut), Err(AssetError::Malformed(_))));
    cut.truncate(83);
    let error = try_read(&cut).unwrap_err().to_string();
    assert!(error.starts_with("test.stl, byte 83: "), "{error}");
    let empty = read(&binary(b"", &[], 0));
    assert_eq!(
        (empty.scene.meshes[0].triangles.len(), empty.warning_count),
        (0, 1)
    );
}

#[test]
fn both_conventions_of_colour_are_read() {
    let red = 31 << 10 | 1 << 15;
    let loaded = read(&binary(b"", &[red, red, 0, red], 4));
    let colors = &loaded.scene.meshes[0].colors;
    assert!(colors.contains(&[1.0, 0.0, 0.0, 1.0]) && colors.contains(&[1.0; 4]));
    // In Magics' order the same bits are blue, and bit 15 selects the default colour.
    let loaded = read(&binary(
        b"COLOR=\xff\x00\x00\xff",
        &[31 << 10, 1 << 15, 0, 0],
        4,
    ));
    let mesh = &loaded.scene.meshes[0];
    let color = |triangle: usize| mesh.colors[mesh.triangles[triangle][0] as usize];
    assert_eq!(color(0), [0.0, 0.0, 1.0, 1.0]);
    assert_eq!(color(1), [1.0, 0.0, 0.0, 1.0]);
    assert_eq!(color(2), [0.0, 0.0, 0.0, 1.0]);
    let noise = read(&binary(b"", &[1, 77, 1 << 15, 9], 4));
    assert!(
        noise.scene.meshes[0].colors.is_empty(),
        "attributes that are no colours"
    );
}

/// Rows: M7.
#[test]
fn ascii_is_read_in_all_its_dialects() {
    let plain = format!("solid part one\n{FACET}endsolid part one\n");
    let reference = read(plain.as_bytes());
    assert_eq!(reference.warnings, []);
    assert_eq!(reference.scene.meshes[0].name, "part one");
    assert_eq!(
        reference.scene.meshes[0].positions,
        [Vec3::ZERO, Vec3::X, Vec3::Y]
    );
    let one_line = plain
        .replace('\n', " ")
        .replace("solid part one", "solid part one\n");
    for (name, text) in [
        ("nameless", format!("solid\n{FACET}endsolid\n")),
        ("no solid", FACET.to_owned()),
        ("upper case", plain.to_uppercase()),
        ("CRLF", plain.replace('\n', "\r\n")),
        ("CR", plain.replace('\n', "\r")),
        ("one line", one_line),
        (
            "split words",
            plain
                .replace("endloop", "end loop")
                .replace("endfacet", "end facet"),
        ),
        ("blanks before", format!("\n \t{plain}")),
        ("no normal", plain.replace("facet normal 0 0 nan", "facet")),
    ] {
        let loaded = read(text.as_bytes());
        assert_eq!(loaded.warnings, [], "{name}");
        assert_eq!(loaded.scene.meshes.len(), 1, "{name}");
        let mesh = &loaded.scene.meshes[0];
        assert_eq!(
            mesh.positions, reference.scene.meshes[0].positions,
            "{name}"
        );
        assert_eq!(mesh.normals, [Vec3::Z; 3], "{name}");
    }
}

#[test]
fn a_solid_without_an_end_is_read_with_a_warning() {
    let loaded = read(format!("solid a\n{FACET}").as_bytes());
    assert_eq!(loaded.scene.meshes[0].triangles.len(), 1);
    assert_eq!(loaded.warning_count, 1);
    assert!(loaded.warnings[0].message.contains("endsolid"));
}

#[test]
fn spread_coordinates_are_random_bytes_and_large_or_small_models_are_not() {
    let of = |size: &dyn Fn(usize) -> f32| {
        let mut bytes = vec![b' '; 80];
        bytes.extend_from_slice(&30_u32.to_le_bytes());
        for number in 0..30 {
            let mut record = [0; 50];
            for corner in 0..3 {
                let at = 12 + 12 * corner + 4 * corner;
                record[at..at + 4].copy_from_slice(&size(3 * number + corner).to_le_bytes());
            }
            bytes.extend_from_slice(&record);
        }
        parse_model(
            &bytes,
            ModelFormat::Stl,
            "a",
            &NoResources,
            &Limits::default(),
        )
    };
    for scale in [1e-30, 1.0, 1e30] {
        assert!(of(&|at| scale * (1 + at % 7) as f32).is_ok(), "{scale}");
        // A few wild corners are a damaged model.
        let wild = |at: usize| if at.is_multiple_of(10) { 1e38 } else { scale };
        assert!(of(&wild).is_ok(), "{scale}");
    }
    let spread = |at: usize| f32::from_bits((u32::try_from(at % 60).unwrap() * 4 + 8) << 23);
    let error = of(&spread).expect_err("nonsense").to_string();
    assert!(error.contains("random bytes"), "{error}");
}

#[test]
fn solids_are_meshes() {
    let text = format!("solid a\n{FACET}endsolid a\nsolid b\n{FACET}{FACET}solid c\n{FACET}");
    let loaded = read(text.as_bytes());
    let meshes = loaded.scene.meshes.iter();
    let meshes: Vec<_> = meshes
        .map(|mesh| (mesh.name.as_str(), mesh.triangles.len()))
        .collect();
    assert_eq!(meshes, [("a", 1), ("b", 2), ("c", 1)]);
    let one = Limits {
        max_meshes: 1,
        ..Limits::default()
    };
    let loaded = parse_model(text.as_bytes(), ModelFormat::Stl, "a", &NoResources, &one).unwrap();
    assert_eq!(loaded.scene.meshes.len(), 1);
    assert_eq!(loaded.scene.meshes[0].triangles.len(), 4);
}

#[test]
fn odd_facets_are_warnings() {
    let vertex = |count: usize| "vertex 1 2 3\n".repeat(count);
    let text = format!(
        "solid\nfacet\n{}endfacet\nfacet\nvertex 0 x 0\n{}endfacet\nbogus 1\n",
        vertex(2),
        vertex(2)
    );
    let loaded = read(text.as_bytes());
    let lines: Vec<_> = loaded
        .warnings
        .iter()
        .map(|warning| warning.location)
        .collect();
    let line = |number| Some(Location::Line(number));
    assert_eq!(
        lines,
        [line(5), line(7), line(11), line(12), None, None],
        "{:?}",
        loaded.warnings
    );
    let quad = "solid\nfacet\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\nendfacet\n";
    assert_eq!(read(quad.as_bytes()).scene.meshes[0].triangles.len(), 2);
    let empty = read(b"solid Empty\nendsolid Empty");
    assert_eq!(
        (empty.scene.meshes[0].name.as_str(), empty.warning_count),
        ("Empty", 1)
    );
}

#[test]
fn formats_are_detected_by_content() {
    let format = |bytes: &[u8]| ModelFormat::from_content(bytes);
    assert_eq!(
        format(&binary(b"v 1 2 3", &[0; 4], 4)),
        Some(ModelFormat::Stl)
    );
    assert_eq!(format(b"  SOLID x\nfacet"), Some(ModelFormat::Stl));
    assert_eq!(format(b"ply\nformat ascii 1.0\n"), Some(ModelFormat::Ply));
    assert_eq!(
        format(b"# comment\n\nmtllib a\nv 1 2 3\n"),
        Some(ModelFormat::Obj)
    );
    assert_eq!(format(b"\xef\xbb\xbfv 1 2 3\n"), Some(ModelFormat::Obj));
    assert_eq!(format(b"glTF\x02"), Some(ModelFormat::Gltf));
    assert_eq!(format(b""), None);
    let by_name = |name: &str| ModelFormat::from_extension(std::path::Path::new(name));
    assert_eq!(by_name("a/b.STL"), Some(ModelFormat::Stl));
    assert_eq!(by_name("obj"), None);
}
