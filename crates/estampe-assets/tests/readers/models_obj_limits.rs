//! OBJ: limits, files that are hostile or not OBJ, and large files, which several threads read
//! ahead.

use super::models_obj::{SQUARE, mesh, read};
use estampe_assets::model::NoResources;
use estampe_assets::{AssetError, Limits, ModelFormat, parse_model};
use estampe_scene::Mesh;

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
