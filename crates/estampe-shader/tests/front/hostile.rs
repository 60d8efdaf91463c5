//! Hostile sources: they end in an error or a module, soon, and without a panic.

use std::time::{Duration, Instant};

use estampe_ir::interface::Stage;
use estampe_shader::front::{Limits, Module, Options, ShaderErrors, Source, load, load_pair};

/// No source of these tests takes longer, also in builds without optimisation.
const LONGEST: Duration = Duration::from_secs(20);

const WGSL: &str = "struct U { m: mat4x4f, list: array<vec4f, 4>, n: u32 }
@group(0) @binding(0) var<uniform> u: U;
@group(0) @binding(1) var t: texture_2d<f32>;
@group(0) @binding(2) var s: sampler;
override scale: f32 = 2.0;
struct Out { @builtin(position) p: vec4f, @location(0) uv: vec2f }
fn f(x: f32, a: ptr<function, f32>) -> f32 { *a += x; return select(x, -x, x > 0.5) * scale; }
@vertex fn vs(@location(0) p: vec3f, @builtin(vertex_index) i: u32) -> Out {
    var o: Out; var sum = 0.0;
    for (var k = 0u; k < u.n; k++) { if (k == 3u) { continue; } sum += f(u.list[k].x, &sum); }
    switch i { case 1u, 2u: { sum *= 2.0; } default: { } }
    o.p = u.m * vec4f(p, sum); o.uv = p.xy; return o;
}
@fragment fn fs(o: Out) -> @location(0) vec4f {
    let c = textureSample(t, s, o.uv); if (c.a < 0.5) { discard; } return c + dpdx(c);
}
";

const VERTEX: &str = "#version 330 core
#define SQ(x) ((x) * (x))
#define N 3
#if N > 2 && defined(SQ)
layout (location = 0) in vec3 p;
#else
#error no
#endif
struct Light { vec3 at; bool on; float k[N]; sampler2D map; };
uniform Light lights[2];
uniform mat4 m; uniform mat2 r;
layout(std140) uniform Block { vec4 a; bvec2 b; } block;
out VS { vec3 n; mat3 tbn; float list[2]; } vs;
float g = SQ(2.0) + 1.0;
vec4 look(sampler2D tex, vec2 uv) { return textureLod(tex, uv, 0.0); }
void main() {
    float w[2][3]; w[1][2] = g; int sum = 0;
    for (int i = 0; i < N; ++i) { if (i == 1) continue; sum += i; }
    vs.n = lights[1].on ? p : lights[0].at * w[1][2]; vs.tbn = mat3(m); vs.list[1] = float(sum);
    gl_Position = m * vec4(r * p.xy, p.z, 1.0) + look(lights[0].map, p.xy) + block.a;
}
";

const FRAGMENT: &str = "#version 330 core
in VS { vec3 n; mat3 tbn; float list[2]; } vs;
uniform mat4 m;
uniform sampler2D tex[2];
out vec4 c;
void main() { c = texture(tex[1], vs.n.xy) * m[0] + vec4(vs.tbn[2], vs.list[1]); }
";

/// What the front end writes functions for, and mends in naga's module.
const COMPUTE: &str = "#version 450
layout(local_size_x = 8) in;
struct Bin { int least; uint count[2]; };
layout(std430, binding = 0) buffer Bins { Bin bins[4]; uint owner; uint more[]; } all;
layout(std430, binding = 1) writeonly buffer Out { float sums[]; };
uniform float gain = 0.5 * 2.0;
struct Range { int least; vec2 ends; };
uniform Range first = Range(1, vec2(2.0, 3.0));
uniform sampler2D maps[3];
uniform sampler2DShadow depth;
shared uint total;
const ivec2 BESIDE = ivec2(1, -1);
void main() {
    uint n = gl_GlobalInvocationID.x; int power; uint carry, high, low;
    if (n == 0u) { total = 0u; }
    barrier();
    atomicMin(all.bins[n & 3u].least, int(n));
    uint before = atomicAdd(all.bins[1].count[n & 1u], 1u) + atomicAdd(total, 2u);
    if (atomicCompSwap(all.owner, n, n + 1u) == before) { atomicExchange(all.more[2], before); }
    float x = frexp(gain, power); before = uaddCarry(n, before, carry);
    umulExtended(n, before, high, low);
    vec4 sum = texture(maps[int(n) % 3], vec2(x)) + textureGather(maps[1], vec2(x), 1);
    sum += textureGatherOffset(maps[0], vec2(x), BESIDE, 3) + textureGather(depth, vec2(x), 0.5);
    sums[n] = dot(sum, vec4(float(power), float(carry), float(high + low), first.least));
}
";

