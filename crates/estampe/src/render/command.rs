//! Runs `estampe render`, from arguments to a written image, stage by stage.

use super::arguments::RenderArgs;
use super::cameras::{self, Shots};
use super::draw::{STAGES, draw_with, encoded, image_format};
use super::passes::{self, Files, OutputFormatName};
use super::report::Report;
use super::texture_detail::PictureDetail;
use super::watch;
use crate::failure::Failure;
use crate::input::{Model, Reading};
use crate::output;
use crate::progress::Progress;
use crate::values::Destination;
use estampe_renderer::ViewDirection;
use estampe_scene::Image;
use std::path::PathBuf;

/// Runs the command.
pub(crate) fn run(args: &RenderArgs) -> Result<(), Failure> {
    if args.watch {
        return watch::run(args);
    }
    draw_once(args).map(drop)
}

/// Draws the model, and returns the files that it was read from.
pub(super) fn draw_once(args: &RenderArgs) -> Result<Vec<PathBuf>, Failure> {
    let clock = args.limits.watch("render", &args.model.name());
    let terminal = args.preview.terminal()?;
    // Without a file the preview is the output.
    let output = args.output.as_ref().unwrap_or(&Destination::StandardOutput);
    let shots = Shots::of(args)?;
    let files = match &shots {
        None => Files::of(&args.passes, output, args.output_format)?,
        // Each camera has its files.
        Some(_) => None,
    };
    if terminal.is_some() {
        check_preview(args.output.as_ref(), files.as_ref())?;
    }
    let named = args.output_format.and_then(OutputFormatName::of_picture);
    // Of passes, the files have a format.
    let is_picture = files.is_none() && shots.is_none();
    let picture = is_picture.then(|| image_format(named, output));
    let picture = picture.transpose()?;
    let written = files.as_ref().map_or(&[][..], |files| &files.files);
    for file in written {
        output::check(&file.output)?;
    }
    if is_picture {
        output::check(output)?;
    }
    // Reading and parsing come before.
    let progress = Progress::new(2 + STAGES, args.report.quiet);

    let limits = args.limits.of_reader(args.picture.thread_count());
    let chosen = args.choice.at(args.picture.shader.time);
    let folder = args.choice.folder_of(&args.model)?;
    let source = (&args.model, &folder);
    let reading = Reading {
        options: &chosen,
        limits: &limits,
        detail: &match &shots {
            Some(shots) => shots.detail(&args.picture),
            None => PictureDetail::of(&args.picture),
        },
    };
    let mut model = Model::read(source, args.format, reading, |stage| {
        progress.stage(stage);
    })?;
    if let Some(shots) = &shots {
        let greatest = shots.greatest(&args.picture);
        args.limits
            .check_memory(&model, &greatest, shots.hold_light())?;
        cameras::run(&model, args, shots, &clock, progress)?;
        return Ok(model.files);
    }
    let holds_light = files
        .as_ref()
        .is_some_and(|files| files.format.holds_light());
    args.limits
        .check_memory(&model, &args.picture, holds_light)?;
    let format = match (picture, &files) {
        (Some(format), _) => format,
        (None, Some(files)) => {
            passes::run(&model, args, files, &clock, progress)?;
            return Ok(model.files);
        }
        (None, None) => unreachable!("a picture, or passes"),
    };
    let preview = |image: &Image| terminal.map(|terminal| terminal.bytes(image));
    let drawn = draw_with(
        &mut model,
        &args.picture,
        ViewDirection::default(),
        (output, format),
        (&clock, &progress),
        |image| match preview(image) {
            Some(bytes) if args.output.is_none() => bytes,
            _ => encoded(image, format),
        },
    )?;
    drop(progress);
    if args.output.is_some()
        && let Some(bytes) = preview(&drawn.frame.image)
    {
        output::write(&Destination::StandardOutput, &bytes?)?;
    }
    let report = Report {
        args: &args.picture,
        output,
        model: &model,
        drawn: &drawn,
        shape: None,
    };
    report.write(&args.report)?;
    Ok(model.files)
}

/// Refuses what a preview cannot show.
fn check_preview(output: Option<&Destination>, files: Option<&Files>) -> Result<(), Failure> {
    if files.is_some() {
        return Err(Failure::Usage(
            "--preview shows pictures of 8 bits a channel; name OUT .png, .jpg, .tga or .webp"
                .to_owned(),
        ));
    }
    if output.is_some_and(Destination::is_standard_output) {
        return Err(Failure::Usage(
            "--preview and -o - both write to standard output; omit -o -, or name a file"
                .to_owned(),
        ));
    }
    Ok(())
}
