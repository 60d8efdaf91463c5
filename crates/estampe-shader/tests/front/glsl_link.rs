//! Vertex and fragment shaders in GLSL, linked by name; versions and built-ins.

use estampe_ir::interface::Stage;
use estampe_shader::front::{BindingKind, ClipSpace, Module, Options, ShaderErrors, Source};
use estampe_shader::front::{load, load_pair};
use estampe_shader::lower::lower;

fn pair(vertex: &str, fragment: &str) -> Result<(Module, Module), ShaderErrors> {
    let options = |file: &str| Options {
        file: Some(file.to_owned()),
        ..Options::default()
    };
    let source = |text, stage| Source::Glsl { text, stage };
    load_pair(
        (source(vertex, Stage::Vertex), &options("a.vert")),
        (source(fragment, Stage::Fragment), &options("a.frag")),
    )
}

#[track_caller]
fn loaded(text: &str, stage: Stage) -> Module {
    load(Source::Glsl { text, stage }, &Options::default())
        .unwrap_or_else(|errors| panic!("{errors}"))
}

const VERTEX: &str = "#version 330 core
in vec3 p;
out vec3 normal;
out vec2 uv;
out float extra;
uniform vec4 tint;
void main() { normal = p; uv = p.xy; extra = 1.0; gl_Position = tint; }
";

#[test]
fn inputs_are_found_by_name_in_any_order() {
    let fragment = "#version 330 core
in vec2 uv;
in vec3 unused;
in vec3 normal;
out vec4 color;
void main() { color = vec4(normal, uv.x); }
";
    let (vertex, fragment) = pair(VERTEX, fragment).unwrap_or_else(|errors| panic!("{errors}"));
    let given = |name: &str| {
        let mut outputs = vertex.reflection.outputs[0].iter();
        outputs
            .find(|output| output.name == name)
            .map(|output| output.location)
    };
    let inputs = &fragment.reflection.inputs[0];
    assert_eq!(inputs.len(), 2, "what nothing reads is left out");
    for input in inputs {
        assert_eq!(Some(input.location), given(&input.name), "{}", input.name);
    }
}

#[track_caller]
fn check_pair(fragment: &str, expected: &str) {
    let text = format!("#version 330 core\nout vec4 color;\n{fragment}");
    let errors = pair(VERTEX, &text).expect_err(fragment);
    assert_eq!(errors.to_string(), expected);
}

#[test]
fn what_does_not_fit_is_told() {
    check_pair(
        "in vec3 normals;\nvoid main() { color = vec4(normals, 1.0); }\n",
        "a.frag:3:9: error: the vertex shader has no output `normals`\n  in vec3 normals;\n  \
         \x20       ^^^^^^^\n  help: it has `normal`: use one name in both",
    );
    check_pair(
        "in vec3 uv;\nvoid main() { color = vec4(uv, 1.0); }\n",
        "a.frag:3:9: error: `uv` is `vec3` here, but the vertex shader writes `vec2`\n  \
         in vec3 uv;\n          ^^\n  help: declare it with one type in both",
    );
    check_pair(
        "uniform vec3 tint;\nvoid main() { color = vec4(tint, 1.0); }\n",
        "a.frag:3:14: error: the uniform `tint` is `vec3` here, but `vec4` in the vertex shader\n  \
         uniform vec3 tint;\n               ^^^^\n  \
         help: declare it with one type in both, or rename one of them",
    );
}

#[test]
fn errors_name_the_file_of_their_shader() {
    let errors = pair("#version 330\nvoid main() { x }\n", "").expect_err("wrong");
    assert_eq!(errors.errors[0].file.as_deref(), Some("a.vert"));
    let errors = pair(VERTEX, "void main() { x; }\n").expect_err("wrong");
    assert_eq!(errors.errors[0].file.as_deref(), Some("a.frag"));
    assert_eq!((errors.errors[0].line, errors.errors[0].column), (1, 15));
}

