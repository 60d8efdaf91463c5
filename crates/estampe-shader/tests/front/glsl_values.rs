//! GLSL that is loaded, lowered and executed: the values are those of the same formulas in Rust.

use std::collections::HashMap;

use estampe_ir::interface::{Input, Output, Stage};
use estampe_ir::op::TextureOp;
use estampe_ir::tree::{Surroundings, Tree, evaluate};
use estampe_shader::front::{Module, Options, Source, load, load_pair};
use estampe_shader::lower::lower;

/// What an invocation reads: inputs by what they are, one buffer of uniforms, textures of one
/// value.
#[derive(Default)]
struct World {
    tree: Option<Tree>,
    inputs: HashMap<Input, f32>,
    uniforms: Vec<u32>,
    none: Vec<u32>,
}

impl Surroundings for World {
    fn input(&mut self, at: usize) -> u32 {
        let input = self.tree.as_ref().expect("a tree").interface.inputs[at];
        match input {
            Input::Cover | Input::FrontFacing => 1,
            Input::VertexIndex => 7,
            other => self.inputs.get(&other).copied().unwrap_or(0.0).to_bits(),
        }
    }
    fn buffer(&mut self, _at: usize) -> &mut Vec<u32> {
        &mut self.uniforms
    }
    fn workgroup(&mut self) -> &mut Vec<u32> {
        &mut self.none
    }
    fn texture(&mut self, _op: &TextureOp, _operands: &[u32]) -> Vec<u32> {
        [0.25_f32, 0.5, 0.75, 1.0].map(f32::to_bits).to_vec()
    }
}

/// Executes a module's only entry point.
fn run(module: &Module, mut world: World) -> HashMap<Output, f32> {
    let stage = lower(&module.module, &module.info, 0).expect("it lowers");
    world.tree = Some(stage.tree.clone());
    let words = evaluate(&stage.tree, &mut world, 1 << 20).expect("it ends");
    let outputs = stage.tree.interface.outputs.iter().copied();
    outputs.zip(words.into_iter().map(f32::from_bits)).collect()
}

/// Writes a uniform's numbers where reflection says that it is.
fn set(module: &Module, uniforms: &mut Vec<u32>, name: &str, values: &[f32]) {
    let (block, member) = module
        .reflection
        .uniform(name)
        .unwrap_or_else(|| panic!("{name}"));
    uniforms.resize((block.size as usize / 4).max(uniforms.len()), 0);
    let first = member.offset as usize / 4;
    for (at, value) in values.iter().enumerate() {
        uniforms[first + at] = value.to_bits();
    }
}

#[track_caller]
fn load_fragment(text: &str) -> Module {
    let source = Source::Glsl {
        text,
        stage: Stage::Fragment,
    };
    load(source, &Options::default()).unwrap_or_else(|errors| panic!("{errors}"))
}

fn color(outputs: &HashMap<Output, f32>) -> [f32; 4] {
    [0, 1, 2, 3].map(|component| {
        let color = Output::Color {
            target: 0,
            component,
        };
        outputs[&color]
    })
}

/// Checks the colour of a fragment shader with `in vec4 v` of (1, 2, 3, 4).
#[track_caller]
fn check(head: &str, body: &str, expected: [f32; 4]) {
    let text =
        format!("#version 330 core\n{head}\nin vec4 v;\nout vec4 c;\nvoid main() {{ {body} }}\n");
    let module = load_fragment(&text);
    let mut world = World::default();
    let stage = lower(&module.module, &module.info, 0).expect("it lowers");
    for scalar in 0..4_u8 {
        let input = Input::Varying(u32::from(scalar));
        assert!(stage.tree.interface.inputs.len() <= 16);
        world.inputs.insert(input, f32::from(scalar) + 1.0);
    }
    assert_eq!(color(&run(&module, world)), expected, "{text}");
}

