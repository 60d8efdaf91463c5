//! The pictures to draw: models times views, without those of other shards.

use super::arguments::BatchArgs;
use super::inputs::{self, Input};
use super::template::Template;
use crate::failure::Failure;
use crate::values::{Destination, ViewName, shown};
use clap::ValueEnum;
use estampe_assets::image::ImageFormat;
use std::collections::HashMap;
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
    for (index, input) in inputs::inputs(args)?.into_iter().enumerate() {
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
            if output == input.path {
                return Err(Failure::Usage(format!(
                    "{}: the picture would replace the model; choose another --output",
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
