//! The options of physically based shading, and the renderer's options from them.

use crate::failure::Failure;
use crate::input::read_file;
use crate::values::shown;
use clap::{Args, ValueEnum};
use estampe_assets::Limits;
use estampe_assets::image::exr::is_exr;
use estampe_assets::image::{decode_exr, decode_hdr};
use estampe_renderer::{Environment, EnvironmentMap, RenderOptions, ToneMap};
use estampe_scene::Workers;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::SystemTime;

/// Light from all around, and how it is shown.
#[derive(Debug, Clone, Args)]
pub(crate) struct PbrArgs {
    /// The surroundings that light the model: a panorama (Radiance HDR or OpenEXR, equirectangular)
    ///
    /// The panorama's middle is at +Z, where the front view stands, and its upper edge is up.
    /// Without it a studio of soft boxes lights the model, which turns with the camera.
    #[arg(long, value_name = "FILE", help_heading = "Physically based shading")]
    hdri: Option<PathBuf>,

    /// Rotation of the surroundings, counter-clockwise from above, in degrees
    #[arg(long, value_name = "DEG", default_value_t = 0.0, value_parser = finite)]
    #[arg(allow_hyphen_values = true, help_heading = "Physically based shading")]
    environment_rotation: f64,

    /// Factor of the light from all around, 0 to 1000
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = factor)]
    #[arg(help_heading = "Physically based shading")]
    environment_intensity: f32,

    /// Let the lights of the model shine too; their units are absolute, see --exposure
    #[arg(long, help_heading = "Physically based shading")]
    scene_lights: bool,

    /// Brightness in stops, -30 to 30: each doubles the light
    #[arg(long, value_name = "STOPS", default_value_t = 0.0, value_parser = stops)]
    #[arg(allow_hyphen_values = true, help_heading = "Physically based shading")]
    exposure: f32,

    /// How bright light is shown: none, neutral (Khronos PBR Neutral), agx or aces
    #[arg(long, value_name = "CURVE", value_enum, default_value = "neutral")]
    #[arg(hide_possible_values = true, help_heading = "Physically based shading")]
    tone_map: ToneMapName,
}

/// Names of tone maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ToneMapName {
    /// What is brighter than white is cut off
    None,
    /// Khronos PBR Neutral: colours stay as they are, highlights are compressed
    Neutral,
    /// AgX: bright colours become white gradually
    Agx,
    /// ACES: the contrast of film
    Aces,
}

impl From<ToneMapName> for ToneMap {
    fn from(name: ToneMapName) -> Self {
        match name {
            ToneMapName::None => Self::None,
            ToneMapName::Neutral => Self::Neutral,
            ToneMapName::Agx => Self::Agx,
            ToneMapName::Aces => Self::Aces,
        }
    }
}

impl PbrArgs {
    /// The renderer's options with these.
    pub(super) fn apply(
        &self,
        options: RenderOptions,
        workers: Workers,
    ) -> Result<RenderOptions, Failure> {
        Ok(RenderOptions {
            environment: Environment {
                map: self.map(workers)?,
                rotation_deg: self.environment_rotation,
                intensity: self.environment_intensity,
            },
            scene_lights: self.scene_lights,
            exposure_ev: self.exposure,
            tone_map: self.tone_map.into(),
            ..options
        })
    }
}

impl PbrArgs {
    /// The panorama's file.
    pub(crate) fn panorama(&self) -> Option<&Path> {
        self.hdri.as_deref()
    }

    /// The surroundings of the panorama. The last one is kept: many models have the same.
    fn map(&self, workers: Workers) -> Result<Option<Arc<EnvironmentMap>>, Failure> {
        type Known = (PathBuf, Option<SystemTime>, Arc<EnvironmentMap>);
        static LAST: Mutex<Option<Known>> = Mutex::new(None);
        let Some(path) = &self.hdri else {
            return Ok(None);
        };
        let mut last = LAST.lock().unwrap_or_else(PoisonError::into_inner);
        // With --watch it may change.
        let modified = std::fs::metadata(path)
            .and_then(|file| file.modified())
            .ok();
        if let Some((known, at, map)) = &*last
            && known == path
            && *at == modified
        {
            return Ok(Some(Arc::clone(map)));
        }
        let limits = Limits::default();
        let bytes = read_file(path, &limits)?;
        let decode = if is_exr(&bytes) {
            decode_exr
        } else {
            decode_hdr
        };
        let image = decode(&bytes, &limits).map_err(|error| error.in_file(&shown(path)))?;
        let [width, height] = [image.width, image.height].map(|side| side as usize);
        let map = EnvironmentMap::from_panorama(width, height, &image.rgb, workers);
        let map = map.map_err(|error| Failure::Input(format!("{}: {error}", shown(path))))?;
        let map = Arc::new(map);
        *last = Some((path.clone(), modified, Arc::clone(&map)));
        Ok(Some(map))
    }
}

/// A number, neither infinite nor NaN.
fn finite(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err("give a number, as in 90".to_owned()),
    }
}

/// A factor of light.
fn factor(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(number) if (0.0..=1000.0).contains(&number) => Ok(number),
        _ => Err("give a number from 0 to 1000, as in 1.5".to_owned()),
    }
}

/// Stops of exposure.
fn stops(text: &str) -> Result<f32, String> {
    match text.parse::<f32>() {
        Ok(number) if (-30.0..=30.0).contains(&number) => Ok(number),
        _ => Err("give a number from -30 to 30, as in -1.5".to_owned()),
    }
}
