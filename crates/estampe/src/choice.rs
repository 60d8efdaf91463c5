//! The options that choose what is read: the scene, animation and variant of a file, and where the
//! files are that it names.

use crate::failure::Failure;
use crate::values::{Source, shown};
use clap::Args;
use estampe_assets::model::{AnimationName, Folder, ModelOptions, TextureAlpha};
use estampe_scene::{NamedCamera, Scene};
use std::path::{Path, PathBuf};

/// What is read of a model, and where its files are.
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

    /// A further folder in which files that the model names, and textures by their own name, are
    /// looked for; repeatable
    #[arg(long = "root", value_name = "DIR", help_heading = "Contents")]
    pub(crate) roots: Vec<PathBuf>,

    /// Use of the alpha of OBJ's textures: auto (by the material), opaque, mask (cut out) or blend
    #[arg(long, value_name = "USE", value_enum, default_value = "auto")]
    #[arg(hide_possible_values = true, help_heading = "Contents")]
    pub(crate) alpha: AlphaName,

    /// Refuse a model that would be read with a warning
    #[arg(long, help_heading = "Contents")]
    pub(crate) strict: bool,
}

/// Names of the uses of alpha.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, clap::ValueEnum)]
pub(crate) enum AlphaName {
    /// By the material
    #[default]
    Auto,
    /// None
    Opaque,
    /// Texels with alpha below a half are cut out
    Mask,
    /// Textures with alpha are blended
    Blend,
}

impl From<AlphaName> for TextureAlpha {
    fn from(name: AlphaName) -> Self {
        match name {
            AlphaName::Auto => Self::Auto,
            AlphaName::Opaque => Self::Opaque,
            AlphaName::Mask => Self::Mask,
            AlphaName::Blend => Self::Blend,
        }
    }
}

impl ChoiceArgs {
    /// The folders in which the files of a model are.
    pub(crate) fn folder_of(&self, model: &Source) -> Result<Folder, Failure> {
        self.check_roots()?;
        Ok(match model {
            Source::File(path) => self.folder(path),
            Source::Builtin(_) | Source::StandardInput => Folder::none().with_roots(&self.roots),
        })
    }

    /// The folders in which the files of the model at `path` are.
    pub(crate) fn folder(&self, path: &Path) -> Folder {
        Folder::of_model(path).with_roots(&self.roots)
    }

    /// Refuses roots that are no folders.
    pub(crate) fn check_roots(&self) -> Result<(), Failure> {
        match self.roots.iter().find(|root| !root.is_dir()) {
            Some(root) => Err(Failure::Usage(format!(
                "--root {}: this is no folder; check the path",
                shown(root)
            ))),
            None => Ok(()),
        }
    }

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
            alpha: self.alpha.into(),
            is_strict: self.strict,
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
