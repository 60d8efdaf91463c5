//! The pictures to draw: models times views, without those of other shards.

use super::arguments::BatchArgs;
use super::inputs::{self, Input};
use super::job_file;
use super::look::{JobOptions, Look, Shot};
use super::template::Template;
use crate::failure::Failure;
use crate::output::{self, Identity};
use crate::presets;
use crate::render::{Files, PassFile, PassFormat};
use crate::values::{Destination, shown};
use clap::Parser;
use estampe_assets::image::ImageFormat;
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A model, and the pictures of it.
#[derive(Debug, Clone)]
pub(super) struct Job {
    pub(super) input: Input,
    pub(super) pictures: Vec<Picture>,
    pub(super) look: Arc<Look>,
}

/// A picture of a model.
#[derive(Debug, Clone)]
pub(super) struct Picture {
    pub(super) shot: Shot,
    pub(super) output: PathBuf,
    pub(super) content: Content,
}

/// What the file of a picture holds.
#[derive(Debug, Clone)]
pub(super) enum Content {
    Picture(ImageFormat),
    Passes(PassFormat, PassFile),
}

/// The jobs of this shard in the order of their inputs, or of the job file.
pub(super) fn jobs(args: &BatchArgs) -> Result<Vec<Job>, Failure> {
    let drafts = match &args.job_file {
        Some(path) => of_file(args, path)?,
        None => of_arguments(args)?,
    };
    let models = drafts.iter();
    let models = models.filter_map(|draft| Identity::of(&draft.input.path));
    let models: HashSet<Identity> = models.collect();
    let mut taken: HashMap<PathBuf, String> = HashMap::new();
    let mut jobs = Vec::new();
    for (index, draft) in drafts.into_iter().enumerate() {
        let job = draft.job(index, &models, &mut taken)?;
        let is_ours = args
            .shard
            .is_none_or(|shard| index % shard.count as usize == shard.number as usize - 1);
        if is_ours {
            jobs.push(job);
        }
    }
    Ok(jobs)
}

/// A job before its pictures have names.
struct Draft {
    input: Input,
    template: Arc<Template>,
    shots: Arc<[Shot]>,
    look: Arc<Look>,
}

fn of_arguments(args: &BatchArgs) -> Result<Vec<Draft>, Failure> {
    let template = Template::parse(args.output.as_deref().unwrap_or_default())
        .map_err(|problem| Failure::Usage(format!("--output {problem}")))?;
    if args.views.len() > 1 && !template.has_view() {
        return Err(Failure::Usage(
            "--views draws several pictures of each model; add {view} to the template".to_owned(),
        ));
    }
    let template = Arc::new(template);
    let look = Arc::new(Look::new(JobOptions {
        choice: args.choice.clone(),
        picture: args.picture.clone(),
        passes: args.passes.clone(),
        cameras: args.cameras.clone(),
        format: args.format,
    })?);
    let shots: Arc<[Shot]> = if args.views.is_empty() {
        look.shots().into()
    } else {
        let views = args.views.iter().copied().map(Some);
        views.map(Shot::of_view).collect()
    };
    check_cameras(&template, &shots, "--output")?;
    let inputs = inputs::inputs(args)?.into_iter();
    let drafts = inputs.map(|input| Draft {
        input,
        template: template.clone(),
        shots: shots.clone(),
        look: look.clone(),
    });
    Ok(drafts.collect())
}