const VERTEX: &str = "#version 330 core
layout (location = 0) in vec3 vertex_position;
layout (location = 1) in vec3 vertex_normal;
layout (location = 2) in vec3 vertex_color;
out struct fragment_data { vec3 position; vec3 normal; vec3 color; } fragment;
uniform mat4 model;
uniform mat4 view;
uniform mat4 projection;
void main() {
    vec4 position = model * vec4(vertex_position, 1.0);
    mat4 modelNormal = transpose(inverse(model));
    vec4 normal = modelNormal * vec4(vertex_normal, 0.0);
    fragment.position = position.xyz;
    fragment.normal = normal.xyz;
    fragment.color = vertex_color;
    gl_Position = projection * view * position;
}
";

const FRAGMENT: &str = "#version 330 core
in struct fragment_data { vec3 position; vec3 normal; vec3 color; } fragment;
uniform vec3 light_position;
uniform vec3 light_color;
layout(location=0) out vec4 FragColor;
uniform mat4 model;
uniform mat4 view;
uniform mat4 projection;
uniform float a_ambient, a_diffuse, a_specular, specular_magnitude;
void main() {
    vec3 N = normalize(fragment.normal);
    vec3 L = normalize(light_position - fragment.position);
    float diffuse_magnitude = max(dot(N, L), 0.0);
    vec3 c = a_ambient * fragment.color * light_color;
    c = c + a_diffuse * diffuse_magnitude * fragment.color * light_color;
    c = c + a_specular * specular_magnitude * light_color;
    FragColor = vec4(c, 1.0);
}
";

/// The shaders of the course, with what they leave out as uniforms.
#[test]
fn the_pair_of_the_course_runs() {
    let options = Options::default();
    let (vertex, fragment) = load_pair(
        (
            Source::Glsl {
                text: VERTEX,
                stage: Stage::Vertex,
            },
            &options,
        ),
        (
            Source::Glsl {
                text: FRAGMENT,
                stage: Stage::Fragment,
            },
            &options,
        ),
    )
    .unwrap_or_else(|errors| panic!("{errors}"));
    // A uniform of both is in one place.
    let offset =
        |module: &Module, name| module.reflection.uniform(name).map(|found| found.1.offset);
    for (name, at) in [("model", 0), ("view", 64), ("projection", 128)] {
        assert_eq!(offset(&vertex, name), Some(at));
        assert_eq!(offset(&fragment, name), Some(at));
    }
    let given: Vec<_> = vertex.reflection.outputs[0].iter().collect();
    let taken: Vec<_> = fragment.reflection.inputs[0].iter().collect();
    assert_eq!(given.len(), 3);
    assert_eq!(given, taken);

    // Scaled by 2 and moved by (1, 0, 0); OpenGL's z of −w..w becomes 0..w.
    let identity: Vec<f32> = (0..16_u8)
        .map(|at| f32::from(u8::from(at % 5 == 0)))
        .collect();
    let mut model = identity.iter().map(|value| value * 2.0).collect::<Vec<_>>();
    model[15] = 1.0;
    model[12] = 1.0;
    let mut world = World::default();
    set(&vertex, &mut world.uniforms, "model", &model);
    set(&vertex, &mut world.uniforms, "view", &identity);
    set(&vertex, &mut world.uniforms, "projection", &identity);
    for component in 0..3_u8 {
        let of = |location| Input::Attribute {
            location,
            component: u32::from(component),
        };
        world.inputs.insert(of(0), f32::from(component) + 1.0);
        world
            .inputs
            .insert(of(1), f32::from(u8::from(component == 2)));
        world.inputs.insert(of(2), 0.5);
    }
    let outputs = run(&vertex, world);
    let position = [0, 1, 2, 3].map(|at| outputs[&Output::Position(at)]);
    assert_eq!(position, [3.0, 4.0, (6.0 + 1.0) / 2.0, 1.0]);
    let varyings = [0, 1, 2, 3, 4, 5, 6, 7, 8].map(|at| outputs[&Output::Varying(at)]);
    assert_eq!(varyings, [3.0, 4.0, 6.0, 0.0, 0.0, 0.5, 0.5, 0.5, 0.5]);

    // The light is right above: the whole diffuse term.
    let mut world = World::default();
    for (at, value) in (0..).zip(varyings) {
        world.inputs.insert(Input::Varying(at), value);
    }
    for (name, values) in [
        ("light_position", &[3.0, 4.0, 10.0][..]),
        ("light_color", &[1.0, 0.5, 0.25]),
        ("a_ambient", &[0.5]),
        ("a_diffuse", &[1.0]),
        ("a_specular", &[2.0]),
        ("specular_magnitude", &[0.25]),
    ] {
        set(&fragment, &mut world.uniforms, name, values);
    }
    assert_eq!(color(&run(&fragment, world)), [1.25, 0.625, 0.3125, 1.0]);
}

