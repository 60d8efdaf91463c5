//! `estampe batch --cameras`: many models from the cameras of a file.

use crate::support::{Folder, Run, TETRAHEDRON, estampe};
use serde_json::{Value, json};
use std::fs;

/// A camera at this place that looks along −z.
fn camera(name: &str, x: f64) -> Value {
    json!({
        "name": name, "width": 24, "height": 20,
        "K": [[30, 0, 12], [0, 30, 10], [0, 0, 1]],
        "R": [[1, 0, 0], [0, -1, 0], [0, 0, -1]],
        "t": [-x, 0.5, 3],
    })
}

fn folder() -> Folder {
    let folder = Folder::new();
    folder.with_file("in/one.obj", TETRAHEDRON);
    folder.with_file("in/two.obj", TETRAHEDRON.replace("v 0 0 1", "v 0 0 2"));
    let cameras = json!([camera("left", -0.2), camera("right", 0.9)]);
    folder.with_file("cams.json", cameras.to_string());
    folder
}

/// Runs `estampe` with these words, where `@` stands for the folder.
fn run(folder: &Folder, words: &str) -> Run {
    let root = folder.path("");
    let root = root
        .to_str()
        .expect("UTF-8")
        .trim_end_matches('/')
        .to_owned();
    estampe(&words.replace('@', &root), &[])
}

/// The report of a batch that succeeds, and its numbers of drawn and of current pictures.
fn batch(folder: &Folder, words: &str) -> (Value, [u64; 2]) {
    let run = run(folder, &format!("batch {words} --report -"));
    assert_eq!(run.code, 0, "{}", run.err);
    let report: Value = serde_json::from_slice(&run.out).expect("a report");
    let count = |key: &str| report["counts"][key].as_u64().expect("a number");
    let counts = [count("drawn"), count("up_to_date")];
    (report, counts)
}

#[test]
fn each_model_is_drawn_by_each_camera() {
    let folder = folder();
    let words = "@/in/*.obj -o @/out/{stem}/{camera}.png --cameras @/cams.json";
    let (report, counts) = batch(&folder, words);
    assert_eq!(counts, [4, 0]);
    let cameras: Vec<&Value> = { report["pictures"].as_array().expect("rows").iter() }
        .map(|row| &row["camera"])
        .collect();
    assert_eq!(cameras, ["left", "right", "left", "right"]);
    assert_eq!(report["pictures"][0]["view"], Value::Null);
    // The bytes are those of `estampe render`.
    let alone = "render @/in/two.obj -q -o @/alone-{camera}.png --cameras @/cams.json";
    assert_eq!(run(&folder, alone).code, 0);
    for name in ["left", "right"] {
        let of = |path: String| fs::read(folder.path(&path)).expect("drawn");
        assert!(
            of(format!("out/two/{name}.png")) == of(format!("alone-{name}.png")),
            "{name}"
        );
    }
    assert_eq!(batch(&folder, words).1, [0, 4]);
    // A camera that changes, and one that is new, in another order.
    let cameras = json!([
        camera("right", 0.8),
        camera("new", 0.1),
        camera("left", -0.2)
    ]);
    folder.with_file("cams.json", cameras.to_string());
    assert_eq!(batch(&folder, words).1, [4, 2]);
    // The size of cameras without one is that of the options.
    let mut sized = camera("left", -0.2);
    let table = sized.as_object_mut().expect("a table");
    table.retain(|key, _| key != "width" && key != "height");
    folder.with_file("cams.json", json!([sized]).to_string());
    let one = format!("{words} --size 24x20");
    assert_eq!(batch(&folder, &one).1, [2, 0], "other options");
    assert_eq!(batch(&folder, &one).1, [0, 2]);
    assert_eq!(batch(&folder, &format!("{words} --size 30x20")).1, [2, 0]);
}

