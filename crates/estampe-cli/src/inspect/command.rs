//! Runs `estampe inspect`: reads the model, and writes the history of the pixel.

use super::arguments::InspectArgs;
use super::{json, text};
use crate::failure::Failure;
use crate::input::Model;
use crate::render::prepare;
use estampe_assets::Limits;
use estampe_renderer::{ViewDirection, inspect};
use std::io::{self, Write};

/// Runs the command.
pub(crate) fn run(args: &InspectArgs) -> Result<(), Failure> {
    let limits = Limits {
        threads: args.picture.thread_count(),
        ..Limits::default()
    };
    let model = Model::read(&args.model, args.format, &limits, |_| {})?;
    let (options, device) = prepare(&model, &args.picture, ViewDirection::default())?;
    let told = inspect(&model.scene, &options, &device, args.pixel)?;
    let report = if args.json {
        format!("{:#}\n", json::history(&model.name, &options, &told))
    } else {
        text::history(&model.name, &options, &told)
    };
    let mut out = io::stdout().lock();
    out.write_all(report.as_bytes())
        .and_then(|()| out.flush())
        .map_err(|error| {
            Failure::Output(format!(
                "the history: {error}; check the program that reads standard output"
            ))
        })
}
