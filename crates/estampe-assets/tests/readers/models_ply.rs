//! PLY: encodings, elements, attributes, damaged files.

use estampe_assets::model::{NoResources, ResourceError, Resources};
use estampe_assets::{AssetError, Limits, Loaded, Location, ModelFormat, parse_model};
use estampe_scene::Mesh;
use glam::{Vec2, Vec3};

fn try_read(bytes: &[u8]) -> Result<Loaded, AssetError> {
    parse_model(
        bytes,
        ModelFormat::Ply,
        "test.ply",
        &NoResources,
        &Limits::default(),
    )
}

fn mesh(bytes: &[u8]) -> Mesh {
    let loaded = try_read(bytes).unwrap();
    assert_eq!(loaded.warnings, []);
    loaded.scene.meshes.into_iter().next().unwrap()
}

const XYZ: &str = "property float x\nproperty float y\nproperty float z\n";
const SQUARE: &str = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

/// An ASCII file of a square's four corners, extended by `elements` and `rows`.
fn ascii(elements: &str, rows: &str) -> Vec<u8> {
    format!("ply\nformat ascii 1.0\nelement vertex 4\n{XYZ}{elements}end_header\n{SQUARE}{rows}")
        .into_bytes()
}

const FACES: &str = "property list uchar int vertex_indices\n";

/// A square with every property of vertices, and lists before and after, in a binary encoding.
fn binary(big: bool, line_end: &str) -> Vec<u8> {
    let name = if big {
        "binary_big_endian"
    } else {
        "binary_little_endian"
    };
    let header = format!(
        "ply\nformat {name} 1.0\ncomment made here\nobj_info odd\nelement vertex 4\n\
         property list uchar short before\nproperty double x\nproperty float y\nproperty short z\n\
         property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\n\
         property uchar green\nproperty uchar blue\nproperty uchar alpha\nproperty float s\n\
         property float t\nproperty list uint double after\nelement odd 2\nproperty list ushort char l\n\
         property int i\nelement face 2\nproperty uchar flag\nproperty list ushort uint vertex_index\n\
         property float quality\nelement edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n"
    );
    let mut out = header.replace('\n', line_end).into_bytes();
    let put = |out: &mut Vec<u8>, little: &[u8]| {
        let mut bytes = little.to_vec();
        if big {
            bytes.reverse();
        }
        out.extend(bytes);
    };
    for (x, y) in [(0.0_f64, 0.0_f32), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
        out.push(2);
        put(&mut out, &7_i16.to_le_bytes());
        put(&mut out, &8_i16.to_le_bytes());
        put(&mut out, &x.to_le_bytes());
        put(&mut out, &y.to_le_bytes());
        put(&mut out, &3_i16.to_le_bytes());
        for value in [0.0_f32, 0.0, -2.0] {
            put(&mut out, &value.to_le_bytes());
        }
        out.extend([255, 0, 188, 51]);
        put(&mut out, &0.25_f32.to_le_bytes());
        put(&mut out, &y.to_le_bytes());
        put(&mut out, &1_u32.to_le_bytes());
        put(&mut out, &9.0_f64.to_le_bytes());
    }
    for _ in 0..2 {
        put(&mut out, &3_u16.to_le_bytes());
        out.extend([1, 2, 3]);
        put(&mut out, &5_i32.to_le_bytes());
    }
    for face in [[0_u32, 1, 2], [0, 2, 3]] {
        out.push(1);
        put(&mut out, &3_u16.to_le_bytes());
        for index in face {
            put(&mut out, &index.to_le_bytes());
        }
        put(&mut out, &0.5_f32.to_le_bytes());
    }
    put(&mut out, &1_i32.to_le_bytes());
    put(&mut out, &3_i32.to_le_bytes());
    out
}

/// Rows: M7.
#[test]
fn both_byte_orders_are_read() {
    for (big, line_end) in [(false, "\n"), (true, "\n"), (false, "\r\n"), (true, "\r")] {
        let mesh = mesh(&binary(big, line_end));
        assert_eq!(mesh.positions[2], Vec3::new(1.0, 1.0, 3.0));
        assert_eq!(mesh.normals, [Vec3::NEG_Z; 4], "as in the file, made unit");
        assert_eq!(mesh.uvs[3], Vec2::new(0.25, 0.0), "v points down");
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(mesh.lines, [[1, 3]]);
        let [r, g, b, a] = mesh.colors[0];
        assert!(r == 1.0 && g == 0.0 && (b - 0.502_886_6).abs() < 1e-5 && a == 0.2);
    }
}

