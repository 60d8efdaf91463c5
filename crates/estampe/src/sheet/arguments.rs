//! The options of `estampe sheet` and their help.

use crate::choice::ChoiceArgs;
use crate::limits::LimitArgs;
use crate::render::{PictureArgs, ReportArgs};
use crate::values::{Destination, FormatName, ImageFormatName, ViewName};
use clap::{Args, ValueEnum};
use estampe_renderer::TextHeight;
use std::ffi::OsString;

/// Draws many models, or the views of one, as labelled cells of one picture: a contact sheet.
#[derive(Debug, Clone, Args)]
#[command(mut_arg("size", |arg| {
    arg.long("cell")
        .default_value("256x192")
        .help("Width and height of the picture in a cell, in pixels, each 1 to 16384")
}))]
#[command(after_help = "\
Examples:
  estampe sheet 'models/*.glb' -o sheet.png
  estampe sheet a.stl b.stl c.stl -o parts.png --columns 3 --cell 320x240 --shading flat
  estampe sheet robot.glb -o views.png --views front,left,back,top,iso
  estampe sheet robot.glb -o turn.png --turn 8 --labels none --background none
  find . -name '*.obj' | estampe sheet - -o sheet.jpg --labels path

Inputs are files, globs (* ? [a-z], and ** for folders), built-in models (builtin:NAME), or - for a list on standard input, \
one path a line. Cells are in the order of the inputs; the files of a glob are sorted. Globs are expanded by estampe too, so \
quote them where the command line would become too long.

With --views or --turn each model has a cell for each view; several models then have a row each. The views of --turn \
go once around the model, from --azimuth (or --view) on, at one distance.

A model that fails has a cell with its problem, and the others are drawn. The sheet has at most 16384 pixels a side.

Exit codes: 0 all cells are drawn, 1 at least one has failed (the sheet is written), 2 wrong usage, 3 the sheet cannot be \
written.

With --json one object is written to standard output, or to standard error with -o -: output {path, format, width, height, \
columns, rows, bytes}, cells [{model, view or null, x, y, width, height, status (drawn, failed or limit), error or null, \
warnings}], counts {drawn, failed, limit}, milliseconds. x and y are those of the cell's picture, from the upper left corner.")]
pub(crate) struct SheetArgs {
    /// The models: files, globs, builtin:NAME, or - for a list on standard input
    #[arg(value_name = "INPUT", required = true)]
    pub(super) inputs: Vec<OsString>,

    /// The sheet: a file named .png, .jpg, .tga or .webp, or - for standard output
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: Destination,

    /// The sheet's format: png, jpeg, tga or webp [default: by OUT's extension; png for -]
    #[arg(long, value_name = "FORMAT", value_enum, hide_possible_values = true)]
    pub(super) output_format: Option<ImageFormatName>,

    /// The models' format, if neither names nor contents show it
    #[arg(long, value_name = "FORMAT", value_enum, hide_possible_values = true)]
    pub(super) format: Option<FormatName>,

    /// Cells in a row [default: a sheet that is nearly square; of several models with views, the
    /// views]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=16_384))]
    #[arg(help_heading = "Sheet")]
    pub(super) columns: Option<u32>,

    /// Space between cells and around them, in pixels
    #[arg(long, value_name = "N", default_value = "8", help_heading = "Sheet")]
    #[arg(value_parser = clap::value_parser!(u32).range(0..=1024))]
    pub(super) gap: u32,

    /// Labels below the cells: auto, none, name, stem, path, view or both
    ///
    /// name: the file's name; stem: without its extension; path: as given or found; view: the
    /// view's name, or the azimuth of --turn; both: name and view; auto: what tells the cells
    /// apart. A long label loses its middle.
    #[arg(long, value_name = "WHAT", value_enum, default_value = "auto")]
    #[arg(hide_possible_values = true, help_heading = "Sheet")]
    pub(super) labels: LabelName,

    /// Line height of labels in pixels: 16, 20, 24 or 32
    #[arg(long, value_name = "PX", value_enum, default_value = "16")]
    #[arg(hide_possible_values = true, help_heading = "Sheet")]
    pub(super) label_size: LabelSize,

    /// Draw each model in these views: front,iso,…
    #[arg(long, value_name = "NAMES", value_enum, value_delimiter = ',', num_args = 1..)]
    #[arg(help_heading = "Sheet")]
    #[arg(conflicts_with_all = ["view", "azimuth", "elevation", "eye", "camera", "turn"])]
    pub(super) views: Vec<ViewName>,

    /// Draw each model in this number of views around it, 1 to 1000
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    #[arg(conflicts_with_all = ["eye", "camera"], help_heading = "Sheet")]
    pub(super) turn: Option<u32>,

    /// Models that are drawn at once [default: one for each processor]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    #[arg(help_heading = "Machine")]
    pub(super) parallel: Option<u16>,

    #[command(flatten)]
    pub(super) choice: ChoiceArgs,

    #[command(flatten)]
    pub(super) picture: PictureArgs,

    #[command(flatten)]
    pub(super) limits: LimitArgs,

    #[command(flatten)]
    pub(crate) report: ReportArgs,
}

/// Texts of labels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum LabelName {
    /// What tells the cells apart
    Auto,
    /// No labels
    None,
    /// The file's name
    Name,
    /// The file's name without its extension
    Stem,
    /// The path
    Path,
    /// The view
    View,
    /// Name and view
    Both,
}

/// Heights of labels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum LabelSize {
    /// 16 pixels
    #[value(name = "16")]
    Px16,
    /// 20 pixels
    #[value(name = "20")]
    Px20,
    /// 24 pixels
    #[value(name = "24")]
    Px24,
    /// 32 pixels
    #[value(name = "32")]
    Px32,
}

impl From<LabelSize> for TextHeight {
    fn from(size: LabelSize) -> Self {
        match size {
            LabelSize::Px16 => Self::Px16,
            LabelSize::Px20 => Self::Px20,
            LabelSize::Px24 => Self::Px24,
            LabelSize::Px32 => Self::Px32,
        }
    }
}
