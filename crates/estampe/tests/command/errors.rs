//! Error messages and exit codes of the command; failed commands leave no files behind.

use crate::support::{Folder, TETRAHEDRON, estampe, estampe_fed};

#[test]
fn a_fault_of_the_input_is_1() {
    let folder = Folder::new();
    let missing = folder.path("missing.obj");
    let empty = folder.with_file("empty.obj", "");
    let unknown = folder.with_file("notes.txt", "hello\n");
    let broken = folder.with_file("broken.ply", "ply\nformat ascii 1.0\nelement vertex 3\n");
    let model = folder.with_file("m.obj", TETRAHEDRON);
    let plain = folder.with_file("plain.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let out = folder.path("out.png");
    for (words, paths, said) in [
        ("render {} -o {}", vec![&missing, &out], "no such file"),
        ("render {} -o {}", vec![&empty, &out], "empty.obj"),
        ("render {} -o {}", vec![&unknown, &out], "--format"),
        ("render {} -o {}", vec![&broken, &out], "broken.ply"),
        ("render builtin:kettle -o {}", vec![&out], "teapot"),
        (
            "render {} -o {} --texture {}",
            vec![&model, &out, &missing],
            "no such file",
        ),
        (
            "render {} -o {} --texture {}",
            vec![&model, &out, &unknown],
            "notes.txt",
        ),
        ("info {}", vec![&missing], "no such file"),
        ("info {}", vec![&broken], "broken.ply"),
    ] {
        let paths: Vec<_> = paths.into_iter().map(std::path::PathBuf::as_path).collect();
        let run = estampe(words, &paths);
        assert_eq!(run.code, 1, "{words} {paths:?}: {}", run.err);
        assert!(run.err.contains(said), "{words} {paths:?}: {}", run.err);
        assert_eq!(
            run.err.trim_end().lines().count(),
            1,
            "one sentence: {}",
            run.err
        );
        assert!(run.out.is_empty() && !out.exists());
    }
    // A texture requires texture coordinates.
    let picture = estampe(
        "render builtin:cube -o {} -q --size 4x4",
        &[&folder.path("t.png")],
    );
    assert_eq!(picture.code, 0);
    let texture = folder.path("t.png");
    let run = estampe("render {} -o {} --texture {}", &[&plain, &out, &texture]);
    assert_eq!(run.code, 1);
    assert!(run.err.contains("texture coordinates"), "{}", run.err);
}

#[test]
fn wrong_usage_is_2() {
    for words in [
        "",
        "paint",
        "render",
        "render builtin:cube",
        "render builtin:cube -o out.gif",
        "render builtin:cube -o out",
        "render builtin:cube -o - --size 0x5",
        "render builtin:cube -o - --size 16385x5",
        "render builtin:cube -o - --view behind",
        "render builtin:cube -o - --view iso --azimuth 5",
        "render builtin:cube -o - --eye 1,2,3 --view iso",
        "render builtin:cube -o - --eye 1,2",
        "render builtin:cube -o - --ortho --fov 20",
        "render builtin:cube -o - --fov 180",
        "render builtin:cube -o - --margin 0.5",
        "render builtin:cube -o - --light 0,0,0",
        "render builtin:cube -o - --light lamp:1,2,3",
        "render builtin:cube -o - --light pos:1,2,3:red",
        "render builtin:cube -o - --attenuation 5",
        "render builtin:cube -o - --light 1,2,3 --attenuation 5",
        "render builtin:cube -o - --light pos:1,2,3 --attenuation 0",
        "render builtin:cube -o - --specular shiny",
        "render builtin:cube -o - --shininess 0",
        "render builtin:cube -o - --levels 1",
        "render builtin:cube -o - --fog 0",
        "render builtin:cube -o - --fog 9:3",
        "render builtin:cube -o - --background fff",
        "render builtin:cube -o - --samples 2",
        "render builtin:cube -o - --threads 0",
        "render builtin:cube -o - --simd mmx",
        "render builtin:cube -o - --shading pretty",
        "render builtin:cube -o - --shading wireframe --wireframe",
        "render builtin:cube -o - --section w",
        "render builtin:cube -o - --section 0,0,0",
        "render builtin:cube -o - --section y=-7",
        "render builtin:cube -o - --section-color 112233",
        "render builtin:cube -o - --edges=181",
        "render builtin:cube -o - --edges --edge-width 0",
        "render builtin:cube -o - --edge-width 2",
        "render builtin:cube -o - --transparency right",
        "render builtin:cube -o - --elevation 91",
        "render builtin:cube -o - --up x",
        "render - -o -",
        "info -",
        "info",
    ] {
        let run = estampe(words, &[]);
        assert_eq!(run.code, 2, "{words}: {}", run.err);
        assert!(!run.err.is_empty() && run.out.is_empty(), "{words}");
    }
    // A level that exists, but not on this processor.
    let missing = if cfg!(target_arch = "x86_64") {
        "neon"
    } else {
        "avx2"
    };
    let run = estampe(&format!("render builtin:cube -o - --simd {missing}"), &[]);
    assert_eq!(run.code, 2);
    assert!(run.err.contains(&format!("no {missing}")), "{}", run.err);
}

#[test]
fn an_output_that_cannot_be_written_is_3() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("d.png")).expect("writable");
    for name in ["d.png", "no/such/folder/out.png"] {
        let run = estampe(
            "render builtin:cube -o {} --size 8x8",
            &[&folder.path(name)],
        );
        assert_eq!(run.code, 3, "{name}: {}", run.err);
        assert!(run.err.contains("folder"), "{}", run.err);
    }
    #[cfg(target_os = "linux")]
    {
        let full = std::path::Path::new("/dev/full");
        let run = estampe(
            "render builtin:cube -o {} --output-format png --size 8x8",
            &[full],
        );
        assert_eq!(run.code, 3, "{}", run.err);
    }
    assert_eq!(folder.names(), ["d.png"]);
}