#[test]
fn ascii_faces_of_any_size_are_read() {
    let faces = format!("element face 2\n{FACES}");
    let square = mesh(&ascii(&faces, "3 0 1 2\n4 0 1 2 3\n"));
    assert_eq!(square.triangles.len(), 3);
    assert!(square.points.is_empty());
    assert_eq!(square.normals, [Vec3::Z; 4]);
    let windows = String::from_utf8(ascii(&faces, "3 0 1 2\n4 0 1 2 3\n")).unwrap();
    assert_eq!(
        mesh(windows.replace('\n', "\r\n").as_bytes()).triangles,
        square.triangles
    );
    let floats = format!("element face 1\n{}", FACES.replace("int", "float"));
    assert_eq!(
        mesh(&ascii(&floats, "3 0 1.0 2 extra words\n")).triangles,
        [[0, 1, 2]]
    );
}

#[test]
fn files_with_only_points_are_read() {
    let cloud = mesh(&ascii("", ""));
    assert_eq!(cloud.points, [0, 1, 2, 3]);
    assert!(cloud.normals.is_empty());
    let cloud = mesh(&ascii(&format!("element face 0\n{FACES}"), ""));
    assert_eq!(cloud.points.len(), 4);
}

#[test]
fn strips_turn_every_other_triangle() {
    let strips = "element tristrips 1\nproperty list int int vertex_indices\n";
    let strip = mesh(&ascii(strips, "8 0 1 3 2 -1 0 1 2\n"));
    assert_eq!(strip.triangles, [[0, 1, 3], [3, 1, 2], [0, 1, 2]]);
    assert!(strip.normals.iter().all(|&normal| normal == Vec3::Z));
}

#[test]
fn corners_and_faces_may_have_attributes() {
    let faces = format!(
        "element face 2\n{FACES}property list uchar float texcoord\nproperty uchar red\n\
         property uchar green\nproperty uchar blue\n"
    );
    let rows = "3 0 1 2 6 0 0 1 0 1 1 255 0 0\n3 0 2 3 6 0.5 0 1 1 0 1 255 0 0\n";
    let mesh = mesh(&ascii(&faces, rows));
    assert_eq!(
        mesh.positions.len(),
        5,
        "corner 0 has two texture coordinates, corner 2 one"
    );
    let uv = |triangle: usize, corner: usize| mesh.uvs[mesh.triangles[triangle][corner] as usize];
    assert_eq!(
        (uv(0, 0), uv(1, 0)),
        (Vec2::new(0.0, 1.0), Vec2::new(0.5, 1.0))
    );
    assert_eq!(
        (uv(0, 2), uv(1, 1)),
        (Vec2::new(1.0, 0.0), Vec2::new(1.0, 0.0))
    );
    assert!(
        mesh.colors
            .iter()
            .all(|&color| color == [1.0, 0.0, 0.0, 1.0])
    );
    assert_eq!(mesh.colors.len(), 5);
}

/// Resources in which every name is a file of one white pixel.
struct WhitePixels;

impl Resources for WhitePixels {
    fn resolve(&self, name: &str) -> Result<String, ResourceError> {
        Ok(name.to_owned())
    }

    fn read(&self, _resolved: &str, _max_bytes: u64) -> Result<Vec<u8>, ResourceError> {
        Ok(vec![
            0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 1, 0, 24, 0x20, 255, 255, 255,
        ])
    }
}

#[test]
fn textures_are_named_in_comments() {
    let faces = format!(
        "comment TextureFile one side.tga\ncomment TextureFile b.tga\nelement face 3\n{FACES}\
         property int texnumber\n"
    );
    let bytes = ascii(&faces, "3 0 1 2 1\n3 0 2 3 0\n3 1 2 3 1\n");
    let limits = Limits::default();
    let loaded = parse_model(&bytes, ModelFormat::Ply, "a", &WhitePixels, &limits).unwrap();
    assert_eq!(loaded.warnings, []);
    assert_eq!(loaded.scene.materials[0].name, "one side.tga");
    assert_eq!(loaded.scene.materials[1].base_color_texture, Some(1));
    let mesh = &loaded.scene.meshes[0];
    let surfaces: Vec<_> = mesh
        .surfaces
        .iter()
        .map(|one| (one.material, one.triangles.clone()))
        .collect();
    assert_eq!(surfaces, [(Some(0), 0..1), (Some(1), 1..3)]);
    assert_eq!(mesh.triangles, [[0, 2, 3], [0, 1, 2], [1, 2, 3]]);
}

