//! OBJ: the effect of every statement of geometry, and tolerated errors.

use estampe_assets::model::{NoResources, Resources};
use estampe_assets::{Limits, Loaded, Location, ModelFormat, parse_model};
use estampe_scene::Mesh;
use glam::{Vec2, Vec3};

pub(super) fn read(text: &str) -> Loaded {
    read_with(text, &NoResources)
}

pub(super) fn read_with(text: &str, resources: &dyn Resources) -> Loaded {
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
pub(super) fn mesh(text: &str) -> Mesh {
    let loaded = read(text);
    assert_eq!(loaded.warnings, [], "{text}");
    assert_eq!(loaded.scene.meshes.len(), 1);
    loaded.scene.meshes.into_iter().next().unwrap()
}

pub(super) fn messages(loaded: &Loaded) -> Vec<String> {
    loaded.warnings.iter().map(ToString::to_string).collect()
}

pub(super) const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

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
