//! The options that choose what is read from a file with several scenes, animations or variants.

use crate::failure::Failure;
use clap::Args;
use estampe_assets::model::{AnimationName, ModelOptions};
use estampe_scene::{NamedCamera, Scene};

/// What is read from a glTF file.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct ChoiceArgs {
    /// The scene of a glTF file, by its number from 0 [default: the file's choice]
    #[arg(long, value_name = "N", help_heading = "Contents")]
    pub(crate) scene: Option<usize>,

    /// The animation, by its number from 0 or its name [default: none; with --time, the first one]
    #[arg(long, value_name = "N|NAME", help_heading = "Contents")]
    pub(crate) animation: Option<String>,

    /// The variant of the materials, by its name
    #[arg(long, value_name = "NAME", help_heading = "Contents")]
    pub(crate) variant: Option<String>,
}

impl ChoiceArgs {
    /// The options of the reader, at a time of the animation.
    pub(crate) fn at(&self, time_s: Option<f32>) -> ModelOptions {
        let named = self.animation.as_ref().map(|name| match name.parse() {
            Ok(index) => AnimationName::Index(index),
            Err(_) => AnimationName::Name(name.clone()),
        });
        let first = time_s.map(|_| AnimationName::First);
        ModelOptions {
            scene: self.scene,
            animation: named.or(first),
            time_s: time_s.unwrap_or(0.0),
            variant: self.variant.clone(),
            ..ModelOptions::default()
        }
    }
}

/// The camera of a file with this number or name.
pub(crate) fn camera<'s>(scene: &'s Scene, chosen: &str) -> Result<&'s NamedCamera, Failure> {
    let cameras = &scene.cameras;
    let by_number = chosen.parse().ok().and_then(|at: usize| cameras.get(at));
    let by_name = || cameras.iter().find(|camera| camera.name == chosen);
    by_number.or_else(by_name).ok_or_else(|| {
        let has = match cameras.len() {
            0 => "the model has no cameras".to_owned(),
            count => {
                let names = cameras.iter().enumerate().take(10);
                let names = names.map(|(at, camera)| match camera.name.as_str() {
                    "" => at.to_string(),
                    name => format!("{at} ({name})"),
                });
                let names = names.collect::<Vec<_>>().join(", ");
                let more = if count > 10 { ", …" } else { "" };
                format!("the model has {names}{more}")
            }
        };
        Failure::Usage(format!("--camera {chosen}: there is no such camera; {has}"))
    })
}
