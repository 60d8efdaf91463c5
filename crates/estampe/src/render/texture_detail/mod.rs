//! The detail that the textures of pictures need.

use super::cameras::NamedCamera;
use super::draw::with_model_camera;
use super::picture::PictureArgs;
use estampe_assets::model::TextureDetail;
use estampe_renderer::{RenderOptions, ViewDirection, first_level_of_texture, first_levels};
use estampe_scene::{Scene, Workers};
use std::sync::Arc;

/// The detail of some pictures of one model: the finest that one of them needs.
pub(crate) struct PictureDetail<'a> {
    pictures: Pictures<'a>,
    workers: Workers,
}

/// The options of the pictures of a scene. `None` if textures are needed whole.
type Pictures<'a> = Box<dyn Fn(&Scene) -> Option<Vec<RenderOptions>> + 'a>;

impl<'a> PictureDetail<'a> {
    /// The most pictures that are looked at: beyond, textures are needed whole. Each takes a pass
    /// over the triangles.
    pub(crate) const MOST_PICTURES: usize = 256;

    /// The detail of a picture.
    pub(crate) fn of(args: &'a PictureArgs) -> Self {
        Self::of_cameras(args, |_, options| vec![options])
    }

    /// The detail of several pictures, some with the camera of a file.
    pub(crate) fn of_all(pictures: Vec<(PictureArgs, Option<Arc<NamedCamera>>)>) -> Self {
        let threads = { pictures.first() }.map_or(0, |(args, _)| args.thread_count());
        let options = move |scene: &Scene| {
            let options = |(args, camera): &(PictureArgs, Option<Arc<NamedCamera>>)| {
                let options = view_options(args, ViewDirection::default(), scene)?;
                Some(match camera {
                    Some(camera) => camera.apply(options),
                    None => options,
                })
            };
            pictures.iter().map(options).collect()
        };
        Self {
            pictures: Box::new(options),
            workers: Workers::new(threads),
        }
    }

    /// The detail of pictures with the same options but for cameras and sizes, which `pictures`
    /// makes of a scene and the options of one picture.
    pub(crate) fn of_cameras(
        args: &'a PictureArgs,
        pictures: impl Fn(&Scene, RenderOptions) -> Vec<RenderOptions> + 'a,
    ) -> Self {
        let options = move |scene: &Scene| {
            let options = view_options(args, ViewDirection::default(), scene)?;
            Some(pictures(scene, options))
        };
        Self {
            pictures: Box::new(options),
            workers: Workers::new(args.thread_count()),
        }
    }
}

impl TextureDetail for PictureDetail<'_> {
    fn first_levels(&self, scene: &Scene) -> Vec<u32> {
        let pictures =
            (self.pictures)(scene).filter(|pictures| pictures.len() <= Self::MOST_PICTURES);
        let Some(pictures) = pictures else {
            return Vec::new();
        };
        let levels = pictures
            .iter()
            .map(|options| first_levels(scene, options, self.workers));
        let finest = levels.reduce(|finest, levels| {
            let both = finest.into_iter().zip(levels);
            both.map(|(a, b)| a.min(b)).collect()
        });
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
    options.map_or(0, |options| {
        first_level_of_texture(size, scene, &options, Workers::new(args.thread_count()))
    })
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
