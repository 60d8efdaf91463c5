//! `estampe shape` end to end: models, pictures, mistakes.

use crate::support::Folder;
use crate::support::picture::Picture;
use crate::support::shell::run;
use estampe_assets::model::NoResources;
use estampe_assets::{Limits, ModelFormat, parse_model};
use estampe_scene::Mesh;
use fastrand::Rng;
use serde_json::Value;
use std::collections::{HashMap, HashSet};

/// The meshes of a model that was written.
fn read(folder: &Folder, name: &str) -> Mesh {
    let bytes = std::fs::read(folder.path(name)).expect("the model was written");
    let path = folder.path(name);
    let format = ModelFormat::from_extension(&path).expect("a model's name");
    let loaded = parse_model(&bytes, format, name, &NoResources, &Limits::default());
    let mut meshes = loaded.expect("a model that can be read").scene.meshes;
    assert_eq!(meshes.len(), 1);
    meshes.remove(0)
}

/// The edges of a mesh, by positions, that have no opposite edge.
fn open_edges(mesh: &Mesh) -> usize {
    let key = |vertex: u32| mesh.positions[vertex as usize].to_array().map(f32::to_bits);
    let mut edges: HashMap<_, i32> = HashMap::new();
    for &[a, b, c] in &mesh.triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *edges.entry((key(from), key(to))).or_insert(0) += 1;
        }
    }
    let opposite = |(from, to): &(_, _)| edges.get(&(*to, *from)).copied();
    edges
        .iter()
        .filter(|(edge, count)| opposite(edge) != Some(**count))
        .count()
}

/// Each kind of function becomes models of each format, with the axes and the ranges of its
/// options.
/// Rows: M3, M4, M5.
#[test]
fn functions_become_models() {
    for (kind, function, low, high, has_triangles) in [
        (
            "explicit curve",
            "--explicit 'x^2' --range x=-1:2",
            [-1.0, 0.0, 0.0],
            [2.0, 4.0, 0.0],
            false,
        ),
        (
            "explicit surface",
            "--explicit 'x*y' --range x=-1:2 --range y=0:2",
            [-1.0, 0.0, -2.0],
            [2.0, 2.0, 4.0],
            true,
        ),
        (
            "parametric curve",
            "--parametric 'cos(t), sin(t)'",
            [-1.0, -1.0, 0.0],
            [1.0, 1.0, 0.0],
            false,
        ),
        (
            "parametric curve",
            "--parametric 's, s^2, -s' --range s=0:1 --resolution 3",
            [0.0, 0.0, -1.0],
            [1.0, 1.0, 0.0],
            false,
        ),
        (
            "parametric surface",
            "--parametric '2*cos(s)*cos(t), 2*sin(s)*cos(t), 2*sin(t)' --range t=-pi/2:pi/2",
            [-2.0; 3],
            [2.0; 3],
            true,
        ),
        (
            "implicit curve",
            "--implicit 'x^2 + y^2 = 1'",
            [-1.0, -1.0, 0.0],
            [1.0, 1.0, 0.0],
            false,
        ),
        (
            "implicit surface",
            "--implicit 'x^2 + y^2 + z^2 - 1'",
            [-1.0; 3],
            [1.0; 3],
            true,
        ),
        (
            "implicit surface",
            "--implicit 'x^2 + y^2 = 1' --range z=-3:0 --resolution 20x20x10",
            [-1.0, -1.0, -3.0],
            [1.0, 1.0, 0.0],
            true,
        ),
    ] {
        let folder = Folder::new();
        for name in ["a.obj", "a.ply", "a.stl"] {
            let needs_tube = name == "a.stl" && !has_triangles;
            let line = format!("estampe shape {function} -o {name} --json");
            let done = run(&line, &folder);
            if needs_tube {
                assert_eq!(done.code, 2, "{line}");
                assert!(done.err.contains("add --tube"), "{}", done.err);
                let tubed = run(&format!("{line} --tube 0.01"), &folder);
                assert_eq!(tubed.code, 0, "{}", tubed.err);
                assert_eq!(open_edges(&read(&folder, name)), 0, "a tube is closed");
                continue;
            }
            assert_eq!(done.code, 0, "{line}: {}", done.err);
            let report: Value = serde_json::from_slice(&done.out).expect("one object");
            assert_eq!(report["shape"]["kind"], kind, "{line}");
            let mesh = read(&folder, name);
            assert_eq!(
                report["counts"]["triangles"],
                mesh.triangles.len(),
                "{line}"
            );
            assert_eq!(report["counts"]["lines"], mesh.lines.len(), "{line}");
            assert_eq!(mesh.triangles.is_empty(), !has_triangles, "{line}");
            assert_eq!(mesh.lines.is_empty(), has_triangles, "{line}");
            let bounds = mesh.bounds();
            for axis in 0..3 {
                let (min, max) = (f64::from(bounds.min[axis]), f64::from(bounds.max[axis]));
                let is_near = |a: f64, b: f64| (a - b).abs() < 0.01;
                assert!(
                    is_near(min, low[axis]) && is_near(max, high[axis]),
                    "{line}: {bounds:?}"
                );
                let reported = &report["bounds"]["max"][axis];
                assert!(reported.as_f64().is_some_and(|x| is_near(x, max)), "{line}");
            }
        }
    }
}

