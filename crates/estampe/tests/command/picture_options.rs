//! Options of a picture: each changes it, and its bytes depend on neither threads nor SIMD level.

use crate::support::picture::Picture;
use crate::support::{Folder, estampe, machines};
use estampe::Level;

/// The picture of these words after `render`, which is the same at every SIMD level and for several
/// numbers of threads.
fn same_everywhere(words: &str) -> Vec<u8> {
    let mut pictures = Vec::new();
    // Each level once: the first machine is the best level again.
    for machine in machines().into_iter().skip(1) {
        let run = estampe(&format!("render {words} -o - -q {machine}"), &[]);
        assert_eq!(run.code, 0, "{words}: {}", run.err);
        pictures.push(run.out);
    }
    let first = pictures.remove(0);
    assert!(pictures.iter().all(|other| *other == first), "{words}");
    first
}

/// Asserts that each of the options changes the picture of the words, each in its own way.
fn all_differ(words: &str, options: &[&str]) {
    let mut seen = vec![same_everywhere(words)];
    for option in options {
        let picture = same_everywhere(&format!("{words} {option}"));
        assert!(!seen.contains(&picture), "{words} {option}");
        seen.push(picture);
    }
}

#[test]
fn zoom_enlarges_about_the_middle() {
    let words = "builtin:sphere --size 80x60 --samples 1 --margin 0.2";
    all_differ(
        words,
        &[
            "--zoom 2",
            "--ortho",
            "--ortho --zoom 2",
            "--eye 0,0,9 --zoom 3",
        ],
    );
    let width = |options: &str| {
        let [left, _, right, _] =
            Picture::read(&same_everywhere(&format!("{words} {options}"))).extent();
        assert!(left.abs_diff(80 - right) <= 1, "{options}: {left} {right}");
        right - left
    };
    for kind in ["", "--ortho", "--eye 1,2,9"] {
        let plain = width(kind);
        let small = width(&format!("{kind} --zoom 0.5"));
        assert!(small.abs_diff(plain / 2) <= 1, "{kind}: {plain} {small}");
    }
}

#[test]
fn more_samples_are_smoother() {
    let words = "builtin:torus --size 64x48 --shading unlit";
    all_differ(
        words,
        &["--samples 1", "--samples 2", "--samples 8", "--samples 16"],
    );
    let colors = |samples: u32| {
        let picture = same_everywhere(&format!("{words} --samples {samples}"));
        Picture::read(&picture).color_count()
    };
    // One colour, the background, and as many mixtures as there are samples between.
    assert_eq!(colors(1), 2);
    assert_eq!(colors(2), 3);
    assert!((6..=9).contains(&colors(8)) && (10..=17).contains(&colors(16)));
}

#[test]
fn colours_and_materials_are_replaced() {
    let size = "--size 64x48";
    let words = format!("builtin:torus {size}");
    all_differ(
        &words,
        &[
            "--color red",
            "--color #f008",
            "--color red --shading unlit",
            "--color red --shading flat",
            "--roughness 0.1",
            "--metallic 1 --color gold",
            "--metallic 1 --roughness 0.2 --color gold",
            "--color red --transparency exact --background none --shading pbr",
        ],
    );
    // Names and digits are the same colour, and an option says what another one said.
    let of = |options: &str| same_everywhere(&format!("{words} {options}"));
    assert!(of("--color red") == of("--color #f00") && of("--color red") == of("--color ff0000ff"));
    assert!(of("--roughness 0.5") == of("--roughness 0.5 --shading pbr"));
    assert!(of("--light 1,1,1:orange") == of("--light 1,1,1:ffa500"));
    let unlit = Picture::read(&of("--color #123456 --shading unlit --samples 1"));
    assert_eq!(unlit.color_count(), 2);
    assert_eq!(unlit.pixel(16, 24), [0x12, 0x34, 0x56, 255]);
}

#[test]
fn one_colour_replaces_materials_textures_and_vertex_colours() {
    let folder = Folder::new();
    folder.with_file("m.mtl", "newmtl a\nKd 0 1 0\nd 0.3\n");
    let painted = folder.with_file(
        "m.obj",
        "mtllib m.mtl\nusemtl a\nv 0 0 0 1 0 0\nv 2 0 0 0 1 0\nv 0 2 0 0 0 1\nf 1 2 3\nl 1 3\n",
    );
    let plain = folder.with_file("n.obj", "v 0 0 0\nv 2 0 0\nv 0 2 0\nf 1 2 3\nl 1 3\n");
    for shading in ["phong", "unlit", "pbr", "gouraud"] {
        let words = format!("render {{}} -o - -q --size 40x30 --color tan --shading {shading}");
        let [a, b] = [&painted, &plain].map(|model| estampe(&words, &[model]));
        assert_eq!((a.code, b.code), (0, 0), "{} {}", a.err, b.err);
        assert!(a.out == b.out, "{shading}");
    }
}