fn compute(text: &str) -> Source<'_> {
    Source::Glsl {
        text,
        stage: Stage::Compute,
    }
}

fn glsl(text: &str) -> Source<'_> {
    Source::Glsl {
        text,
        stage: Stage::Vertex,
    }
}

/// Loads a source, and checks that it took not too long.
fn timed(source: Source<'_>) -> Result<Module, ShaderErrors> {
    let start = Instant::now();
    let loaded = load(source, &Options::default());
    assert!(
        start.elapsed() < LONGEST,
        "{:?}: {source:?}",
        start.elapsed()
    );
    if let Err(errors) = &loaded {
        assert!(!errors.errors.is_empty());
        assert!(errors.to_string().len() < 1 << 20);
        let _ = errors.to_json();
    }
    loaded
}

/// The error of a source that nests deeply or is large.
#[track_caller]
fn refused(source: Source<'_>) -> String {
    match timed(source) {
        Ok(_) => panic!("it is accepted"),
        Err(errors) => errors.errors[0].message.clone(),
    }
}

/// A text with parts removed, repeated, exchanged or replaced.
fn mutated(text: &str, random: &mut fastrand::Rng) -> String {
    let mut bytes = text.as_bytes().to_vec();
    for _ in 0..random.usize(1..4) {
        if !bytes.iter().any(u8::is_ascii_digit) {
            break;
        }
        let at = random.usize(..bytes.len());
        let end = (at + random.usize(1..24)).min(bytes.len());
        match random.u8(..12) {
            0 => drop(bytes.drain(at..end)),
            1 => {
                let part = bytes[at..end].to_vec();
                let to = random.usize(..bytes.len());
                bytes.splice(to..to, part);
            }
            2 => bytes[at] = b"(){}[];,.=+-*/<>&|!?:#09azAZ_ \n\"@\\"[random.usize(..34)],
            3 => bytes.truncate(at),
            4 => bytes[at] = random.u8(..),
            // Numbers change, which often leaves the text valid.
            6.. => {
                let digits = bytes
                    .iter()
                    .enumerate()
                    .filter(|(_, byte)| byte.is_ascii_digit());
                let digits: Vec<usize> = digits.map(|(at, _)| at).collect();
                bytes[digits[random.usize(..digits.len())]] = b"0123456789"[random.usize(..10)];
            }
            _ => {
                let words = [
                    "float",
                    "vec3",
                    "in",
                    "#if",
                    "struct",
                    "4294967295",
                    "1e39",
                    "u",
                    "m",
                ];
                bytes.splice(at..end, words[random.usize(..words.len())].bytes());
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// How many of some sources load.
fn accepted(count: usize, mut one: impl FnMut(usize) -> bool) -> usize {
    (0..count).filter(|index| one(*index)).count()
}

#[test]
fn mutated_wgsl_ends() {
    timed(Source::Wgsl(WGSL)).expect("the original");
    let mut random = fastrand::Rng::with_seed(1);
    let good = accepted(400, |_| {
        timed(Source::Wgsl(&mutated(WGSL, &mut random))).is_ok()
    });
    assert!((5..380).contains(&good), "{good}");
}

#[test]
fn mutated_glsl_ends() {
    timed(glsl(VERTEX)).unwrap_or_else(|errors| panic!("{errors}"));
    let mut random = fastrand::Rng::with_seed(2);
    let good = accepted(800, |_| timed(glsl(&mutated(VERTEX, &mut random))).is_ok());
    assert!((10..760).contains(&good), "{good}");
}

#[test]
fn mutated_functions_of_glsl_end() {
    timed(compute(COMPUTE)).unwrap_or_else(|errors| panic!("{errors}"));
    let mut random = fastrand::Rng::with_seed(6);
    let good = accepted(600, |_| {
        timed(compute(&mutated(COMPUTE, &mut random))).is_ok()
    });
    assert!((5..570).contains(&good), "{good}");
}

#[test]
fn mutated_pairs_end() {
    let mut random = fastrand::Rng::with_seed(3);
    let options = Options::default();
    let good = accepted(200, |index| {
        let is_vertex = index % 2 == 0;
        let vertex = if is_vertex {
            mutated(VERTEX, &mut random)
        } else {
            VERTEX.to_owned()
        };
        let fragment = if is_vertex {
            FRAGMENT.to_owned()
        } else {
            mutated(FRAGMENT, &mut random)
        };
        let fragment = Source::Glsl {
            text: &fragment,
            stage: Stage::Fragment,
        };
        load_pair((glsl(&vertex), &options), (fragment, &options)).is_ok()
    });
    assert!((2..190).contains(&good), "{good}");
}

#[test]
fn random_bytes_end() {
    let mut random = fastrand::Rng::with_seed(4);
    for _ in 0..200 {
        let bytes: Vec<u8> = (0..random.usize(..400)).map(|_| random.u8(..)).collect();
        let text = String::from_utf8_lossy(&bytes).into_owned();
        let _ = timed(Source::Wgsl(&text));
        let _ = timed(glsl(&text));
        let _ = timed(Source::SpirVBytes(&bytes));
    }
}

/// A SPIR-V module of one compute shader that does nothing, with its words changed.
#[test]
fn mutated_spirv_ends() {
    let module = [
        0x0723_0203,
        0x0001_0000,
        0,
        10,
        0, // header
        0x0002_0011,
        1, // OpCapability Shader
        0x0003_000e,
        0,
        1, // OpMemoryModel Logical GLSL450
        0x0005_000f,
        5,
        1,
        0x6e69_616d,
        0, // OpEntryPoint GLCompute %1 "main"
        0x0006_0010,
        1,
        17,
        1,
        1,
        1, // OpExecutionMode %1 LocalSize 1 1 1
        0x0002_0013,
        2, // %2 = OpTypeVoid
        0x0003_0021,
        3,
        2, // %3 = OpTypeFunction %2
        0x0005_0036,
        2,
        1,
        0,
        3, // %1 = OpFunction
        0x0002_00f8,
        4,           // OpLabel
        0x0001_00fd, // OpReturn
        0x0001_0038, // OpFunctionEnd
    ];
    timed(Source::SpirV(&module)).unwrap_or_else(|errors| panic!("{errors}"));
    let mut random = fastrand::Rng::with_seed(5);
    let good = accepted(1000, |_| {
        let mut words = module.to_vec();
        for _ in 0..random.usize(1..3) {
            let at = random.usize(..words.len());
            match random.u8(..4) {
                0 => words[at] = random.u32(..),
                1 => words[at] ^= 1 << random.u32(..32),
                2 => words[at] = random.u32(..12),
                _ => drop(words.drain(at..(at + 2).min(words.len()))),
            }
        }
        timed(Source::SpirV(&words)).is_ok()
    });
    assert!((10..900).contains(&good), "{good}");
}

/// What recursion would follow down is refused before.
#[test]
fn deep_nesting_is_refused() {
    let main = |body: &str| format!("#version 330\nout vec4 c;\nvoid main() {{ {body} }}\n");
    let deep = 20_000;
    let open = "(".repeat(deep);
    let close = ")".repeat(deep);
    let chain = "1.0+".repeat(deep);
    let not = "!".repeat(deep);
    let choice = "true?1.0:".repeat(deep);
    let branches = "if (true) ; else ".repeat(deep);
    let blocks = "{".repeat(deep);
    for body in [
        format!("float x = {open}1.0{close};"),
        format!("float x = {chain}1.0;"),
        format!("bool x = {not}true;"),
        format!("float x = {choice}1.0;"),
        format!("{branches};"),
        blocks.clone(),
        format!("int x; x{};", "=x".repeat(deep)),
        format!("float x; {};", "if(true)".repeat(deep)),
    ] {
        let message = refused(glsl(&main(&body)));
        let known = ["too deeply", "too many", "not closed"];
        assert!(known.iter().any(|part| message.contains(part)), "{message}");
    }
    let deep = 200_000;
    let open = "(".repeat(deep);
    let close = ")".repeat(deep);
    let chain = "1.0+".repeat(deep);
    let not = "!".repeat(deep);
    let blocks = "{".repeat(deep);
    let main = |body: &str| format!("fn f() {{ {body} }}\n");
    for body in [
        format!("let x = {open}1.0{close};"),
        format!("let x = {chain}1.0;"),
        format!("let x = {not}true;"),
        format!("if (true) {{ }} {}", "else if (true) { }".repeat(deep)),
        format!("{blocks}{}", "}".repeat(deep)),
        format!("let x = 1{};", ".x".repeat(deep)),
        format!(
            "var x: {}f32{};",
            "array<".repeat(deep),
            ", 2>".repeat(deep)
        ),
    ] {
        let message = refused(Source::Wgsl(&main(&body)));
        let start: String = body.chars().take(30).collect();
        assert!(
            message.contains("too deeply") || message.contains("too many"),
            "{start}: {message}"
        );
    }
}

#[test]
fn macros_that_grow_are_refused() {
    let mut text = "#version 330\n#define A0 x\n".to_owned();
    for level in 1..40 {
        text.push_str(&format!("#define A{level} A{0} A{0}\n", level - 1));
    }
    text.push_str("A39\n");
    assert!(refused(glsl(&text)).contains("too large when its macros are replaced"));
    let mut text = "#define F0(x) x\n".to_owned();
    for level in 1..40 {
        text.push_str(&format!(
            "#define F{level}(x) F{0}(x) + F{0}(x x)\n",
            level - 1
        ));
    }
    text.push_str("float x = F39(1);\n");
    assert!(refused(glsl(&text)).contains("too large when its macros are replaced"));
    let text = format!(
        "#define F(x) x\nfloat x = {}1{};",
        "F(".repeat(9_999),
        ")".repeat(9_999)
    );
    assert!(refused(glsl(&text)).contains("nest too deeply"));
}

/// Types that are small to write and large to walk over.
#[test]
fn types_that_grow_are_refused() {
    let mut text = "#version 330\nstruct S0 { float x; };\n".to_owned();
    for level in 1..60 {
        text.push_str(&format!(
            "struct S{level} {{ S{0} a; S{0} b; }};\n",
            level - 1
        ));
    }
    text.push_str("uniform S59 s; out S59 o; void main() { gl_Position = vec4(s.a.a.a.x); }\n");
    assert!(refused(glsl(&text)).contains("too many"));
    for head in [
        "out float x[1000000];",
        "uniform bool x[1000000];",
        "uniform sampler2D x[1000000];",
        "uniform mat2 x[1000][1000][1000];",
        "struct S { float a[1000][1000]; }; out S x;",
        "float x[99999999999];",
    ] {
        let text = format!("#version 330\n{head}\nvoid main() {{ gl_Position = vec4(0.0); }}\n");
        refused(glsl(&text));
    }
}

/// Calls that are written once for each sampler, or need a function of their own.
#[test]
fn calls_that_grow_are_refused() {
    let call = format!(
        "sum += texture(maps[i], vec2({}0.5));\n",
        "0.1 + ".repeat(100)
    );
    let text = |calls: usize| {
        format!(
            "#version 330\nuniform sampler2D maps[64]; uniform int i;\n\
             void main() {{ vec4 sum = vec4(0.0);\n{}gl_Position = sum; }}\n",
            call.repeat(calls)
        )
    };
    timed(glsl(&text(1))).expect("one call");
    assert!(refused(glsl(&text(30))).contains("too many calls with samplers"));
    let text = |gathers: usize| {
        let gathers = (0..gathers)
            .map(|at| format!("sum += textureGatherOffset(map, vec2(0.5), ivec2({at}, 1));\n"));
        format!(
            "#version 430\nuniform sampler2D map;\n\
             void main() {{ vec4 sum = vec4(0.0);\n{}gl_Position = sum; }}\n",
            gathers.collect::<String>()
        )
    };
    timed(glsl(&text(7))).expect("seven gathers");
    assert!(refused(glsl(&text(9_000))).contains("more than 64 gathers differ"));
}

#[test]
fn limits_are_kept() {
    let options = Options {
        limits: Limits {
            source_bytes: 10,
            ..Limits::default()
        },
        ..Options::default()
    };
    let errors = load(glsl("void main() { }"), &options).expect_err("too long");
    assert_eq!(
        errors.to_string(),
        "shader: error: the shader has 15 bytes, more than the limit of 10"
    );
}
