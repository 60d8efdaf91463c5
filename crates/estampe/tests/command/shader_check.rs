//! `estampe shader check` end to end: exit codes, errors with their caret, JSON.

use crate::support::shell::run;
use crate::support::{Folder, estampe_fed};
use serde_json::Value;

const WGSL: &str = "\
override size: u32;
@group(0) @binding(0) var<storage, read_write> words: array<u32>;
@compute @workgroup_size(size) fn count(@builtin(local_invocation_index) i: u32) { words[i] = i; }
@fragment fn red() -> @location(0) vec4f { return vec4f(1.0, 0.0, 0.0, 1.0); }
";

const VERTEX: &str = "\
#version 330 core
in vec3 position;
out vec2 uv;
void main() { uv = position.xy; gl_Position = vec4(position, 1.0); }
";

const FRAGMENT: &str = "\
#version 330 core
in vec2 uv;
out vec4 color;
void main() { color = vec4(uv, LIGHT, 1.0); }
";

fn object(out: &[u8]) -> Value {
    serde_json::from_slice(out).expect("one object")
}

/// Rows: G1, G2, G3.
#[test]
fn right_shaders_end_with_0() {
    let folder = Folder::new();
    folder.with_file("a.wgsl", WGSL);
    folder.with_file("a.vert", VERTEX);
    folder.with_file("a.fs", FRAGMENT);
    folder.with_file("b.glsl", VERTEX);
    let checks = [
        ("a.wgsl", "a.wgsl: right: compute `count`, fragment `red`"),
        ("a.wgsl -D size=64", "right"),
        ("a.fs -D LIGHT=0.5", "a.fs: right: fragment `main`"),
        ("b.glsl", "b.glsl: right: vertex `main`"),
        ("b.glsl --stage vertex", "vertex"),
        (
            "--vertex a.vert --fragment a.fs -D LIGHT=1.0",
            "a.vert, a.fs: right: vertex `main`, fragment `main`",
        ),
    ];
    for (words, said) in checks {
        let done = run(&format!("estampe shader check {words}"), &folder);
        assert_eq!(done.code, 0, "{words}: {}", done.err);
        assert!(done.err.contains(said), "{words}: {}", done.err);
        assert!(done.out.is_empty(), "{words}");
        let done = run(&format!("estampe shader check {words} -q --json"), &folder);
        assert_eq!((done.code, &*done.err), (0, ""), "{words}");
        assert_eq!(object(&done.out)["ok"], true, "{words}");
    }
    let done = estampe_fed("shader check - -q", &[], WGSL.as_bytes());
    assert_eq!((done.code, &*done.err), (0, ""));
}

/// Each error has its line, and a caret below the place.
/// Rows: G1, G2.
#[test]
fn wrong_shaders_end_with_1_and_show_the_place() {
    let folder = Folder::new();
    folder.with_file("a.wgsl", "@fragment fn f() {\n  let x = missing + 1;\n}\n");
    folder.with_file("a.frag", "void main() {\n  gl_FragColor = vec3(1.0);\n}\n");
    folder.with_file("a.spv", [3, 2, 0x23, 7, 0, 0, 1, 0]);
    let done = run("estampe shader check a.wgsl", &folder);
    assert_eq!((done.code, done.out.len()), (1, 0), "{}", done.err);
    let lines: Vec<&str> = done.err.lines().collect();
    assert!(lines[0].starts_with("a.wgsl:2:11: error: "), "{}", done.err);
    assert_eq!(lines[1], "    let x = missing + 1;");
    assert_eq!(lines[2], "            ^^^^^^^");

    let done = run("estampe shader check a.frag --json", &folder);
    assert_eq!((done.code, &*done.err), (1, ""));
    let object = object(&done.out);
    assert_eq!(object["ok"], false);
    let error = &object["errors"][0];
    assert_eq!(
        (&error["line"], &error["file"]),
        (&2.into(), &"a.frag".into())
    );
    assert!(error["column"].as_u64() > Some(0), "{error}");
    assert!(
        error["message"]
            .as_str()
            .is_some_and(|message| message.contains("vec3")),
        "{error}"
    );

    let done = run("estampe shader check a.spv", &folder);
    assert_eq!(done.code, 1);
    assert!(done.err.starts_with("a.spv: error: "), "{}", done.err);
}

/// What the fragment shader reads and the vertex shader does not write is an error of both
/// together, in the file that reads it.
/// Rows: G2.
#[test]
fn the_stages_of_a_program_must_fit() {
    let folder = Folder::new();
    folder.with_file("a.vert", VERTEX);
    folder.with_file(
        "a.frag",
        "#version 330 core\nin vec4 tint;\nout vec4 c;\nvoid main() { c = tint; }\n",
    );
    let done = run("estampe shader check a.frag", &folder);
    assert_eq!(done.code, 0, "alone it is right: {}", done.err);
    let done = run(
        "estampe shader check --vertex a.vert --fragment a.frag",
        &folder,
    );
    assert_eq!(done.code, 1);
    assert!(
        done.err.contains("a.frag") && done.err.contains("tint"),
        "{}",
        done.err
    );
}

#[test]
fn mistakes_of_the_command_line_are_2() {
    let folder = Folder::new();
    folder.with_file("a.wgsl", WGSL);
    folder.with_file("notes.txt", "hello\n");
    folder.with_file("latin.wgsl", [b'/', b'/', 0xe9, b'\n']);
    for (words, code, said) in [
        ("", 2, "FILE"),
        ("a.wgsl --stage fragment", 2, "GLSL"),
        ("a.wgsl --stage geometry", 2, "--stage"),
        ("a.wgsl -D =3", 2, "NAME=VALUE"),
        ("a.wgsl -D depth=3", 2, "`size`"),
        ("a.wgsl -D size=big", 2, "a number"),
        ("--vertex a.wgsl", 2, "--fragment"),
        ("--vertex a.wgsl --fragment a.wgsl", 2, "GLSL"),
        ("notes.txt", 2, "--language"),
        ("missing.wgsl", 1, "no such file"),
        ("latin.wgsl", 1, "byte 2 is not UTF-8"),
    ] {
        let done = run(&format!("estampe shader check {words}"), &folder);
        assert_eq!(done.code, code, "{words}: {}", done.err);
        assert!(done.err.contains(said), "{words}: {}", done.err);
        assert!(done.out.is_empty(), "{words}");
    }
    let done = run("estampe shader check missing.wgsl --json", &folder);
    assert_eq!(object(&done.out)["exit_code"], 1);
}
