//! The options of `estampe batch` and their help.

use crate::choice::ChoiceArgs;
use crate::limits::LimitArgs;
use crate::render::{CamerasArgs, PassArgs, PictureArgs};
use crate::values::{FormatName, ViewName};
use clap::Args;
use std::ffi::OsString;
use std::path::PathBuf;

/// Renders many models in one process: files that are up to date are left alone, and one that
/// fails does not stop the others.
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Examples:
  estampe batch 'models/*.glb' -o 'thumbnails/{stem}.png' --size 256x256
  estampe batch 'models/**/*.stl' -o 'out/{dir}/{stem}-{view}.jpg' --views front,iso
  estampe batch 'models/*.glb' -o 'data/{stem}/{pass}.png' --pass color,depth,normal,object-id
  find . -name '*.obj' | estampe batch - -o 'out/{stem}.png'
  estampe batch 'models/*.glb' -o 'views/{stem}/{camera}.png' --cameras cameras.json
  estampe batch --job-file jobs.toml
  estampe batch 'models/*' -o 'out/{stem}.png' --shard 3/64 --report report.json

Inputs are files, globs (* ? [a-z], and ** for folders) or - for a list on standard input, one path a line. Globs are \
expanded by estampe, so quote them: thousands of files then fit the command line. A folder is an error.

The name of a picture is made of the template: {stem} is the file's name without its extension, {name} with it, {ext} its \
extension, {dir} its folder below that of the glob, {index} its number from 0 in sorted order, {view} the view, {camera} the name of the camera of --cameras, and {pass} the pass of --pass. \
The template's extension is the picture's format. Folders are made. Two pictures of one name are an error before \
anything is drawn.

A picture is up to date if its model, all files that the model named, the options and the versions are those it was drawn \
with, and nobody changed it since. That is kept in a folder .estampe beside the pictures.

Exit codes: 0 all pictures are drawn or up to date, 1 at least one failed, 2 wrong usage, 3 the report cannot be written.

The report has pictures [{input, output, view or null, camera or null, passes [name], status (drawn, up-to-date, failed, limit or cancelled), \
error or null, milliseconds, warnings}] and counts {drawn, up_to_date, failed, limit, cancelled}, in sorted order.")]
pub(crate) struct BatchArgs {
    /// The models: files, globs, or - for a list on standard input
    #[arg(value_name = "INPUT", required_unless_present = "job_file")]
    pub(crate) inputs: Vec<OsString>,

    /// The template of the pictures' names, such as 'out/{stem}.png'
    #[arg(
        short,
        long,
        value_name = "TEMPLATE",
        required_unless_present = "job_file"
    )]
    pub(crate) output: Option<String>,

    /// Jobs with options of their own, in a TOML or JSON file; `estampe schema` prints its schema
    #[arg(long, value_name = "FILE")]
    #[arg(conflicts_with_all = ["inputs", "output", "views", "format"])]
    pub(crate) job_file: Option<PathBuf>,

    /// Draw each model in these views: front,iso,… (its {view} must be in the template)
    #[arg(long, value_name = "NAMES", value_enum, value_delimiter = ',', num_args = 1..)]
    #[arg(conflicts_with_all = ["view", "azimuth", "elevation", "eye", "camera", "cameras"])]
    pub(crate) views: Vec<ViewName>,

    /// The models' format, if neither names nor contents show it
    #[arg(long, value_name = "FORMAT", value_enum, hide_possible_values = true)]
    pub(crate) format: Option<FormatName>,

    /// Models that are drawn at once [default: one for each processor]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    #[arg(help_heading = "Machine")]
    pub(crate) parallel: Option<u16>,

    /// Draw the i-th of n shares of the models, for schedulers of many machines: 1/n to n/n
    #[arg(long, value_name = "I/N", value_parser = shard, help_heading = "Machine")]
    pub(crate) shard: Option<Shard>,

    /// Draw all pictures anew, up to date or not
    #[arg(long)]
    pub(crate) force: bool,

    /// Begin no further model after one has failed
    #[arg(long)]
    pub(crate) fail_fast: bool,

    #[command(flatten)]
    pub(crate) limits: LimitArgs,

    /// Write the report, as JSON, to a file or - for standard output
    #[arg(long, value_name = "FILE", help_heading = "Report")]
    pub(crate) report: Option<PathBuf>,

    /// Write nothing but errors
    #[arg(short, long, help_heading = "Report")]
    pub(crate) quiet: bool,

    #[command(flatten)]
    pub(crate) choice: ChoiceArgs,

    #[command(flatten)]
    pub(crate) picture: PictureArgs,

    #[command(flatten)]
    pub(crate) passes: PassArgs,

    #[command(flatten)]
    pub(crate) cameras: CamerasArgs,
}

/// A share of the work.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Shard {
    /// From 1.
    pub(crate) number: u32,
    pub(crate) count: u32,
}

/// `i/n` with 1 ≤ i ≤ n.
fn shard(text: &str) -> Result<Shard, String> {
    let parts = text.split_once('/').and_then(|(number, count)| {
        let (number, count) = (number.parse().ok()?, count.parse().ok()?);
        (1..=count)
            .contains(&number)
            .then_some(Shard { number, count })
    });
    parts.ok_or_else(|| "write I/N with I from 1 to N, as in 3/64".to_owned())
}
