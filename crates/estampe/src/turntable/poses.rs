//! The models of the frames: one, or that of `--animate` at the times of the frames.

use super::arguments::TurntableArgs;
use crate::failure::Failure;
use crate::input::{Model, Reading};
use crate::values::Source;
use estampe_assets::Limits;
use estampe_assets::model::{LeastDetail, TextureDetail};

/// The poses of a model over the turn.
#[derive(Debug)]
pub(super) struct Poses<'a> {
    args: &'a TurntableArgs,
    limits: &'a Limits,
    duration_s: f32,
}

impl<'a> Poses<'a> {
    /// The poses of a model whose file has animations.
    pub(super) fn new(
        args: &'a TurntableArgs,
        limits: &'a Limits,
        model: &Model,
    ) -> Result<Self, Failure> {
        if args.model == Source::StandardInput {
            return Err(Failure::Usage(
                "--animate reads the model for each frame, and standard input can be read once; \
                 name a file"
                    .to_owned(),
            ));
        }
        let clips = &model.choices.animations;
        let chosen = args.choice.animation.as_deref().unwrap_or("0");
        let by_number = chosen.parse().ok().and_then(|at: usize| clips.get(at));
        let by_name = || clips.iter().find(|clip| clip.name == chosen);
        let clip = by_number.or_else(by_name).ok_or_else(|| {
            Failure::Usage(format!(
                "{}: the model has no animation; omit --animate",
                model.name
            ))
        })?;
        Ok(Self {
            args,
            limits,
            duration_s: clip.duration_s,
        })
    }

    /// The time of a frame. The animation's end is the time of the frame after the last one, so
    /// that it repeats with the turn.
    pub(super) fn time_s(&self, frame: u32) -> f32 {
        let part = f64::from(frame) / f64::from(self.args.frames);
        estampe_renderer::transforms::round_to_f32(f64::from(self.duration_s) * part)
    }

    /// The model at the time of a frame, whose textures do not matter.
    pub(super) fn shape_at(&self, frame: u32) -> Result<Model, Failure> {
        self.at(frame, &LeastDetail)
    }

    /// The model at the time of a frame.
    pub(super) fn at(&self, frame: u32, detail: &dyn TextureDetail) -> Result<Model, Failure> {
        let chosen = self.args.choice.at(Some(self.time_s(frame)));
        let options = Reading {
            options: &chosen,
            limits: self.limits,
            detail,
        };
        let folder = self.args.choice.folder_of(&self.args.model)?;
        let source = (&self.args.model, &folder);
        Model::read(source, self.args.format, options, |_| {})
    }
}
