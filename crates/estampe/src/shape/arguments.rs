//! The options of `estampe shape` and their help.

use super::grid::{NamedRange, Resolution, named_range, resolution, tube_radius};
use crate::render::{PictureArgs, ReportArgs};
use crate::values::Destination;
use clap::{ArgGroup, Args};

/// Meshes a function: writes a model (OBJ, STL, PLY), or draws a picture (PNG, JPEG, TGA).
#[derive(Debug, Clone, Args)]
#[command(group(ArgGroup::new("function").required(true).args(["explicit", "parametric", "implicit"])))]
#[command(after_help = "\
Examples:
  estampe shape --explicit 'sin(x) + cos(y)' -o waves.png
  estampe shape --explicit '1/x' --range y=-4:4 -o hyperbola.png
  estampe shape --parametric 'cos(s)*cos(t), sin(s)*cos(t), sin(t)' --range t=-pi/2:pi/2 -o ball.obj
  estampe shape --parametric 'cos(t), sin(t), t/8' --range t=0:6*pi --tube 0.1 -o spring.stl
  estampe shape --implicit 'x^2 + y^2 + z^2 = 1' -o sphere.ply --resolution 96
  estampe shape --implicit '(x^2 + y^2)^2 = 2*(x^2 - y^2)' -o lemniscate.png

Expressions have numbers, + - * / ^ (2^3^2 is 2^9, -2^2 is -4), parentheses, the constants pi, e and tau, and \
the functions sin cos tan asin acos atan atan2 sinh cosh tanh exp ln log2 sqrt abs min max floor sign pow. \
Multiplication is written: 2*x. Normals come from exact derivatives.

A function may jump, have poles, or be undefined in places: the curve or surface is interrupted there. Values \
of --explicit are cut by a range of theirs: --range y=-4:4 for a curve, z=-4:4 for a surface. Roots of \
--implicit are found where the function changes its sign; those of (x - 1)^2 are not.

Curves are lines in OBJ and PLY, and drawn as round tubes. STL holds triangles only: add --tube for a curve. \
Surfaces that meet themselves, such as the sphere above, share vertices there and are closed.

Space: curves in the plane have z = 0 and are drawn from the front, all else has Z up and is drawn so. Files \
have the same coordinates; draw one of a surface by estampe render FILE --up z.

Exit codes: 0 success, 1 the function has nothing to mesh in its ranges, 2 wrong usage or a mistake in an \
expression, 3 the output cannot be written.

With --json one object is written to standard output, or to standard error with -o -. For a picture it is that \
of estampe render and also has shape; for a model: model, shape {kind, expressions, ranges {NAME: [FROM, TO]}, \
resolution, interruptions}, output {path, format, bytes}, counts, bounds {min, max} or null, timings_ms {mesh, \
encode, write, total}, warnings, warning_count. An error gives {error, exit_code}.")]
pub(crate) struct ShapeArgs {
    /// y of a curve over x, or z of a surface over x and y, if the expression names y
    #[arg(long, value_name = "EXPR", allow_hyphen_values = true)]
    pub(crate) explicit: Option<String>,

    /// Two or three coordinates with commas between: of a curve over t, or a surface over s and t
    #[arg(long, value_name = "EXPR,EXPR[,EXPR]", allow_hyphen_values = true)]
    pub(crate) parametric: Option<String>,

    /// The curve in x and y, or the surface in x, y and z, at whose points this is 0; or an
    /// equation LEFT = RIGHT
    #[arg(long, value_name = "EXPR", allow_hyphen_values = true)]
    pub(crate) implicit: Option<String>,

    /// The range of a variable, as in x=-3:3 or t=0:2*pi; repeatable [default: -5:5 for --explicit,
    /// 0:tau for --parametric, -2:2 for --implicit]
    #[arg(long, value_name = "NAME=FROM:TO", value_parser = named_range)]
    pub(crate) range: Vec<NamedRange>,

    /// Cells along each variable, or along all: 1000 segments of a curve (256 if implicit), 128
    /// cells of a surface (64 along the longest side if implicit) [default: these]
    #[arg(long, value_name = "N[xM[xK]]", value_parser = resolution)]
    pub(crate) resolution: Option<Resolution>,

    /// The model or picture: a file named .obj, .stl, .ply, .png, .jpg, .tga or .webp, or - for
    /// standard output
    #[arg(short, long, value_name = "OUT", allow_hyphen_values = true)]
    #[arg(value_parser = crate::values::destination())]
    pub(crate) output: Destination,

    /// The output's format: obj, stl, ply, png, jpeg, tga or webp [default: by OUT's extension]
    #[arg(long, value_name = "FORMAT", value_enum, hide_possible_values = true)]
    pub(crate) output_format: Option<ShapeFormat>,

    /// Make a curve a tube of this radius [default: in pictures, 0.5 % of its extent]
    #[arg(long, value_name = "RADIUS", value_parser = tube_radius, allow_hyphen_values = true)]
    pub(crate) tube: Option<f64>,

    /// Write texture coordinates of a surface; its seams are then not closed
    #[arg(long)]
    pub(crate) uvs: bool,

    #[command(flatten)]
    pub(crate) picture: PictureArgs,

    #[command(flatten)]
    pub(crate) report: ReportArgs,
}

/// Formats of models and pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum ShapeFormat {
    /// Wavefront OBJ
    Obj,
    /// ASCII STL
    Stl,
    /// ASCII PLY
    Ply,
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