/// Rows: M4, M5.
#[test]
fn closed_surfaces_are_closed_in_every_format() {
    let folder = Folder::new();
    let sphere = "--parametric 'cos(s)*cos(t), sin(s)*cos(t), sin(t)' --range t=-pi/2:pi/2 \
                  --resolution 24x12";
    let torus = "--implicit '(x^2 + y^2 + z^2 + 0.75)^2 = 4*(x^2 + y^2)' --resolution 30";
    for function in [sphere, torus] {
        for name in ["a.obj", "a.ply", "a.stl"] {
            let done = run(&format!("estampe shape {function} -o {name} -q"), &folder);
            assert_eq!((done.code, done.err.as_str()), (0, ""));
            let mesh = read(&folder, name);
            assert_eq!(open_edges(&mesh), 0, "{name}");
            // Outwards: the sum of a · (b × c) is six times the volume.
            let at = |vertex: u32| mesh.positions[vertex as usize].as_dvec3();
            let parts = mesh
                .triangles
                .iter()
                .map(|&[a, b, c]| at(a).dot(at(b).cross(at(c))));
            assert!(parts.sum::<f64>() > 6.0, "{name}");
        }
    }
    // With texture coordinates a seam has two vertices, at one position.
    let done = run(
        &format!("estampe shape {sphere} -o a.ply --uvs -q"),
        &folder,
    );
    assert_eq!(done.code, 0, "{}", done.err);
    let mesh = read(&folder, "a.ply");
    assert_eq!(
        (mesh.uvs.len(), mesh.positions.len()),
        (mesh.positions.len(), 25 * 11 + 2 * 24)
    );
    assert_eq!(open_edges(&mesh), 0);
    let places: HashSet<_> = mesh
        .positions
        .iter()
        .map(|p| p.to_array().map(f32::to_bits))
        .collect();
    assert_eq!(places.len(), 24 * 11 + 2);
}