#[test]
fn passes_have_cameras_too() {
    let folder = folder();
    let words = "@/in/*.obj -o @/out/{camera}/{stem}-{pass}.png --cameras @/cams.json \
                 --pass color,depth --depth-unit 0.01";
    assert_eq!(batch(&folder, words).1, [8, 0]);
    let alone = "render @/in/one.obj -q -o @/a/{camera}-{pass}.png --cameras @/cams.json \
                 --pass color,depth --depth-unit 0.01";
    fs::create_dir_all(folder.path("a")).expect("writable");
    let run = run(&folder, alone);
    assert_eq!(run.code, 0, "{}", run.err);
    for (camera, pass) in [("left", "color"), ("left", "depth"), ("right", "depth")] {
        let of = |path: String| fs::read(folder.path(&path)).expect("drawn");
        let (own, right) = (
            of(format!("out/{camera}/one-{pass}.png")),
            of(format!("a/{camera}-{pass}.png")),
        );
        assert!(own == right, "{camera} {pass}");
    }
    fs::remove_file(folder.path("out/right/two-depth.png")).expect("drawn");
    assert_eq!(batch(&folder, words).1, [1, 7]);
    let exr = "@/in/*.obj -o @/{stem}-{camera}.exr --cameras @/cams.json --pass color,depth";
    assert_eq!(batch(&folder, exr).1, [4, 0]);
}

#[test]
fn job_files_have_cameras() {
    let folder = folder();
    let jobs = r#"
        [options]
        size = "24x20"
        view = "iso"
        [[jobs]]
        input = "@/in/one.obj"
        output = "@/out/{camera}.png"
        options = { cameras = "@/cams.json" }
        [[jobs]]
        input = "@/in/two.obj"
        output = "@/out/{stem}-{view}.png"
    "#;
    let root = folder.path("");
    let root = root
        .to_str()
        .expect("UTF-8")
        .trim_end_matches('/')
        .to_owned();
    folder.with_file("jobs.toml", jobs.replace('@', &root));
    let (report, counts) = batch(&folder, "--job-file @/jobs.toml");
    assert_eq!(counts, [3, 0]);
    assert_eq!(report["pictures"][1]["camera"], "right");
    assert_eq!(report["pictures"][2]["view"], "iso");
    assert_eq!(batch(&folder, "--job-file @/jobs.toml").1, [0, 3]);
    let both = run(
        &folder,
        "batch --job-file @/jobs.toml --cameras @/cams.json",
    );
    assert_eq!(both.code, 2);
    assert!(
        both.err.contains("beside --job-file have no effect"),
        "{}",
        both.err
    );
    let untold = jobs.replace("{camera}", "one").replace('@', &root);
    folder.with_file("jobs.toml", untold);
    let run = run(&folder, "batch --job-file @/jobs.toml");
    assert_eq!(run.code, 2);
    assert!(
        run.err.contains("add {camera} to the template"),
        "{}",
        run.err
    );
}

#[test]
fn cameras_and_templates_fit() {
    let folder = folder();
    folder.with_file("broken.json", "[{}]");
    for (words, problem) in [
        (
            "-o @/{stem}.png --cameras @/cams.json",
            "add {camera} to the template",
        ),
        (
            "-o @/{camera}.png --cameras @/cams.json",
            "or {camera} to the template",
        ),
        ("-o @/{stem}-{camera}.png", "there are no cameras"),
        (
            "-o @/{stem}-{camera}.png --cameras @/broken.json",
            "$[0]: `K` is missing",
        ),
        (
            "-o @/{stem}-{camera}.png --cameras @/none.json",
            "none.json",
        ),
        (
            "-o @/{stem}-{camera}-{view}.png --cameras @/cams.json --views front,top",
            "cannot be used with",
        ),
        (
            "-o @/{stem}-{camera}.png --cameras @/cams.json --ortho",
            "cannot be used with",
        ),
    ] {
        let run = run(&folder, &format!("batch @/in/*.obj {words}"));
        assert_ne!(run.code, 0, "{words}");
        assert!(run.err.contains(problem), "{words}: {}", run.err);
    }
    // The size of the greatest camera counts.
    let mut large = camera("large", 0.0);
    large["width"] = json!(2000);
    large["height"] = json!(1000);
    folder.with_file(
        "cams.json",
        json!([camera("small", 0.0), large]).to_string(),
    );
    let words =
        "batch @/in/*.obj -o @/{stem}-{camera}.png --cameras @/cams.json --max-memory 2000000";
    let run = run(&folder, words);
    assert_eq!(run.code, 1);
    assert!(run.err.contains("--max-memory"), "{}", run.err);
}
