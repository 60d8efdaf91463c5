//! The files of passes.

use super::arguments::{OutputFormatName, PassArgs, PassName};
use crate::failure::Failure;
use crate::values::{Destination, shown};
use std::path::Path;

/// The text in a name that stands for the pass.
const PLACEHOLDER: &str = "{pass}";

/// Formats that hold passes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PassFormat {
    Exr,
    /// Radiance HDR, of colours.
    Hdr,
    Png,
}

impl PassFormat {
    /// True if colours are light that is not clipped.
    pub(crate) fn holds_light(self) -> bool {
        match self {
            Self::Exr | Self::Hdr => true,
            Self::Png => false,
        }
    }
}

/// A file, and what it holds.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PassFile {
    pub(crate) output: Destination,
    pub(crate) passes: Vec<PassName>,
}

/// All files of one format.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Files {
    pub(crate) format: PassFormat,
    pub(crate) files: Vec<PassFile>,
}

impl Files {
    /// The files of the options; `None` if one picture is asked for.
    pub(crate) fn of(
        args: &PassArgs,
        output: &Destination,
        named: Option<OutputFormatName>,
    ) -> Result<Option<Self>, Failure> {
        let path = match output {
            Destination::File(path) => Some(path.as_path()),
            Destination::StandardOutput => None,
        };
        let has = |extension: &str| {
            let found = path.and_then(Path::extension);
            found.is_some_and(|found| found.eq_ignore_ascii_case(extension))
        };
        let is = |format: OutputFormatName, extension: &str| match named {
            Some(named) => named == format,
            None => has(extension),
        };
        let is_exr = is(OutputFormatName::Exr, "exr");
        let is_hdr = is(OutputFormatName::Hdr, "hdr");
        let is_png = is(OutputFormatName::Png, "png");
        if args.pass.is_empty() && !is_exr && !is_hdr {
            return Ok(None);
        }
        let mut passes = args.pass.clone();
        passes.sort_unstable();
        passes.dedup();
        if passes.is_empty() {
            passes.push(PassName::Color);
        }
        let name = path.and_then(Path::to_str);
        let placed = name.filter(|name| name.contains(PLACEHOLDER));
        let format = match () {
            () if is_exr => PassFormat::Exr,
            () if is_hdr => PassFormat::Hdr,
            () if is_png && placed.is_some() => PassFormat::Png,
            () => {
                return Err(Failure::Usage(
                    "passes are written as OpenEXR, or as a PNG for each: name OUT .exr, or with \
                     {pass} as in scene-{pass}.png"
                        .to_owned(),
                ));
            }
        };
        if format == PassFormat::Png && passes.contains(&PassName::Position) {
            return Err(Failure::Usage(
                "PNG cannot hold positions, which are floats; name OUT .exr".to_owned(),
            ));
        }
        let is_color = |pass: &PassName| !pass.is_of_surfaces();
        let fits = placed.is_some() || passes.len() == 1;
        if format == PassFormat::Hdr && !(fits && passes.iter().all(is_color)) {
            return Err(Failure::Usage(
                "Radiance HDR holds one picture, color or albedo; name OUT .exr for other passes, or for \
                 several"
                    .to_owned(),
            ));
        }
        let files = match placed {
            Some(name) => { passes.iter() }
                .map(|&pass| PassFile {
                    output: Destination::File(name.replace(PLACEHOLDER, &pass.name()).into()),
                    passes: vec![pass],
                })
                .collect(),
            None => vec![PassFile {
                output: output.clone(),
                passes,
            }],
        };
        Ok(Some(Self { format, files }))
    }

    /// The passes of all files.
    pub(crate) fn passes(&self) -> Vec<PassName> {
        let passes = self.files.iter().flat_map(|file| &file.passes);
        passes.copied().collect()
    }

    /// For messages.
    pub(super) fn name(&self) -> String {
        let name = |file: &PassFile| match &file.output {
            Destination::File(path) => shown(path),
            Destination::StandardOutput => "standard output".to_owned(),
        };
        self.files.iter().map(name).collect::<Vec<_>>().join(", ")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;

    fn files(output: &str, pass: &[PassName]) -> Result<Option<Vec<String>>, Failure> {
        let args = PassArgs {
            pass: pass.to_vec(),
            depth_unit: 0.001,
        };
        let output = Destination::File(PathBuf::from(output));
        let files = Files::of(&args, &output, None)?;
        Ok(files.map(|files| {
            let name = |file: &PassFile| match &file.output {
                Destination::File(path) => format!("{} {}", path.display(), file.passes.len()),
                Destination::StandardOutput => unreachable!("a file"),
            };
            files.files.iter().map(name).collect()
        }))
    }

    #[test]
    fn the_name_says_how_passes_are_written() {
        use PassName::{Color, Depth, ObjectId, Position};
        assert_eq!(files("a.png", &[]).ok(), Some(None));
        assert_eq!(
            files("a.exr", &[]).ok(),
            Some(Some(vec!["a.exr 1".to_owned()]))
        );
        let all = files("d/a.EXR", &[Depth, Position, Depth]);
        assert_eq!(all.ok(), Some(Some(vec!["d/a.EXR 2".to_owned()])));
        let each = files("d/{pass}.png", &[ObjectId, Color]);
        let expected = ["d/color.png 1", "d/object-id.png 1"].map(str::to_owned);
        assert_eq!(each.ok(), Some(Some(expected.to_vec())));
        let folders = files("{pass}/a.png", &[ObjectId, Color]);
        let expected = ["color/a.png 1", "object-id/a.png 1"].map(str::to_owned);
        assert_eq!(folders.ok(), Some(Some(expected.to_vec())));
        assert!(files("a.png", &[Depth]).is_err());
        assert!(files("{pass}.jpg", &[Depth]).is_err());
        assert!(files("{pass}.png", &[Position]).is_err());
        assert_eq!(
            files("a.hdr", &[]).ok(),
            Some(Some(vec!["a.hdr 1".to_owned()]))
        );
        assert!(files("a.hdr", &[Depth]).is_err());
        assert!(files("a.hdr", &[Color, PassName::Albedo]).is_err());
        assert!(files("{pass}.hdr", &[Color, PassName::Albedo]).is_ok());
    }
}
