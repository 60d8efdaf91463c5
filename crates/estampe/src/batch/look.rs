//! The look of a picture: all options of `estampe render` that say how it is read and drawn.

use super::record::digest;
use crate::choice::ChoiceArgs;
use crate::failure::Failure;
use crate::input::read_file;
use crate::presets::PresetArgs;
use crate::render::{PassArgs, PictureArgs};
use crate::values::FormatName;
use clap::Parser;
use estampe_assets::Limits;
use std::path::Path;

/// The options that a job may have.
#[derive(Debug, Clone, Parser)]
#[command(no_binary_name = true, disable_help_flag = true)]
pub(super) struct JobOptions {
    #[command(flatten)]
    pub(super) choice: ChoiceArgs,

    #[command(flatten)]
    pub(super) picture: PictureArgs,

    #[command(flatten)]
    pub(super) passes: PassArgs,

    /// The model's format: gltf, obj, stl, ply, off or 3mf
    #[arg(long, value_enum)]
    pub(super) format: Option<FormatName>,
}

/// Options that were checked.
#[derive(Debug, Clone)]
pub(super) struct Look {
    pub(super) options: JobOptions,
    /// Everything beside the model that a picture depends on, without the view.
    pub(super) identity: String,
}

impl Look {
    pub(super) fn new(options: JobOptions) -> Result<Self, Failure> {
        options.picture.check()?;
        options.choice.check_roots()?;
        let identity = identity(&options)?;
        Ok(Self { options, identity })
    }
}

/// The options, the digests of their files, and the versions. Options that change no byte (threads,
/// SIMD level) are not in it.
fn identity(options: &JobOptions) -> Result<String, Failure> {
    let mut picture = options.picture.clone();
    picture.threads = None;
    picture.simd = estampe::Level::best();
    picture.view = None;
    picture.presets = PresetArgs::default();
    let digest_of = |path: Option<&Path>| -> Result<String, Failure> {
        match path {
            Some(path) => Ok(digest(&read_file(path, &Limits::default())?)),
            None => Ok(String::new()),
        }
    };
    Ok(format!(
        "{} {} {picture:?} {:?} {:?} {} {} {}",
        env!("CARGO_PKG_VERSION"),
        estampe_renderer::PICTURE_VERSION,
        options.choice,
        options.format,
        digest_of(picture.texture.as_deref())?,
        digest_of(picture.shader.file())?,
        digest_of(picture.pbr.panorama())?,
    ))
}

/// The first line of a message about options, without the word before it.
pub(super) fn first_line(error: &clap::Error) -> String {
    let text = error.to_string();
    let line = text.lines().next().unwrap_or_default();
    line.strip_prefix("error: ").unwrap_or(line).to_owned()
}
