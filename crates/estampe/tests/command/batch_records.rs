//! `estampe batch` draws a picture again only if something that its record names has changed.

use super::batch::{batch, models, pictures, report};
use crate::support::{Run, TETRAHEDRON, estampe};
use std::fs;

/// The pictures are those of `estampe render`; what is up to date stays, and what has changed is
/// drawn again.
#[test]
fn pictures_are_drawn_once_and_again_if_something_changed() {
    let folder = models();
    let words = "IN/**/*.obj -o OUT/{dir}/{stem}.png";
    let counts = |run: &Run, drawn: u64, up_to_date: u64| {
        assert_eq!(run.code, 0, "{}", run.err);
        let report = report(run);
        assert_eq!(report["counts"]["drawn"], drawn, "{report}");
        assert_eq!(report["counts"]["up_to_date"], up_to_date, "{report}");
    };
    counts(&batch(&folder, words), 3, 0);
    assert_eq!(
        pictures(&folder, "out"),
        ["a/one.png", "b/three.png", "b/two.png"]
    );
    for (model, picture) in [
        ("in/b/three.obj", "out/b/three.png"),
        ("in/a/one.obj", "out/a/one.png"),
    ] {
        let alone = folder.path("alone.png");
        let run = estampe(
            "render {} -o {} --size 48x40",
            &[&folder.path(model), &alone],
        );
        assert_eq!(run.code, 0, "{}", run.err);
        assert!(
            fs::read(alone).ok() == fs::read(folder.path(picture)).ok(),
            "{picture}"
        );
    }
    counts(&batch(&folder, words), 0, 3);
    // Threads and the SIMD level change no byte.
    counts(
        &batch(
            &folder,
            &format!("{words} --threads 2 --simd sse2 --parallel 1"),
        ),
        0,
        3,
    );
    // A file that a model names.
    let red = fs::read(folder.path("out/b/three.png")).expect("drawn");
    folder.with_file("in/b/skin.mtl", "newmtl skin\nKd 0 1 0\n");
    counts(&batch(&folder, words), 1, 2);
    assert!(fs::read(folder.path("out/b/three.png")).expect("drawn") != red);
    // The model.
    folder.with_file("in/a/one.obj", TETRAHEDRON.replace("v 1 0 0", "v 3 0 0"));
    counts(&batch(&folder, words), 1, 2);
    // The picture, and its absence.
    folder.with_file("out/a/one.png", "not a picture");
    fs::remove_file(folder.path("out/b/two.png")).expect("drawn");
    counts(&batch(&folder, words), 2, 1);
    // An option, and all.
    counts(&batch(&folder, &format!("{words} --shading flat")), 3, 0);
    counts(
        &batch(&folder, &format!("{words} --shading flat --force")),
        3,
        0,
    );
    // A record that was cut off.
    folder.with_file("out/a/.estampe/one.png.json", "{\"picture\":");
    counts(&batch(&folder, &format!("{words} --shading flat")), 1, 2);
}

/// The picture is drawn again if a texture is found elsewhere.
#[test]
fn textures_that_are_searched_are_in_the_record() {
    let folder = models();
    let mtl = "newmtl skin\nmap_Kd D:\\art\\skin.tga\n";
    folder.with_file("in/b/skin.mtl", mtl);
    let tga = |blue: u8| {
        let header = [0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 1, 0, 24, 0];
        [&header[..], &[blue, 0, 0]].concat()
    };
    let library = folder.path("library");
    folder.with_file("library/deep/skin.tga", tga(255));
    let root = library.to_str().expect("ASCII");
    let words = format!("IN/b/three.obj -o OUT/three.png --root {root}");
    let run_again = |drawn: u64, warnings: usize| {
        let run = batch(&folder, &words);
        assert_eq!(run.code, 0, "{}", run.err);
        let said = report(&run);
        assert_eq!(said["counts"]["drawn"], drawn, "{said}");
        let warned = said["pictures"][0]["warnings"].as_array().map(Vec::len);
        assert_eq!(warned, Some(warnings), "{said}");
        fs::read(folder.path("out/three.png")).expect("drawn")
    };
    let blue = run_again(1, 0);
    assert!(run_again(0, 0) == blue);
    folder.with_file("in/textures/skin.tga", tga(0));
    let black = run_again(1, 0);
    assert!(black != blue && run_again(0, 0) == black);
    fs::remove_file(folder.path("in/textures/skin.tga")).expect("written");
    assert!(run_again(1, 0) == blue);
    fs::remove_file(folder.path("library/deep/skin.tga")).expect("written");
    let plain = run_again(1, 1);
    assert!(plain != blue && run_again(0, 0) == plain);

    let run = batch(&folder, "IN/b/three.obj -o OUT/three.png --root IN/none");
    assert_eq!(run.code, 2, "{}", run.err);
    assert!(
        run.err.contains("in/none: this is no folder"),
        "{}",
        run.err
    );
}
