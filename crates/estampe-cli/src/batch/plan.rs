//! The pictures to draw: models times views, without those of other shards.

use super::arguments::BatchArgs;
use super::inputs::{self, Input};
use super::template::Template;
use crate::failure::Failure;
use crate::output::Identity;
use crate::values::{Destination, ViewName, shown};
use clap::ValueEnum;
use estampe_assets::image::ImageFormat;
use std::collections::{HashMap, HashSet};
use std::path::PathBuf;

/// A model, and the pictures of it.
#[derive(Debug, Clone)]
pub(super) struct Job {
    pub(super) input: Input,
    pub(super) pictures: Vec<Picture>,
}

/// A picture of a model.
#[derive(Debug, Clone)]
pub(super) struct Picture {
    pub(super) view: Option<ViewName>,
    pub(super) output: PathBuf,
    pub(super) format: ImageFormat,
}

/// The jobs of this shard in the order of their inputs.
pub(super) fn jobs(args: &BatchArgs) -> Result<Vec<Job>, Failure> {
    let template = Template::parse(&args.output)
        .map_err(|problem| Failure::Usage(format!("--output {problem}")))?;
    if args.views.len() > 1 && !template.has_view() {
        return Err(Failure::Usage(
            "--views draws several pictures of each model; add {view} to the template".to_owned(),
        ));
    }
    let mut views: Vec<Option<ViewName>> = args.views.iter().copied().map(Some).collect();
    if views.is_empty() {
        views.push(args.picture.view);
    }
    let mut jobs = Vec::new();
    let mut taken: HashMap<PathBuf, String> = HashMap::new();
    let inputs = inputs::inputs(args)?;
    let models = inputs.iter().filter_map(|input| Identity::of(&input.path));
    let models: HashSet<Identity> = models.collect();
    for (index, input) in inputs.into_iter().enumerate() {
        let mut pictures = Vec::new();
        for &view in &views {
            let name = view.as_ref().and_then(ValueEnum::to_possible_value);
            let name = name.as_ref().map(clap::builder::PossibleValue::get_name);
            let output = template.name(&input, index, name);
            let format = Destination::File(output.clone()).image_format();
            let Some(format) = format else {
                return Err(Failure::Usage(format!(
                    "--output {}: the name does not show the image's format; end it with .png, \
                     .jpg or .tga",
                    args.output
                )));
            };
            let before = taken.insert(output.clone(), inputs::name(&input));
            if let Some(other) = before {
                return Err(Failure::Usage(format!(
                    "{}: the picture of {other} and of {}; add {{dir}}, {{ext}}, {{index}} or \
                     {{view}} to the template",
                    shown(&output),
                    inputs::name(&input)
                )));
            }
            let is_model = |one: Identity| models.contains(&one);
            if output == input.path || Identity::of(&output).is_some_and(is_model) {
                return Err(Failure::Usage(format!(
                    "{}: the picture would replace a model; choose another --output",
                    shown(&output)
                )));
            }
            pictures.push(Picture {
                view,
                output,
                format,
            });
        }
        let is_ours = args
            .shard
            .is_none_or(|shard| index % shard.count as usize == shard.number as usize - 1);
        if is_ours {
            jobs.push(Job { input, pictures });
        }
    }
    Ok(jobs)
}
