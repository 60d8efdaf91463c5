//! Limits that a source exceeds: the message, the place at which it does, and the help.

use estampe_ir::interface::Stage;
use estampe_shader::front::{Limits, Options, Source, load};
use estampe_shader::lower::lower;

/// Options that allow brackets two deep.
fn shallow() -> Options {
    Options {
        limits: Limits {
            nesting: 2,
            ..Limits::default()
        },
        ..Options::default()
    }
}

/// Checks the line, the column, the message and the help of a source's only error, and that the
/// line of its place is shown.
#[track_caller]
fn check(source: Source<'_>, options: &Options, place: (u32, u32), message: &str, help: &str) {
    let errors = load(source, options)
        .expect_err("it exceeds a limit")
        .errors;
    let [error] = &*errors else {
        panic!("{errors:?}");
    };
    assert_eq!(error.message, message);
    assert_eq!((error.line, error.column), place);
    assert_eq!(error.help.as_deref().unwrap_or_default(), help);
    let (Source::Glsl { text, .. } | Source::Wgsl(text)) = source else {
        return;
    };
    let line = text.lines().nth(place.0 as usize - 1);
    let shown: String = line.unwrap_or_default().chars().take(200).collect();
    assert_eq!(error.line_text, shown);
}

fn glsl(text: &str) -> Source<'_> {
    Source::Glsl {
        text,
        stage: Stage::Fragment,
    }
}

#[test]
fn nesting_and_chains() {
    let wgsl = "name parts of it with `let`, or move them to functions";
    check(
        Source::Wgsl("fn f() {\n    let x = 1+1+1+1+1+1+1+1+1+1+1+1+1+1+1+1+1;\n}"),
        &shallow(),
        (2, 40),
        "too many operators follow each other here",
        wgsl,
    );
    check(
        Source::Wgsl(
            "fn f() {\nif a { } else if b { } else if c { } else if d { } else if e { }\nelse { }\n}",
        ),
        &shallow(),
        (3, 1),
        "too many branches follow each other here",
        wgsl,
    );
    let help = "name parts of it with variables, or move them to functions";
    check(
        glsl("void main() {\n    float x = ((1.0));\n}"),
        &shallow(),
        (2, 16),
        "brackets nest too deeply here",
        help,
    );
    check(
        glsl("void main() {\n    float x = 1.+1.+1.+1.+1.+1.+1.+1.+1.+1.+1.+1.+1.+1.+1.+1.+1.;\n}"),
        &shallow(),
        (2, 62),
        "too many operators follow each other here",
        help,
    );
    check(
        glsl("void main() {\n    if (a) ; else if (b) ; else if (c) ;\n}"),
        &shallow(),
        (2, 33),
        "too many branches follow each other here",
        help,
    );
    let nested = format!(
        "fn f() {{\n    let x = {}1{};\n}}",
        "(".repeat(200),
        ")".repeat(200)
    );
    check(
        Source::Wgsl(&nested),
        &Options::default(),
        (2, 212),
        "expressions or statements nest too deeply",
        "",
    );
}

#[test]
fn directives_and_macros() {
    let options = Options::default();
    let text = format!("{}void main() {{ }}\n", "#if 1\n".repeat(300));
    check(
        glsl(&text),
        &options,
        (257, 2),
        "conditions nest too deeply here",
        "",
    );
    for deep in ["(".repeat(100), "- ".repeat(100)] {
        let text = format!("\n#if {deep}1\n#endif\n");
        check(
            glsl(&text),
            &options,
            (2, 2),
            "this expression nests too deeply",
            "",
        );
    }
    let text = format!(
        "#define F(x) x\nfloat x = {}1{};",
        "F(".repeat(99),
        ")".repeat(99)
    );
    let errors = load(glsl(&text), &options).expect_err("it nests");
    let error = &errors.errors[0];
    assert_eq!(error.message, "macros nest too deeply here");
    assert_eq!((error.line, error.length), (2, 1));
    let text = format!("#define F(x) x\nfloat x = F({});", "1,".repeat(999));
    check(
        glsl(&text),
        &options,
        (2, 11),
        "this macro has too many arguments",
        "",
    );
    let few = Options {
        limits: Limits {
            tokens: 20,
            ..Limits::default()
        },
        ..Options::default()
    };
    check(
        glsl("#define TEN 1 1 1 1 1 1 1 1 1 1\nTEN\nTEN TEN\n"),
        &few,
        (2, 1),
        "the shader is too large when its macros are replaced",
        "raise the limit `tokens` of the options, or make the macros smaller",
    );
}

#[test]
fn samplers_and_gathers() {
    let options = Options::default();
    let call = format!(
        "sum += texture(maps[i], vec2({}0.5));\n",
        "0.1 + ".repeat(100)
    );
    let text = format!(
        "#version 330\nuniform sampler2D maps[64]; uniform int i; out vec4 c;\n\
         void main() {{ vec4 sum = vec4(0.0);\n{}c = sum; }}\n",
        call.repeat(30)
    );
    // 64 samplers, 209 tokens each: 2^18 are reached in the 20th call.
    check(
        glsl(&text),
        &options,
        (23, 8),
        "there are too many calls with samplers at computed indices",
        "use an array texture, such as `sampler2DArray`",
    );
    let gathers =
        (0..70).map(|at| format!("sum += textureGatherOffset(map, vec2(0.5), ivec2({at}, 1));\n"));
    let text = format!(
        "#version 430\nuniform sampler2D map; out vec4 c;\n\
         void main() {{ vec4 sum = vec4(0.0);\n{}c = sum; }}\n",
        gathers.collect::<String>()
    );
    check(
        glsl(&text),
        &options,
        (68, 8),
        "more than 64 gathers differ",
        "use fewer offsets, or `texelFetch`",
    );
}

/// Calls that are inlined too deeply, and too many values.
#[test]
fn shaders_that_are_large_when_inlined() {
    let mut deep = "fn level_0(x: f32) -> f32 { return x; }\n".to_owned();
    let mut wide = deep.clone();
    for level in 1..140 {
        let below = level - 1;
        deep += &format!("fn level_{level}(x: f32) -> f32 {{ return level_{below}(x) + 1.0; }}\n");
    }
    for level in 1..30 {
        let below = level - 1;
        wide += &format!(
            "fn level_{level}(x: f32) -> f32 {{ return level_{below}(x) + level_{below}(x + 1.0); }}\n"
        );
    }
    for (functions, last) in [(deep, 139), (wide, 29)] {
        let text = format!(
            "{functions}@fragment fn main(@location(0) x: f32) -> @location(0) vec4f
            {{ return vec4f(level_{last}(x)); }}"
        );
        let module = load(Source::Wgsl(&text), &Options::default());
        let module = module.unwrap_or_else(|errors| panic!("{errors}"));
        let error = lower(&module.module, &module.info, 0).expect_err("it is large");
        assert_eq!(
            error.to_string(),
            "the shader has more than 1000000 operations when its functions are inlined: make \
             arrays and functions smaller, or call them in a loop"
        );
    }
}
