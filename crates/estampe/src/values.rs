//! Parsers for the values of options.

use clap::builder::{OsStringValueParser, TypedValueParser};
use estampe::Level;
use estampe_assets::ModelFormat;
use estampe_assets::image::ImageFormat;
use estampe_renderer::transforms::round_to_f32;
use estampe_renderer::{Up, ViewDirection};
use estampe_scene::UpAxis;
use glam::DVec3;
use std::path::{Path, PathBuf};

/// The greatest width and height of an image.
pub(crate) const MAX_SIDE: u32 = 16_384;

/// `WxH` in pixels.
pub(crate) fn size(text: &str) -> Result<(u32, u32), String> {
    let side = |text: &str| {
        text.parse()
            .ok()
            .filter(|side| (1..=MAX_SIDE).contains(side))
    };
    let sides = text.split_once(['x', 'X', '×']);
    let sides = sides.and_then(|(width, height)| Some((side(width)?, side(height)?)));
    sides.ok_or_else(|| format!("write WIDTHxHEIGHT, each 1 to {MAX_SIDE} pixels, as in 1024x768"))
}

/// `WxH` of a plot in pixels: large enough for its texts.
pub(crate) fn plot_size(text: &str) -> Result<(u32, u32), String> {
    const LEAST: (u32, u32) = (200, 150);
    match size(text)? {
        (width, height) if width >= LEAST.0 && height >= LEAST.1 => Ok((width, height)),
        _ => Err(format!(
            "a plot has at least {}x{} pixels",
            LEAST.0, LEAST.1
        )),
    }
}

/// A positive distance as the pipeline rounds it.
pub(crate) fn distance(text: &str) -> Result<f32, String> {
    let distance = number(text)
        .map(round_to_f32)
        .filter(|distance| *distance > 0.0);
    distance.ok_or_else(|| "write a distance above 0, as in 0.1".to_owned())
}

/// A positive distance, or `inf`.
pub(crate) fn distance_or_infinity(text: &str) -> Result<f32, String> {
    match text {
        "inf" | "infinity" | "∞" => Ok(f32::INFINITY),
        _ => distance(text).map_err(|message| format!("{message}, or inf")),
    }
}

/// A finite number.
fn number(text: &str) -> Option<f64> {
    text.trim()
        .parse()
        .ok()
        .filter(|number: &f64| number.is_finite())
}

/// A number of a range, both ends included.
pub(crate) fn number_between(text: &str, low: f64, high: f64) -> Result<f64, String> {
    let in_range = number(text).filter(|number| (low..=high).contains(number));
    in_range.ok_or_else(|| format!("write a number from {low} to {high}"))
}

/// Degrees around the up axis.
pub(crate) fn azimuth(text: &str) -> Result<f64, String> {
    number_between(text, -36_000.0, 36_000.0)
}

/// Degrees above the horizontal plane.
pub(crate) fn elevation(text: &str) -> Result<f64, String> {
    number_between(text, -90.0, 90.0)
}

/// Degrees of the vertical opening angle.
pub(crate) fn fov(text: &str) -> Result<f64, String> {
    number_between(text, 0.1, 175.0)
}

/// A fraction of the shorter side of the image.
pub(crate) fn margin(text: &str) -> Result<f64, String> {
    number_between(text, 0.0, 0.49)
}

/// The enlargement of a picture.
pub(crate) fn zoom(text: &str) -> Result<f64, String> {
    number_between(text, 0.01, 1000.0)
}

/// A share, 0 to 1.
pub(crate) fn share(text: &str) -> Result<f32, String> {
    number_between(text, 0.0, 1.0).map(round_to_f32)
}

/// The width of points in pixels.
pub(crate) fn point_size(text: &str) -> Result<f32, String> {
    number_between(text, 0.1, 256.0).map(round_to_f32)
}

/// The width of lines in pixels.
pub(crate) fn line_width(text: &str) -> Result<f32, String> {
    number_between(text, 0.1, 64.0).map(round_to_f32)
}

/// Samples per pixel.
pub(crate) fn samples(text: &str) -> Result<u32, String> {
    let count = text.parse().ok();
    count
        .filter(|count| [1, 2, 4, 8, 16].contains(count))
        .ok_or_else(|| "write 1, 2, 4, 8 or 16".to_owned())
}

