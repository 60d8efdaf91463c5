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
        "render builtin:cube -o - --eye 1,2,3 --target 1,2,3",
        "render builtin:cube -o - --eye 0,0,0",
        "render builtin:cube -o - --zoom 0",
        "render builtin:cube -o - --zoom=-2",
        "render builtin:cube -o - --ortho --fov 20",
        "render builtin:cube -o - --fov 180",
        "render builtin:cube -o - --margin 0.5",
        "render builtin:cube -o - --light 0,0,0",
        "render builtin:cube -o - --light lamp:1,2,3",
        "render builtin:cube -o - --light pos:1,2,3:redish",
        "render builtin:cube -o - --light pos:1,2,3:#ff000080",
        "render builtin:cube -o - --color redd",
        "render builtin:cube -o - --roughness 1.5",
        "render builtin:cube -o - --metallic 1 --shading phong",
        "render builtin:cube -o - --point-size 0",
        "render builtin:cube -o - --line-width 65",
        "render builtin:cube -o - --background linear:red",
        "render builtin:cube -o - --background conic:red,blue",
        "render builtin:cube -o - --attenuation 5",
        "render builtin:cube -o - --light 1,2,3 --attenuation 5",
        "render builtin:cube -o - --light pos:1,2,3 --attenuation 0",
        "render builtin:cube -o - --specular shiny",
        "render builtin:cube -o - --shininess 0",
        "render builtin:cube -o - --levels 1",
        "render builtin:cube -o - --fog 0",
        "render builtin:cube -o - --fog 9:3",
        "render builtin:cube -o - --background ffff0",
        "render builtin:cube -o - --samples 3",
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

#[test]
fn mistakes_on_the_command_line_have_advice() {
    for (words, advice) in [
        ("render builtin:cube -o o.png --ambient -1", "from 0 to 10"),
        ("render builtin:cube -o o.png --fov -20", "from 0.1 to 175"),
        ("render builtin:cube -o o.png --threads -1", "1..=1024"),
        ("render builtin:cube -o o.png --timeout -1", "above 0"),
        ("render builtin:cube -o o.png --fog -1:5", "`-1`"),
        ("render builtin:cube -o o.png --zoom -2", "from 0.01"),
        ("render builtin:cube -o --json", "./--json"),
        ("render builtin:cube -o -q", "./-q"),
        ("render builtin:cube o.png", "-o o.png"),
        ("render builtin:cube b.stl -o o.png", "estampe batch"),
        ("render builtin:cube -o o.png --eye 1 2 3", "commas"),
        ("render builtin:cube -o o.png --width 100", "--size WxH"),
        ("render builtin:cube -o o.png --colour red", "'--color'"),
        ("render builtin:cube -o o.png --shading gourad", "gouraud"),
        ("render builtin:cube -o o.png --color tomatoe", "tomato"),
        ("render builtin:cube -o o.bmp", ".bmp"),
        ("render builtin:cube -o o.png --scene 3", "built-in"),
        ("render teapot -o o.png", "builtin:teapot"),
        ("render *.obj -o o.png", "estampe batch"),
        ("turntable builtin:cube -o o.mp4", "ffmpeg"),
    ] {
        let run = estampe(words, &[]);
        assert!(run.code == 1 || run.code == 2, "{words}: {}", run.err);
        assert!(run.err.contains(advice), "{words}: {}", run.err);
        assert!(!run.err.contains("as a value, use"), "{words}: {}", run.err);
    }
}

#[test]
fn a_file_may_begin_with_a_hyphen() {
    let folder = Folder::new();
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_estampe"))
        .args(["render", "builtin:cube", "-o", "-x.png", "--size", "8x8"])
        .current_dir(folder.path(""))
        .output();
    let run = crate::support::Run::from(output.expect("the command starts"));
    assert_eq!(run.code, 0, "{}", run.err);
    assert_eq!(folder.names(), ["-x.png"]);
}

#[test]
fn standard_input_shows_its_format() {
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
               property float z\nelement face 1\nproperty list uchar int vertex_indices\n\
               end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    for model in [
        TETRAHEDRON,
        ply,
        "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
    ] {
        let run = estampe_fed("render - -o - -q --size 8x8", &[], model.as_bytes());
        assert_eq!(run.code, 0, "{}", run.err);
        assert!(run.out.starts_with(b"\x89PNG"));
    }
    let run = estampe_fed("render - -o -", &[], b"hello\n");
    assert_eq!(run.code, 1);
    assert!(run.err.contains("--format gltf"), "{}", run.err);
}

