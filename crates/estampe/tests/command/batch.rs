//! `estampe batch`: many models, one process.

use crate::support::{Folder, Run, TETRAHEDRON, estampe, estampe_fed};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

/// A folder with three models in two folders; one has a material with a texture.
pub(super) fn models() -> Folder {
    let folder = Folder::new();
    for below in ["in/a", "in/b"] {
        fs::create_dir_all(folder.path(below)).expect("writable");
    }
    folder.with_file("in/a/one.obj", TETRAHEDRON);
    folder.with_file("in/b/two.obj", TETRAHEDRON.replace("v 0 0 1", "v 0 0 2"));
    let textured = format!("mtllib skin.mtl\nusemtl skin\n{TETRAHEDRON}");
    folder.with_file("in/b/three.obj", textured);
    folder.with_file("in/b/skin.mtl", "newmtl skin\nKd 1 0 0\n");
    folder
}

/// Runs `estampe batch` on the folder's models, with IN and OUT for their folders.
pub(super) fn batch(folder: &Folder, words: &str) -> Run {
    batch_fed(folder, words, &[])
}

fn batch_fed(folder: &Folder, words: &str, input: &[u8]) -> Run {
    let (models, out) = (folder.path("in"), folder.path("out"));
    let text = |path: &Path| {
        path.to_str()
            .expect("a temporary folder of ASCII")
            .to_owned()
    };
    let words = words
        .replace("IN", &text(&models))
        .replace("OUT", &text(&out));
    estampe_fed(
        &format!("batch {words} --size 48x40 --report -"),
        &[],
        input,
    )
}

pub(super) fn report(run: &Run) -> Value {
    serde_json::from_slice(&run.out).expect("a report")
}

/// The names below a folder, sorted, without the records.
pub(super) fn pictures(folder: &Folder, below: &str) -> Vec<String> {
    fn walk(at: &Path, prefix: &str, names: &mut Vec<String>) {
        for entry in fs::read_dir(at).expect("a folder").flatten() {
            let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
            if entry.path().is_dir() {
                if !name.ends_with(".estampe") {
                    walk(&entry.path(), &format!("{name}/"), names);
                }
            } else {
                names.push(name);
            }
        }
    }
    let mut names = Vec::new();
    walk(&folder.path(below), "", &mut names);
    names.sort();
    names
}

#[test]
fn a_model_that_fails_ends_alone() {
    let folder = models();
    folder.with_file("in/a/bad.obj", "f 1 2 3\n");
    folder.with_file("in/a/worse.stl", [0_u8; 90]);
    let words = "IN/**/*.obj IN/a/worse.stl IN/a/missing.obj -o OUT/{stem}.png --parallel 1";
    let run = batch(&folder, words);
    assert_eq!(run.code, 1, "{}", run.err);
    let said = report(&run);
    assert_eq!(said["counts"]["drawn"], 3, "{said}");
    assert_eq!(said["counts"]["failed"], 3, "{said}");
    let of = |stem: &str| {
        let pictures = said["pictures"].as_array().expect("a list").clone();
        let is_it = |picture: &Value| {
            let input = picture["input"].as_str().expect("a path");
            Path::new(input)
                .file_stem()
                .is_some_and(|name| name == stem)
        };
        pictures.into_iter().find(is_it).expect("in the report")
    };
    assert_eq!(of("bad")["status"], "failed");
    assert!(
        of("missing")["error"]
            .as_str()
            .expect("text")
            .contains("no such file")
    );
    assert!(run.err.contains("error: ") && run.err.contains("3 drawn, 3 failed in "));
    assert!(!folder.path("out/bad.png").exists());
    // In sorted order the first one fails.
    let fast = batch(&folder, &format!("{words} --fail-fast --force"));
    assert_eq!(fast.code, 1);
    assert_eq!(report(&fast)["counts"]["cancelled"], 5, "{}", fast.err);
}

#[test]
fn names_that_would_collide_or_say_nothing_are_errors_before_any_work() {
    let folder = models();
    folder.with_file("in/a/two.obj", TETRAHEDRON);
    for (words, problem) in [
        ("IN/**/*.obj -o OUT/{stem}.png", "the picture of"),
        ("IN/**/*.obj -o OUT/{frame}.png", "{frame} is unknown"),
        (
            "IN/**/*.obj -o OUT/{index}",
            "does not show the image's format",
        ),
        (
            "IN/**/*.obj -o OUT/{index}.png --views front,top",
            "add {view}",
        ),
        (
            "IN/**/*.obj -o OUT/{index}.png --shard 0/3",
            "I from 1 to N",
        ),
        (
            "IN/**/*.obj -o OUT/{index}.png --shard 4/3",
            "I from 1 to N",
        ),
    ] {
        let run = batch(&folder, words);
        assert_eq!(run.code, 2, "{words}: {}", run.err);
        assert!(run.err.contains(problem), "{words}: {}", run.err);
    }
    let nothing = batch(&folder, "IN/*.glb -o OUT/{stem}.png");
    assert_eq!(nothing.code, 1);
    assert!(nothing.err.contains("no file matches"), "{}", nothing.err);
    assert!(!folder.path("out").exists());
}

/// Each model is in exactly one share.
#[test]
fn shards_share_the_models() {
    let folder = models();
    let mut drawn = Vec::new();
    for number in 1..=3 {
        let words = format!("IN/**/*.obj -o OUT/{{stem}}.png --shard {number}/3");
        let said = report(&batch(&folder, &words));
        let pictures = said["pictures"].as_array().expect("a list");
        assert_eq!(pictures.len(), 1, "{said}");
        drawn.push(pictures[0]["output"].as_str().expect("a path").to_owned());
    }
    drawn.sort();
    drawn.dedup();
    assert_eq!(drawn.len(), 3);
    assert_eq!(
        pictures(&folder, "out"),
        ["one.png", "three.png", "two.png"]
    );
}

