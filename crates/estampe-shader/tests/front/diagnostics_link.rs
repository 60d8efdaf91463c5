//! Stages that do not fit each other: the exact messages.

use estampe_ir::interface::Stage;
use estampe_shader::front::{Module, Options, Source, load, load_pair};
use estampe_shader::lower::lower;
use estampe_shader::program::{LinkError, StageSource, TextCompute, TextProgram};
use estampe_types::{Program, SampleType};

/// A vertex shader, a fragment shader, and what is said of them.
const PAIRS: &[(&str, &str, &str)] = &[
    (
        r#"#version 330 core
void main() { gl_Position = vec4(1.0); }
"#,
        r#"#version 330 core
layout(location = 2) in vec4 v;
out vec4 c;
void main() { c = v; }
"#,
        r#"a.frag:2:30: error: the vertex shader has no output at location 2
  layout(location = 2) in vec4 v;
                               ^
  help: add an `out` with this location to it"#,
    ),
    (
        r#"#version 330 core
void main() { gl_Position = vec4(1.0); }
"#,
        r#"#version 330 core
in vec4 tangent;
out vec4 c;
void main() { c = tangent; }
"#,
        r#"a.frag:2:9: error: the vertex shader has no output `tangent`
  in vec4 tangent;
          ^^^^^^^
  help: declare it there with `out`, and give it a value"#,
    ),
    (
        r#"#version 330 core
uniform sampler2D map;
void main() { gl_Position = texture(map, vec2(0.0)); }
"#,
        r#"#version 330 core
uniform samplerCube map;
out vec4 c;
void main() { c = texture(map, vec3(0.0)); }
"#,
        r#"a.frag:2:21: error: the sampler `map` has another type in the vertex shader
  uniform samplerCube map;
                      ^^^
  help: declare it with one type in both, or rename one of them"#,
    ),
];

#[test]
fn pairs_in_glsl() {
    let options = |file: &str| Options {
        file: Some(file.to_owned()),
        ..Options::default()
    };
    for &(vertex, fragment, expected) in PAIRS {
        let source = |text, stage| Source::Glsl { text, stage };
        let errors = load_pair(
            (source(vertex, Stage::Vertex), &options("a.vert")),
            (source(fragment, Stage::Fragment), &options("a.frag")),
        )
        .expect_err(expected);
        assert_eq!(errors.to_string(), expected);
    }
}

fn wgsl(text: &str) -> Module {
    load(Source::Wgsl(text), &Options::default()).unwrap_or_else(|errors| panic!("{errors}"))
}

fn lowered(text: &str, entry_point: usize) -> StageSource {
    let module = wgsl(text);
    lower(&module.module, &module.info, entry_point).unwrap_or_else(|error| panic!("{error}"))
}

/// Why a module's first two entry points make no program.
#[track_caller]
fn refused(text: &str) -> String {
    let (vertex, fragment) = (lowered(text, 0), lowered(text, 1));
    let made = TextProgram::new(&vertex, Some(&fragment), u64::MAX);
    made.expect_err("they do not fit").to_string()
}

const OUT: &str =
    "struct Out { @builtin(position) p: vec4f, @location(1) @interpolate(flat) v: vec2f }
@vertex fn v() -> Out { var out: Out; return out; }
";

#[test]
fn varyings_are_written_and_alike() {
    let with = |fragment: &str| refused(&format!("{OUT}{fragment}"));
    assert_eq!(
        with("@fragment fn f(@location(2) v: f32) -> @location(0) vec4f { return vec4f(v); }"),
        "the fragment shader reads location 2, which the vertex shader does not write: \
         write it there, or do not read it"
    );
    assert_eq!(
        with(
            "@fragment fn f(@location(1) @interpolate(flat) v: vec3f) -> @location(0) vec4f
            { return vec4f(v, 1.0); }"
        ),
        "the fragment shader reads 3 scalars of location 1, of which the vertex shader writes 2: \
         give both the same type"
    );
    assert_eq!(
        with("@fragment fn f(@location(1) v: vec2f) -> @location(0) vec4f { return v.xyxy; }"),
        "location 1 is Flat in the vertex shader and Smooth in the fragment shader: \
         declare the same interpolation in both"
    );
}