/// Sizes of arrays of arrays, which naga takes the other way round.
#[test]
fn arrays_of_arrays_have_their_sizes() {
    check(
        "float g[2][3];",
        "float w[3][2]; w[2][1] = v.x; w[0][1] = 9.0; g[1][2] = v.y; g[0][2] = 8.0; \
         float q[] = float[](5.0, 6.0, 7.0); float[2] r = float[2](1.0, 3.0); \
         c = vec4(w[2][1], g[1][2], q[2], r[1]);",
        [1.0, 2.0, 7.0, 3.0],
    );
}

/// Global variables take values that are no constants when `main` begins, in order.
#[test]
fn global_variables_begin_with_their_values() {
    check(
        "const float K = 2.0; float a = K * 3.0; float b = a + 1.0; float list[] = float[](a, b);",
        "c = vec4(a, b, list[1], v.x); a = 0.0;",
        [6.0, 7.0, 7.0, 1.0],
    );
}

#[test]
fn macros_are_replaced() {
    check(
        "#define SQ(x) ((x)*(x))\n#define CAT(a, b) a##b\n#define TWICE(f, x) f(f(x))\n\
         #if defined(SQ) && !defined(NONE) && __VERSION__ == 330\n#define ONE 1.0\n#else\n\
         #error not here\n#endif\nfloat self = 4.0;\n#define self self + 1.0",
        "float xy = 5.0; c = vec4(SQ(v.y + ONE), TWICE(SQ, v.y), CAT(x, y), self);",
        [9.0, 16.0, 5.0, 5.0],
    );
}

/// Functions that naga lacks, and control flow.
#[test]
fn functions_and_loops() {
    check(
        "void f(inout vec3 a, const in float s, out float r) { a *= s; r = a.x; }",
        "vec3 n = v.xyz; float r; f(n, 2.0, r); float whole; float part = modf(2.75, whole); \
         int sum = 0; for (int i = 0, last = 4; i <= last; ++i) { if (i == 3) continue; sum += i; } \
         c = vec4(n.z, r + part, whole, float(sum));",
        [6.0, 2.75, 2.0, 7.0],
    );
}

/// Functions that are declared first and defined after their use.
#[test]
fn prototypes_are_enough_before_a_call() {
    check(
        "float twice(float x); float half_of(in float x);\n\
         float both(float x) { return twice(x) + half_of(x); }\n\
         float half_of(in float x) { return twice(x) * 0.25; }\n\
         float twice(float x) { return x + x; }",
        "c = vec4(both(v.y), half_of(v.w), twice(v.x), v.z);",
        [5.0, 2.0, 2.0, 3.0],
    );
}

