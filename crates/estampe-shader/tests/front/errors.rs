//! Wrong shaders, and what is said of them.

use estampe_ir::interface::Stage;
use estampe_shader::front::{Options, Source, load};

/// Checks the messages about fragment shaders in GLSL. Returns their number.
pub(crate) fn glsl(cases: &[(&str, &str)]) -> usize {
    in_stage(Stage::Fragment, cases)
}

/// Checks the messages about shaders of a stage in GLSL. Returns their number.
pub(crate) fn in_stage(stage: Stage, cases: &[(&str, &str)]) -> usize {
    check(cases, |text| Source::Glsl { text, stage })
}

/// Checks the messages about modules in WGSL. Returns their number.
pub(crate) fn wgsl(cases: &[(&str, &str)]) -> usize {
    check(cases, Source::Wgsl)
}

fn check<'a>(cases: &[(&'a str, &str)], source: impl Fn(&'a str) -> Source<'a>) -> usize {
    for &(text, expected) in cases {
        match load(source(text), &Options::default()) {
            Ok(_) => panic!("no error in\n{text}"),
            Err(errors) => assert_eq!(errors.to_string(), expected, "{text}"),
        }
    }
    cases.len()
}
