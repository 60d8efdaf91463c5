//! One model: read, drawn in each view, written.

use super::arguments::BatchArgs;
use super::deadline::{self, Claim};
use super::look::Shot;
use super::plan::{Content, Job, Picture};
use super::record::{self, NamedFiles, Sources, digest};
use crate::failure::Failure;
use crate::input::{self, Model, Reading};
use crate::output;
use crate::render::{
    self, PassFormat, PassName, PictureArgs, PictureDetail, Sources as PassSources,
};
use crate::values::{Destination, shown};
use estampe::Device;
use estampe_assets::Limits;
use estampe_assets::model::SourceBytes;
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
            .map(|picture| (arguments(job, picture), picture.shot.camera.clone()))
            .collect();
        let model = Model::of_source(
            (&job.input.path, SourceBytes::Memory(bytes)),
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
        let to_draw = job.pictures.iter().zip(&current);
        let to_draw = to_draw.filter(|(_, is_current)| !**is_current);
        let to_draw: Vec<&Picture> = to_draw.map(|(picture, _)| picture).collect();
        if let Err(failure) = self.check_memory(&model, &args.picture, &to_draw) {
            return all(failure);
        }
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
                let camera = picture.shot.camera.as_deref();
                let bytes = |args: &PictureArgs| match &picture.content {
                    Content::Picture(format) => {
                        let look = (ViewDirection::default(), *format);
                        render::drawn_bytes(&model, (args, camera), look, device)
                    }
                    Content::Passes(format, file) => {
                        let wanted = passes_of(&to_draw, &picture.shot);
                        let unit = job.look.options.passes.depth_unit;
                        let of = (wanted.as_slice(), *format);
                        let drawn = passes.of(&model, (args, &picture.shot), of, device)?;
                        let size = camera.map_or(args.size, |camera| camera.size);
                        drawn.encode(file, *format, (size, unit))
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

    /// Refuses a model whose greatest picture needs more memory than the limit.
    fn check_memory(
        &self,
        model: &Model,
        args: &PictureArgs,
        pictures: &[&Picture],
    ) -> Result<(), Failure> {
        let cameras = { pictures.iter() }.filter_map(|picture| picture.shot.camera.as_ref());
        let sizes = cameras.map(|camera| camera.size);
        let greatest = sizes.max_by_key(|(width, height)| u64::from(*width) * u64::from(*height));
        let greatest = PictureArgs {
            size: greatest.unwrap_or(args.size),
            ..args.clone()
        };
        let hold_light = { pictures.iter() }.any(|picture| match &picture.content {
            Content::Picture(_) => false,
            Content::Passes(format, _) => format.holds_light(),
        });
        self.args.limits.check_memory(model, &greatest, hold_light)
    }
}

/// The passes of a shot that are drawn.
fn passes_of(pictures: &[&Picture], shot: &Shot) -> Vec<PassName> {
    let of_shot = pictures.iter().filter(|picture| picture.shot == *shot);
    let passes = of_shot.filter_map(|picture| match &picture.content {
        Content::Picture(_) => None,
        Content::Passes(_, file) => Some(&file.passes),
    });
    passes.flatten().copied().collect()
}

/// The frames of a shot, from which its passes are made: it is drawn once for all of its files.
#[derive(Default)]
struct DrawnPasses(Option<(Shot, PassSources)>);

impl DrawnPasses {
    /// Those of a shot.
    fn of(
        &mut self,
        model: &Model,
        (args, shot): (&PictureArgs, &Shot),
        of: (&[PassName], PassFormat),
        device: &Device,
    ) -> Result<&PassSources, Failure> {
        let last = self.0.take().filter(|(last, _)| last == shot);
        let drawn = match last {
            Some(drawn) => drawn,
            None => {
                let default = ViewDirection::default();
                let mut options = render::frame_options(model, args, default, device)?;
                if let Some(camera) = &shot.camera {
                    options = camera.apply(options);
                }
                let (sources, _) = PassSources::draw(of, model, args, (&options, device))?;
                (shot.clone(), sources)
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
        view: picture.shot.view,
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
    // The values of the camera itself: others of its file may change.
    let camera = match &picture.shot.camera {
        Some(camera) => format!(" {camera:?}"),
        None => String::new(),
    };
    let view = picture.shot.view;
    digest(format!("{} {view:?}{passes}{camera}", job.look.identity).as_bytes())
}

fn status_of(failure: Failure) -> Status {
    match failure {
        Failure::Limit(problem) => Status::Limit(problem),
        other => Status::Failed(other.to_string()),
    }
}