/// Blocks between stages match by the block's name; matrices and arrays take several locations.
/// The uniforms of both shaders are in one block, textures have one list of bindings.
#[test]
fn blocks_structures_and_matrices_pass() {
    let vertex = "#version 330 core
layout (location = 3) in mat4 instance;
in vec3 position;
out VS_OUT { vec3 at; mat3 tbn; float list[2]; } vs_out;
uniform sampler2D heights;
struct Wind { vec3 direction; float force; };
uniform Wind wind;
void main() {
    vs_out.at = position + wind.direction * textureLod(heights, position.xy, 0.0).x;
    vs_out.tbn = mat3(instance);
    vs_out.list[0] = 1.0;
    vs_out.list[1] = wind.force;
    gl_Position = instance * vec4(position, 1.0);
}
";
    let fragment = "#version 330 core
in VS_OUT { vec3 at; mat3 tbn; float list[2]; } fs_in;
uniform sampler2D heights;
uniform sampler2D colors;
uniform vec3 view;
out vec4 color;
void main() {
    color = vec4(fs_in.tbn * (fs_in.at - view), fs_in.list[1]);
    color += texture(heights, vec2(0.5)) + texture(colors, vec2(0.5));
}
";
    let (vertex, fragment) = pair(vertex, fragment).unwrap_or_else(|errors| panic!("{errors}"));
    let locations = |module: &Module| -> Vec<u32> {
        module.reflection.inputs[0]
            .iter()
            .map(|input| input.location)
            .collect()
    };
    assert_eq!(locations(&vertex), [0, 3, 4, 5, 6]);
    assert_eq!(locations(&fragment), [0, 1, 2, 3, 4, 5]);
    assert_eq!(vertex.reflection.outputs[0], fragment.reflection.inputs[0]);
    let slot = |module: &Module, name: &str| {
        let mut pairs = module.reflection.combined_samplers.iter();
        pairs
            .find(|pair| pair.name == name)
            .map(|pair| (pair.texture, pair.sampler))
    };
    assert_eq!(slot(&vertex, "heights"), Some(((0, 1), (0, 2))));
    assert_eq!(slot(&fragment, "heights"), Some(((0, 1), (0, 2))));
    assert_eq!(slot(&fragment, "colors"), Some(((0, 3), (0, 4))));
    let force = |module: &Module| {
        module
            .reflection
            .uniform("wind.force")
            .map(|found| found.1.offset)
    };
    assert_eq!(force(&vertex), Some(12));
    assert_eq!(force(&fragment), Some(12));
    assert_eq!(
        fragment
            .reflection
            .uniform("view")
            .map(|found| found.1.offset),
        Some(16)
    );
    for module in [&vertex, &fragment] {
        lower(&module.module, &module.info, 0).expect("it lowers");
    }
}

/// GLSL of OpenGL ES 2 and WebGL 1.
#[test]
fn the_first_webgl_is_read() {
    let vertex = "attribute vec3 position;
uniform mat4 matrix;
varying vec2 v_uv;
void main() { v_uv = position.xy; gl_Position = matrix * vec4(position, 1.0); gl_PointSize = 2.0; }
";
    let fragment = "#version 100
#ifdef GL_ES
precision mediump float;
#endif
varying vec2 v_uv;
uniform sampler2D sampler;
uniform lowp vec4 tint;
void main() {
    highp vec4 c = texture2D(sampler, v_uv) * tint;
    if (c.a < 0.5) discard;
    gl_FragColor = c;
}
";
    let (_, fragment) = pair(vertex, fragment).unwrap_or_else(|errors| panic!("{errors}"));
    assert_eq!(fragment.reflection.combined_samplers[0].name, "sampler");
    assert_eq!(fragment.reflection.outputs[0][0].name, "gl_FragColor");
    assert_eq!(
        fragment
            .reflection
            .uniform("tint")
            .map(|found| found.1.offset),
        Some(64)
    );
}

/// Built-ins of all stages, and what version 300 es writes.
#[test]
fn built_in_variables_are_read_and_written() {
    let vertex = loaded(
        "#version 330
out float gl_ClipDistance[2];
flat out int id;
uniform vec4 plane;
void main() {
    gl_Position = vec4(float(gl_VertexID), float(gl_InstanceID), 0.0, 1.0);
    gl_ClipDistance[0] = dot(gl_Position, plane);
    gl_ClipDistance[1] = 1.0;
    id = gl_VertexID + 1;
}
",
        Stage::Vertex,
    );
    lower(&vertex.module, &vertex.info, 0).expect("it lowers");
    assert!(vertex.reflection.outputs[0][0].is_flat);
    let fragment = loaded(
        "#version 300 es
precision highp float;
precision highp sampler2D;
flat in int id;
layout(location = 0) out vec4 a;
layout(location = 1) out vec4 b;
void main() {
    a = gl_FragCoord;
    b = vec4(gl_FrontFacing ? 1.0 : 0.0, float(id), 0.0, 1.0);
    gl_FragDepth = gl_FragCoord.z * 0.5;
}
",
        Stage::Fragment,
    );
    lower(&fragment.module, &fragment.info, 0).expect("it lowers");
    assert_eq!(fragment.reflection.outputs[0].len(), 2);
    let many = loaded(
        "void main() { gl_FragData[0] = vec4(1.0); gl_FragData[2] = vec4(gl_FragCoord.x); }",
        Stage::Fragment,
    );
    let targets: Vec<_> = many.reflection.outputs[0]
        .iter()
        .map(|target| target.location)
        .collect();
    assert_eq!(targets, [0, 2]);
    let compute = loaded(
        "#version 430
#define SIZE 8
layout(local_size_x = SIZE, local_size_y = SIZE) in;
layout(std430, binding = 0) buffer Data { float values[]; } data;
layout(rgba8, binding = 1) writeonly uniform image2D picture;
shared float tile[SIZE * SIZE];
void main() {
    uint at = gl_LocalInvocationIndex;
    tile[at] = data.values[gl_GlobalInvocationID.x];
    memoryBarrierShared();
    barrier();
    data.values[gl_GlobalInvocationID.x] = tile[63u - at] * float(gl_WorkGroupSize.x);
    imageStore(picture, ivec2(gl_GlobalInvocationID.xy), vec4(tile[0]));
}
",
        Stage::Compute,
    );
    assert_eq!(compute.entry_points[0].workgroup_size, [8, 8, 1]);
    assert_eq!(
        compute
            .reflection
            .binding("Data")
            .map(|found| found.binding),
        Some(0)
    );
    let picture = compute.reflection.binding("picture").expect("an image");
    assert!(matches!(
        picture.kind,
        BindingKind::StorageTexture {
            is_written: true,
            ..
        }
    ));
}

