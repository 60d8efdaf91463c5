//! The detail that the textures of a picture need.

use super::draw::with_model_camera;
use super::picture::PictureArgs;
use estampe_assets::model::TextureDetail;
use estampe_renderer::{RenderOptions, ViewDirection, first_level_of_texture, first_levels};
use estampe_scene::Scene;

/// The detail of pictures with these options: the finest that one of them needs.
#[derive(Debug)]
pub(crate) struct PictureDetail {
    pictures: Vec<PictureArgs>,
}

impl PictureDetail {
    /// The detail of a picture.
    pub(crate) fn of(args: &PictureArgs) -> Self {
        Self::of_all([args.clone()])
    }

    /// The detail of several pictures of one model.
    pub(crate) fn of_all(pictures: impl IntoIterator<Item = PictureArgs>) -> Self {
        Self {
            pictures: pictures.into_iter().collect(),
        }
    }
}

impl TextureDetail for PictureDetail {
    fn first_levels(&self, scene: &Scene) -> Vec<u32> {
        let mut finest: Option<Vec<u32>> = None;
        for args in &self.pictures {
            let Some(options) = view_options(args, ViewDirection::default(), scene) else {
                return Vec::new();
            };
            let levels = first_levels(scene, &options);
            finest = Some(match finest {
                Some(finest) => finest
                    .into_iter()
                    .zip(levels)
                    .map(|(a, b)| a.min(b))
                    .collect(),
                None => levels,
            });
        }
        finest.unwrap_or_default()
    }
}

/// The first level of a texture of this size in place of the scene's that a picture needs.
pub(super) fn level_of_texture(
    size: (u32, u32),
    args: &PictureArgs,
    default_view: ViewDirection,
    scene: &Scene,
) -> u32 {
    let options = view_options(args, default_view, scene);
    options.map_or(0, |options| first_level_of_texture(size, scene, &options))
}

/// The options that decide what is visible. `None` if textures are needed whole: a shader may read
/// them as it likes, and a camera that does not exist is an error later.
fn view_options(
    args: &PictureArgs,
    default_view: ViewDirection,
    scene: &Scene,
) -> Option<RenderOptions> {
    if args.shader.file().is_some() {
        return None;
    }
    with_model_camera(args.view_options(default_view), args, scene).ok()
}

#[cfg(test)]
mod tests;
