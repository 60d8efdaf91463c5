//! `estampe inspect` end to end: the history ends with the pixel that `estampe render` writes.

#[expect(
    dead_code,
    reason = "pixels are compared, and nothing else of pictures"
)]
#[path = "support/picture.rs"]
mod picture;
#[expect(dead_code, reason = "the test knows the names of its files")]
mod support;

use picture::Picture;
use serde_json::Value;
use support::{Folder, TETRAHEDRON, estampe};

/// Rows: U1.
#[test]
fn the_history_ends_with_the_pixel_of_the_picture() {
    let folder = Folder::new();
    let model = folder.with_file("m.obj", TETRAHEDRON);
    let out = folder.path("m.png");
    let options = [
        "",
        "--samples 1",
        "--shading flat --cull back",
        "--shading toon --background none",
        "--shading normals --samples 1 --view top",
        "--shading wireframe --ortho",
        "--specular phong:0.5 --levels 3 --fog 4,ff0000",
    ];
    let (mut covered, mut records) = (0, 0);
    for options in options {
        let options = format!("--size 61x47 {options}");
        let run = estampe(&format!("render {{}} -o {{}} {options}"), &[&model, &out]);
        assert_eq!(run.code, 0, "{options}: {}", run.err);
        let picture = Picture::open(&out);
        for pixel in [[0, 0], [30, 23], [31, 20], [20, 30], [40, 35], [60, 46]] {
            let [x, y] = pixel;
            let words = format!("inspect {{}} --pixel {x},{y} --json {options}");
            let run = estampe(&words, &[&model]);
            assert_eq!(run.code, 0, "{words}: {}", run.err);
            let told: Value = serde_json::from_slice(&run.out).expect("JSON");
            let expected = serde_json::json!(picture.pixel(x, y));
            assert_eq!(told["final_rgba8"], expected, "{words}");
            let history = told["history"].as_array().expect("a list");
            covered += u32::from(!history.is_empty());
            records += history.len();
            for record in history {
                assert_eq!(record["vertices"].as_array().map(Vec::len), Some(3));
                let sum: f64 = record["barycentrics"]
                    .as_array()
                    .expect("of a triangle")
                    .iter()
                    .filter_map(Value::as_f64)
                    .sum();
                assert!((sum - 1.0).abs() < 1e-12, "{record}");
            }
        }
    }
    assert!(
        covered > 12 && records > 20,
        "{covered} pixels, {records} records"
    );
}

/// Rows: U1.
#[test]
fn the_text_names_spaces_tests_and_the_last_value() {
    let folder = Folder::new();
    let model = folder.with_file("m.obj", TETRAHEDRON);
    let words = "inspect {} --pixel 30,23 --size 61x47 --samples 1";
    let run = estampe(words, &[&model]);
    let text = String::from_utf8(run.out).expect("UTF-8");
    assert_eq!(run.code, 0, "{}", run.err);
    for part in [
        "61x47, 1 sample\n",
        "object   ",
        "world    ",
        "eye      ",
        "clip     ",
        "NDC      ",
        "window   ",
        "edge functions",
        "barycentric",
        "shader's colour",
        "passed: ",
        "final RGBA ",
    ] {
        assert!(text.contains(part), "{part:?} is not in: {text}");
    }
}

#[test]
fn pixels_outside_are_refused_with_advice() {
    let folder = Folder::new();
    let model = folder.with_file("m.obj", TETRAHEDRON);
    let run = estampe("inspect {} --pixel 61,0 --size 61x47", &[&model]);
    assert_eq!((run.code, run.out.len()), (2, 0), "{}", run.err);
    let parts = ["61,0", "61x47", "choose another --pixel"];
    assert!(
        parts.iter().all(|part| run.err.contains(part)),
        "{}",
        run.err
    );
    let run = estampe("inspect {} --pixel 1x2", &[&model]);
    assert_eq!(run.code, 2);
    assert!(run.err.contains("10,20"), "{}", run.err);
}