/// Types that buffers hold otherwise: the author's offsets are those of std140.
#[test]
fn uniforms_that_naga_cannot_lay_out() {
    let module = load_fragment(
        "#version 330 core
struct Small { float a; bool on; };
uniform float first;
uniform bool blinn;
uniform Small small[2];
uniform mat2 turn;
layout(std140) uniform Block { bvec2 flags; mat3x2 wide[2]; float last; } block;
out vec4 c;
void main() {
    c = vec4(blinn ? 1.0 : 0.0, small[1].on ? small[1].a : -1.0, (turn * vec2(1.0, 2.0)).y, first);
    if (block.flags.y) c.x += block.wide[1][2].y + block.last;
}
",
    );
    let uniform = |name: &str| {
        let (block, member) = module
            .reflection
            .uniform(name)
            .unwrap_or_else(|| panic!("{name}"));
        (block.name.clone(), member.kind.glsl_name(), member.offset)
    };
    let loose = String::new();
    let block = "Block".to_owned();
    assert_eq!(uniform("first"), (loose.clone(), "float".to_owned(), 0));
    assert_eq!(uniform("blinn"), (loose.clone(), "bool".to_owned(), 4));
    assert_eq!(
        uniform("small[0].a"),
        (loose.clone(), "float".to_owned(), 16)
    );
    assert_eq!(
        uniform("small[1].on"),
        (loose.clone(), "bool".to_owned(), 36)
    );
    assert_eq!(uniform("turn"), (loose, "mat2".to_owned(), 48));
    assert_eq!(
        uniform("Block.flags"),
        (block.clone(), "bvec2".to_owned(), 0)
    );
    assert_eq!(
        uniform("Block.wide"),
        (block.clone(), "mat3x2".to_owned(), 16)
    );
    assert_eq!(uniform("Block.last"), (block, "float".to_owned(), 112));

    // Both blocks read one buffer here, which is large enough for both.
    let mut world = World {
        uniforms: vec![0; 64],
        ..World::default()
    };
    set(&module, &mut world.uniforms, "first", &[0.0]);
    world.uniforms[1] = 1;
    world.uniforms[8] = 3.5_f32.to_bits();
    world.uniforms[9] = 1;
    set(
        &module,
        &mut world.uniforms,
        "turn",
        &[1.0, 2.0, 0.0, 0.0, 3.0, 4.0],
    );
    // The third column of the second matrix.
    world.uniforms[4 + 5 * 4 + 1] = 10.0_f32.to_bits();
    world.uniforms[28] = 5.0_f32.to_bits();
    assert_eq!(color(&run(&module, world)), [16.0, 3.5, 10.0, 0.0]);
}

/// Combined samplers: alone, in arrays and structures, and as parameters.
#[test]
fn samplers_are_split() {
    let module = load_fragment(
        "#version 330 core
struct Material { sampler2D diffuse; sampler2D specular; float shininess; };
uniform Material material;
uniform sampler2D maps[2];
uniform sampler2DShadow shadow;
layout(binding = 5) uniform samplerCube sky;
out vec4 c;
vec4 look(sampler2D tex, vec2 uv) { return texture(tex, uv); }
vec4 twice(vec2 uv, sampler2D one) { return look(one, uv) + textureLod(one, uv, 0.0); }
void main() {
    float tex = 1.0;
    vec4 maps1 = texelFetch(maps[1], ivec2(0), 0);
    c = twice(vec2(0.5), material.specular) * tex + maps1 + vec4(texture(shadow, vec3(0.5)));
    c += texture(sky, vec3(1.0)) * material.shininess;
    c += vec4(textureSize(maps[0], 0), 0.0, 0.0) + textureGrad(maps[0], vec2(0.5), vec2(0.1), vec2(0.1));
    c += textureOffset(material.diffuse, vec2(0.5), ivec2(1, 0));
}
",
    );
    let pairs = &module.reflection.combined_samplers;
    let names: Vec<_> = pairs.iter().map(|pair| pair.name.as_str()).collect();
    let expected = [
        "material.diffuse",
        "material.specular",
        "maps[0]",
        "maps[1]",
        "shadow",
        "sky",
    ];
    assert_eq!(names, expected);
    assert_eq!(pairs[0].texture, (0, 1));
    assert_eq!(pairs[0].sampler, (0, 2));
    assert_eq!(pairs[5].unit, Some(5));
    assert!(module.reflection.uniform("material.shininess").is_some());
    lower(&module.module, &module.info, 0).expect("it lowers");
}

/// A program may leave a uniform unused, whether the block that it becomes is used or not.
#[test]
fn uniforms_may_be_unused() {
    let v = [1.0, 2.0, 3.0, 4.0];
    check("uniform float time;", "c = v;", v);
    let head = "uniform float time; uniform vec3 tints[4]; uniform sampler2D map;";
    check(head, "c = v + texture(map, v.xy);", [1.25, 2.5, 3.75, 5.0]);
    let head = "layout(std140) uniform Block { mat4 a; vec2 b[3]; };";
    check(head, "c = v;", v);
}

