//! One model: read, drawn in each view, written.

use super::arguments::BatchArgs;
use super::deadline::{self, Claim};
use super::plan::{Content, Job, Picture};
use super::record::{self, NamedFiles, Sources, digest};
use crate::failure::Failure;
use crate::input::{self, Model, Reading};
use crate::output;
use crate::render::{self, PassName, PictureArgs, PictureDetail, Sources as PassSources};
use crate::values::{Destination, ViewName, shown};
use estampe::Device;
use estampe_assets::Limits;
use estampe_renderer::ViewDirection;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// What became of a picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Status {
    Drawn,
    UpToDate,
    Failed(String),
    /// A limit of the options was exceeded.
    Limit(String),
    /// Not begun, because another one failed.
    Cancelled,
}

/// A picture, and what became of it.
#[derive(Debug, Clone)]
pub(super) struct Outcome {
    pub(super) input: String,
    pub(super) picture: Picture,
    pub(super) status: Status,
    pub(super) time: Duration,
    pub(super) warnings: Vec<String>,
}

/// What became of a job's pictures, and the warnings of its model.
pub(super) type Done = (Vec<Status>, Vec<String>);

/// What all jobs share.
#[derive(Clone)]
pub(super) struct Shared {
    pub(super) args: Arc<BatchArgs>,
    pub(super) limits: Limits,
}

impl Shared {
    /// Does a job with a device; a job that panics has failed.
    pub(super) fn outcomes(&self, job: &Job, device: &Arc<Device>) -> Vec<Outcome> {
        let start = Instant::now();
        let (statuses, warnings) = match self.args.limits.timeout {
            None => self.caught(job, device, &Claim::default()),
            Some(timeout) => {
                let (shared, theirs, device) = (self.clone(), job.clone(), device.clone());
                let work = move |claim: &Claim| shared.caught(&theirs, &device, claim);
                let name = shown(&job.input.path);
                deadline::run(&name, timeout, work).unwrap_or_else(|problem| {
                    (vec![Status::Limit(problem); job.pictures.len()], Vec::new())
                })
            }
        };
        let share = u32::try_from(job.pictures.len()).unwrap_or(1).max(1);
        let time = start.elapsed() / share;
        let pictures = job.pictures.iter().zip(statuses);
        pictures
            .map(|(picture, status)| Outcome {
                input: shown(&job.input.path),
                picture: picture.clone(),
                status,
                time,
                warnings: warnings.clone(),
            })
            .collect()
    }

    /// A job that panics has failed.
    fn caught(&self, job: &Job, device: &Device, claim: &Claim) -> Done {
        let work = std::panic::AssertUnwindSafe(|| self.done(job, device, claim));
        std::panic::catch_unwind(work).unwrap_or_else(|_| {
            let name = shown(&job.input.path);
            let problem = format!(
                "{name}: an internal error; please report it with the model, the others are drawn"
            );
            (
                vec![Status::Failed(problem); job.pictures.len()],
                Vec::new(),
            )
        })
    }

    fn done(&self, job: &Job, device: &Device, claim: &Claim) -> Done {
        let all = |failure: Failure| (vec![status_of(failure); job.pictures.len()], Vec::new());
        let bytes = match input::read_file(&job.input.path, &self.limits) {
            Ok(bytes) => bytes,
            Err(failure) => return all(failure),
        };
        let model_digest = digest(&bytes);
        let folder = job.look.options.choice.folder(&job.input.path);
        let max_bytes = self.limits.max_file_bytes;
        let is_current = |picture: &Picture| {
            let options = options_of(job, picture);
            !self.args.force
                && record::is_up_to_date(picture, (&options, &model_digest), &folder, max_bytes)
        };
        let current: Vec<bool> = job.pictures.iter().map(is_current).collect();
        if current.iter().all(|&is_current| is_current) {
            return (vec![Status::UpToDate; current.len()], Vec::new());
        }
        let named = NamedFiles::new(folder);
        let args = &job.look.options;
        let chosen = args.choice.at(args.picture.shader.time);
        let pictures = { job.pictures.iter() }
            .map(|picture| arguments(job, picture))
            .collect();
        let model = Model::of_bytes(
            (&job.input.path, &bytes),
            args.format.map(estampe_assets::ModelFormat::from),
            Reading {
                options: &chosen,
                limits: &self.limits,
                detail: &PictureDetail::of_all(pictures),
            },
            &named,
        );
        let model = match model {
            Ok(model) => model,
            Err(failure) => return all(failure),
        };
        if let Err(failure) = self.args.limits.check_memory(&model, &args.picture) {
            return all(failure);
        }
        let to_draw = job.pictures.iter().zip(&current);
        let to_draw = to_draw.filter(|(_, is_current)| !**is_current);
        let to_draw: Vec<&Picture> = to_draw.map(|(picture, _)| picture).collect();
        let mut passes = DrawnPasses::default();
        let statuses = job
            .pictures
            .iter()
            .zip(current)
            .map(|(picture, is_current)| {
                if is_current {
                    return Status::UpToDate;
                }
                let sources = Sources {
                    options: options_of(job, picture),
                    model: model_digest.clone(),
                    named: named.digests(),
                    searched: named.searched(),
                };
                let bytes = |args: &PictureArgs| match &picture.content {
                    Content::Picture(format) => {
                        let look = (ViewDirection::default(), *format);
                        render::drawn_bytes(&model, args, look, device)
                    }
                    Content::Passes(format, file) => {
                        let wanted = passes_of(&to_draw, picture.view);
                        let unit = job.look.options.passes.depth_unit;
                        let drawn = passes.of(&model, args, &wanted, device)?;
                        drawn.encode(file, *format, (args.size, unit))
                    }
                };
                match draw(&model, (job, picture), &sources, (bytes, claim)) {
                    Ok(()) => Status::Drawn,
                    Err(failure) => status_of(failure),
                }
            });
        let statuses = statuses.collect();
        let warnings = model.warnings.iter().map(ToString::to_string).collect();
        (statuses, warnings)
    }
}

