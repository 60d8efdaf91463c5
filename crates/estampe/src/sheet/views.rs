//! The views in which each model of a sheet is drawn.

use super::arguments::SheetArgs;
use crate::failure::Failure;
use crate::input::Model;
use crate::render::{self, PictureArgs, PictureDetail};
use crate::turntable::{Orbit, turned};
use crate::values::ViewName;
use clap::ValueEnum;
use estampe::Device;
use estampe_renderer::{Eye, RenderOptions, ViewDirection};
use estampe_scene::{Image, Scene};

/// The views of the options.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Views {
    /// That of `estampe render`.
    One,
    Named(Vec<ViewName>),
    /// This number, around the model.
    Turn(u32),
}

impl Views {
    pub(super) fn of(args: &SheetArgs) -> Self {
        match args.turn {
            Some(count) => Self::Turn(count),
            None if args.views.is_empty() => Self::One,
            None => Self::Named(args.views.clone()),
        }
    }

    /// The number of views, at least 1.
    pub(super) fn count(&self) -> usize {
        match self {
            Self::One => 1,
            Self::Named(names) => names.len(),
            Self::Turn(count) => *count as usize,
        }
    }

    /// The names of the views, if they have some: words, or azimuths as in 22.5°.
    pub(super) fn names(&self, args: &SheetArgs) -> Vec<Option<String>> {
        match self {
            Self::One => vec![args.picture.view.and_then(name)],
            Self::Named(names) => names.iter().copied().map(name).collect(),
            Self::Turn(count) => {
                let default = ViewDirection::default().azimuth_deg;
                let azimuth = args.picture.azimuth.unwrap_or(default);
                let view = args.picture.view.map(ViewDirection::from);
                let start = view.map_or(azimuth, |view| view.azimuth_deg);
                let step = 360.0 / f64::from(*count);
                let degrees = { 0..*count }.map(|at| degrees(start + step * f64::from(at)));
                degrees.map(Some).collect()
            }
        }
    }

    /// The detail of the textures in all views.
    pub(super) fn detail<'a>(&'a self, picture: &'a PictureArgs) -> PictureDetail<'a> {
        match self {
            Self::One => PictureDetail::of(picture),
            Self::Named(names) => {
                let of_view = |&view: &ViewName| PictureArgs {
                    view: Some(view),
                    ..picture.clone()
                };
                PictureDetail::of_all(names.iter().map(|name| (of_view(name), None)).collect())
            }
            Self::Turn(count) => PictureDetail::of_cameras(picture, |scene, options| {
                turned(&Self::orbit(scene, &options), *count, &options)
            }),
        }
    }

    /// The circle around a model.
    fn orbit(scene: &Scene, options: &RenderOptions) -> Orbit {
        let Eye::Fitted(start) = options.camera.eye else {
            unreachable!("--turn has no options that fix the eye");
        };
        let mut orbit = Orbit::new(scene, options, start);
        orbit.include(scene, options.up);
        orbit
    }

    /// Draws the views of a model one after the other, until `use_image` returns false.
    pub(super) fn draw(
        &self,
        model: &Model,
        args: &SheetArgs,
        device: &Device,
        mut use_image: impl FnMut(usize, Result<Image, Failure>) -> bool,
    ) -> Result<(), Failure> {
        let picture = &args.picture;
        let default = ViewDirection::default();
        match self {
            Self::One | Self::Named(_) => {
                for at in 0..self.count() {
                    let mut picture = picture.clone();
                    if let Self::Named(names) = self {
                        picture.view = Some(names[at]);
                    }
                    let options = render::frame_options(model, &picture, default, device)?;
                    let frame = render::frame(model, &picture, &options, device);
                    if !use_image(at, frame.map(|frame| frame.image)) {
                        break;
                    }
                }
            }
            Self::Turn(count) => {
                let options = render::frame_options(model, picture, default, device)?;
                let orbit = Self::orbit(&model.scene, &options);
                for (at, options) in turned(&orbit, *count, &options).iter().enumerate() {
                    let frame = render::frame(model, picture, options, device);
                    if !use_image(at, frame.map(|frame| frame.image)) {
                        break;
                    }
                }
            }
        }
        Ok(())
    }
}

fn name(view: ViewName) -> Option<String> {
    let value = view.to_possible_value();
    value.map(|value| value.get_name().to_owned())
}

/// An angle in 0..360, with at most one decimal.
fn degrees(angle: f64) -> String {
    let tenths = libm::round(angle * 10.0).rem_euclid(3600.0);
    format!("{}°", tenths / 10.0)
}

#[cfg(test)]
mod tests {
    use super::degrees;

    #[test]
    fn angles_are_in_a_turn() {
        for (angle, text) in [
            (0.0, "0°"),
            (-90.0, "270°"),
            (382.5, "22.5°"),
            (359.96, "0°"),
            (51.428, "51.4°"),
        ] {
            assert_eq!(degrees(angle), text);
        }
    }
}
