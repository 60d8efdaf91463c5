//! Formats of the output, and their names.

use super::arguments::{AnimationFormatName, TurntableArgs};
use crate::failure::Failure;
use crate::values::Destination;
use clap::ValueEnum;
use estampe_assets::image::ImageFormat;
use std::path::PathBuf;

/// The text in a name that stands for the frame's number.
const PLACEHOLDER: &str = "{frame}";

/// What is written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Output {
    Gif,
    Apng,
    Webp,
    Y4m,
    /// Numbered pictures.
    Pictures(ImageFormat),
}

impl Output {
    /// The output of the options.
    pub(super) fn of(args: &TurntableArgs) -> Result<Self, Failure> {
        use AnimationFormatName as Name;
        let extension = args.output.extension();
        let by_name = |extension: &str| AnimationFormatName::from_str(extension, true).ok();
        let format = args.output_format.or_else(|| by_name(extension?));
        let is_numbered = name_of(&args.output).is_some_and(|name| name.contains(PLACEHOLDER));
        let format = format.ok_or_else(|| {
            let advice = match extension.map(str::to_ascii_lowercase).as_deref() {
                Some("mp4" | "mov" | "mkv" | "webm" | "avi") => {
                    "for other programs' video: -o - --output-format y4m | ffmpeg -i - OUT"
                }
                _ => "name it .gif, .png, .webp or .y4m, or add --output-format",
            };
            Failure::Usage(format!("OUT's name does not show the format; {advice}"))
        })?;
        match (format, is_numbered) {
            (Name::Png, true) => Ok(Self::Pictures(ImageFormat::Png)),
            (Name::Jpeg, true) => Ok(Self::Pictures(ImageFormat::Jpeg)),
            (Name::Tga, true) => Ok(Self::Pictures(ImageFormat::Tga)),
            (Name::Webp, true) => Ok(Self::Pictures(ImageFormat::Webp)),
            (Name::Gif | Name::Y4m, true) => Err(Failure::Usage(
                "GIF and Y4M hold all frames in one file; omit {frame}, or name pictures .png, \
                 .jpg, .tga or .webp"
                    .to_owned(),
            )),
            (Name::Gif, false) => Ok(Self::Gif),
            (Name::Png, false) => Ok(Self::Apng),
            (Name::Webp, false) => Ok(Self::Webp),
            (Name::Y4m, false) => Ok(Self::Y4m),
            (Name::Jpeg | Name::Tga, false) => Err(Failure::Usage(
                "JPEG and TGA hold one picture; add {frame} to the name for numbered ones, or name \
                 it .gif, .png, .webp or .y4m"
                    .to_owned(),
            )),
        }
    }

    /// For the report.
    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::Gif => "gif",
            Self::Apng => "apng",
            Self::Webp => "webp",
            Self::Y4m => "y4m",
            Self::Pictures(ImageFormat::Png) => "numbered png",
            Self::Pictures(ImageFormat::Jpeg) => "numbered jpeg",
            Self::Pictures(ImageFormat::Tga) => "numbered tga",
            Self::Pictures(_) => "numbered webp",
        }
    }
}

/// The name of the file, if it is text.
fn name_of(output: &Destination) -> Option<&str> {
    match output {
        Destination::File(path) => path.file_name()?.to_str(),
        Destination::StandardOutput => None,
    }
}

/// The destination of a frame: its number, with as many digits as the last one has, at least four,
/// in place of `{frame}`.
pub(super) fn numbered(output: &Destination, frame: u32, count: u32) -> Destination {
    let (Destination::File(path), Some(name)) = (output, name_of(output)) else {
        return output.clone();
    };
    let digits = count.saturating_sub(1).to_string().len().max(4);
    let name = name.replace(PLACEHOLDER, &format!("{frame:0digits$}"));
    let path: PathBuf = path.with_file_name(name);
    Destination::File(path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_same_digits() {
        let name = |name: &str, frame, count| {
            let output = Destination::File(PathBuf::from(name));
            let Destination::File(path) = numbered(&output, frame, count) else {
                unreachable!("a file");
            };
            path.to_string_lossy().into_owned()
        };
        assert_eq!(name("a/f{frame}.png", 7, 36), "a/f0007.png");
        assert_eq!(name("{frame}-{frame}.tga", 7, 10_001), "00007-00007.tga");
        assert_eq!(name("{frame}/plain.png", 7, 36), "{frame}/plain.png");
    }
}
