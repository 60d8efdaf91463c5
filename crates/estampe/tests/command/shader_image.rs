//! `estampe shader image` end to end: pictures of WGSL, GLSL and SPIR-V, their resources, mistakes.

use crate::support::Folder;
use crate::support::picture::Picture;
use crate::support::shell::run;

/// u red, v green, and a uniform blue.
const UV: &str = "\
struct Tint { blue: f32, time: f32, gains: array<vec4f, 2> }
@group(0) @binding(0) var<uniform> tint: Tint;
override levels: f32 = 255.0;
@fragment fn uv(@location(0) uv: vec2f, @location(3) @interpolate(flat) n: vec2i) -> @location(0) vec4f {
    return vec4f(uv + vec2f(n), tint.blue / levels + tint.time * tint.gains[1].y, 1.0);
}
@fragment fn other() -> @location(0) vec4f { return vec4f(0.0); }
";

fn draw(folder: &Folder, words: &str) -> Picture {
    let done = run(
        &format!("estampe shader image {words} -q -o out.png"),
        folder,
    );
    assert_eq!((done.code, &*done.err), (0, ""), "{words}");
    Picture::open(&folder.path("out.png"))
}

/// Rows: G2.
#[test]
fn inputs_are_the_place_in_the_picture() {
    let folder = Folder::new();
    folder.with_file("a.wgsl", UV);
    let options = "--entry uv --size 4x2 --set blue=51 --time 0.5 --set gains[1]=0,0.4,0,0";
    let picture = draw(&folder, &format!("a.wgsl {options}"));
    assert_eq!((picture.width, picture.height), (4, 2));
    // (x + ½)/4, (y + ½)/2, 51/255 + 0.5·0.4.
    assert_eq!(picture.pixel(0, 0), [32, 64, 102, 255]);
    assert_eq!(picture.pixel(3, 1), [223, 191, 102, 255]);
    let whole = draw(
        &folder,
        "a.wgsl --entry uv --size 4x2 -D levels=51 --set tint.blue=51",
    );
    assert_eq!(whole.pixel(0, 0), [32, 64, 255, 255]);
    let turned = draw(&folder, "a.wgsl --entry uv --size 4x2 --origin bottom");
    assert_eq!(turned.pixel(0, 1), [32, 64, 0, 255]);
}

#[test]
fn uniforms_and_inputs_of_16_bits_are_set() {
    let text = "enable f16;
        struct Small { tint: vec3h, time: f16, turn: mat2x2h, last: f16 }
        @group(0) @binding(0) var<uniform> small: Small;
        @fragment fn main(@location(0) uv: vec2h) -> @location(0) vec4f {
            let at = small.turn * uv;
            return vec4f(f32(at.x), f32(small.tint.y), f32(small.tint.z * small.time + small.last), 1.0);
        }";
    let folder = Folder::new();
    folder.with_file("a.wgsl", text);
    let options = "--size 2x2 --set tint=0,0.2,0.4 --time 0.5 --set turn=0,0,1,0 --set last=0.2";
    let picture = draw(&folder, &format!("a.wgsl {options}"));
    // The first row's v, 1/4, and the second one's; 0.2 + 0.4 / 2.
    assert_eq!(picture.pixel(0, 0), [64, 51, 102, 255]);
    assert_eq!(picture.pixel(1, 1), [191, 51, 102, 255]);
}

/// GLSL has its first row at the bottom; toys get a main; common uniforms are set.
/// Rows: G1.
#[test]
fn toys_of_glsl_are_drawn() {
    let folder = Folder::new();
    folder.with_file(
        "toy.glsl",
        "void mainImage(out vec4 color, in vec2 at) {\n  vec2 p = at / iResolution.xy;\n  \
         color = vec4(p, iTime, 0.0) + texture(iChannel0, p) * 0.0;\n}\n",
    );
    folder.with_file(
        "old.frag",
        "uniform vec2 u_resolution;\nuniform float time;\nvarying vec2 v;\n\
         void main() { gl_FragColor = vec4(gl_FragCoord.xy / u_resolution, time, v.y); }\n",
    );
    draw(&folder, "old.frag --size 2x2");
    std::fs::rename(folder.path("out.png"), folder.path("in.png")).expect("it was drawn");
    let options = "--size 4x2 --time 0.2";
    let toy = draw(
        &folder,
        &format!("toy.glsl {options} --texture iChannel0=in.png"),
    );
    assert_eq!(toy.pixel(0, 1), [32, 64, 51, 255], "the bottom left");
    assert_eq!(toy.pixel(3, 0), [223, 191, 51, 255]);
    let old = draw(&folder, &format!("old.frag {options}"));
    assert_eq!(old.pixel(0, 1), [32, 64, 51, 64]);

    // Errors count the author's lines.
    folder.with_file(
        "bad.glsl",
        "void mainImage(out vec4 c, in vec2 p) {\n  c = vec4(nix, iTime);\n}\n",
    );
    let done = run("estampe shader image bad.glsl -o out2.png", &folder);
    assert_eq!(done.code, 1);
    assert!(
        done.err.starts_with("estampe shader image: bad.glsl:2:"),
        "{}",
        done.err
    );
    assert!(
        done.err.contains("\n    c = vec4(nix, iTime);\n"),
        "{}",
        done.err
    );
    assert!(!folder.path("out2.png").exists());
}