#[test]
fn damaged_faces_are_omitted_and_damaged_vertices_are_errors() {
    let faces = format!("element face 4\n{FACES}");
    let loaded = try_read(&ascii(&faces, "3 0 1 9\n2 0 1\n3 0 -1 2\n3 0 1 2\n")).unwrap();
    assert_eq!(loaded.scene.meshes[0].triangles.len(), 1);
    let lines: Vec<_> = loaded
        .warnings
        .iter()
        .map(|warning| warning.location)
        .collect();
    assert_eq!(lines, [14, 15, 16].map(|line| Some(Location::Line(line))));
    let cut = try_read(&ascii(&faces, "3 0 1 2\n3 0 1\n")).unwrap();
    assert_eq!(cut.scene.meshes[0].triangles.len(), 1);
    assert_eq!(cut.warning_count, 1);
    let whole = binary(false, "\n");
    let vertices = whole.len() - 8 - 2 * 19 - 2 * 9;
    let error = try_read(&whole[..vertices - 1]).unwrap_err();
    assert!(matches!(error, AssetError::Malformed(_)));
    assert!(matches!(error.fault().location, Some(Location::Byte(at)) if at > 500));
    let error = try_read(&ascii(&faces, "3 0 x 2\n"))
        .unwrap_err()
        .to_string();
    assert!(
        error.starts_with("test.ply, line 14: a number was expected"),
        "{error}"
    );
}

#[test]
fn hostile_counts_allocate_no_memory() {
    let header = |elements: &str| {
        format!("ply\nformat binary_little_endian 1.0\n{elements}end_header\n").into_bytes()
    };
    let vertices = |count: &str| header(&format!("element vertex {count}\n{XYZ}"));
    assert!(matches!(
        try_read(&vertices("49999999")),
        Err(AssetError::Malformed(_))
    ));
    assert!(matches!(
        try_read(&vertices("4000000000")),
        Err(AssetError::LimitExceeded(_))
    ));
    assert!(matches!(
        try_read(&vertices("99999999999999999999")),
        Err(AssetError::Malformed(_))
    ));
    assert!(matches!(
        try_read(&vertices("-1")),
        Err(AssetError::Malformed(_))
    ));
    let empty = header(&format!(
        "element nothing 18446744073709551615\nelement vertex 0\n{XYZ}"
    ));
    assert!(
        try_read(&empty).is_ok(),
        "elements without properties take no time"
    );
    let mut list = header(&format!(
        "element vertex 0\n{XYZ}element face 99999999\nproperty list uint uint vertex_indices\n"
    ));
    list.extend(u32::MAX.to_le_bytes());
    assert_eq!(try_read(&list).unwrap().scene.meshes[0].triangles.len(), 0);
    let mut unknown = header("element odd 99\nproperty list uint double l\n");
    unknown.extend(u32::MAX.to_le_bytes());
    assert!(try_read(&unknown).is_err());
    let many = "element a 1\n".repeat(300);
    assert!(matches!(
        try_read(&header(&many)),
        Err(AssetError::LimitExceeded(_))
    ));
}

/// Rows: M7.
#[test]
fn headers_that_are_wrong_are_errors_with_their_line() {
    let fails = |text: &str| {
        let error = try_read(text.as_bytes()).unwrap_err();
        assert!(matches!(error, AssetError::Malformed(_)), "{error:?}");
        error.to_string()
    };
    assert!(fails("plyx").contains("does not start with `ply`"));
    assert!(fails("").contains("does not start with `ply`"));
    assert!(fails("ply\nformat ascii 1.0\n").contains("no `end_header`"));
    assert!(fails("ply\nend_header\n").contains("line 2"));
    assert!(fails("ply\nformat utf 1.0\n").contains("`utf` is not a PLY format"));
    assert!(fails("ply\nformat ascii 1.0\nproperty int x\n").contains("line 3"));
    assert!(fails("ply\nformat ascii 1.0\nelement vertex x\n").contains("line 3"));
    assert!(
        fails("ply\nformat ascii 1.0\nelement v 1\nproperty list float int l\n").contains("line 4")
    );
    assert!(fails("ply\nformat ascii 1.0\nelement v 1\nproperty quad l\n").contains("line 4"));
    assert!(fails("ply\nformat ascii 1.0\nend_header\n").contains("no `vertex` element"));
    let flat = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n";
    assert!(fails(flat).contains("`x`, `y`, `z`"));
}
