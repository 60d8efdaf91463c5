//! The `main` of an example: arguments, a picture, a file.

use crate::arguments::Arguments;
use crate::{Course, LadderError, Model, Picture};
use estampe_assets::image::decode;
use estampe_assets::{AssetError, Limits, read_stream};
use estampe_scene::Image;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Runs an example: draws the picture of a rung and writes it.
///
/// The arguments are `-o FILE` (PNG, TGA or JPEG by its extension; default the rung's name with
/// `.png`), `--model FILE` and `--texture FILE` (default the built-in ones). Errors are printed
/// as a sentence; the exit code is 1 if the picture could not be drawn or written, 2 if the
/// arguments are wrong.
#[must_use]
pub fn run(number: u32, draw: fn(&Course) -> Result<Picture, LadderError>) -> ExitCode {
    let written = || -> Result<PathBuf, LadderError> {
        let arguments = Arguments::parse(number, std::env::args_os().skip(1))?;
        let mut course = Course::new()?;
        if let Some(path) = &arguments.model {
            course.model = Model::read(path)?;
        }
        if let Some(path) = &arguments.texture {
            course.model.texture = read_texture(path)?;
        }
        let file = draw(&course)?.encode(arguments.format)?;
        write(&arguments.output, &file)?;
        Ok(arguments.output)
    };
    match written() {
        Ok(path) => {
            eprintln!("wrote {}", path.display());
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("{error}");
            let is_usage = matches!(error, LadderError::Usage(_));
            ExitCode::from(if is_usage { 2 } else { 1 })
        }
    }
}

fn read_texture(path: &Path) -> Result<Image, LadderError> {
    let limits = Limits::default();
    let name = path.display().to_string();
    let bytes = File::open(path).and_then(|file| read_stream(file, &limits));
    let bytes = bytes.map_err(|cause| {
        AssetError::io(cause.to_string(), "check the path and its permissions").in_file(&name)
    })?;
    Ok(decode(&bytes, &limits).map_err(|error| error.in_file(&name))?)
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), LadderError> {
    std::fs::write(path, bytes).map_err(|cause| LadderError::Write {
        path: path.display().to_string(),
        cause,
    })
}
