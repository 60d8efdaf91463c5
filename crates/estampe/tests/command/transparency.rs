//! `estampe render --transparency` end to end.

use crate::support::{Folder, Run, estampe};
use estampe::Level;

/// Three panes of glass that cross in front of a bar.
const PANES: &str = "mtllib panes.mtl
v -1.4 -0.9 0.5\nv 1 -0.9 -0.9\nv 1 0.9 -0.9\nv -1.4 0.9 0.5
v -1 -0.7 -0.9\nv 1.4 -0.7 0.5\nv 1.4 1.1 0.5\nv -1 1.1 -0.9
v -1.7 0.35 -0.4\nv 1.7 0.35 -0.4\nv 1.7 0.6 -0.4\nv -1.7 0.6 -0.4
usemtl bar\nf 9 10 11 12\nusemtl red\nf 1 2 3 4\nusemtl green\nf 5 6 7 8
";
const GLASS: &str = "newmtl bar\nKd 0.3 0.3 0.3
newmtl red\nKd 0.9 0.1 0.1\nd 0.6
newmtl green\nKd 0.1 0.8 0.2\nd 0.6
";

fn drawn(folder: &Folder, words: &str) -> Run {
    let words = format!("render {{}} -o - --size 80x60 {words}");
    let run = estampe(&words, &[&folder.path("panes.obj")]);
    assert_eq!(run.code, 0, "{words}: {}", run.err);
    run
}

fn panes() -> Folder {
    let folder = Folder::new();
    folder.with_file("panes.obj", PANES);
    folder.with_file("panes.mtl", GLASS);
    folder
}

/// The methods give different pictures, each the same at every SIMD level and for any number of
/// threads; sorted is what a picture has without the option.
///
/// Rows: D6, U3.
#[test]
fn each_method_has_its_picture_everywhere() {
    let folder = panes();
    let mut pictures = Vec::new();
    for method in ["sorted", "exact", "weighted"] {
        let mut of_method = Vec::new();
        for level in Level::all_available() {
            for threads in [1, 3] {
                let machine = format!("--threads {threads} --simd {}", level.name());
                let run = drawn(&folder, &format!("-q --transparency {method} {machine}"));
                of_method.push(run.out);
            }
        }
        assert!(
            of_method.windows(2).all(|pair| pair[0] == pair[1]),
            "{method}"
        );
        pictures.extend(of_method.pop());
    }
    assert!(pictures[0] != pictures[1] && pictures[1] != pictures[2] && pictures[0] != pictures[2]);
    assert!(
        drawn(&folder, "-q").out == pictures[0],
        "the default is sorted"
    );
}

/// The report names the method and the number of layers.
///
/// Rows: D6.
#[test]
fn the_report_counts_the_layers() {
    let folder = panes();
    for (method, layers) in [("sorted", "null"), ("exact", "2"), ("weighted", "null")] {
        let run = drawn(&folder, &format!("--json --transparency {method}"));
        let report = run.err.replace([' ', '\n'], "");
        let expected = format!("\"transparency\":{{\"layers\":{layers},\"method\":\"{method}\"}}");
        assert!(report.contains(&expected), "{expected}: {report}");
    }
}

/// More layers than are peeled are a warning.
///
/// Rows: D6.
#[test]
fn too_many_layers_are_a_warning() {
    let folder = Folder::new();
    let mut model = "mtllib glass.mtl\nusemtl glass\n".to_owned();
    for layer in 0..140 {
        let z = f64::from(layer) * 0.01;
        model += &format!("v -1 -1 {z}\nv 1 -1 {z}\nv 0 1 {z}\nf -3 -2 -1\n");
    }
    folder.with_file("panes.obj", &model);
    folder.with_file("glass.mtl", "newmtl glass\nKd 0.5 0.6 0.7\nd 0.05\n");
    let run = drawn(&folder, "--view front --samples 1 --transparency exact");
    assert!(
        run.err.contains("warning: more than 128 layers"),
        "{}",
        run.err
    );
    let quiet = drawn(&folder, "-q --view front --samples 1 --transparency exact");
    assert!(quiet.err.is_empty(), "{}", quiet.err);
    let sorted = drawn(&folder, "--view front --samples 1");
    assert!(!sorted.err.contains("warning"), "{}", sorted.err);
    assert!(sorted.out == run.out, "parallel layers are sorted rightly");
}
