//! The parts of a file that are read: one scene, one moment of one animation, one variant.

use super::document::{Document, Index};
use crate::AssetError;
use crate::model::options::{AnimationName, ModelOptions};

/// The chosen parts.
#[derive(Debug, Clone, Copy)]
pub(super) struct Choice {
    /// The scene; `None` is all nodes.
    pub(super) scene: Option<Index>,
    /// Index of an animation that exists.
    pub(super) animation: Option<usize>,
    pub(super) time_s: f32,
    /// Index of a variant that exists.
    pub(super) variant: Option<usize>,
}

impl Choice {
    /// Finds what the options name.
    pub(super) fn of(document: &Document<'_>, options: &ModelOptions) -> Result<Self, AssetError> {
        let scenes = document.scenes.len();
        let scene = match options.scene {
            Some(index) if index >= scenes => {
                return Err(AssetError::unsupported(
                    format!("the file has no scene {index}"),
                    format!("it has {scenes}, counted from 0"),
                ));
            }
            Some(index) => Some(Index(index)),
            None => document.scene.or((scenes > 0).then_some(Index(0))),
        };
        let animations = document.animations.iter().map(|animation| &*animation.name);
        let animation = match &options.animation {
            None => None,
            Some(AnimationName::First) => (animations.len() > 0).then_some(0),
            Some(AnimationName::Index(index)) => Some(
                (*index < animations.len())
                    .then_some(*index)
                    .ok_or_else(|| missing("animation", &index.to_string(), animations))?,
            ),
            Some(AnimationName::Name(name)) => Some(find("animation", name, animations)?),
        };
        let variants = document.extensions.variants().iter();
        let variants = variants.map(|variant| &*variant.name);
        let variant = options.variant.as_ref();
        Ok(Self {
            scene,
            animation,
            time_s: options.time_s,
            variant: variant
                .map(|name| find("variant", name, variants))
                .transpose()?,
        })
    }
}

fn find<'a>(
    what: &str,
    wanted: &str,
    mut names: impl Iterator<Item = &'a str> + Clone,
) -> Result<usize, AssetError> {
    let all = names.clone();
    names
        .position(|name| name == wanted)
        .ok_or_else(|| missing(what, wanted, all))
}

fn missing<'a>(what: &str, wanted: &str, names: impl Iterator<Item = &'a str>) -> AssetError {
    const LISTED: usize = 20;
    let names: Vec<String> = names.take(LISTED).map(|name| format!("`{name}`")).collect();
    let advice = if names.is_empty() {
        "it has none".to_owned()
    } else {
        format!("it has {}", names.join(", "))
    };
    AssetError::unsupported(format!("the file has no {what} `{wanted}`"), advice)
}
