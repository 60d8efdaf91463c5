//! Runs `estampe render`, from arguments to a written image, stage by stage.

use super::arguments::RenderArgs;
use super::draw::{STAGES, draw, image_format};
use super::passes::{self, Files, OutputFormatName};
use super::report::Report;
use super::texture_detail::PictureDetail;
use crate::failure::Failure;
use crate::input::{Model, Reading};
use crate::output;
use crate::progress::Progress;
use estampe_renderer::ViewDirection;

/// Runs the command.
pub(crate) fn run(args: &RenderArgs) -> Result<(), Failure> {
    let clock = args.limits.watch("render", &args.model.name());
    let files = Files::of(&args.passes, &args.output, args.output_format)?;
    let named = args.output_format.and_then(OutputFormatName::of_picture);
    // Of passes, the files have a format.
    let picture = files.is_none().then(|| image_format(named, &args.output));
    let picture = picture.transpose()?;
    output::check(&args.output)?;
    // Reading and parsing come before.
    let progress = Progress::new(2 + STAGES, args.report.quiet);

    let limits = args.limits.of_reader(args.picture.thread_count());
    let chosen = args.choice.at(args.picture.shader.time);
    let folder = args.choice.folder_of(&args.model)?;
    let source = (&args.model, &folder);
    let reading = Reading {
        options: &chosen,
        limits: &limits,
        detail: &PictureDetail::of(&args.picture),
    };
    let model = Model::read(source, args.format, reading, |stage| {
        progress.stage(stage);
    })?;
    args.limits.check_memory(&model, &args.picture)?;
    let format = match (picture, &files) {
        (Some(format), _) => format,
        (None, Some(files)) => return passes::run(&model, args, files, &clock, progress),
        (None, None) => unreachable!("a picture, or passes"),
    };
    let drawn = draw(
        &model,
        &args.picture,
        ViewDirection::default(),
        (&args.output, format),
        &clock,
        &progress,
    )?;
    drop(progress);
    let report = Report {
        args: &args.picture,
        output: &args.output,
        model: &model,
        drawn: &drawn,
        shape: None,
    };
    report.write(&args.report)
}
