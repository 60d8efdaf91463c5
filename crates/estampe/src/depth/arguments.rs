//! The options of `estampe depth` and their help.

use crate::values::{self, Destination};
use clap::Args;
use estampe_visibility::precision::DepthFormat;

/// Prints the least separation that a depth buffer tells apart, by distance.
#[derive(Debug, Clone, Args)]
#[command(after_help = "\
Examples:
  estampe depth --near 0.01 --far 1000 --format d24
  estampe depth --near 0.1 --far inf --format d32f --reversed
  estampe depth --near 1 --far 1000 --format d16 --at 10 --at 100
  estampe depth --near 0.1 --far 10000 --format d16 --log -o depth.svg

Two surfaces parallel to the picture, the first at the distance, the second behind it, are shown in the right \
order if they are at least the separation apart. The column separation is measured: it evaluates the depths that \
the pipeline computes in 32-bit floats and stores in the format. The column formula is that of the format's steps \
alone: s = d*z^2 / (n*f/(f - n) - d*z) for steps d, or s = z*((f/n)^d - 1) with --log. A - says that no surface up to \
the far plane is told apart from the first.

Remedies, in this order: move the near plane away (the separation is inversely proportional to it), more bits, d32f \
with --reversed. The unit is that of --near.

A plot is drawn with -o: the measurement in blue, the formula dashed, the other formats in grey.

Exit codes: 0 success, 2 wrong usage, 3 the plot cannot be written.

With --json one object is written to standard output, or to standard error with -o -: near, far (null if infinite), \
format, reversed, logarithmic, rows [{distance, stored, separation, formula}] (separation and formula null where the \
table has -), output {path, format, bytes} or null. An error gives {error, exit_code}.")]
pub(crate) struct DepthArgs {
    /// The distance of the near plane
    #[arg(long, value_name = "N", value_parser = values::distance, allow_hyphen_values = true)]
    pub(crate) near: f32,

    /// The distance of the far plane, or inf
    #[arg(long, value_name = "F", value_parser = values::distance_or_infinity, allow_hyphen_values = true)]
    pub(crate) far: f32,

    /// The depth format: d16, d24 (fixed point of 16 and 24 bits) or d32f (float)
    #[arg(long, value_name = "FORMAT", value_enum, hide_possible_values = true)]
    pub(crate) format: DepthFormatName,

    /// Depth 1 at the near plane, 0 at the far plane
    #[arg(long)]
    pub(crate) reversed: bool,

    /// Logarithmic depth, written by the fragment shader: log(z/n) / log(f/n)
    #[arg(long)]
    pub(crate) log: bool,

    /// A distance to print, between the planes; repeatable [default: 1, 2, 5, 10 and so on]
    #[arg(long, value_name = "Z", value_parser = values::distance, allow_hyphen_values = true)]
    pub(crate) at: Vec<f32>,

    /// The plot: a file named .svg, .png, .jpg, .tga or .webp, or - for standard output
    #[arg(short, long, value_name = "OUT", allow_hyphen_values = true)]
    #[arg(value_parser = crate::values::destination())]
    pub(crate) output: Option<Destination>,

    /// The plot's format: svg, png, jpeg, tga or webp [default: by OUT's extension]
    #[arg(
        long,
        value_name = "FORMAT",
        value_enum,
        hide_possible_values = true,
        requires = "output"
    )]
    pub(crate) output_format: Option<PlotFormatName>,

    /// Width and height of the plot in pixels
    #[arg(long, value_name = "WxH", default_value = "560x380", value_parser = values::plot_size)]
    pub(crate) size: (u32, u32),

    /// Write the table as one JSON object
    #[arg(long, help_heading = "Report")]
    pub(crate) json: bool,

    /// Print no table
    #[arg(short, long, help_heading = "Report")]
    pub(crate) quiet: bool,
}

/// Names of depth formats.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum DepthFormatName {
    /// 16 bits, fixed point
    D16,
    /// 24 bits, fixed point
    D24,
    /// 32-bit floats
    #[value(alias = "d32")]
    D32f,
}

impl From<DepthFormatName> for DepthFormat {
    fn from(name: DepthFormatName) -> Self {
        match name {
            DepthFormatName::D16 => Self::Unorm16,
            DepthFormatName::D24 => Self::Unorm24,
            DepthFormatName::D32f => Self::Float32,
        }
    }
}

/// Formats of plots.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum PlotFormatName {
    /// Scalable, with text
    Svg,
    /// A picture, lossless
    Png,
    /// A picture, lossy
    #[value(alias = "jpg")]
    Jpeg,
    /// A picture, lossless, simple
    Tga,
    /// A picture, lossless, small
    Webp,
}
