//! `estampe shader template`: a shader to begin with, for `estampe render --shader`.

use crate::failure::Failure;
use clap::Args;

/// Writes a working shader for `estampe render --shader`.
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Examples:
  estampe shader template > my.wgsl
  estampe render builtin:teapot -o teapot.png --shader my.wgsl --set gloss=0.5
  estampe shader template glsl > my.frag

Its comments name the inputs and uniforms that have values by themselves.

Exit codes: 0 success, 2 wrong usage, 3 the shader cannot be written.")]
pub(crate) struct TemplateArgs {
    /// The language: wgsl or glsl
    #[arg(value_name = "LANGUAGE", value_enum, default_value = "wgsl")]
    #[arg(hide_possible_values = true)]
    language: TemplateLanguage,
}

/// Languages of templates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum TemplateLanguage {
    /// A vertex and a fragment shader
    Wgsl,
    /// A fragment shader
    Glsl,
}

/// Runs the command.
pub(crate) fn run(args: &TemplateArgs) -> Result<(), Failure> {
    let text = match args.language {
        TemplateLanguage::Wgsl => include_str!("surface.wgsl"),
        TemplateLanguage::Glsl => include_str!("surface.frag"),
    };
    crate::output::print(text)
}
