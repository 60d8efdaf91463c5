//! OFF: headers, attributes, colours, polygons, damaged files.

use estampe_assets::model::NoResources;
use estampe_assets::{AssetError, Limits, Loaded, Location, ModelFormat, parse_model};
use estampe_scene::Mesh;
use glam::{Vec2, Vec3};
use std::path::Path;

fn try_read(text: &str) -> Result<Loaded, AssetError> {
    let bytes = text.as_bytes();
    parse_model(
        bytes,
        ModelFormat::Off,
        "test.off",
        &NoResources,
        &Limits::default(),
    )
}

fn mesh(text: &str) -> Mesh {
    let loaded = try_read(text).unwrap_or_else(|error| panic!("{text}: {error}"));
    assert_eq!(loaded.warnings, [], "{text}");
    loaded.scene.meshes.into_iter().next().unwrap()
}

const SQUARE: &str = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
const CORNERS: [Vec3; 4] = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::Y];

/// A corner of sRGB-encoded 188 has half of the light.
fn assert_color(found: [f32; 4], expected: [f32; 4]) {
    let is_near = found
        .iter()
        .zip(expected)
        .all(|(a, b)| (a - b).abs() < 0.005);
    assert!(is_near, "{found:?} is not {expected:?}");
}

#[test]
fn headers_are_read_however_they_are_written() {
    for header in [
        "OFF\n4 1 0\n",
        "OFF 4 1 4\n",
        "OFF4 1 0\n",
        "OFF\n4 1\n",
        "4 1 0\n",
        "\u{feff}# made by hand\n\nOFF # here\n# counts\n4\t1\r\n",
    ] {
        let mesh = mesh(&format!("{header}{SQUARE}4 0 1 2 3\n"));
        assert_eq!(mesh.positions, CORNERS, "{header}");
        assert_eq!(mesh.triangles.len(), 2, "{header}");
    }
    // Lines do not matter.
    let words = format!("OFF 4 2 0 {SQUARE} 3 0 1 2 3 0 2 3").replace('\n', " ");
    let one_line = mesh(&words);
    assert_eq!(one_line.triangles, [[0, 1, 2], [0, 2, 3]]);
    let spread = mesh(&words.replace(' ', "\n"));
    assert_eq!(spread.triangles, one_line.triangles);
    assert_eq!(spread.positions, CORNERS);
}