#[test]
fn vertices_store_nothing_and_stages_agree_on_bindings() {
    assert_eq!(
        refused(
            "@group(0) @binding(0) var<storage, read_write> n: u32;
            @vertex fn v() -> @builtin(position) vec4f { n = 1u; return vec4f(); }
            @fragment fn f() -> @location(0) vec4f { return vec4f(); }"
        ),
        "the vertex shader stores to a buffer or texture: vertices may be shaded more than once; \
         store in the fragment shader or in a compute shader"
    );
    assert_eq!(
        refused(
            "@group(0) @binding(3) var<uniform> a: vec4f;
            @group(0) @binding(3) var s: sampler;
            @group(0) @binding(4) var t: texture_2d<f32>;
            @vertex fn v() -> @builtin(position) vec4f { return a; }
            @fragment fn f() -> @location(0) vec4f { return textureSample(t, s, vec2f()); }"
        ),
        "group 0, binding 3 is a uniform buffer in the vertex shader and a sampler in the fragment \
         shader: give one of them another number"
    );
}

#[test]
fn work_groups_are_small() {
    let source = lowered("@compute @workgroup_size(512, 256) fn main() { }", 0);
    let error = TextCompute::new(&source, u64::MAX).expect_err("it is large");
    assert_eq!(
        error,
        LinkError::Invocations {
            size: [512, 256, 1]
        }
    );
    assert_eq!(
        error.to_string(),
        "work-groups of 512x256x1 invocations: at most 65536 together"
    );
}

/// What lowering refuses, which has no place in the text.
#[test]
fn what_is_not_lowered_is_told() {
    let module = wgsl("@compute @workgroup_size(1) fn main() { }");
    let missing = lower(&module.module, &module.info, 1).expect_err("it has one");
    assert_eq!(missing.to_string(), "there is no entry point number 1");
    let module = wgsl(
        "override n: u32;
        var<workgroup> w: array<f32, n>;
        @compute @workgroup_size(1) fn main() { w[0] = 1.0; }",
    );
    let open = lower(&module.module, &module.info, 0).expect_err("`n` has no value");
    assert_eq!(
        open.to_string(),
        "values of arrays of unknown size are not supported yet"
    );
}

/// The types that a program tells of its colours, by location.
#[track_caller]
fn color_types(fragment: &str) -> Vec<Option<SampleType>> {
    let text =
        format!("{fragment}\n@vertex fn v() -> @builtin(position) vec4f {{ return vec4f(); }}");
    let (vertex, fragment) = (lowered(&text, 1), lowered(&text, 0));
    let program = TextProgram::new(&vertex, Some(&fragment), u64::MAX).expect("they fit");
    program.interface().color_types.clone()
}

#[test]
fn the_types_of_colors_are_told_by_location() {
    use SampleType::{Float, Sint, Uint};
    assert_eq!(
        color_types("@fragment fn f() -> @location(0) vec4f { return vec4f(); }"),
        [Some(Float)]
    );
    assert_eq!(
        color_types(
            "struct Colors { @location(3) a: vec2i, @location(0) b: u32, @location(2) c: f32 }
            @fragment fn f() -> Colors { return Colors(); }"
        ),
        [Some(Uint), None, Some(Float), Some(Sint)]
    );
    assert_eq!(
        color_types("enable f16; @fragment fn f() -> @location(0) vec4h { return vec4h(); }"),
        [Some(Float)]
    );
    assert_eq!(color_types("@fragment fn f() { }"), []);
}

/// A list by location must not be as long as a hostile text says.
#[test]
fn large_locations_are_refused() {
    for (text, is_right) in [
        ("@fragment fn f() -> @location(255) u32 { return 1; }", true),
        (
            "@fragment fn f() -> @location(256) u32 { return 1; }",
            false,
        ),
        ("@fragment fn f(@location(1000000) a: f32) { }", false),
        (
            "@vertex fn v(@location(256) a: f32) -> @builtin(position) vec4f { return vec4f(a); }",
            false,
        ),
    ] {
        let module = wgsl(text);
        let said = lower(&module.module, &module.info, 0)
            .err()
            .map(|error| error.to_string());
        let refusal = "locations above 255 are not supported yet";
        assert_eq!(said.as_deref(), (!is_right).then_some(refusal), "{text}");
    }
}