/// The bytes do not depend on threads, or on what runs the shader.
/// Rows: G1, G2.
#[test]
fn pictures_are_the_same_on_every_machine() {
    let folder = Folder::new();
    folder.with_file(
        "a.wgsl",
        "@fragment fn f(@location(1) p: vec4f) -> @location(0) vec4f {\n\
         var z = p.xy * 3.0 - vec2f(2.0, 1.5); let c = z; var n = 0;\n\
         while n < 60 && dot(z, z) < 4.0 { z = vec2f(z.x * z.x - z.y * z.y, 2.0 * z.x * z.y) + c; n++; }\n\
         return vec4f(sin(vec3f(0.2, 0.3, 0.4) * f32(n)) * 0.5 + fwidth(z.x) * 0.001 + 0.5, 1.0); }\n",
    );
    let mut all: Vec<Vec<u8>> = Vec::new();
    let mut machines = vec![
        "--threads 1",
        "--threads 2",
        "--via interpreter --threads 2",
    ];
    let available: Vec<&str> = estampe::Level::all_available()
        .iter()
        .map(|level| level.name())
        .collect();
    for level in ["avx2", "avx512"] {
        if available.contains(&level) {
            machines.push(if level == "avx2" {
                "--via avx2"
            } else {
                "--via avx512"
            });
        }
    }
    for machine in machines {
        let line = format!("estampe shader image a.wgsl -q -o - --size 90x60 {machine}");
        let done = run(&line, &folder);
        assert_eq!(done.code, 0, "{machine}: {}", done.err);
        all.push(done.out);
    }
    assert!(Picture::read(&all[0]).color_count() > 20);
    assert!(all.iter().all(|bytes| *bytes == all[0]));
}

/// Buffers are the bytes of files; samplers and textures are found by their names.
/// Rows: G2.
#[test]
fn buffers_and_textures_are_those_of_the_options() {
    let folder = Folder::new();
    folder.with_file("a.wgsl", UV);
    draw(&folder, "a.wgsl --entry uv --size 2x2");
    std::fs::rename(folder.path("out.png"), folder.path("in.png")).expect("it was drawn");
    folder.with_file(
        "b.wgsl",
        "@group(0) @binding(0) var picture: texture_2d<f32>;\n\
         @group(0) @binding(1) var linear: sampler;\n\
         @group(1) @binding(0) var<storage, read> plane: array<f32>;\n\
         @fragment fn f(@location(0) uv: vec2f) -> @location(0) vec4f {\n\
         return vec4f(textureSample(picture, linear, uv).rg, plane[1], 1.0); }\n",
    );
    let plane: Vec<u8> = [0.0_f32, 0.6]
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    folder.with_file("plane.bin", plane);
    let options = "--size 2x2 --texture picture=in.png --buffer 1,0=plane.bin";
    let picture = draw(&folder, &format!("b.wgsl {options}"));
    assert_eq!(picture.pixel(0, 0), [64, 64, 153, 255]);
    assert_eq!(picture.pixel(1, 1), [191, 191, 153, 255]);
    let by_number = "--size 2x2 --texture 0,0=in.png --buffer 1,0=zeros:8";
    assert_eq!(
        draw(&folder, &format!("b.wgsl {by_number}")).pixel(0, 1),
        [64, 191, 0, 255]
    );
}

/// SPIR-V is checked, described, and drawn as the WGSL of which naga wrote it.
/// Rows: G3.
#[test]
fn spirv_draws_what_its_wgsl_does() {
    let folder = Folder::new();
    folder.with_file("a.spv", include_bytes!("support/tinted.spv"));
    folder.with_file(
        "a.wgsl",
        "@group(0) @binding(0) var<uniform> tint: vec4f;\n\
         @fragment fn fs(@location(0) color: vec3f) -> @location(0) vec4f {\n\
         return vec4f(color, 1.0) * tint; }\n",
    );
    let tint: Vec<u8> = [0.5_f32, 1.0, 0.25, 1.0]
        .iter()
        .flat_map(|x| x.to_le_bytes())
        .collect();
    folder.with_file("tint.bin", tint);
    for (command, said) in [
        ("check a.spv", "a.spv: right: vertex `vs`, fragment `fs`"),
        ("reflect a.spv", "binding 0,0: uniform buffer"),
        ("dump a.spv --entry fs --stage ir", "kernel fragment"),
    ] {
        let done = run(&format!("estampe shader {command}"), &folder);
        let all = String::from_utf8_lossy(&done.out).into_owned() + &done.err;
        assert!(done.code == 0 && all.contains(said), "{command}: {all}");
    }
    let picture = draw(&folder, "a.spv --size 4x2 --buffer 0,0=tint.bin");
    assert_eq!(picture.pixel(3, 1), [112, 191, 0, 255]);
    std::fs::rename(folder.path("out.png"), folder.path("spv.png")).expect("it was drawn");
    draw(&folder, "a.wgsl --size 4x2 --set tint=0.5,1,0.25,1");
    let bytes = ["out.png", "spv.png"].map(|name| std::fs::read(folder.path(name)).expect("drawn"));
    assert_eq!(bytes[0], bytes[1]);
}

