//! `estampe schema`: the JSON Schemas of files that commands read.

use crate::failure::Failure;
use crate::{batch, output, render};
use clap::{Args, ValueEnum};

/// Prints the JSON Schema of a file that a command reads
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Examples:
  estampe schema > jobs.schema.json
  estampe schema cameras > cameras.schema.json

Editors check files by their schemas as they are written.

Exit codes: 0 success, 2 wrong usage, 3 the schema cannot be written.")]
pub(crate) struct SchemaArgs {
    /// The file: jobs, of `estampe batch --job-file`, or cameras, of `estampe render --cameras`
    #[arg(
        value_name = "FILE",
        value_enum,
        default_value = "jobs",
        hide_possible_values = true
    )]
    file: SchemaName,
}

/// Files with a schema.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum SchemaName {
    /// Job files of `estampe batch`
    Jobs,
    /// Cameras of `estampe render`
    Cameras,
}

/// Runs the command.
pub(crate) fn run(args: &SchemaArgs) -> Result<(), Failure> {
    let schema = match args.file {
        SchemaName::Jobs => batch::schema(),
        SchemaName::Cameras => render::schema_of_cameras(),
    };
    output::print(&format!("{schema:#}\n"))
}
