//! `estampe render --cameras`: pinhole cameras of data sets.

use super::passes::{channels, floats};
use crate::support::{Folder, estampe, machines};
use exr::prelude::FlatSamples;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::Path;

/// The report of a run that succeeds.
fn report(words: &str, paths: &[&Path]) -> Value {
    let run = estampe(&format!("render {words} --json"), paths);
    assert_eq!(run.code, 0, "{}", run.err);
    serde_json::from_slice(&run.out).expect("one object")
}

/// The numbers of K, R and t.
fn numbers(pinhole: &Value) -> Vec<f64> {
    let rows = ["K", "R"].map(|key| pinhole[key].as_array().expect("rows").clone());
    let rows = rows.into_iter().flatten().chain([pinhole["t"].clone()]);
    let numbers = rows.flat_map(|row| row.as_array().expect("a row").clone());
    numbers.map(|one| one.as_f64().expect("a number")).collect()
}

fn objects(channels: &BTreeMap<String, FlatSamples>) -> &[u32] {
    match &channels["object-id.id"] {
        FlatSamples::U32(objects) => objects,
        _ => panic!("numbers of objects are integers"),
    }
}

/// The share of pixels whose value differs by more than a step of 8 bits.
fn differing(a: &[f32], b: &[f32]) -> f64 {
    assert_eq!(a.len(), b.len());
    let pairs = a.iter().zip(b);
    pairs.filter(|(a, b)| (*a - *b).abs() > 4e-3).count() as f64 / a.len() as f64
}

/// What a report says draws the same picture again, and a part of it if the principal point moves.
///
/// Rows: I3.
#[test]
fn reported_cameras_draw_the_same_picture() {
    let folder = Folder::new();
    let first = folder.path("first.exr");
    let look = "--pass color,object-id --samples 1 --up auto";
    let drawn = report(
        &format!("builtin:teapot --size 64x48 -o {{}} {look}"),
        &[&first],
    );
    let pinhole = &drawn["camera"]["pinhole"];
    let mut whole = pinhole.clone();
    whole["name"] = json!("whole");
    let mut part = pinhole.clone();
    part["name"] = json!("part");
    part["width"] = json!(30);
    part["height"] = json!(20);
    part["K"][0][2] = json!(pinhole["K"][0][2].as_f64().expect("c_x") - 20.0);
    part["K"][1][2] = json!(pinhole["K"][1][2].as_f64().expect("c_y") - 15.0);
    let file = folder.with_file("cameras.json", json!([whole, part]).to_string());
    let words = format!("builtin:teapot --size 64x48 --cameras {{}} -o {{}} {look}");
    let again = report(&words, &[&file, &folder.path("{camera}.exr")]);
    assert_eq!(again["cameras"][1]["width"], 30);
    assert_eq!(again["cameras"][0]["name"], "whole");
    let (before, after) = (numbers(pinhole), numbers(&again["cameras"][0]["pinhole"]));
    for (before, after) in before.iter().zip(&after) {
        assert!((before - after).abs() < 1e-9, "{before} {after}");
    }

    let [first, whole, part] =
        ["first", "whole", "part"].map(|name| channels(&folder.path(&format!("{name}.exr"))));
    assert!(objects(&first).iter().filter(|&&id| id == 1).count() > 900);
    let differing_ids = |a: &[u32], b: &[u32]| a.iter().zip(b).filter(|(a, b)| a != b).count();
    assert!(differing_ids(objects(&first), objects(&whole)) <= 2);
    let (red, red_again) = (floats(&first["R"]), floats(&whole["R"]));
    assert!(differing(&red, &red_again) < 0.01);
    let crop = |values: &[f32]| -> Vec<f32> {
        let rows = values.chunks(64).skip(15).take(20);
        rows.flat_map(|row| row[20..50].to_vec()).collect()
    };
    assert!(differing(&crop(&red), &floats(&part["R"])) < 0.02);
}