/// Ambient light.
pub(crate) fn ambient(text: &str) -> Result<f32, String> {
    let ambient = number_between(text, 0.0, 10.0)?;
    Ok(round_to_f32(ambient))
}

/// `x,y,z`.
pub(crate) fn vector(text: &str) -> Result<DVec3, String> {
    let parts: Vec<Option<f64>> = text.split(',').map(number).collect();
    match parts[..] {
        [Some(x), Some(y), Some(z)] => Ok(DVec3::new(x, y, z)),
        _ => Err("write three numbers with commas between, as in 1,0.5,-2".to_owned()),
    }
}

/// `x,y,z`, not all zero.
pub(crate) fn direction(text: &str) -> Result<DVec3, String> {
    match vector(text)? {
        DVec3::ZERO => {
            Err("0,0,0 is not a direction; write three numbers that are not all zero".to_owned())
        }
        direction => Ok(direction),
    }
}

/// `y`, `z`, `auto` or a direction.
pub(crate) fn up(text: &str) -> Result<Up, String> {
    match text {
        "auto" => Ok(Up::FromScene),
        "y" | "Y" => Ok(Up::Axis(UpAxis::Y)),
        "z" | "Z" => Ok(Up::Axis(UpAxis::Z)),
        _ if text.contains(',') => direction(text).map(Up::Direction),
        _ => Err("write y, z, auto, or a direction as in 0,0,1".to_owned()),
    }
}

/// The name of a SIMD level.
pub(crate) fn simd(text: &str) -> Result<Level, String> {
    Level::named(text).map_err(|error| error.to_string())
}

/// Source of a model.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Source {
    /// A file.
    File(PathBuf),
    /// One of the built-in models, by name.
    Builtin(String),
    /// Standard input.
    StandardInput,
}

impl Source {
    /// For messages.
    pub(crate) fn name(&self) -> String {
        match self {
            Self::File(path) => shown(path),
            Self::Builtin(name) => format!("builtin:{name}"),
            Self::StandardInput => "standard input".to_owned(),
        }
    }
}

impl From<std::ffi::OsString> for Source {
    fn from(text: std::ffi::OsString) -> Self {
        match text.to_str() {
            Some("-") => Self::StandardInput,
            Some(name) if name.starts_with("builtin:") => {
                Self::Builtin(name["builtin:".len()..].to_owned())
            }
            _ => Self::File(text.into()),
        }
    }
}

/// Destination of an image.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Destination {
    /// A file.
    File(PathBuf),
    /// Standard output.
    StandardOutput,
}

impl Destination {
    /// True for standard output.
    pub(crate) fn is_standard_output(&self) -> bool {
        matches!(self, Self::StandardOutput)
    }

    /// The extension, if it can be shown.
    pub(crate) fn extension(&self) -> Option<&str> {
        match self {
            Self::File(path) => path.extension()?.to_str(),
            Self::StandardOutput => None,
        }
    }

    /// The format of the destination's extension.
    pub(crate) fn image_format(&self) -> Option<ImageFormat> {
        match self {
            Self::File(path) => ImageFormat::from_path(path),
            Self::StandardOutput => Some(ImageFormat::Png),
        }
    }
}

/// The parser of destinations. Of options without their value the next option would be one.
pub(crate) fn destination() -> impl TypedValueParser<Value = Destination> {
    OsStringValueParser::new().try_map(|text| {
        let shown = text.to_string_lossy().into_owned();
        let is_option = shown.starts_with("--") || shown.len() == 2 && shown.starts_with('-');
        if is_option {
            Err(format!(
                "this is an option; write ./{shown} for a file of this name"
            ))
        } else {
            Ok(Destination::from(text))
        }
    })
}

impl From<std::ffi::OsString> for Destination {
    fn from(text: std::ffi::OsString) -> Self {
        if text == "-" {
            Self::StandardOutput
        } else {
            Self::File(text.into())
        }
    }
}

/// The path for messages, on one line.
pub(crate) fn shown(path: &Path) -> String {
    crate::terminal::one_line(&path.to_string_lossy()).into_owned()
}

/// Formats of models.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum FormatName {
    /// glTF 2.0: .gltf with its files, or .glb
    #[value(alias = "glb")]
    Gltf,
    /// Wavefront OBJ
    Obj,
    /// Stereolithography, binary or ASCII
    Stl,
    /// Stanford PLY, ASCII or binary
    Ply,
    /// Geomview's OFF, as text
    Off,
    /// 3D Manufacturing Format, a package
    #[value(name = "3mf")]
    ThreeMf,
}

