//! Runs `estampe sheet`.

use super::arguments::{LabelName, SheetArgs};
use super::job::{Done, Shared};
use super::layout::Layout;
use super::models::{models, name, stem};
use super::paint::Sheet;
use super::pool;
use super::report::Report;
use super::views::Views;
use crate::batch::Lines;
use crate::failure::{DONE, Failure};
use crate::input::read_file;
use crate::output;
use crate::render;
use crate::values::{MAX_SIDE, Source};
use estampe_assets::Limits;
use estampe_renderer::TextHeight;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

/// The exit code if a cell failed.
const INCOMPLETE: u8 = 1;

/// Space above and below a label, in pixels.
const LABEL_SPACE: u32 = 4;

/// Runs the command, and returns its exit code.
pub(crate) fn run(args: &SheetArgs) -> Result<u8, Failure> {
    let start = Instant::now();
    let format = render::image_format(args.output_format, &args.output)?;
    check(args)?;
    let models = models(args)?;
    let files = models.iter().filter_map(|model| match model {
        Source::File(path) => Some(path.as_path()),
        _ => None,
    });
    output::check_inputs(&args.output, files)?;
    let views = Views::of(args);
    let layout = layout(args, models.len(), &views)?;
    let names = views.names(args);
    let shared = Shared {
        args: Arc::new(args.clone()),
        limits: args.limits.of_reader(args.picture.thread_count()),
        views: Arc::new(views),
        sheet: Arc::new(Mutex::new(Sheet::new(
            layout,
            args.picture.background.in_the_middle(),
        ))),
        refused: Arc::default(),
    };
    let lines = Lines::new(models.len(), args.report.quiet);
    let done = pool::draw(&shared, &models, |model, done| show(&lines, model, done))?;
    lines.finish();
    let refused = shared.refused.lock();
    if let Some(failure) = refused.unwrap_or_else(PoisonError::into_inner).take() {
        return Err(failure);
    }
    let bytes = {
        let sheet = shared.sheet.lock();
        let mut sheet = sheet.unwrap_or_else(PoisonError::into_inner);
        write_labels(&mut sheet, args, &models, &names);
        render::encoded(&sheet.image, format)?
    };
    output::write(&args.output, &bytes)?;
    let report = Report {
        args,
        layout,
        models: &models,
        views: &names,
        done: &done,
        format,
        bytes: bytes.len(),
        time: start.elapsed(),
    };
    report.write()?;
    Ok(if report.is_complete() {
        DONE
    } else {
        INCOMPLETE
    })
}

/// Refuses what no model can be drawn with, before any is read.
fn check(args: &SheetArgs) -> Result<(), Failure> {
    output::check(&args.output)?;
    args.picture.check()?;
    args.choice.check_roots()?;
    let picture = &args.picture;
    let files: [Option<&Path>; 3] = [
        picture.texture.as_deref(),
        picture.shader.file(),
        picture.pbr.panorama(),
    ];
    for file in files.into_iter().flatten() {
        read_file(file, &Limits::default())?;
        output::check_inputs(&args.output, [file])?;
    }
    Ok(())
}

fn layout(args: &SheetArgs, models: usize, views: &Views) -> Result<Layout, Failure> {
    let (width, height) = args.picture.size;
    let label_height = match args.labels {
        LabelName::None => 0,
        _ => TextHeight::from(args.label_size).px() + LABEL_SPACE,
    };
    let count = views.count();
    let is_table = models > 1 && count > 1;
    let by_views = is_table.then(|| u32::try_from(count).unwrap_or(u32::MAX));
    let columns = args.columns.or(by_views);
    let cells = models.saturating_mul(count);
    let sizes = ([width, height], label_height, args.gap);
    Layout::new(cells, columns, sizes).map_err(|[width, height]| {
        Failure::Usage(format!(
            "{cells} cells need a sheet of {width}x{height} pixels, and {MAX_SIDE} a side are possible; choose \
             a smaller --cell, other --columns, or draw single pictures with estampe batch"
        ))
    })
}

/// Shows that a model is done, or its problems, each once.
fn show(lines: &Lines, model: &Source, done: &Done) {
    let mut problems: Vec<&str> = done.statuses.iter().filter_map(|s| s.problem()).collect();
    problems.dedup();
    let result = match problems[..] {
        [] => Ok("drawn"),
        _ => Err(problems.join("; ")),
    };
    lines.show(
        &model.name(),
        result.as_ref().map_or_else(|p| Err(p.as_str()), |w| Ok(*w)),
    );
}

fn write_labels(sheet: &mut Sheet, args: &SheetArgs, models: &[Source], views: &[Option<String>]) {
    let label = match args.labels {
        LabelName::None => return,
        LabelName::Auto => match (models.len(), views.len()) {
            (_, 1) => LabelName::Name,
            (1, _) => LabelName::View,
            _ => LabelName::Both,
        },
        chosen => chosen,
    };
    let cells = { models.iter() }.flat_map(|model| views.iter().map(move |view| (model, view)));
    for (cell, (model, view)) in cells.enumerate() {
        let view = view.as_deref().unwrap_or_default();
        let text = match label {
            LabelName::Stem => stem(model),
            LabelName::Path => model.name(),
            LabelName::View => view.to_owned(),
            LabelName::Both if !view.is_empty() => format!("{}, {view}", name(model)),
            _ => name(model),
        };
        sheet.write_label(cell, &text, args.label_size.into());
    }
}