/// Each position is projected by K, R and t to the centre of its pixel, with focal lengths that
/// differ and a principal point that is not in the middle.
#[test]
fn pixels_are_oblong_and_principal_points_are_anywhere() {
    let folder = Folder::new();
    let (k, r) = (
        [[90.0, 0.0, 11.5], [0.0, 45.0, 30.25], [0.0, 0.0, 1.0]],
        // To the left, and the picture on its side.
        [[0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]],
    );
    let t = [1.25, 0.0, 6.0];
    let camera = json!([{ "K": k, "R": r, "t": t, "width": 50, "height": 40 }]);
    let file = folder.with_file("c.json", camera.to_string());
    let out = folder.path("c.exr");
    let words = "builtin:teapot --cameras {} -o {} --pass position,depth,object-id";
    report(words, &[&file, &out]);
    let channels = channels(&out);
    let position = ["position.X", "position.Y", "position.Z"].map(|name| floats(&channels[name]));
    let (depth, objects) = (floats(&channels["Z"]), objects(&channels));
    let (mut covered, mut beside) = (0, 0);
    for at in (0..50 * 40).filter(|&at| objects[at] != 0) {
        covered += 1;
        let p = [0, 1, 2].map(|axis| f64::from(position[axis][at]));
        let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let seen = [0, 1, 2].map(|axis| dot(r[axis], p) + t[axis]);
        assert!((seen[2] - f64::from(depth[at])).abs() < 1e-4, "{seen:?}");
        let x = dot(k[0], seen) / seen[2] - (at % 50) as f64;
        let y = dot(k[1], seen) / seen[2] - (at / 50) as f64;
        let off = (x - 0.5).abs().max((y - 0.5).abs());
        // The centre may be outside of a narrow triangle by a rounding of the pipeline, and the
        // point inside is further away the narrower it is.
        assert!(off < 0.1, "{at}: {x} {y}");
        beside += usize::from(off > 0.001);
    }
    assert!(covered > 500, "{covered}");
    assert!(beside * 100 <= covered, "{beside} of {covered}");
}

#[test]
fn cameras_do_not_depend_on_threads_or_simd_level() {
    let folder = Folder::new();
    let camera = json!([{
        "K": [[60.0, 0.0, 20.0], [0.0, 55.0, 10.0], [0.0, 0.0, 1.0]],
        "R": [[1, 0, 0], [0, -1, 0], [0, 0, -1]],
        "t": [0, 1, 9],
    }]);
    let file = folder.with_file("c.json", camera.to_string());
    let mut first = None;
    for how in machines() {
        let out = folder.path("{camera}.png");
        let words = format!("builtin:teapot --size 40x30 --cameras {{}} -o {{}} --shadow {how}");
        report(&words, &[&file, &out]);
        let bytes = std::fs::read(folder.path("0000.png")).expect("written");
        let expected = first.get_or_insert_with(|| bytes.clone());
        assert!(*expected == bytes, "{how}");
    }
}

#[test]
fn cameras_that_cannot_be_drawn_are_errors() {
    let folder = Folder::new();
    let camera = json!({
        "K": [[60, 0, 20], [0, 55, 10], [0, 0, 1]],
        "R": [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
        "t": [0, 1, 9],
    });
    let mut mirrored = camera.clone();
    mirrored["R"][1][1] = json!(-1);
    let two = folder.with_file("two.json", json!([camera, camera]).to_string());
    let mirrored = folder.with_file("m.json", json!([camera, mirrored]).to_string());
    let broken = folder.with_file("b.json", "[{");
    let missing = folder.path("none.json");
    let names = folder.names();
    for (file, out, options, problem) in [
        (&two, "a.png", "", "add {camera} to OUT"),
        (&two, "no/{camera}.png", "", "does not exist"),
        (&two, "{camera}.png", "--view top", "cannot be used with"),
        (&two, "{camera}.png", "--pass depth", "written as OpenEXR"),
        (&two, "{camera}.gif", "", ".gif is no format of pictures"),
        (
            &mirrored,
            "{camera}.png",
            "",
            "m.json: $[1].R: this is a reflection, of determinant -1.000",
        ),
        (&broken, "{camera}.png", "", "this is no JSON"),
        (&missing, "{camera}.png", "", "no such file"),
    ] {
        let words = format!("render builtin:cube --size 8x8 --cameras {{}} -o {{}} {options}");
        let run = estampe(&words, &[file, &folder.path(out)]);
        assert_ne!(run.code, 0, "{out} {options}");
        assert!(run.err.contains(problem), "{out} {options}: {}", run.err);
    }
    assert_eq!(folder.names(), names);
}

#[test]
fn schemas_are_printed() {
    for (words, title) in [
        ("schema", "Job file of estampe batch"),
        ("schema jobs", "Job file of estampe batch"),
        ("schema cameras", "Cameras of estampe render --cameras"),
    ] {
        let run = estampe(words, &[]);
        assert_eq!(run.code, 0, "{}", run.err);
        let schema: Value = serde_json::from_slice(&run.out).expect("JSON");
        assert_eq!(schema["title"], title);
    }
}
