//! `estampe shader`: shaders as text on the command line.
//!
//! ```text
//! source (file, language, stage; shader toys) -> module -> check: errors with their place
//!                                                       -> image: the picture of a fragment shader
//!                                                       -> reflect: what it reads and writes
//!                                                       -> dump: what the compiler makes of it
//! ```
//!
//! `template` writes shaders for surfaces, which `crate::render` draws. [`resources`] and
//! [`uniforms`] make what shaders bind of the options in [`values`].

mod check;
mod dump;
mod image;
mod place;
mod reflect;
pub(crate) mod resources;
pub(crate) mod source;
mod template;
mod toy;
pub(crate) mod triangle;
pub(crate) mod uniforms;
pub(crate) mod values;

use crate::failure::{DONE, Failure};
use clap::{Args, Subcommand};

/// Checks, draws, describes and compiles shaders as text: WGSL, GLSL and SPIR-V.
#[derive(Debug, Clone, Args)]
#[command(arg_required_else_help = true)]
#[command(after_help = "\
Examples:
  estampe shader check sky.wgsl
  estampe shader image sky.wgsl -o sky.png
  estampe shader reflect model.vert
  estampe shader dump sky.wgsl --stage asm
  estampe shader template > my.wgsl

`estampe help shader COMMAND` explains all options of a command. `estampe compute` runs compute shaders, `estampe render \
--shader` draws models.")]
pub(crate) struct ShaderArgs {
    #[command(subcommand)]
    command: ShaderCommand,
}

#[derive(Debug, Clone, Subcommand)]
enum ShaderCommand {
    Check(check::CheckArgs),
    // Boxed, because it has many options.
    Image(Box<image::ImageArgs>),
    Reflect(reflect::ReflectArgs),
    Dump(dump::DumpArgs),
    Template(template::TemplateArgs),
}

impl ShaderArgs {
    /// The name for messages.
    pub(crate) fn name(&self) -> &'static str {
        match self.command {
            ShaderCommand::Check(_) => "shader check",
            ShaderCommand::Image(_) => "shader image",
            ShaderCommand::Reflect(_) => "shader reflect",
            ShaderCommand::Dump(_) => "shader dump",
            ShaderCommand::Template(_) => "shader template",
        }
    }

    /// Whether a JSON object is wanted, and if so whether it goes to standard error.
    pub(crate) fn json(&self) -> Option<bool> {
        match &self.command {
            ShaderCommand::Check(args) => args.json.then_some(false),
            ShaderCommand::Image(_) | ShaderCommand::Dump(_) | ShaderCommand::Template(_) => None,
            ShaderCommand::Reflect(args) => args.json.then_some(false),
        }
    }
}

/// Runs the command. Returns the exit code.
pub(crate) fn run(args: &ShaderArgs) -> Result<u8, Failure> {
    match &args.command {
        ShaderCommand::Check(args) => check::run(args),
        ShaderCommand::Image(args) => image::run(args).map(|()| DONE),
        ShaderCommand::Reflect(args) => reflect::run(args).map(|()| DONE),
        ShaderCommand::Dump(args) => dump::run(args).map(|()| DONE),
        ShaderCommand::Template(args) => template::run(args).map(|()| DONE),
    }
}