#[test]
fn gradients_are_behind_everything() {
    let words = "builtin:torus --size 64x48";
    let gradient = "--background linear:#102040,#e0c080";
    all_differ(
        words,
        &[
            gradient,
            "--background radial:#102040,#e0c080",
            "--background linear:#102040,red,#e0c080",
            "--background linear:#102040,#e0c08000",
            "--background #10204080",
            "--background none",
            &format!("{gradient} --ground"),
            &format!("{gradient} --fog 9"),
            &format!("{gradient} --shading wireframe"),
            &format!("{gradient} --shading normals"),
            &format!("{gradient} --color #f008 --transparency exact"),
            &format!("{gradient} --color #f008 --transparency weighted"),
        ],
    );
    let of = |options: &str| same_everywhere(&format!("{words} {options}"));
    // A gradient of one colour is that colour, wherever it is used.
    for (options, code) in [
        ("", "f2f2f2"),
        ("--ground", "123456"),
        ("--fog 8", "ff0080"),
        ("--shading wireframe", "f2f2f2"),
        ("--shading uv", "123456"),
        ("--color #0f08", "ff0080"),
    ] {
        let plain = of(&format!("{options} --background {code}"));
        for shape in ["linear", "radial"] {
            let gradient = format!("{options} --background {shape}:{code},{code},{code}");
            assert!(plain == of(&gradient), "{gradient}");
        }
    }
}

#[test]
fn gradients_go_from_the_first_colour_to_the_last() {
    let of = |options: &str| {
        let words = format!("builtin:sphere --size 64x64 --margin 0.45 --samples 1 {options}");
        Picture::read(&same_everywhere(&words))
    };
    let down = of("--background linear:white,black");
    let column: Vec<u8> = (0..64).map(|y| down.pixel(0, y)[0]).collect();
    assert!(
        column.is_sorted_by(|above, below| above >= below),
        "{column:?}"
    );
    assert!(column[0] > 245 && column[63] < 10, "{column:?}");
    assert_eq!(down.pixel(0, 0), down.pixel(63, 0));
    let around = of("--background radial:white,black");
    assert_eq!(around.pixel(0, 0), around.pixel(63, 63));
    assert!(around.pixel(0, 0)[0] < 10 && around.pixel(0, 32)[0] > around.pixel(0, 0)[0] + 30);
    let clear = of("--background linear:#ff0000,transparent");
    let alphas: Vec<u8> = (0..64).map(|y| clear.pixel(5, y)[3]).collect();
    assert!(
        alphas.is_sorted_by(|above, below| above >= below),
        "{alphas:?}"
    );
    for y in 0..48 {
        let [r, g, b, _] = clear.pixel(5, y);
        assert!(
            r >= 250 && g < 6 && b < 6,
            "nothing dark is mixed in: {r} {g} {b} at {y}"
        );
    }
    // Formats without alpha have the default background behind it.
    let jpeg = of("--background linear:#ff0000,transparent --output-format jpeg");
    assert!(jpeg.pixel(5, 63)[1] > 200);
}

#[test]
fn lines_and_points_have_a_width() {
    let folder = Folder::new();
    let model = folder.with_file(
        "l.obj",
        "v -1 0 0\nv 1 0 0\nv 0 0.7 0\nv 0 -0.7 0\nl 1 2\np 3\np 4\n",
    );
    let of = |options: &str| {
        let mut pictures = Vec::new();
        for level in Level::all_available() {
            let words = format!(
                "render {{}} -o - -q --size 64x48 --view front --ortho --simd {} {options}",
                level.name()
            );
            let run = estampe(&words, &[&model]);
            assert_eq!(run.code, 0, "{options}: {}", run.err);
            pictures.push(run.out);
        }
        assert!(
            pictures.iter().all(|other| *other == pictures[0]),
            "{options}"
        );
        Picture::read(&pictures[0])
    };
    let dark = |picture: &Picture, x: usize, rows: std::ops::Range<usize>| -> f64 {
        let grey = |y| 1.0 - f64::from(picture.pixel(x, y)[0]) / 242.0;
        rows.map(grey).sum()
    };
    // Of black lines, the sum of the darkness across is the width.
    for samples in [1, 4, 16] {
        for width in [2.0, 5.0, 9.5] {
            let picture = of(&format!(
                "--color black --line-width {width} --samples {samples}"
            ));
            let across = dark(&picture, 20, 14..34);
            assert!((across - width).abs() < 0.8, "{samples} {width}: {across}");
        }
    }
    for size in [3.0, 6.5] {
        let picture = of(&format!("--color black --point-size {size} --samples 16"));
        let above = dark(&picture, 32, 0..20);
        assert!((above - size).abs() < 0.8, "{size}: {above}");
    }
    let plain = of("--samples 1");
    assert!(plain.rgba() != of("--samples 1 --line-width 1.5").rgba());
    let words = "builtin:torus --size 64x48 --shading wireframe";
    all_differ(words, &["--line-width 0.5", "--line-width 3"]);
    all_differ(
        "builtin:torus --size 64x48 --wireframe",
        &["--line-width 3"],
    );
}
