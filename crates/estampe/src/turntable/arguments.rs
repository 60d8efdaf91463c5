//! The options of `estampe turntable` and their help.

use crate::choice::ChoiceArgs;
use crate::limits::LimitArgs;
use crate::render::{PictureArgs, ReportArgs};
use crate::values::{Destination, FormatName, Source};
use clap::Args;
use estampe_assets::image::animation::{Chroma, FrameRate, LumaWeights};

/// Draws an animation of a model that turns once around: GIF, APNG, WebP, video or pictures.
#[derive(Debug, Clone, Args)]
#[command(mut_arg("size", |arg| arg.default_value("480x360")))]
#[command(after_help = "\
Examples:
  estampe turntable model.glb -o model.gif
  estampe turntable builtin:teapot -o teapot.png --frames 72 --fps 24 --background none
  estampe turntable part.stl -o 'frames/{frame}.png' --size 1920x1080 --elevation 30
  estampe turntable robot.glb -o walk.webp --animate --animation Walk
  estampe turntable model.obj -o - --output-format y4m --fps 30 --frames 240 | ffmpeg -i - model.mp4

The camera goes once around the up axis through the middle of the model (or through --target), from --azimuth (or --view) \
on, towards the right, at one height and distance: the nearest from which no part of the model leaves the picture at any \
angle. Default lights go with the camera; --light stays with the model. After the last frame the first one follows.

Outputs, by the name of OUT or --output-format:
  .gif          256 colours, chosen for all frames together; --background none gives hard edges
  .png, .apng   animated PNG: lossless, with alpha
  .webp         animated WebP: lossless, with alpha
  .y4m, or -    with --output-format y4m: video without compression, for ffmpeg and other encoders
  {frame}       in the name: a picture for each frame, numbered from 0000: .png, .jpg, .tga or .webp

Exit codes: 0 success, 1 the model is missing or invalid, 2 wrong usage, 3 the output cannot be written.

With --json one object is written to standard output, or to standard error with -o -: model, output {path, format, \
width, height, frames, frames_per_second, bytes or null}, milliseconds, warnings [text].")]
pub(crate) struct TurntableArgs {
    /// The model: a file, builtin:NAME, or - for standard input
    #[arg(value_name = "MODEL")]
    pub(crate) model: Source,

    /// The animation: a file named .gif, .png, .webp or .y4m, pictures as in f{frame}.png, or -
    #[arg(short, long, value_name = "OUT", allow_hyphen_values = true)]
    #[arg(value_parser = crate::values::destination())]
    pub(crate) output: Destination,

    /// The model's format: gltf, obj, stl, ply, off or 3mf [default: by extension, else by content]
    #[arg(long, value_name = "FORMAT", value_enum, hide_possible_values = true)]
    pub(crate) format: Option<FormatName>,

    /// The output's format: gif, png, webp, y4m, or of {frame} png, jpeg, tga or webp
    #[arg(long, value_name = "FORMAT", value_enum, hide_possible_values = true)]
    pub(crate) output_format: Option<AnimationFormatName>,

    /// Frames of the turn, 1 to 100000
    #[arg(long, value_name = "N", default_value = "36")]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub(crate) frames: u32,

    /// Frames in a second, 0.1 to 60 (of GIF 50), as in 24 or 29.97
    #[arg(long, value_name = "RATE", default_value = "12", value_parser = rate)]
    pub(crate) fps: FrameRate,

    /// Play the model's animation (--animation, else the first one) during the turn
    #[arg(long, conflicts_with = "time")]
    pub(crate) animate: bool,

    /// Chroma of video: 420, a sample for four pixels, or 444, one for each
    #[arg(long, value_name = "NAME", value_enum, default_value = "420")]
    #[arg(hide_possible_values = true, help_heading = "Video")]
    pub(crate) chroma: ChromaName,

    /// Luma of video: bt601, which ffmpeg assumes, or bt709; 8 bits, limited range
    #[arg(long, value_name = "NAME", value_enum, default_value = "bt601")]
    #[arg(hide_possible_values = true, help_heading = "Video")]
    pub(crate) matrix: MatrixName,

    #[command(flatten)]
    pub(crate) choice: ChoiceArgs,

    #[command(flatten)]
    pub(crate) picture: PictureArgs,

    #[command(flatten)]
    pub(crate) limits: LimitArgs,

    #[command(flatten)]
    pub(crate) report: ReportArgs,
}

/// Formats of animations, and of their numbered pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum AnimationFormatName {
    /// 256 colours
    Gif,
    /// Animated PNG, or numbered PNG
    #[value(alias = "apng")]
    Png,
    /// Animated WebP, or numbered WebP
    Webp,
    /// Video without compression
    Y4m,
    /// Numbered JPEG
    #[value(alias = "jpg")]
    Jpeg,
    /// Numbered TGA
    Tga,
}

/// Resolutions of chroma.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum ChromaName {
    /// A sample for four pixels
    #[value(name = "420")]
    Quarter,
    /// A sample for each pixel
    #[value(name = "444")]
    Full,
}

impl From<ChromaName> for Chroma {
    fn from(name: ChromaName) -> Self {
        match name {
            ChromaName::Quarter => Self::Quarter,
            ChromaName::Full => Self::Full,
        }
    }
}

/// Weights of luma.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum MatrixName {
    /// ITU-R BT.601
    Bt601,
    /// ITU-R BT.709
    Bt709,
}

impl From<MatrixName> for LumaWeights {
    fn from(name: MatrixName) -> Self {
        match name {
            MatrixName::Bt601 => Self::Bt601,
            MatrixName::Bt709 => Self::Bt709,
        }
    }
}

/// A rate with at most three decimals.
fn rate(text: &str) -> Result<FrameRate, String> {
    let (whole, decimals) = text.split_once('.').unwrap_or((text, ""));
    let digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
    let is_number = !whole.is_empty() && digits(whole) && digits(decimals) && decimals.len() <= 3;
    let thousandths = format!("{whole}{decimals:0<3}").parse().ok();
    let thousandths = thousandths.filter(|rate| is_number && (100..=60_000).contains(rate));
    let rate = thousandths.and_then(|thousandths| FrameRate::new(thousandths, 1000));
    rate.ok_or_else(|| "write frames in a second, 0.1 to 60, as in 24 or 29.97".to_owned())
}

#[cfg(test)]
mod tests {
    use super::rate;

    #[test]
    fn rates_are_decimal_numbers() {
        for (text, frames, seconds) in [
            ("24", 24, 1),
            ("12.5", 25, 2),
            ("29.97", 2997, 100),
            ("0.1", 1, 10),
            ("60.000", 60, 1),
        ] {
            let rate = rate(text).expect(text);
            assert_eq!((rate.frames(), rate.seconds()), (frames, seconds), "{text}");
        }
        for wrong in [
            "",
            "0",
            "60.001",
            ".5",
            "1e1",
            "-3",
            "0.0999",
            "24.",
            "+5",
            "999999999",
        ] {
            assert_eq!(rate(wrong).is_ok(), wrong == "24.", "{wrong}");
        }
    }
}
