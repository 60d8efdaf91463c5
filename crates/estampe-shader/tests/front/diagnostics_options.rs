//! Wrong options, constants and names of entry points: the exact messages.

use estampe_ir::interface::Stage;
use estampe_shader::front::{Module, Options, Source, load};

const OVERRIDES: &str = "@id(7) override gain: f32;
override steps: u32 = 2u;
override size: u32 = 1u;
@compute @workgroup_size(size) fn main() { var sum = gain * f32(steps); }
@compute @workgroup_size(1) fn other() { }
";

fn module() -> Module {
    let module = load(Source::Wgsl(OVERRIDES), &Options::default());
    module.unwrap_or_else(|errors| panic!("{errors}"))
}

#[track_caller]
fn check_constants(constants: &[(&str, f64)], expected: &str) {
    let constants = constants
        .iter()
        .map(|&(name, value)| (name.to_owned(), value))
        .collect::<Vec<_>>();
    let errors = module()
        .specialize(None, &constants)
        .expect_err("wrong constants");
    assert_eq!(errors.to_string(), expected);
    // Options settle them in the same way.
    let options = Options {
        constants: Some(constants),
        file: Some("a.wgsl".to_owned()),
        ..Options::default()
    };
    let errors = load(Source::Wgsl(OVERRIDES), &options).expect_err("wrong constants");
    assert_eq!(errors.to_string(), expected.replacen("shader", "a.wgsl", 1));
}

#[test]
fn constants() {
    check_constants(
        &[("gian", 1.0)],
        "shader: error: the shader has no constant `gian`\n  help: did you mean `gain`?",
    );
    check_constants(
        &[("8", 1.0)],
        "shader: error: the shader has no constant `8`\n  \
         help: constants are named by their name, or by the digits of their id",
    );
    check_constants(
        &[],
        "shader: error: the constant `gain` has neither a value nor a default\n  \
         help: give it a value among the options' constants",
    );
    check_constants(
        &[("7", f64::NAN)],
        "shader: error: the value of a constant is infinite or not a number",
    );
    check_constants(
        &[("7", 1.0), ("steps", -1.0)],
        "shader: error: the value of a constant is out of the range of its type",
    );
    check_constants(
        &[("gain", 1.0), ("size", 0.0)],
        "shader: error: a constant makes the size of the workgroup 0 or negative",
    );
}

#[test]
fn entry_points() {
    for (stage, name) in [(Stage::Compute, "mian"), (Stage::Vertex, "main")] {
        let errors = module()
            .specialize(Some((stage, name)), &[])
            .expect_err("there is none");
        let stage = format!("{stage:?}").to_lowercase();
        assert_eq!(
            errors.to_string(),
            format!("shader: error: there is no entry point `{name}` of the {stage} stage")
        );
    }
    assert!(
        module()
            .specialize(Some((Stage::Compute, "other")), &[])
            .is_ok()
    );
}

#[track_caller]
fn check_define(name: &str, value: &str, expected: &str) {
    let options = Options {
        defines: vec![(name.to_owned(), value.to_owned())],
        ..Options::default()
    };
    let source = Source::Glsl {
        text: "void main() { }",
        stage: Stage::Fragment,
    };
    let errors = load(source, &options).expect_err("a wrong macro");
    assert_eq!(errors.to_string(), expected);
}

#[test]
fn defines() {
    check_define(
        "A B",
        "1",
        "shader: error: the options define `A B`, which is no name",
    );
    check_define(
        "COUNT",
        "1 /* and",
        "shader: error: the options define `COUNT` with a comment that has no end",
    );
    check_define(
        "/*",
        "1",
        "shader: error: the options define `/*`, which is no name",
    );
}
