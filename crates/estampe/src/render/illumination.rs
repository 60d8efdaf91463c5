//! The options of light, highlights and fog, and the renderer's options from them.

use super::illumination_values::{self as values, FogValue, LightValue};
use crate::failure::Failure;
use crate::values::ambient;
use clap::Args;
use estampe::srgb;
use estampe_renderer::transforms::round_to_f32;
use estampe_renderer::{Fog, RenderOptions, Specular};
use estampe_scene::{Light, LightSource};
use glam::{DVec3, Vec3};

/// Light and what it meets on its way to the eye.
#[derive(Debug, Clone, Args)]
pub(crate) struct IlluminationArgs {
    /// A light instead of the default lights; repeatable: [dir:|pos:]X,Y,Z[:COLOUR][:INTENSITY]
    ///
    /// dir:X,Y,Z, or X,Y,Z alone, is a direction towards the light; pos:X,Y,Z is a position.
    /// COLOUR is a CSS name or hexadecimal digits [default: white], INTENSITY a factor, 0 to 1000
    /// [default: 1].
    #[arg(long, value_name = "LIGHT", value_parser = values::light, allow_hyphen_values = true)]
    #[arg(help_heading = "Light")]
    light: Vec<LightValue>,

    /// Ambient light, 0 to 10, times the base colour [default: 0.18]
    #[arg(long, value_name = "AMOUNT", value_parser = ambient, help_heading = "Light")]
    ambient: Option<f32>,

    /// The distance at which lights with a position end; without it they reach everywhere alike
    ///
    /// At distance d, 1 - min(d/DISTANCE, 1) of the light is left. Needs a light with a position.
    #[arg(long, value_name = "DISTANCE", value_parser = values::distance, help_heading = "Light")]
    attenuation: Option<f64>,

    /// Highlights: none, phong (reflected light) or blinn (half vector), with or without :STRENGTH
    ///
    /// STRENGTH, 0 to 10, is the specular colour of all materials [default: the materials']. A
    /// highlight of the same size needs about four times the shininess with blinn. Toon shading has
    /// no highlights.
    #[arg(long, value_name = "MODEL[:STRENGTH]", default_value = "phong")]
    #[arg(value_parser = values::specular, help_heading = "Light")]
    specular: Specular,

    /// Specular exponent of all materials, 1 to 10000 [default: the materials']
    #[arg(long, value_name = "EXPONENT", help_heading = "Light")]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=10_000))]
    shininess: Option<u32>,

    /// Levels of each channel of lit colours, 2 to 256; with toon shading, steps of light
    #[arg(long, value_name = "N", help_heading = "Light")]
    #[arg(value_parser = clap::value_parser!(u16).range(2..=256))]
    levels: Option<u16>,

    /// Fog that is complete at a distance from the eye: [START:]DISTANCE[,COLOUR]
    ///
    /// It begins at START [default: 0, the eye]. COLOUR is a CSS name or hexadecimal digits
    /// [default: the background's].
    #[arg(long, value_name = "FOG", value_parser = values::fog, allow_hyphen_values = true, help_heading = "Light")]
    fog: Option<FogValue>,
}

impl IlluminationArgs {
    /// Refuses combinations of options that would have no effect.
    pub(super) fn check(&self) -> Result<(), Failure> {
        let has_position = self.light.iter().any(|light| light.is_positional);
        if self.attenuation.is_none() || has_position {
            return Ok(());
        }
        Err(Failure::Usage(
            "--attenuation needs a light with a position; add one, as in --light pos:2,3,4"
                .to_owned(),
        ))
    }

    /// The renderer's options with these.
    pub(super) fn apply(&self, options: RenderOptions) -> RenderOptions {
        let fog = |fog: &FogValue| Fog {
            start_world: fog.start,
            end_world: fog.end,
            color: fog.color,
        };
        RenderOptions {
            lights: self.light.iter().map(|light| self.light(light)).collect(),
            ambient: self.ambient,
            specular: self.specular,
            shininess: self.shininess,
            levels: self.levels,
            fog: self.fog.as_ref().map(fog),
            ..options
        }
    }

    fn light(&self, light: &LightValue) -> Light {
        let source = if light.is_positional {
            let furthest = DVec3::splat(f64::from(f32::MAX));
            LightSource::Positional {
                position_world: light.vector.clamp(-furthest, furthest).as_vec3(),
                reach: self.attenuation.map(round_to_f32),
            }
        } else {
            LightSource::Directional {
                // Normalised, because f64's range exceeds f32's; only the direction matters.
                towards_light_world: light.vector.normalize_or(DVec3::Y).as_vec3(),
            }
        };
        let color = Vec3::from(light.color.map(srgb::decode)) * light.intensity;
        Light { source, color }
    }
}
