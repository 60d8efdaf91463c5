//! The look of a picture: all options of `estampe render` that say how it is read and drawn.

use super::record::digest;
use crate::choice::ChoiceArgs;
use crate::failure::Failure;
use crate::input::read_file;
use crate::presets::PresetArgs;
use crate::render::{CamerasArgs, NamedCamera, PassArgs, PictureArgs, read_cameras};
use crate::values::{FormatName, ViewName};
use clap::{Parser, ValueEnum};
use estampe_assets::Limits;
use std::path::Path;
use std::sync::Arc;

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

    #[command(flatten)]
    pub(super) cameras: CamerasArgs,

    /// The model's format: gltf, obj, stl, ply, off or 3mf
    #[arg(long, value_enum)]
    pub(super) format: Option<FormatName>,
}

/// From where a picture is seen.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Shot {
    pub(super) view: Option<ViewName>,
    pub(super) camera: Option<Arc<NamedCamera>>,
}

impl Shot {
    pub(super) fn of_view(view: Option<ViewName>) -> Self {
        Self { view, camera: None }
    }

    /// The name of the view.
    pub(super) fn view_name(&self) -> Option<String> {
        let value = self.view.as_ref()?.to_possible_value()?;
        Some(value.get_name().to_owned())
    }

    /// The name of the camera.
    pub(super) fn camera_name(&self) -> Option<&str> {
        Some(self.camera.as_ref()?.name.as_str())
    }
}

/// Options that were checked.
#[derive(Debug, Clone)]
pub(super) struct Look {
    pub(super) options: JobOptions,
    /// Everything beside the model that a picture depends on, without view and camera.
    pub(super) identity: String,
    /// The cameras of the options' file.
    cameras: Vec<Arc<NamedCamera>>,
}

impl Look {
    pub(super) fn new(options: JobOptions) -> Result<Self, Failure> {
        options.picture.check()?;
        options.choice.check_roots()?;
        let identity = identity(&options)?;
        let mut cameras = Vec::new();
        if let Some(path) = &options.cameras.cameras {
            cameras.extend(read_cameras(path, options.picture.size)?);
        }
        Ok(Self {
            options,
            identity,
            cameras: cameras.into_iter().map(Arc::new).collect(),
        })
    }

    /// The shots of the options: its view, or its cameras.
    pub(super) fn shots(&self) -> Vec<Shot> {
        if self.cameras.is_empty() {
            return vec![Shot::of_view(self.options.picture.view)];
        }
        let of_camera = |camera: &Arc<NamedCamera>| Shot {
            view: None,
            camera: Some(camera.clone()),
        };
        self.cameras.iter().map(of_camera).collect()
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