/// Rows: M3, M4, M5.
#[test]
fn functions_become_pictures() {
    let folder = Folder::new();
    for (name, function) in [
        ("wave.png", "--explicit 'sin(x)'"),
        ("waves.tga", "--explicit 'sin(x)*cos(y)'"),
        ("spring.jpg", "--parametric 'cos(3*t), sin(3*t), t/4'"),
        ("ring.png", "--implicit 'x^2 + y^2 = 1' --shading unlit"),
        (
            "ball.png",
            "--implicit 'x^2 + y^2 + z^2 = 1' --resolution 20 --background none",
        ),
    ] {
        let line = format!("estampe shape {function} -o {name} --size 96x72");
        let done = run(&line, &folder);
        assert_eq!(done.code, 0, "{line}: {}", done.err);
        assert!(done.err.contains("96x72"), "{}", done.err);
        let picture = Picture::open(&folder.path(name));
        let [left, top, right, bottom] = picture.extent();
        assert!(right - left > 40 || bottom - top > 40, "{name}");
    }
    // A circle in the plane is seen from the front, and a cylinder upright: Z is up.
    let extent = |function: &str| {
        let line = format!("estampe shape {function} -o a.png -q --size 90x90 --ortho");
        let done = run(&line, &folder);
        assert_eq!(done.code, 0, "{}", done.err);
        Picture::open(&folder.path("a.png")).extent()
    };
    let [left, top, right, bottom] = extent("--parametric 'cos(t), sin(t)'");
    assert!((right - left).abs_diff(bottom - top) <= 1);
    let [left, top, right, bottom] = extent("--parametric 'cos(s), sin(s), t' --range t=0:9");
    assert!(bottom - top > 2 * (right - left));
    let [left, top, right, bottom] =
        extent("--parametric 'cos(s), sin(s), t' --range t=0:9 --up y");
    assert!(bottom - top < 2 * (right - left));
    // Texture coordinates are there for pictures.
    let wave = "--explicit 'sin(x)*cos(y)' --shading uv";
    let [left, ..] = extent(wave);
    assert!(left > 0 && Picture::open(&folder.path("a.png")).color_count() > 100);
}

#[test]
fn the_bytes_depend_on_nothing_else() {
    let folder = Folder::new();
    for name in ["a.obj", "a.stl", "a.ply", "a.png"] {
        let mut seen: Option<Vec<u8>> = None;
        for threads in [1, 2, 3] {
            let line = format!(
                "estampe shape --implicit 'sin(x)*cos(y) + sin(y)*cos(z) + sin(z)*cos(x)' \
                 --resolution 12 -o {name} -q --size 64x48 --threads {threads}"
            );
            assert_eq!(run(&line, &folder).code, 0);
            let bytes = std::fs::read(folder.path(name)).expect("written");
            assert!(seen.as_ref().is_none_or(|seen| *seen == bytes), "{name}");
            seen = Some(bytes);
        }
    }
    let line =
        "estampe shape --explicit 'x^2' --resolution 2 --range x=-1:1 -o - --output-format obj -q";
    let done = run(line, &folder);
    assert_eq!(
        String::from_utf8_lossy(&done.out),
        "# estampe\no explicit_curve\nv -1 1 0\nv 0 0 0\nv 1 1 0\nl 1 2 3\n"
    );
}

/// A mistake in an expression is shown with carets, and nothing is written.
#[test]
fn mistakes_are_shown_in_the_expression() {
    let folder = Folder::new();
    for (option, shown) in [
        (
            "--explicit 'sni(x) + 1'",
            "unknown function `sni`; did you mean `sin`?\n  sni(x) + 1\n  ^^^\n",
        ),
        (
            "--parametric 'cos(t), sin(t'",
            "this `(` is not closed; add a `)`\n  cos(t), sin(t\n             ^\n",
        ),
        (
            "--implicit 'x^2 + y^2 = 1 = 2'",
            "an equation is not possible here; write one side of it\n  x^2 + y^2 = 1 = 2\n                ^\n",
        ),
        (
            "--explicit 'x + z'",
            "unknown name `z`; the variables are `x` and `y`\n  x + z\n      ^\n",
        ),
        (
            "--explicit '-2x'",
            "an operator is missing between `2` and `x`; to multiply, write `*`\n  -2x\n    ^\n",
        ),
    ] {
        let done = run(&format!("estampe shape {option} -o a.obj"), &folder);
        assert_eq!(done.code, 2, "{option}");
        assert_eq!(done.err, format!("estampe shape: {shown}"));
        assert!(done.out.is_empty() && folder.names().is_empty());
    }
    let done = run(
        "estampe shape --explicit x --range x=0:foo -o a.obj",
        &folder,
    );
    assert_eq!(done.code, 2);
    assert!(
        done.err.contains("unknown name `foo`") && done.err.contains("^^^"),
        "{}",
        done.err
    );
    let done = run("estampe shape --explicit 'x(' -o a.obj --json", &folder);
    let report: Value = serde_json::from_slice(&done.out).expect("one object");
    assert_eq!(report["exit_code"], 2);
}

