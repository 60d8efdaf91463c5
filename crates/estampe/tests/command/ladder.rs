//! `estampe ladder` end to end: the pictures' files, and the errors.

use crate::support::picture::Picture;
use crate::support::{Folder, TETRAHEDRON, estampe};
use estampe::Level;

/// Rows: L1.
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

/// Rows: L1.
#[test]
fn all_rungs_and_a_sheet() {
    let folder = Folder::new();
    let out = folder.path("out");
    let run = estampe("ladder all -o {}", &[&out]);
    assert_eq!((run.code, run.out.len(), run.err.as_str()), (0, 0, ""));
    assert_eq!(folder.names(), ["out"], "nothing is written beside it");
    let names = std::fs::read_dir(&out).expect("the folder is made");
    let names = names.map(|entry| entry.expect("readable").file_name());
    let mut names: Vec<_> = names
        .map(|name| name.into_string().expect("plain"))
        .collect();
    names.sort();
    assert_eq!(names.len(), 24);
    for (number, name) in (1..=23).zip(&names) {
        assert!(name.starts_with(&format!("ladder_{number:02}_")), "{name}");
    }
    assert_eq!(names[23], "sheet.png");
    let sheet = Picture::open(&out.join("sheet.png"));
    assert_eq!((sheet.width, sheet.height), (6 * 208 - 8, 4 * 208 - 8));
}

#[test]
fn a_texture_replaces_the_built_in_one() {
    let folder = Folder::new();
    let red = folder.path("red.png");
    let cube = "render builtin:plane -o {} -q --view front --background ff0000 --size 2x2";
    assert_eq!(estampe(cube, &[&red]).code, 0);
    let out = folder.path("out");
    let run = estampe("ladder 8 --texture {} -o {}", &[&red, &out]);
    assert_eq!(run.code, 0, "{}", run.err);
    let picture = Picture::open(&out.join("ladder_08_diffuse_texture.png"));
    assert_eq!(picture.pixel(0, 0), [255, 0, 0, 255], "the texture itself");
    let [r, g, b, _] = picture.pixel(808 + 400, 400);
    assert!(r > 200 && g == 0 && b == 0, "the model");
}

/// A rung that sets pixels itself, one that the pipeline draws, one with several passes,
/// one whose shaders are text.
///
/// Rows: L1, U3.
#[test]
fn the_bytes_depend_on_neither_threads_nor_simd() {
    let levels = Level::all_available();
    assert!(levels.len() >= 2, "two levels are compared");
    for (rung, name) in [
        (7, "ladder_07_z_buffer.png"),
        (13, "ladder_13_four_shaders.png"),
        (21, "ladder_21_stencil_logic.png"),
        (22, "ladder_22_glsl.png"),
    ] {
        let folder = Folder::new();
        let mut files = Vec::new();
        for level in [levels[0], levels[levels.len() - 1]] {
            for threads in [1, 2, 7] {
                let simd = level.name();
                let out = folder.path(&format!("{simd}_{threads}"));
                let words = format!("ladder {rung} -o {{}} -q --threads {threads} --simd {simd}");
                let run = estampe(&words, &[&out]);
                assert_eq!(run.code, 0, "{words}: {}", run.err);
                files.push((words, std::fs::read(out.join(name)).expect("written")));
            }
        }
        for (words, file) in &files {
            assert!(*file == files[0].1, "{words} writes other bytes");
        }
    }
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
        (
            "ladder 1 --texture {} -o {}",
            vec![&missing, &out],
            1,
            "no such file",
        ),
        (
            "ladder 1 --texture {} -o {}",
            vec![&points, &out],
            1,
            "points.obj",
        ),
        ("ladder 1 -o {}", vec![&file], 3, "folder"),
    ] {
        let paths: Vec<_> = paths.into_iter().map(std::path::PathBuf::as_path).collect();
        let run = estampe(words, &paths);
        assert_eq!(run.code, code, "{words}: {}", run.err);
        assert!(run.err.contains(said), "{words}: {}", run.err);
    }
}