/// Rows: M7.
#[test]
fn vertices_have_what_the_header_says() {
    let file = "STCN4OFF\n3 1 0\n\
        0 0 0 2  0 0 2  255 0 0 255  0.25 0.25\n\
        2 0 0 2  0 0 1  0 255 0 0    1 0\n\
        0 2 0 2  0 0 1  0 0 188 51   0 1\n\
        3 0 1 2\n";
    for text in [
        file.to_owned(),
        file.replace("  ", "\n ").replace('\n', "  "),
    ] {
        let mesh = mesh(&text);
        assert_eq!(mesh.positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
        assert_eq!(mesh.normals, [Vec3::Z; 3]);
        let uvs = [(0.25, 0.75), (1.0, 1.0), (0.0, 0.0)].map(Vec2::from);
        assert_eq!(mesh.uvs, uvs);
        assert_color(mesh.colors[0], [1.0, 0.0, 0.0, 1.0]);
        assert_color(mesh.colors[1], [0.0, 1.0, 0.0, 0.0]);
        assert_color(mesh.colors[2], [0.0, 0.0, 0.5, 0.2]);
    }
    // Without alpha, with numbers to 1, and without the letter.
    for header in ["COFF", "OFF"] {
        let text = format!("{header}\n2 1 0\n0 0 0 1 0 0.737\n1 0 0 0 1 0\n2 0 1\n");
        let mesh = mesh(&text);
        assert_color(mesh.colors[0], [1.0, 0.0, 0.5, 1.0]);
        assert_color(mesh.colors[1], [0.0, 1.0, 0.0, 1.0]);
        assert_eq!(mesh.lines, [[0, 1]]);
    }
}

#[test]
fn polygons_are_split_inside_and_small_faces_are_lines_and_points() {
    // An L, whose area is 3.
    let text = "OFF\n6 1 0\n0 0 0\n2 0 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n6 0 1 2 3 4 5\n";
    let ell = mesh(text);
    let area = |&[a, b, c]: &[u32; 3]| {
        let [a, b, c] = [a, b, c].map(|at| ell.positions[at as usize]);
        (b - a).cross(c - a).z / 2.0
    };
    assert!(ell.triangles.iter().all(|triangle| area(triangle) > 0.0));
    assert_eq!(ell.triangles.iter().map(area).sum::<f32>(), 3.0);
    let mixed = mesh(&format!("OFF\n4 3 0\n{SQUARE}1 3\n2 0 1\n3 0 1 2\n"));
    assert_eq!((mixed.points, mixed.lines), (vec![3], vec![[0, 1]]));
    assert_eq!(mixed.triangles.len(), 1);
    let cloud = mesh(&format!("OFF\n4 0 0\n{SQUARE}"));
    assert_eq!(cloud.points, [0, 1, 2, 3]);
}

#[test]
fn colours_of_faces_become_colours_of_vertices() {
    let text = format!("OFF\n4 3 0\n{SQUARE}3 0 1 2 255 0 0\n3 0 2 3 0 0 188 51\n3 1 2 3 7\n");
    let square = mesh(&text);
    let colors = |triangle: [u32; 3]| triangle.map(|at| square.colors[at as usize]);
    for (triangle, color) in [
        (0, [1.0, 0.0, 0.0, 1.0]),
        (1, [0.0, 0.0, 0.5, 0.2]),
        (2, [1.0; 4]),
    ] {
        for found in colors(square.triangles[triangle]) {
            assert_color(found, color);
        }
    }
    let of_triangle = |at: usize| square.triangles[at].map(|at| square.positions[at as usize]);
    assert_eq!(of_triangle(0), [CORNERS[0], CORNERS[1], CORNERS[2]]);
    assert_eq!(of_triangle(1), [CORNERS[0], CORNERS[2], CORNERS[3]]);
    let white = &try_read(&text).unwrap().scene.materials[0];
    assert_eq!(white.base_color, Vec3::ONE);
}

/// Rows: M7.
#[test]
fn damage_is_located() {
    let fault = |text: &str| try_read(text).unwrap_err();
    for (text, line, what) in [
        ("OFF\n", 2, "no number of vertices"),
        ("OFF\n4\n", 3, "no number of faces"),
        ("OFF\n-4 1 0\n", 2, "no number of vertices"),
        ("OFF\n4 1 0\n0 0 0\n1 1\n", 5, "ends at vertex 1 of 4"),
        (
            "OFF\n4 1 0\n0 0 0\n1 a 1\n",
            4,
            "a word of vertex 1 is no number",
        ),
    ] {
        let error = fault(text);
        assert!(matches!(error, AssetError::Malformed(_)), "{error}");
        assert_eq!(
            error.fault().location,
            Some(Location::Line(line)),
            "{error}"
        );
        assert!(error.to_string().contains(what), "{error}");
    }
    for text in [
        "OFF BINARY\n\0\0\0\x04",
        "3nOFF\n4\n1 1 0\n",
        "nOFF 4 1 1 0\n",
    ] {
        let error = fault(text);
        assert!(
            matches!(error, AssetError::Unsupported(_)),
            "{text}: {error}"
        );
    }
    for text in ["OFF 99999999999 1 0\n", "OFF 1 99999999999 0\n"] {
        let error = fault(text);
        assert!(
            matches!(error, AssetError::LimitExceeded(_)),
            "{text}: {error}"
        );
    }
    let warning = |faces: &str| {
        let loaded = try_read(&format!("OFF\n4 3 0\n{SQUARE}3 0 1 2\n{faces}3 0 2 3\n")).unwrap();
        let count = loaded.scene.meshes[0].triangles.len();
        (count, loaded.warnings[0].to_string())
    };
    let (count, text) = warning("3 0 1 4\n");
    assert_eq!(count, 2);
    assert_eq!(
        text,
        "test.off, line 8: face 1 refers to a vertex that does not exist; it is omitted"
    );
    assert_eq!(warning("99999 0 1 2\n").0, 1);
    let (count, text) = warning("x 1 2\n");
    assert_eq!(count, 1);
    assert!(
        text.contains("line 8: the file ends, or has a word that is no number, at face 1 of 3")
    );
}

#[test]
fn the_format_is_found_by_extension_and_by_content() {
    let found = ModelFormat::from_extension(Path::new("a/b.OFF"));
    assert_eq!(found, Some(ModelFormat::Off));
    for text in ["OFF\n", "# x\n COFF 1 2 3", "OFF12 3 4\n", "STCN4OFF"] {
        let found = ModelFormat::from_content(text.as_bytes());
        assert_eq!(found, Some(ModelFormat::Off), "{text}");
    }
    for text in ["", "OFFSET 1\n", "XOFF", "CCOFF", "v 0 0 0\n# OFF"] {
        let found = ModelFormat::from_content(text.as_bytes());
        assert_ne!(found, Some(ModelFormat::Off), "{text}");
    }
}
