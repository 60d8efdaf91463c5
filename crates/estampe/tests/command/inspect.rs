//! `estampe inspect` end to end: the history ends with the pixel that `estampe render` writes, and
//! every stage has a picture and totals.

use crate::support::picture::Picture;
use crate::support::{Folder, TETRAHEDRON, estampe};
use serde_json::Value;

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
    let run = estampe("inspect {}", &[&model]);
    assert!(run.code == 2 && run.err.contains("--pixel"), "{}", run.err);
    let run = estampe("inspect {} --pixel 1x2", &[&model]);
    assert_eq!(run.code, 2);
    assert!(run.err.contains("10,20"), "{}", run.err);
}

const STAGES: [&str; 7] = [
    "vertex", "clip", "bin", "raster", "fragment", "depth", "blend",
];

/// Rows: U2.
#[test]
fn stages_are_the_same_at_every_number_of_threads_and_their_totals_agree() {
    let folder = Folder::new();
    let model = folder.with_file("m.obj", TETRAHEDRON);
    let mut expected: Option<(Vec<Vec<u8>>, Value)> = None;
    for threads in [1, 2, 5] {
        let out = folder.path("");
        let options = format!("--size 61x147 --threads {threads} --eye 0.9,0.3,0.5");
        let words = format!("inspect {{}} --stage all -o {{}} {options} --json");
        let run = estampe(&words, &[&model, &out]);
        assert_eq!(run.code, 0, "{}", run.err);
        let mut told: Value = serde_json::from_slice(&run.out).expect("JSON");
        let names = told["stages"].as_array().expect("a list").iter();
        let names: Vec<_> = names.filter_map(|stage| stage["stage"].as_str()).collect();
        assert_eq!(names, STAGES);
        let pictures = STAGES.map(|stage| {
            let picture = folder.path(&format!("{stage}.png"));
            std::fs::read(picture).expect("it was written")
        });
        for stage in told["stages"].as_array_mut().expect("a list") {
            stage["output"]["path"].take();
        }
        match &expected {
            None => expected = Some((pictures.into(), told)),
            Some(expected) => assert_eq!(*expected, (pictures.into(), told)),
        }
    }
    let (_, told) = expected.expect("drawn");
    let total = |stage: usize, name: &str| told["stages"][stage]["totals"][name].as_u64();
    assert_eq!(total(0, "primitives"), Some(4));
    let clip = ["inside", "clipped", "dropped"].map(|name| total(1, name).expect("a number"));
    assert_eq!(clip.iter().sum::<u64>(), 4, "{clip:?}");
    assert_eq!(total(2, "tile_side"), Some(64), "of 4 samples");
    assert_eq!(
        total(3, "covered"),
        total(4, "runs"),
        "one run for each pixel"
    );
    assert_eq!(total(3, "visible_pixels"), total(6, "pixels"));
    assert!(total(4, "runs") > total(4, "pixels"), "{told}");
    let ranges = &told["stages"][0]["totals"]["ranges"];
    assert_eq!(
        ranges["object"],
        serde_json::json!([[0.0, 1.0], [0.0, 1.0], [0.0, 1.0]])
    );
}

/// Rows: U2.
#[test]
fn a_stage_is_a_picture_and_a_line_of_totals() {
    let folder = Folder::new();
    let model = folder.with_file("m.obj", TETRAHEDRON);
    for stage in STAGES {
        let out = folder.path("stage.png");
        let words = format!("inspect {{}} --stage {stage} -o {{}} --size 64x48 --samples 1");
        let run = estampe(&words, &[&model, &out]);
        let text = String::from_utf8(run.out).expect("UTF-8");
        assert_eq!((run.code, text.lines().count()), (0, 1), "{}", run.err);
        assert!(text.starts_with(&format!("{stage}: ")), "{text}");
        let picture = Picture::open(&out);
        assert!(picture.width >= 200 && picture.height >= 150, "{stage}");

        let words = format!("inspect {{}} --stage {stage} -o - --size 64x48 --samples 1");
        let piped = estampe(&words, &[&model]);
        assert_eq!(piped.err, text);
        assert_eq!(Some(piped.out), std::fs::read(&out).ok());
    }
}

#[test]
fn stages_without_a_place_are_refused_with_advice() {
    let folder = Folder::new();
    let model = folder.with_file("m.obj", TETRAHEDRON);
    let missing = folder.path("missing");
    for (words, code, advice) in [
        ("inspect {} --stage bin", 2, "--output"),
        ("inspect {} --pixel 1,1 -o {}", 2, "--pixel"),
        ("inspect {} -o {}", 2, "--stage"),
        ("inspect {} --pixel 1,1 --stage bin -o {}", 2, "--pixel"),
        ("inspect {} --stage tile -o {}", 2, "fragment"),
        ("inspect {} --stage all -o -", 2, "name a folder"),
        ("inspect {} --stage all -o {}", 3, "create it first"),
        ("inspect {} --stage bin -o {}", 2, ".png"),
    ] {
        let run = estampe(words, &[&model, &missing]);
        assert_eq!((run.code, run.out.len()), (code, 0), "{words}: {}", run.err);
        assert!(run.err.contains(advice), "{words}: {}", run.err);
    }
}