#[test]
fn lists_come_on_standard_input_and_models_have_several_views() {
    let folder = models();
    let model = folder.path("in/a/one.obj");
    let list = format!(
        "{}\r\n\n{}\n",
        model.display(),
        folder.path("in/b/two.obj").display()
    );
    let words = "- -o OUT/{stem}-{view}.jpg --views front,iso --quiet";
    let run = batch_fed(&folder, words, list.as_bytes());
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    let names = [
        "one-front.jpg",
        "one-iso.jpg",
        "two-front.jpg",
        "two-iso.jpg",
    ];
    assert_eq!(pictures(&folder, "out"), names);
    let alone = folder.path("alone.jpg");
    let render = estampe("render {} -o {} --size 48x40 --view iso", &[&model, &alone]);
    assert_eq!(render.code, 0, "{}", render.err);
    assert!(fs::read(alone).ok() == fs::read(folder.path("out/one-iso.jpg")).ok());
}

#[test]
fn models_over_a_limit_end_alone() {
    let folder = models();
    let bytes = format!("--max-bytes {}", TETRAHEDRON.len());
    for (limit, count) in [
        ("--max-triangles 3", 3),
        (&bytes, 1),
        ("--max-bytes 1", 3),
        ("--max-memory 2000", 3),
        ("--max-memory 80000", 0),
        ("--timeout 60", 0),
        ("--timeout 0.000001", 3),
    ] {
        let run = batch(
            &folder,
            &format!("IN/**/*.obj -o OUT/{{stem}}.png --force {limit}"),
        );
        assert_eq!(run.code, i32::from(count > 0), "{limit}: {}", run.err);
        let said = report(&run);
        assert_eq!(said["counts"]["limit"], count, "{limit}: {said}");
        assert_eq!(said["counts"]["drawn"], 3 - count, "{limit}: {said}");
        assert_eq!(
            run.err.contains("limit of"),
            count > 0,
            "{limit}: {}",
            run.err
        );
        let model = folder.path("in/a/one.obj");
        let words = format!("render {{}} -o {{}} --size 48x40 {limit}");
        let alone = estampe(&words, &[&model, &folder.path("alone.png")]);
        assert_eq!(alone.code, i32::from(count == 3), "{limit}: {}", alone.err);
    }
}

#[test]
fn a_picture_that_would_replace_another_model_is_an_error() {
    let folder = models();
    // Its content shows the format.
    folder.with_file("in/x.png", "ply\nformat ascii 1.0\nend_header\n");
    let run = batch(&folder, "IN/a/one.obj IN/x.png -o IN/x.png");
    assert_eq!(run.code, 2, "{}", run.err);
    assert!(run.err.contains("would replace a model"), "{}", run.err);
}

/// Files of passes are those of `render`, and one that is missing is drawn again.
#[test]
fn passes_are_files_or_one_openexr() {
    let folder = models();
    let passes = "--pass color,depth,object-id --depth-unit 0.01";
    let words =
        format!("IN/*/*.obj -o OUT/{{stem}}/{{pass}}/{{view}}.png {passes} --views front,top");
    let run = batch(&folder, &words);
    assert_eq!(run.code, 0, "{}", run.err);
    let said = report(&run);
    assert_eq!(said["counts"]["drawn"], 18, "{said}");
    assert_eq!(said["pictures"][1]["passes"], json!(["depth"]));
    let model = folder.path("in/a/one.obj");
    let alone = format!("render {{}} -o {{}} {passes} --size 48x40 --view top");
    let run = estampe(&alone, &[&model, &folder.path("{pass}.png")]);
    assert_eq!(run.code, 0, "{}", run.err);
    for pass in ["color", "depth", "object-id"] {
        let file = fs::read(folder.path(&format!("out/one/{pass}/top.png"))).expect("drawn");
        let alone = fs::read(folder.path(&format!("{pass}.png")));
        assert!(alone.is_ok_and(|alone| alone == file), "{pass}");
    }
    fs::remove_file(folder.path("out/one/depth/top.png")).expect("there");
    let said = report(&batch(&folder, &words));
    assert_eq!(said["counts"]["drawn"], 1, "{said}");
    assert_eq!(said["counts"]["up_to_date"], 17, "{said}");

    let run = batch(&folder, &format!("IN/a/*.obj -o OUT/{{stem}}.exr {passes}"));
    assert_eq!(run.code, 0, "{}", run.err);
    let exr = folder.path("one.exr");
    let words = format!("render {{}} -o {{}} {passes} --size 48x40");
    assert_eq!(estampe(&words, &[&model, &exr]).code, 0);
    assert!(fs::read(exr).ok() == fs::read(folder.path("out/one.exr")).ok());
    for (words, problem) in [
        (
            "IN/a/*.obj -o OUT/{stem}.png --pass depth",
            "written as OpenEXR",
        ),
        ("IN/a/*.obj -o OUT/{stem}-{pass}.png", "add --pass"),
        ("IN/*/*.obj -o OUT/{pass}.png --pass depth", "add {dir}"),
    ] {
        let run = batch(&folder, words);
        assert_eq!(run.code, 2, "{words}: {}", run.err);
        assert!(run.err.contains(problem), "{words}: {}", run.err);
    }
}
