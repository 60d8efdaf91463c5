//! Draws what passes are made of, and encodes their files.

use super::super::draw::{encoded, frame, light_frame};
use super::arguments::PassName;
use super::files::{PassFile, PassFormat};
use super::planes::{Colors, Sources};
use crate::failure::Failure;
use crate::input::Model;
use crate::render::PictureArgs;
use estampe::Device;
use estampe_assets::image::{ImageFormat, encode_exr, encode_hdr, encode_png_16};
use estampe_renderer::{Ground, Pinhole, RenderOptions, Shading, surface_points};
use estampe_scene::Camera;

/// The camera of passes, and as a pinhole if it is one.
pub(crate) type DrawnCamera = (Camera, Option<Pinhole>);

impl Sources {
    /// Draws what these passes need in files of a format, and returns the camera of it.
    pub(crate) fn draw(
        (passes, format): (&[PassName], PassFormat),
        model: &Model,
        picture: &PictureArgs,
        (options, device): (&RenderOptions, &Device),
    ) -> Result<(Self, Option<DrawnCamera>), Failure> {
        let mut camera = None;
        let mut image_of = |pass: PassName, options: &RenderOptions| {
            if !passes.contains(&pass) {
                return Ok(None);
            }
            let colors = if format.holds_light() {
                let frame = light_frame(model, picture, options, device)?;
                camera = Some((frame.camera, frame.pinhole));
                Colors::Light(frame.image)
            } else {
                let frame = frame(model, picture, options, device)?;
                camera = Some((frame.camera, frame.pinhole));
                Colors::Codes(frame.image)
            };
            Ok::<Option<Colors>, Failure>(Some(colors))
        };
        let color = image_of(PassName::Color, options)?;
        let unlit = RenderOptions {
            shading: Shading::Unlit,
            ground: Ground::None,
            shadows: false,
            fog: None,
            levels: None,
            program: None,
            ..options.clone().without_overlays()
        };
        let albedo = image_of(PassName::Albedo, &unlit)?;
        let mut points = Vec::new();
        if passes.iter().any(|pass| pass.is_of_surfaces()) {
            let found = surface_points(&model.scene, options, device);
            let found = found.map_err(|error| picture.shader.failure(error))?;
            camera = Some((found.camera, found.pinhole));
            points = found.points;
        }
        let sources = Self {
            color,
            albedo,
            points,
        };
        Ok((sources, camera))
    }

    /// The bytes of a file of this size, and a unit of depth.
    pub(crate) fn encode(
        &self,
        file: &PassFile,
        format: PassFormat,
        (size, depth_unit): ((u32, u32), f64),
    ) -> Result<Vec<u8>, Failure> {
        let failure = |error: estampe_assets::AssetError| Failure::Output(error.to_string());
        match (format, file.passes.as_slice()) {
            (PassFormat::Exr, passes) => {
                let channels = passes.iter().flat_map(|&pass| self.channels(pass));
                encode_exr(size, channels.collect()).map_err(failure)
            }
            (PassFormat::Hdr, passes) => {
                let light = self.colors(passes[0]).light();
                encode_hdr(&light.over(RenderOptions::DEFAULT_BACKGROUND)).map_err(failure)
            }
            (PassFormat::Png, &[pass @ (PassName::Color | PassName::Albedo)]) => {
                encoded(self.colors(pass).codes(), ImageFormat::Png)
            }
            (PassFormat::Png, passes) => {
                let codes = self.codes(passes[0], depth_unit)?;
                encode_png_16(size, &codes).map_err(failure)
            }
        }
    }
}
