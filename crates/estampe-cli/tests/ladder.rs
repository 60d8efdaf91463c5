//! `estampe ladder` end to end: the pictures' files, and the errors.

#[path = "support/picture.rs"]
#[allow(dead_code, reason = "other tests use the rest")]
mod picture;
mod support;

use picture::Picture;
use support::{Folder, TETRAHEDRON, estampe};

#[test]
fn a_rung_is_a_picture_in_a_folder_that_is_made() {
    let folder = Folder::new();
    let out = folder.path("new");
    let run = estampe("ladder 1 -o {}", &[&out]);
    assert_eq!((run.code, run.out.len(), run.err.as_str()), (0, 0, ""));
    let picture = Picture::open(&out.join("ladder_01_pixel.png"));
    assert_eq!((picture.width, picture.height), (100, 100));
    assert_eq!(picture.pixel(52, 41), [255, 0, 0, 255]);
    assert_eq!(picture.extent(), [52, 41, 53, 42], "one pixel is red");
}

#[test]
fn a_model_replaces_the_built_in_one() {
    let folder = Folder::new();
    let model = folder.with_file("m.obj", TETRAHEDRON);
    let run = estampe("ladder 5 --model {} -o {}", &[&model, &folder.path("out")]);
    assert_eq!(run.code, 0, "{}", run.err);
    let picture = Picture::open(&folder.path("out").join("ladder_05_random_colors.png"));
    let [left, top, right, bottom] = picture.extent();
    let colors = picture.color_count();
    assert_eq!((left, bottom), (400, 400), "the corner at the origin");
    assert!(right >= 799 && top <= 1 && (2..=5).contains(&colors));
}

#[test]
fn the_rung_of_glsl_waits() {
    let folder = Folder::new();
    let run = estampe("ladder 22 -o {}", &[&folder.path("out")]);
    assert_eq!(run.code, 2);
    assert!(run.err.contains("GLSL"), "{}", run.err);
    assert!(folder.names().is_empty(), "no folder is made");
}

#[test]
fn wrong_rungs_models_and_folders_are_errors() {
    let folder = Folder::new();
    let out = folder.path("out");
    let file = folder.with_file("file", "");
    let missing = folder.path("missing.obj");
    let points = folder.with_file("points.obj", "v 0 0 0\np 1\n");
    for (words, paths, code, said) in [
        ("ladder 0 -o {}", vec![&out], 2, "1 to 23"),
        ("ladder 24 -o {}", vec![&out], 2, "1 to 23"),
        ("ladder lines -o {}", vec![&out], 2, "1 to 23"),
        ("ladder 1", vec![], 2, "--output"),
        ("ladder 1 --model - -o {}", vec![&out], 2, "standard input"),
        (
            "ladder 1 --model {} -o {}",
            vec![&missing, &out],
            1,
            "no such file",
        ),
        (
            "ladder 1 --model {} -o {}",
            vec![&points, &out],
            1,
            "no triangles",
        ),
        ("ladder 1 -o {}", vec![&file], 3, "folder"),
    ] {
        let paths: Vec<_> = paths.into_iter().map(std::path::PathBuf::as_path).collect();
        let run = estampe(words, &paths);
        assert_eq!(run.code, code, "{words}: {}", run.err);
        assert!(run.err.contains(said), "{words}: {}", run.err);
    }
}