impl From<FormatName> for ModelFormat {
    fn from(name: FormatName) -> Self {
        match name {
            FormatName::Gltf => Self::Gltf,
            FormatName::Obj => Self::Obj,
            FormatName::Stl => Self::Stl,
            FormatName::Ply => Self::Ply,
            FormatName::Off => Self::Off,
            FormatName::ThreeMf => Self::ThreeMf,
        }
    }
}

/// Formats of images.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum ImageFormatName {
    /// Lossless, with alpha
    Png,
    /// Lossy, without alpha
    #[value(alias = "jpg")]
    Jpeg,
    /// Lossless, with alpha, simple
    Tga,
    /// Lossless, with alpha, smaller than PNG
    Webp,
}

impl From<ImageFormatName> for ImageFormat {
    fn from(name: ImageFormatName) -> Self {
        match name {
            ImageFormatName::Png => Self::Png,
            ImageFormatName::Jpeg => Self::Jpeg,
            ImageFormatName::Tga => Self::Tga,
            ImageFormatName::Webp => Self::Webp,
        }
    }
}

/// Named views.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum ViewName {
    /// Azimuth 45, elevation 35.264: isometric with --ortho
    Iso,
    /// From +z
    Front,
    /// From -z
    Back,
    /// From -x
    Left,
    /// From +x
    Right,
    /// From +y
    Top,
    /// From -y
    Bottom,
}

impl From<ViewName> for ViewDirection {
    fn from(name: ViewName) -> Self {
        match name {
            ViewName::Iso => Self::ISO,
            ViewName::Front => Self::FRONT,
            ViewName::Back => Self::BACK,
            ViewName::Left => Self::LEFT,
            ViewName::Right => Self::RIGHT,
            ViewName::Top => Self::TOP,
            ViewName::Bottom => Self::BOTTOM,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_two_numbers_in_range() {
        assert_eq!(size("1024x768"), Ok((1024, 768)));
        assert_eq!(size("1X16384"), Ok((1, 16_384)));
        for wrong in [
            "",
            "x",
            "1024",
            "0x5",
            "5x0",
            "16385x5",
            "1024x768x3",
            "-1x5",
            "1.5x2",
            "a×b",
        ] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn vectors_are_three_finite_numbers() {
        assert_eq!(vector("1, -2.5,3e2"), Ok(DVec3::new(1.0, -2.5, 300.0)));
        for wrong in ["", "1,2", "1,2,3,4", "1,,3", "nan,0,0", "inf,0,0", "a,b,c"] {
            assert!(vector(wrong).is_err(), "{wrong}");
        }
        assert!(direction("0,0,0").is_err() && direction("0,0,-0.0").is_err());
        assert_eq!(up("0,0,1"), Ok(Up::Direction(DVec3::Z)));
        assert_eq!(up("z"), Ok(Up::Axis(UpAxis::Z)));
        assert!(up("x").is_err() && up("0,0,0").is_err());
    }

    #[test]
    fn ranges_hold() {
        assert!(
            fov("35").is_ok() && fov("0").is_err() && fov("180").is_err() && fov("nan").is_err()
        );
        assert!(margin("0").is_ok() && margin("0.5").is_err() && margin("-0.1").is_err());
        assert!(elevation("-90").is_ok() && elevation("90.1").is_err());
        assert_eq!(ambient("0.5"), Ok(0.5));
        assert!(simd("avx1024").is_err_and(|message| message.contains("scalar")));
    }

    #[test]
    fn sources_and_destinations_are_parsed() {
        assert_eq!(
            Source::from(std::ffi::OsString::from("-")),
            Source::StandardInput
        );
        let builtin = Source::Builtin("teapot".to_owned());
        assert_eq!(
            Source::from(std::ffi::OsString::from("builtin:teapot")),
            builtin
        );
        assert_eq!(
            Source::from(std::ffi::OsString::from("./-")),
            Source::File("./-".into())
        );
        assert!(Destination::from(std::ffi::OsString::from("-")).is_standard_output());
        let file = Destination::from(std::ffi::OsString::from("a.TGA"));
        assert_eq!(file.image_format(), Some(ImageFormat::Tga));
    }
}
