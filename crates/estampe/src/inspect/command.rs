//! Runs `estampe inspect`: reads the model, and writes the history of the pixel, or the pictures of
//! the stages.

use super::arguments::InspectArgs;
use super::stages::{Shown, StageName, show};
use super::{json, text};
use crate::failure::Failure;
use crate::input::{Model, Reading};
use crate::output;
use crate::render::{PictureDetail, image_format, output_name, prepare};
use crate::values::{Destination, shown};
use estampe::Device;
use estampe_assets::Limits;
use estampe_assets::image::{ImageFormat, encode, encode_drawing_png};
use estampe_renderer::{FrameStages, RenderOptions, ViewDirection, inspect, inspect_stages};
use serde_json::{Value, json};
use std::io::{self, Write};

/// Runs the command.
pub(crate) fn run(args: &InspectArgs) -> Result<(), Failure> {
    // Destinations are checked before any work is done.
    let files = match (args.stage, &args.output) {
        (Some(stage), Some(output)) => files(stage, output)?,
        _ => Vec::new(),
    };
    let limits = Limits {
        threads: args.picture.thread_count(),
        ..Limits::default()
    };
    let chosen = args.choice.at(args.picture.shader.time);
    let folder = args.choice.folder_of(&args.model)?;
    let source = (&args.model, &folder);
    let reading = Reading {
        options: &chosen,
        limits: &limits,
        detail: &PictureDetail::of(&args.picture),
    };
    let model = Model::read(source, args.format, reading, |_| {})?;
    let (options, device) = prepare(&model, &args.picture, ViewDirection::default())?;
    if let Some(pixel) = args.pixel {
        let told = inspect(&model.scene, &options, &device, pixel)?;
        let report = if args.json {
            format!("{:#}\n", json::history(&model.name, &options, &told))
        } else {
            text::history(&model.name, &options, &told)
        };
        return write(&report, "the history", false);
    }
    let frame = inspect_stages(&model.scene, &options, &device)?;
    let report = draw(&model.name, &options, &frame, &device, &files)?;
    let is_on_standard_output = files.iter().any(|file| file.output.is_standard_output());
    let report = if args.json {
        format!("{:#}\n", report.json)
    } else {
        report.text
    };
    write(&report, "the totals", is_on_standard_output)
}

/// A stage and the file of its picture.
struct StageFile {
    stage: StageName,
    output: Destination,
    format: ImageFormat,
}

/// The files of the stages: one, or one for each stage in a folder.
fn files(stage: StageName, output: &Destination) -> Result<Vec<StageFile>, Failure> {
    if stage != StageName::All {
        let format = image_format(None, output)?;
        output::check(output)?;
        let output = output.clone();
        return Ok(vec![StageFile {
            stage,
            output,
            format,
        }]);
    }
    let Destination::File(folder) = output else {
        return Err(Failure::Usage(
            "all stages are several files, which standard output cannot hold; name a folder"
                .to_owned(),
        ));
    };
    if !folder.is_dir() {
        let name = shown(folder);
        return Err(Failure::Output(format!(
            "{name}: the pictures of all stages are written to a folder, and this is none; \
             create it first"
        )));
    }
    let each = StageName::EACH.map(|stage| StageFile {
        stage,
        output: Destination::File(folder.join(format!("{}.png", stage.name()))),
        format: ImageFormat::Png,
    });
    for file in &each {
        output::check(&file.output)?;
    }
    Ok(each.into())
}

/// What is told of the stages, in both forms.
struct Report {
    text: String,
    json: Value,
}

/// Draws and writes the pictures.
fn draw(
    model: &str,
    options: &RenderOptions,
    frame: &FrameStages,
    device: &Device,
    files: &[StageFile],
) -> Result<Report, Failure> {
    let mut text = String::new();
    let mut stages = Vec::new();
    for file in files {
        let Shown { image, totals } = show(file.stage, frame, device)?;
        let bytes = match file.format {
            ImageFormat::Png => encode_drawing_png(&image)?,
            other => encode(&image, other)?,
        };
        output::write(&file.output, &bytes)?;
        text += &format!("{}: {}\n", file.stage.name(), totals.text());
        stages.push(json!({
            "stage": file.stage.name(),
            "output": {
                "path": output_name(&file.output),
                "width": image.width,
                "height": image.height,
                "bytes": bytes.len(),
            },
            "totals": totals.json(),
        }));
    }
    let json = json!({
        "model": model,
        "size": [options.width, options.height],
        "samples": options.samples,
        "stages": stages,
    });
    Ok(Report { text, json })
}

/// Writes to standard output, or to standard error if a picture is on it.
fn write(report: &str, what: &str, to_standard_error: bool) -> Result<(), Failure> {
    if !to_standard_error {
        return output::print(report);
    }
    let written = io::stderr().lock().write_all(report.as_bytes());
    written.map_err(|error| {
        Failure::Output(format!(
            "{what}: {error}; check the program that reads standard output"
        ))
    })
}
