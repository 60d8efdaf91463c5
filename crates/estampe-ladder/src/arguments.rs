//! The arguments of an example's command line.

use crate::{LadderError, rung};
use estampe_assets::image::ImageFormat;
use std::path::PathBuf;

/// The arguments of an example.
#[derive(Debug)]
pub(crate) struct Arguments {
    pub(crate) output: PathBuf,
    pub(crate) format: ImageFormat,
    pub(crate) model: Option<PathBuf>,
    pub(crate) texture: Option<PathBuf>,
}

impl Arguments {
    pub(crate) fn parse(
        number: u32,
        mut words: impl Iterator<Item = std::ffi::OsString>,
    ) -> Result<Self, LadderError> {
        let mut output = PathBuf::from(format!("{}.png", rung(number)?.name));
        let (mut model, mut texture) = (None, None);
        let usage = || {
            let arguments = "the arguments are [-o FILE] [--model FILE] [--texture FILE]";
            LadderError::Usage(arguments.to_owned())
        };
        while let Some(word) = words.next() {
            let value = words.next().map(PathBuf::from).ok_or_else(usage)?;
            match word.to_str() {
                Some("-o") => output = value,
                Some("--model") => model = Some(value),
                Some("--texture") => texture = Some(value),
                _ => return Err(usage()),
            }
        }
        let format = ImageFormat::from_path(&output).ok_or_else(|| {
            let name = output.display();
            LadderError::Usage(format!("{name}: name the picture .png, .tga or .jpg"))
        })?;
        Ok(Self {
            output,
            format,
            model,
            texture,
        })
    }
}