#[test]
fn an_old_picture_survives_a_failure() {
    let folder = Folder::new();
    let out = folder.with_file("out.png", "the old one");
    let broken = folder.with_file("broken.stl", "solid x\nfacet normal");
    assert_eq!(estampe("render {} -o {}", &[&broken, &out]).code, 1);
    assert_eq!(std::fs::read(&out).expect("still there"), b"the old one");
    assert_eq!(
        estampe("render builtin:cube -o {} -q --size 8x8", &[&out]).code,
        0
    );
    assert!(std::fs::read(&out).expect("there").starts_with(b"\x89PNG"));
    assert_eq!(folder.names(), ["broken.stl", "out.png"]);
}

#[test]
fn failures_are_reported_as_json_too() {
    let run = estampe_fed("render - --format ply -o x.png --json", &[], b"ply\n");
    assert_eq!(run.code, 1);
    let report: serde_json::Value = serde_json::from_slice(&run.out).expect("one object");
    assert_eq!(report["exit_code"], 1);
    assert!(
        report["error"]
            .as_str()
            .is_some_and(|error| error.contains("standard input"))
    );
}

#[test]
fn quiet_is_quiet_and_warnings_are_few() {
    let folder = Folder::new();
    let odd = format!("{TETRAHEDRON}{}", "f 1 2 999\n".repeat(40));
    let model = folder.with_file("odd.obj", odd);
    let out = folder.path("out.png");
    let run = estampe("render {} -o {} --size 8x8", &[&model, &out]);
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(
        run.err.contains("warning: ") && run.err.contains("more"),
        "{}",
        run.err
    );
    assert!(run.err.lines().count() <= 8, "{}", run.err);
    let run = estampe("render {} -o {} --size 8x8 -q", &[&model, &out]);
    assert!(run.code == 0 && run.err.is_empty(), "{}", run.err);
}

#[test]
fn help_has_examples_limits_and_exit_codes() {
    let run = estampe("--version", &[]);
    let version = String::from_utf8_lossy(&run.out).into_owned();
    assert!(
        run.code == 0 && version.contains("picture version"),
        "{version}"
    );
    let help = String::from_utf8_lossy(&estampe("help render", &[]).out).into_owned();
    for word in [
        "Examples:",
        "Exit codes:",
        "--margin",
        "[default: 35]",
        "1 to 16384",
        "builtin:torus",
    ] {
        assert!(
            help.contains(word),
            "{word} is missing in the help:\n{help}"
        );
    }
}

#[test]
fn every_command_has_examples_and_exit_codes() {
    for command in [
        "shape",
        "info",
        "inspect",
        "diff",
        "depth",
        "compute",
        "shader check",
        "shader image",
        "shader reflect",
        "shader dump",
        "shader template",
    ] {
        let run = estampe(&format!("help {command}"), &[]);
        let help = String::from_utf8_lossy(&run.out).into_owned();
        assert_eq!(run.code, 0, "{command}");
        for word in ["Examples:", "Exit codes:", &format!("estampe {command} ")] {
            assert!(
                help.contains(word),
                "{word} is missing in the help:\n{help}"
            );
        }
    }
}

#[test]
fn info_counts_the_contents_of_a_model() {
    let folder = Folder::new();
    let model = folder.with_file("m.obj", TETRAHEDRON);
    let run = estampe("info {} --json", &[&model]);
    assert_eq!(run.code, 0, "{}", run.err);
    let report: serde_json::Value = serde_json::from_slice(&run.out).expect("one object");
    assert_eq!(report["counts"]["triangles"], 4);
    assert_eq!(report["bounds"]["max"], serde_json::json!([1.0, 1.0, 1.0]));
    assert_eq!(report["up"], "y");
    let run = estampe("info builtin:teapot", &[]);
    let text = String::from_utf8_lossy(&run.out).into_owned();
    assert!(
        text.contains("triangles") && text.contains("with normals, uvs"),
        "{text}"
    );
}