/// Without derivatives `texture` reads the base level.
#[test]
fn vertex_shaders_sample_textures() {
    let text = "#version 330 core
        in vec2 at;
        uniform sampler2D heights;
        uniform samplerCube sky;
        float raised(sampler2D map, vec2 at) { return texture(map, at).y; }
        void main() {
            float height = raised(heights, at) + texture(sky, vec3(at, 1.0)).z;
            gl_Position = vec4(at, height, textureProj(heights, vec3(at, 1.0)).x);
        }";
    let stage = Stage::Vertex;
    let module = load(Source::Glsl { text, stage }, &Options::default()).expect("it loads");
    let outputs = run(&module, World::default());
    // OpenGL's depth, −w to w.
    assert_eq!(outputs[&Output::Position(2)], (0.5 + 0.75 + 0.25) * 0.5);
    assert_eq!(outputs[&Output::Position(3)], 0.25);
}

/// Types are unique: the array of clip distances may have the type of one of the author.
#[test]
fn clip_distances_beside_an_array_of_their_size() {
    let text = "#version 330 core
        in vec4 at;
        void main() {
            float weights[2] = float[](at.x, 2.0);
            gl_Position = at;
            gl_ClipDistance[0] = weights[1];
            gl_ClipDistance[1] = weights[0];
        }";
    let stage = Stage::Vertex;
    let module = load(Source::Glsl { text, stage }, &Options::default()).expect("it loads");
    let outputs = run(&module, World::default());
    assert_eq!(outputs[&Output::ClipDistance(0)], 2.0);
    assert_eq!(outputs[&Output::ClipDistance(1)], 0.0);

    let text = "void main() { gl_ClipDistance[0] = 1.0; }";
    let error = load(Source::Glsl { text, stage }, &Options::default()).expect_err("no position");
    assert!(error.to_string().contains("`gl_Position`"), "{error}");
}

#[test]
fn continue_in_do_while_evaluates_the_condition() {
    let body = "float n = 0.0; float i = 0.0;
        do { i += 1.0; if (i >= v.z) continue; n += i; } while (i < v.z);
        c = vec4(n, i, 0.0, 1.0);";
    check("", body, [3.0, 3.0, 0.0, 1.0]);
}

#[test]
fn and_and_or_evaluate_the_second_operand_only_if_they_must() {
    let head = "float calls = 0.0; bool yes(float by) { calls += by; return true; }";
    let body = "bool a = v.x > 5.0 && yes(1.0); bool b = v.x < 5.0 || yes(2.0);
        bool d = v.x < 5.0 && yes(4.0); bool e = v.x > 5.0 || yes(8.0);
        c = vec4(calls, float(a) + 2.0 * float(b), float(d) + 2.0 * float(e), 1.0);";
    check(head, body, [12.0, 2.0, 3.0, 1.0]);
}

#[test]
fn lazy_operands_nest_in_every_form() {
    let head = "float calls = 0.0;
        bool f(float by, bool result) { calls += by; return result; }";
    let body = "float n = 0.0, i = 0.0; bool[2] p = bool[2](false, false);
        do if (v.x > i || f(1.0, false)) n += 1.0; else { n += 8.0; continue; }
        while ((i += 1.0) < 2.0 && f(16.0, true) && !f(0.0, false));
        int k = 0;
        do { int j = 0; do { if (++j == 2) continue; k += j; } while (j < 3); } while (k < 9);
        switch (k) {
            case 12: p[f(32.0, true) && k > 9 ? 1 : 0] = v.x < 0.0 || v.y < 0.0 ^^ f(64.0, true);
            default: for (int m = 0; m < 2 && f(128.0, true); m++) n += 0.25;
        }
        bool q = false;
        if (v.x > 0.0 || (q = true)) c = vec4(calls, n, float(k), p[1] && !q ? 1.0 : 0.0);";
    check(
        head,
        body,
        [1.0 + 16.0 + 32.0 + 64.0 + 256.0, 9.5, 12.0, 1.0],
    );
}