#[test]
fn wrong_usage_is_2() {
    let folder = Folder::new();
    for (options, said) in [
        ("", "required"),
        ("-o a.obj", "required"),
        ("--explicit x", "--output"),
        ("--explicit x --implicit y -o a.obj", "cannot be used with"),
        ("--explicit x -o a.gif", "name it .obj"),
        ("--explicit x -o -", "add --output-format"),
        (
            "--explicit x -o a.obj --range z=0:1",
            "no range of \"z\"; there are ranges of x, y",
        ),
        ("--explicit x -o a.obj --range x=0:1 --range x=0:2", "twice"),
        ("--explicit x -o a.obj --range x=1:1", "empty"),
        (
            "--explicit x -o a.obj --range x=0:1/0",
            "limits are numbers",
        ),
        ("--explicit x -o a.obj --range 0:1", "NAME=FROM:TO"),
        ("--explicit x -o a.obj --resolution 5x5", "write one number"),
        ("--explicit x*y -o a.obj --resolution 4096", "at most 2048"),
        ("--implicit x*y*z -o a.obj --resolution 513", "at most 512"),
        (
            "--implicit x*y*z -o a.obj --resolution 5x5",
            "write one number",
        ),
        ("--explicit x -o a.obj --resolution 0", "write N, NxM"),
        ("--explicit x -o a.obj --uvs", "--uvs is for"),
        ("--explicit x*y -o a.obj --tube 1", "--tube is for curves"),
        ("--explicit x -o a.obj --tube -1", "above 0"),
        ("--parametric t -o a.obj", "two or three coordinates, not 1"),
        ("--parametric 's, t' -o a.obj", "three coordinates, not 2"),
        (
            "--parametric 't, t, t, t' -o a.obj",
            "two or three coordinates, not 4",
        ),
        ("--explicit x -o a.png --shading pretty", "--shading"),
    ] {
        let done = run(&format!("estampe shape {options}"), &folder);
        assert_eq!(done.code, 2, "{options}: {}", done.err);
        assert!(done.err.contains(said), "{options}: {}", done.err);
        assert!(
            done.out.is_empty() && folder.names().is_empty(),
            "{options}"
        );
    }
}

#[test]
fn a_function_without_a_shape_is_1_and_a_bad_output_3() {
    let folder = Folder::new();
    for (options, said) in [
        ("--explicit 'sqrt(-1 - x^2)'", "not defined in these ranges"),
        (
            "--explicit 'x + 100' --range y=0:1",
            "all of its values are outside",
        ),
        ("--explicit '0/0*x*y'", "not defined in these ranges"),
        ("--parametric '1, 2'", "points coincide"),
        ("--parametric 's*0, t*0, 1'", "points coincide"),
        ("--implicit 'x^2 + y^2 + 1'", "does not change its sign"),
        ("--implicit '1/x + 0*z'", "only where it jumps"),
        (
            "--implicit 'x + y + z - 3e9' --range x=1e9:1000000001 --range y=1e9:1000000001 --range \
             z=1e9:1000000001",
            "32-bit floats",
        ),
    ] {
        let done = run(&format!("estampe shape {options} -o a.obj"), &folder);
        assert_eq!(done.code, 1, "{options}: {}", done.err);
        assert!(done.err.contains(said), "{options}: {}", done.err);
        assert_eq!(
            done.err.trim_end().lines().count(),
            1,
            "one sentence: {}",
            done.err
        );
        assert!(folder.names().is_empty());
    }
    let done = run("estampe shape --explicit x -o no/such/a.obj", &folder);
    assert_eq!(done.code, 3, "{}", done.err);
    assert!(done.err.contains("does not exist"), "{}", done.err);
}