/// A file that is cut off is drawn as far as it goes, with a warning, if there is something to
/// draw; with --strict every warning is an error. Random bytes are no model.
#[test]
fn damaged_files_are_drawn_as_far_as_they_go_unless_strict() {
    let folder = Folder::new();
    let facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
    let mut binary = vec![b' '; 80];
    binary.extend_from_slice(&3_u32.to_le_bytes());
    for number in 0..3_u8 {
        let mut record = [0; 50];
        record[12..16].copy_from_slice(&f32::from(number).to_le_bytes());
        record[28..32].copy_from_slice(&1_f32.to_le_bytes());
        record[44..48].copy_from_slice(&2_f32.to_le_bytes());
        binary.extend_from_slice(&record);
    }
    let header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
                  property float z\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n";
    let vertices = "0 0 0\n1 0 0\n0 1 0\n";
    let cases: Vec<(&str, Vec<u8>, bool)> = vec![
        ("cut.stl", binary[..binary.len() - 60].to_vec(), true),
        ("text.stl", format!("solid a\n{facet}").into_bytes(), true),
        (
            "within.stl",
            format!("solid a\n{facet}facet normal 0 0 1\nouter loop\nvertex 0 0").into_bytes(),
            true,
        ),
        (
            "faces.ply",
            format!("{header}{vertices}3 0 1 2\n3 0").into_bytes(),
            true,
        ),
        (
            "faces.off",
            format!("OFF\n3 2 0\n{vertices}3 0 1 2\n3 0 2").into_bytes(),
            true,
        ),
        (
            "last.obj",
            format!("{vertices}v 0 0 1\nf 1 2 3\nf 1")
                .replace("0 0 0\n1", "v 0 0 0\nv 1")
                .replace("\n0 1 0", "\nv 0 1 0")
                .into_bytes(),
            true,
        ),
        (
            "vertices.ply",
            format!("{header}0 0 0\n1 0").into_bytes(),
            false,
        ),
        ("vertices.off", b"OFF\n3 1 0\n0 0 0\n1 0".to_vec(), false),
        ("nothing.stl", binary[..84].to_vec(), false),
        ("header.glb", b"glTF\x02\0\0\0\xff\0\0\0".to_vec(), false),
        ("start.3mf", b"PK\x03\x04".to_vec(), false),
    ];
    for (name, bytes, is_drawn) in cases {
        let model = folder.with_file(name, bytes);
        let run = estampe("render {} -o - --size 8x8", &[&model]);
        if is_drawn {
            assert_eq!(run.code, 0, "{name}: {}", run.err);
            assert!(run.err.contains("warning: "), "{name}: {}", run.err);
        } else {
            assert_eq!(run.code, 1, "{name}: {}", run.err);
        }
        let run = estampe("render {} -o - --size 8x8 --strict", &[&model]);
        assert_eq!((run.code, run.out.len()), (1, 0), "{name}: {}", run.err);
        assert!(run.err.contains(name), "{name}: {}", run.err);
    }
    let sound = folder.with_file("sound.stl", format!("solid a\n{facet}endsolid a\n"));
    assert_eq!(
        estampe("render {} -o - --size 8x8 --strict", &[&sound]).code,
        0
    );
    let mut random = fastrand::Rng::with_seed(7);
    let mut nonsense: Vec<u8> = (0..80).map(|_| random.u8(..)).collect();
    nonsense.extend_from_slice(&40_u32.to_le_bytes());
    nonsense.extend((0..40 * 50).map(|_| random.u8(..)));
    for name in ["random.stl", "random.bin"] {
        let model = folder.with_file(name, &nonsense);
        let run = estampe("render {} -o - --size 8x8", &[&model]);
        assert_eq!(run.code, 1, "{name}: {}", run.err);
        assert!(run.err.contains("random bytes"), "{name}: {}", run.err);
    }
}

#[test]
fn choices_of_gltf_are_errors_elsewhere() {
    let folder = Folder::new();
    let model = folder.with_file("m.obj", TETRAHEDRON);
    for option in ["--scene 0", "--animation walk", "--variant red"] {
        let run = estampe(&format!("render {{}} -o - --size 8x8 {option}"), &[&model]);
        assert_eq!(run.code, 1, "{option}: {}", run.err);
        assert!(run.err.contains("OBJ has neither"), "{}", run.err);
    }
    assert_eq!(
        estampe("render {} -o - --size 8x8 --time 1", &[&model]).code,
        0
    );
}

#[test]
fn the_alpha_of_a_texture_has_uses() {
    let folder = Folder::new();
    let image =
        "render builtin:sphere -o {} -q --size 16x16 --background none --margin 0.3 --color red";
    assert_eq!(estampe(image, &[&folder.path("t.png")]).code, 0);
    folder.with_file("m.mtl", "newmtl a\nmap_Kd t.png\n");
    let model = folder.with_file(
        "m.obj",
        "mtllib m.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
         f 1/1 2/2 3/3 4/4\n",
    );
    let of = |option: &str| {
        let words =
            format!("render {{}} -o - -q --size 32x32 --view front --background none {option}");
        let run = estampe(&words, &[&model]);
        assert_eq!(run.code, 0, "{option}: {}", run.err);
        run.out
    };
    assert!(of("") == of("--alpha auto") && of("--alpha auto") == of("--alpha opaque"));
    let (mask, blend) = (of("--alpha mask"), of("--alpha blend"));
    assert!(mask != of("") && blend != of("") && mask != blend);
}