/// The passes of a view that are drawn.
fn passes_of(pictures: &[&Picture], view: Option<ViewName>) -> Vec<PassName> {
    let of_view = pictures.iter().filter(|picture| picture.view == view);
    let passes = of_view.filter_map(|picture| match &picture.content {
        Content::Picture(_) => None,
        Content::Passes(_, file) => Some(&file.passes),
    });
    passes.flatten().copied().collect()
}

/// What the passes of a view are made of: it is drawn once for all of its files.
#[derive(Default)]
struct DrawnPasses(Option<(Option<ViewName>, PassSources)>);

impl DrawnPasses {
    /// Those of the view of the options.
    fn of(
        &mut self,
        model: &Model,
        args: &PictureArgs,
        passes: &[PassName],
        device: &Device,
    ) -> Result<&PassSources, Failure> {
        let last = self.0.take().filter(|(view, _)| *view == args.view);
        let drawn = match last {
            Some(drawn) => drawn,
            None => {
                let default = ViewDirection::default();
                let options = render::frame_options(model, args, default, device)?;
                let (sources, _) = PassSources::draw(passes, model, args, (&options, device))?;
                (args.view, sources)
            }
        };
        Ok(&self.0.insert(drawn).1)
    }
}

/// Draws and writes a picture, then its record.
fn draw(
    model: &Model,
    (job, picture): (&Job, &Picture),
    sources: &Sources,
    (bytes, claim): (
        impl FnOnce(&PictureArgs) -> Result<Vec<u8>, Failure>,
        &Claim,
    ),
) -> Result<(), Failure> {
    let args = arguments(job, picture);
    let destination = Destination::File(picture.output.clone());
    render::check_output(&destination, model, &args)?;
    let bytes = bytes(&args)?;
    if !claim.begin_writing() {
        return Err(Failure::Limit("given up".to_owned()));
    }
    let written = write(picture, &destination, &bytes);
    if written.is_ok() {
        record::write(&picture.output, &bytes, sources);
    }
    claim.end_writing();
    written
}

/// The options of a picture.
fn arguments(job: &Job, picture: &Picture) -> PictureArgs {
    PictureArgs {
        view: picture.view,
        ..job.look.options.picture.clone()
    }
}

fn write(picture: &Picture, destination: &Destination, bytes: &[u8]) -> Result<(), Failure> {
    if let Some(folder) = picture.output.parent() {
        std::fs::create_dir_all(folder).map_err(|error| {
            Failure::Output(format!(
                "{}: the folder cannot be made: {error}; check the path and its permissions",
                shown(folder)
            ))
        })?;
    }
    output::write(destination, bytes)
}

/// The digest of the options and versions.
fn options_of(job: &Job, picture: &Picture) -> String {
    let passes = match &picture.content {
        Content::Picture(_) => String::new(),
        Content::Passes(format, file) => {
            let unit = job.look.options.passes.depth_unit;
            format!(" {format:?} {:?} {unit}", file.passes)
        }
    };
    digest(format!("{} {:?}{passes}", job.look.identity, picture.view).as_bytes())
}

fn status_of(failure: Failure) -> Status {
    match failure {
        Failure::Limit(problem) => Status::Limit(problem),
        other => Status::Failed(other.to_string()),
    }
}