#[test]
fn interruptions_are_reported() {
    let folder = Folder::new();
    let half =
        "estampe shape --implicit 'x^2 + y^2 + z^2 - 1 + 0*sqrt(z)' --resolution 20 -o a.ply";
    let done = run(half, &folder);
    assert_eq!(done.code, 0);
    assert!(
        done.err.starts_with("warning: the function jumps"),
        "{}",
        done.err
    );
    let quiet = run(&format!("{half} -q"), &folder);
    assert!(quiet.err.is_empty(), "{}", quiet.err);
    let report = run(&format!("{half} -q --json"), &folder);
    let report: Value = serde_json::from_slice(&report.out).expect("one object");
    assert!(
        report["shape"]["interruptions"]
            .as_u64()
            .is_some_and(|count| count > 0)
    );
    assert_eq!(report["warning_count"], 1);
    // A picture's report is that of `render`, and has the shape.
    let line = "estampe shape --explicit x^2 --range x=0:1 -o a.png --size 8x8 --json -q";
    let report: Value = serde_json::from_slice(&run(line, &folder).out).expect("one object");
    assert_eq!(
        report["shape"]["ranges"]["x"],
        serde_json::json!([0.0, 1.0])
    );
    assert_eq!(report["output"]["width"], 8);
}

#[test]
fn help_has_examples_functions_and_exit_codes() {
    let folder = Folder::new();
    let help = String::from_utf8_lossy(&run("estampe help shape", &folder).out).into_owned();
    for word in [
        "Examples:",
        "Exit codes:",
        "atan2",
        "--tube",
        "--shading",
        "0:tau",
        "--up z",
    ] {
        assert!(
            help.contains(word),
            "{word} is missing in the help:\n{help}"
        );
    }
    // The examples of the help work.
    let mut count = 0;
    for line in help
        .lines()
        .filter(|line| line.starts_with("  estampe shape"))
    {
        let line = line
            .trim()
            .replace(".png", ".png --size 40x30")
            .replace(" 96", " 20");
        let done = run(&line, &folder);
        assert_eq!(done.code, 0, "{line}: {}", done.err);
        count += 1;
    }
    assert_eq!((count, folder.names().len()), (6, 6));
}

/// Arbitrary expressions and ranges end with an exit code that is documented, and never crash.
#[test]
fn hostile_arguments() {
    let folder = Folder::new();
    let words = [
        "x", "y", "z", "s", "t", "(", ")", "+", "-", "*", "/", "^", ",", "1", "1e9", "sin(", "ln(",
        "floor(", "=", "0", "pi",
    ];
    let mut random = Rng::with_seed(12);
    let mut codes = [0; 4];
    for _ in 0..150 {
        let kind = ["explicit", "parametric", "implicit"][random.usize(..3)];
        let text: String = (0..random.usize(1..9))
            .map(|_| words[random.usize(..words.len())])
            .collect();
        let out = ["a.obj", "a.stl", "a.ply", "a.png"][random.usize(..4)];
        let range = ["x=-1e30:1e30", "x=0:1e-30", "t=5:-5", "x=1e20:1e21"][random.usize(..4)];
        let line = format!(
            "estampe shape --{kind} '{text}' -o {out} --range {range} --resolution 9 --size 16x16 -q"
        );
        let done = run(&line, &folder);
        assert!((0..=3).contains(&done.code), "{line}: {}", done.err);
        assert!(!done.err.contains("panicked"), "{line}: {}", done.err);
        codes[done.code as usize] += 1;
    }
    let valid = run(
        "estampe shape --explicit 'x^3/1e30' --range x=-1e30:1e30 -o a.png --size 9x9",
        &folder,
    );
    assert!(valid.code <= 1, "{}", valid.err);
    assert!(codes[2] > 50 && codes[3] == 0, "{codes:?}");
}
