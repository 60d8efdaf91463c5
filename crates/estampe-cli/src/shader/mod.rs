//! `estampe shader`: shaders as text on the command line.
//!
//! ```text
//! source (file, language, stage) -> module -> check: errors with their place
//! ```

mod check;
mod source;

use crate::failure::Failure;
use clap::{Args, Subcommand};

/// Checks shaders as text: WGSL, GLSL and SPIR-V.
#[derive(Debug, Clone, Args)]
#[command(arg_required_else_help = true)]
pub(crate) struct ShaderArgs {
    #[command(subcommand)]
    command: ShaderCommand,
}

#[derive(Debug, Clone, Subcommand)]
enum ShaderCommand {
    Check(check::CheckArgs),
}

impl ShaderArgs {
    /// The name for messages.
    pub(crate) fn name(&self) -> &'static str {
        match self.command {
            ShaderCommand::Check(_) => "shader check",
        }
    }

    /// Whether a JSON object is wanted, and if so whether it goes to standard error.
    pub(crate) fn json(&self) -> Option<bool> {
        match &self.command {
            ShaderCommand::Check(args) => args.json.then_some(false),
        }
    }
}

/// Runs the command. Returns the exit code.
pub(crate) fn run(args: &ShaderArgs) -> Result<u8, Failure> {
    match &args.command {
        ShaderCommand::Check(args) => check::run(args),
    }
}
