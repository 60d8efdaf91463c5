//! Options of a picture: each changes it, and its bytes depend on neither threads nor SIMD level.

use crate::support::estampe;
use crate::support::picture::Picture;
use estampe::Level;

/// The picture of these words after `render`, which is the same at every SIMD level and for several
/// numbers of threads.
fn same_everywhere(words: &str) -> Vec<u8> {
    let mut pictures = Vec::new();
    let threads = [1, 2, 7].into_iter().cycle();
    for (level, threads) in Level::all_available().into_iter().zip(threads) {
        let machine = format!("--threads {threads} --simd {}", level.name());
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