fn of_file(args: &BatchArgs, path: &Path) -> Result<Vec<Draft>, Failure> {
    let mut unset =
        JobOptions::try_parse_from([""; 0]).map_err(|error| Failure::Usage(error.to_string()))?;
    unset.picture.threads = args.picture.threads;
    unset.picture.simd = args.picture.simd;
    unset.picture.presets = args.picture.presets.clone();
    let given = (&args.picture, &args.choice, &args.passes, &args.cameras);
    let none = (&unset.picture, &unset.choice, &unset.passes, &unset.cameras);
    if format!("{given:?}") != format!("{none:?}") {
        return Err(Failure::Usage(
            "options of pictures beside --job-file have no effect; write them into its table options"
                .to_owned(),
        ));
    }
    let jobs = job_file::read(path, &presets::table(&args.picture.presets)?)?.into_iter();
    jobs.map(|job| {
        let template = Template::parse(&job.output)
            .map_err(|problem| Failure::Usage(format!("{}: output {problem}", shown(path))))?;
        let shots = job.look.shots();
        check_cameras(&template, &shots, &format!("{}: output", shown(path)))?;
        let base = job.input.parent().unwrap_or(Path::new("")).to_owned();
        Ok(Draft {
            input: Input {
                path: job.input,
                base,
            },
            template: Arc::new(template),
            shots: shots.into(),
            look: job.look,
        })
    })
    .collect()
}

/// Refuses a template that does not tell cameras apart, or that has no camera to name.
fn check_cameras(template: &Template, shots: &[Shot], place: &str) -> Result<(), Failure> {
    let has_cameras = shots.iter().any(|shot| shot.camera.is_some());
    let problem = match (has_cameras, template.has_camera()) {
        (true, false) if shots.len() > 1 => {
            "the file of cameras has several; add {camera} to the template, as in \
             'out/{stem}/{camera}.png'"
        }
        (false, true) => {
            "the template has {camera}, and there are no cameras; add --cameras, or `cameras` in a job file"
        }
        _ => return Ok(()),
    };
    Err(Failure::Usage(format!("{place}: {problem}")))
}

impl Draft {
    /// The job with the names of its pictures, none of which is taken or a model.
    fn job(
        self,
        index: usize,
        models: &HashSet<Identity>,
        taken: &mut HashMap<PathBuf, String>,
    ) -> Result<Job, Failure> {
        let input = self.input.clone();
        let mut pictures = Vec::new();
        for shot in self.shots.iter() {
            let view = shot.view_name();
            let names = (view.as_deref(), shot.camera_name());
            let output = self.template.name(&input, index, names);
            for (output, content) in self.files(output)? {
                let before = taken.insert(output.clone(), inputs::name(&input));
                if let Some(other) = before {
                    return Err(Failure::Usage(format!(
                        "{}: the picture of {other} and of {}; add {{dir}}, {{ext}}, {{index}}, \
                         {{view}} or {{camera}} to the template",
                        shown(&output),
                        inputs::name(&input)
                    )));
                }
                let is_model = |one: Identity| models.contains(&one);
                let cameras = self.look.options.cameras.cameras.as_deref();
                output::check_inputs(&Destination::File(output.clone()), cameras)?;
                if output == input.path || Identity::of(&output).is_some_and(is_model) {
                    return Err(Failure::Usage(format!(
                        "{}: the picture would replace a model; choose another --output",
                        shown(&output)
                    )));
                }
                pictures.push(Picture {
                    shot: shot.clone(),
                    output,
                    content,
                });
            }
        }
        Ok(Job {
            input,
            pictures,
            look: self.look,
        })
    }

    /// The files of a shot, with what each holds: one, or those of the passes.
    fn files(&self, output: PathBuf) -> Result<Vec<(PathBuf, Content)>, Failure> {
        let destination = Destination::File(output.clone());
        let passes = &self.look.options.passes;
        if let Some(Files { format, files }) = Files::of(passes, &destination, None)? {
            let files = files.into_iter().map(|file| {
                let path = match &file.output {
                    Destination::File(path) => path.clone(),
                    Destination::StandardOutput => unreachable!("passes of a file"),
                };
                (path, Content::Passes(format, file))
            });
            return Ok(files.collect());
        }
        if self.template.has_pass() {
            return Err(Failure::Usage(
                "the template has {pass}, and there are no passes; add --pass, as in --pass color,depth"
                    .to_owned(),
            ));
        }
        let Some(format) = destination.image_format() else {
            return Err(Failure::Usage(format!(
                "--output {}: the name does not show the image's format; end it with .png, .jpg, .tga, \
                 .webp, .exr or .hdr",
                shown(&output)
            )));
        };
        Ok(vec![(output, Content::Picture(format))])
    }
}