/// Vulkan's GLSL keeps its numbers; combined samplers get a free one for the sampler.
#[test]
fn the_glsl_of_vulkan_keeps_its_numbers() {
    let module = loaded(
        "#version 450
layout(set = 0, binding = 1) uniform texture2D t;
layout(set = 0, binding = 2) uniform sampler s;
layout(set = 1, binding = 0) uniform sampler2D both;
layout(push_constant) uniform Push { vec4 color; } push;
layout(constant_id = 3) const int count = 2;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() {
    color = texture(sampler2D(t, s), uv) * push.color * texture(both, uv) * float(count);
}
",
        Stage::Fragment,
    );
    assert_eq!(module.reflection.combined_samplers[0].texture, (1, 0));
    assert_eq!(module.reflection.combined_samplers[0].sampler, (1, 1));
    assert_eq!(module.reflection.push_constant_size, 16);
    assert_eq!(module.reflection.overrides[0].id, Some(3));
    let given = [("3".to_owned(), 5.0)];
    let settled = module.specialize(None, &given).expect("a value");
    assert!(settled.reflection.overrides.is_empty());
}

/// Push constants have the layout of storage buffers, the offsets that are given, and truth values.
#[test]
fn push_constants_are_laid_out_as_std430() {
    let text = |members: &str, layout: &str| {
        format!(
            "#version 450
struct Item {{ vec3 at; float size; }};
layout({layout}) uniform Push {{ {members} }} push;
layout(location = 0) out vec4 color;
void main() {{ color = vec4(float(push.last)); }}
"
        )
    };
    let places = |members: &str, layout: &str| -> Vec<(String, u32)> {
        let module = loaded(&text(members, layout), Stage::Fragment);
        let block = &module.reflection.blocks[0];
        assert_eq!(block.slot, None);
        let members = block.members.iter();
        members
            .map(|member| (member.name.clone(), member.offset))
            .collect()
    };
    let named = |list: &[(&str, u32)]| -> Vec<(String, u32)> {
        let list = list.iter();
        list.map(|(name, offset)| ((*name).to_owned(), *offset))
            .collect()
    };
    let members = "float list[3]; mat2 m; bool flag; Item items[2]; float last;";
    let expected = [
        ("list", 0),
        ("m", 16),
        ("flag", 32),
        ("items[0].at", 48),
        ("items[0].size", 60),
        ("items[1].at", 64),
        ("items[1].size", 76),
        ("last", 80),
    ];
    assert_eq!(places(members, "push_constant"), named(&expected));
    let expected = [("list", 0), ("last", 48)];
    assert_eq!(
        places("float list[3]; float last;", "push_constant, std140"),
        named(&expected)
    );
    let members = "layout(offset = 64) float first; layout(offset = 80) vec2 list[2]; vec3 last3; \
                   layout(offset = 124) bool last;";
    let expected = [("first", 64), ("list", 80), ("last3", 96), ("last", 124)];
    assert_eq!(places(members, "push_constant"), named(&expected));

    let source = text(
        "vec4 first; layout(offset = 8) float last;",
        "push_constant",
    );
    let source = Source::Glsl {
        text: &source,
        stage: Stage::Fragment,
    };
    let errors = load(source, &Options::default()).expect_err("it overlaps");
    let error = errors.to_string();
    assert!(error.contains("`last` cannot begin at byte 8"), "{error}");
    assert!(error.contains("ends at byte 16"), "{error}");
}

#[test]
fn clip_space_is_an_option() {
    let text = "#version 330\nin vec4 p;\nvoid main() { gl_Position = p; }\n";
    let length = |clip_space| {
        let options = Options {
            clip_space,
            ..Options::default()
        };
        let source = Source::Glsl {
            text,
            stage: Stage::Vertex,
        };
        let module = load(source, &options).unwrap_or_else(|errors| panic!("{errors}"));
        let functions = module.module.functions.iter();
        functions
            .map(|(_, function)| function.expressions.len())
            .sum::<usize>()
    };
    assert!(length(Some(ClipSpace::OpenGl)) > length(Some(ClipSpace::Webgpu)));
    assert_eq!(length(None), length(Some(ClipSpace::OpenGl)));
}