/// A picture whose shader never ends is drawn all the same, in seconds.
#[test]
fn endless_loops_are_stopped() {
    let folder = Folder::new();
    folder.with_file(
        "a.wgsl",
        "@group(0) @binding(0) var<uniform> zero: f32;\n\
         @fragment fn f(@location(0) uv: vec2f) -> @location(0) vec4f {\n\
         var x = uv.x; loop { x = x * 0.5 + zero; if x > 2.0 { break; } } return vec4f(x); }\n",
    );
    for options in [
        "--max-jumps 10000",
        "--max-jumps 10000 --via interpreter",
        "",
    ] {
        let words = format!("a.wgsl --size 32x16 {options} -q -o out.png");
        let done = run(&format!("estampe shader image {words}"), &folder);
        assert_eq!(done.code, 1, "{words}");
        assert!(done.err.contains("max_shader_jumps"), "{}", done.err);
        assert!(!folder.path("out.png").exists());
    }
}

#[test]
fn mistakes_say_what_to_do() {
    let folder = Folder::new();
    folder.with_file("a.wgsl", UV);
    folder.with_file(
        "v.wgsl",
        "@vertex fn v() -> @builtin(position) vec4f { return vec4f(); }",
    );
    folder.with_file(
        "t.frag",
        "uniform sampler2D wood; uniform bool on; uniform ivec2 n;\n\
         void main() { gl_FragColor = on ? texture2D(wood, vec2(n)) : vec4(0.0); }\n",
    );
    for (words, code, said) in [
        ("a.wgsl -o o.png", 2, "--entry"),
        ("a.wgsl -o o.png --entry nix", 2, "`uv`, `other`"),
        ("v.wgsl -o o.png", 1, "no fragment shader"),
        ("a.wgsl -o o.gif --entry uv", 2, ".png"),
        ("a.wgsl -o no/o.png --entry uv", 3, "folder"),
        ("a.wgsl -o o.png --size 0x5", 2, "WIDTHxHEIGHT"),
        ("a.wgsl -o o.png --time never", 2, "seconds"),
        ("a.wgsl -o o.png --via gpu", 2, "avx2"),
        ("a.wgsl -o o.png --entry uv --set red=1", 2, "`blue`"),
        ("a.wgsl -o o.png --entry uv --set blue=1,2", 2, "1 number"),
        (
            "a.wgsl -o o.png --entry uv --set gains[2]=1,2,3,4",
            2,
            "2 elements",
        ),
        (
            "a.wgsl -o o.png --entry uv --set gains=1,2,3",
            2,
            "8 numbers",
        ),
        ("a.wgsl -o o.png --entry uv --buffer 0,0=zeros:4", 2, "48"),
        (
            "a.wgsl -o o.png --entry uv --buffer 0,1=zeros:4",
            2,
            "`tint`",
        ),
        (
            "a.wgsl -o o.png --entry uv --buffer 0,0=no.bin",
            1,
            "no such file",
        ),
        ("t.frag -o o.png", 2, "--texture wood=FILE"),
        ("t.frag -o o.png --texture oak=a.png", 2, "`wood`"),
        ("t.frag -o o.png --texture wood=a.wgsl", 1, "a.wgsl"),
        ("t.frag -o o.png --set on=maybe", 2, "true and false"),
        ("t.frag -o o.png --set n=1,0.5", 2, "2 integers"),
        ("missing.frag -o o.png", 1, "no such file"),
    ] {
        let done = run(&format!("estampe shader image {words}"), &folder);
        assert_eq!(done.code, code, "{words}: {}", done.err);
        assert!(done.err.contains(said), "{words}: {}", done.err);
        assert!(
            done.out.is_empty() && !folder.path("o.png").exists(),
            "{words}"
        );
    }
}

/// Rows: G2.
#[test]
fn immediates_are_given_with_the_picture() {
    let folder = Folder::new();
    folder.with_file(
        "a.wgsl",
        "struct P { red: f32, greens: array<f32, 2> }\nvar<immediate> p: P;\n\
         @fragment fn fs(@builtin(position) at: vec4f) -> @location(0) vec4f {\n\
             return vec4f(p.red, p.greens[u32(at.x)], 0.0, 1.0);\n}\n",
    );
    // 1.0, 0.0, 0.5: 0x3f800000, 0, 0x3f000000.
    let picture = draw(
        &folder,
        "a.wgsl --size 2x1 --immediates hex:0000803f_00000000_0000003f",
    );
    assert_eq!(picture.pixel(0, 0), [255, 0, 0, 255]);
    assert_eq!(picture.pixel(1, 0), [255, 128, 0, 255]);
    let done = run("estampe shader image a.wgsl --size 2x1 -o b.png", &folder);
    assert_eq!(done.code, 2);
    assert!(
        done.err.contains("the shader reads 12 bytes of immediates"),
        "{}",
        done.err
    );
}
