//! `estampe render --shader` end to end: templates, inputs and uniforms by name, mistakes.

use crate::support::picture::Picture;
use crate::support::shell::run;
use crate::support::{Folder, TETRAHEDRON, estampe};

/// The templates are shaders that work, with the same bytes on every machine.
/// Rows: G1, G2.
#[test]
fn templates_draw_the_same_everywhere() {
    let folder = Folder::new();
    for (language, name) in [("", "my.wgsl"), ("glsl", "my.frag")] {
        let done = run(&format!("estampe shader template {language}"), &folder);
        assert_eq!((done.code, &*done.err), (0, ""), "{name}");
        folder.with_file(name, done.out);
        let line = format!(
            "estampe render builtin:teapot -q --size 64x48 --shader {name} --set gloss=0.5 -o -"
        );
        let first = run(&line, &folder);
        assert_eq!((first.code, &*first.err), (0, ""), "{name}");
        let picture = Picture::read(&first.out);
        assert!(picture.color_count() > 60, "{name}");
        for machine in [
            "--threads 1",
            "--threads 2",
            "--via interpreter",
            "--simd auto",
        ] {
            let other = run(&format!("{line} {machine}"), &folder);
            assert!(
                other.code == 0 && other.out == first.out,
                "{name} {machine}"
            );
        }
    }
}

/// What `--shading normals` shows, by a shader in each language; stored numbers are encoded.
/// Rows: G1, G2.
#[test]
fn inputs_have_values_by_their_names() {
    let folder = Folder::new();
    folder.with_file(
        "a.wgsl",
        "@fragment fn f(@location(5) normal: vec3f, @location(0) uv: vec2f, @builtin(front_facing) front: bool)\n\
         -> @location(0) vec4f { let n = normalize(select(-normal, normal, front));\n\
         return vec4f(pow(n * 0.5 + 0.5, vec3f(2.2)), 1.0); }\n",
    );
    folder.with_file(
        "a.frag",
        "varying vec2 v_uv; varying vec3 vNormal;\n\
         void main() { vec3 n = normalize(gl_FrontFacing ? vNormal : -vNormal);\n\
         gl_FragColor = vec4(pow(n * 0.5 + 0.5, vec3(2.2)), 1.0); }\n",
    );
    let draw = |options: &str| {
        let line =
            format!("estampe render builtin:teapot -q --size 48x36 --samples 1 -o - {options}");
        let done = run(&line, &folder);
        assert_eq!((done.code, &*done.err), (0, ""), "{options}");
        Picture::read(&done.out)
    };
    let expected = draw("--shading normals");
    for shader in ["a.wgsl", "a.frag"] {
        let picture = draw(&format!("--shader {shader}"));
        let (mut most, mut covered) = (0, 0);
        for (x, y) in (0..36).flat_map(|y| (0..48).map(move |x| (x, y))) {
            let [a, b] = [picture.pixel(x, y), expected.pixel(x, y)];
            covered += u32::from(a != expected.pixel(0, 0));
            most = most.max((0..4).map(|c| a[c].abs_diff(b[c])).max().unwrap_or(0));
        }
        // x^2.2 is not quite the inverse of sRGB's function.
        assert!(most <= 10 && covered > 400, "{shader}: {most} {covered}");
    }
}

/// Rows: G2.
#[test]
fn uniforms_and_textures_are_those_of_the_options() {
    let folder = Folder::new();
    let model = folder.with_file("m.obj", TETRAHEDRON);
    folder.with_file(
        "a.wgsl",
        "struct U { tint: vec3f, uTime: f32, u_resolution: vec2f, baseColor: vec4f }\n\
         @group(0) @binding(0) var<uniform> u: U;\n\
         @group(1) @binding(1) var wood: texture_2d<f32>;\n\
         @group(1) @binding(2) var linear: sampler;\n\
         @fragment fn f(@location(2) at: vec2f) -> @location(0) vec4f {\n\
         let texel = textureSample(wood, linear, at).r * 0.0;\n\
         let is_right = u.u_resolution.x == 40.0 && u.uTime == 3.0 && u.baseColor.a == 1.0;\n\
         return vec4f(select(vec3f(1.0), u.tint, is_right) + texel, 1.0); }\n",
    );
    let texture = folder.path("t.png");
    assert_eq!(
        estampe("render builtin:cube -o {} -q --size 4x4", &[&texture]).code,
        0
    );
    let shader = folder.path("a.wgsl");
    let words = "render {} -o - -q --size 40x30 --samples 1 --shader {} --texture {} --time 3 --set tint=1,0,0";
    let done = estampe(words, &[&model, &shader, &texture]);
    assert_eq!((done.code, &*done.err), (0, ""));
    let picture = Picture::read(&done.out);
    assert_eq!(picture.pixel(20, 15), [255, 0, 0, 255]);
}

#[test]
fn mistakes_say_what_to_do() {
    let folder = Folder::new();
    folder.with_file(
        "a.wgsl",
        "@fragment fn f() -> @location(0) vec4f { return vec4f(x); }",
    );
    folder.with_file("b.wgsl", "@compute @workgroup_size(1) fn f() {}");
    folder.with_file(
        "c.wgsl",
        "@fragment fn f() -> @location(0) vec4f { return vec4f(1.0); }",
    );
    folder.with_file(
        "d.wgsl",
        "@group(0) @binding(0) var t: texture_2d<f32>; @group(0) @binding(1) var s: sampler;\n\
         @fragment fn f(@location(2) uv: vec2f) -> @location(0) vec4f { return textureSample(t, s, uv); }",
    );
    folder.with_file(
        "e.wgsl",
        "@vertex fn v(@location(6) p: vec3f) -> @builtin(position) vec4f { return vec4f(p, 1.0); }\n\
         @fragment fn f() -> @location(0) vec4f { return vec4f(1.0); }",
    );
    for (words, code, said) in [
        ("--shader a.wgsl", 1, "a.wgsl:1:55"),
        ("--shader b.wgsl", 1, "fragment"),
        ("--shader c.wgsl --set tint=1", 2, "no uniform `tint`"),
        ("--shader c.wgsl --shading flat", 2, "--shading"),
        ("--shader c.wgsl --via avx2 --simd avx2", 2, "--simd"),
        ("--set tint=1", 2, "--shader"),
        ("--shader d.wgsl", 2, "--texture"),
        ("--shader e.wgsl", 1, "location 6"),
        ("--shader missing.wgsl", 1, "no such file"),
    ] {
        let line = format!("estampe render builtin:cube -o o.png {words}");
        let done = run(&line, &folder);
        assert_eq!(done.code, code, "{words}: {}", done.err);
        assert!(done.err.contains(said), "{words}: {}", done.err);
        assert!(
            done.out.is_empty() && !folder.path("o.png").exists(),
            "{words}"
        );
    }
}
