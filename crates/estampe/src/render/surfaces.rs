//! The options of colours, materials, points and lines.

use super::appearance_names::ShadingName;
use crate::colors;
use crate::failure::Failure;
use crate::values;
use clap::Args;
use estampe_renderer::{RenderOptions, Shading};

/// What surfaces, points and lines look like.
#[derive(Debug, Clone, Args)]
pub(crate) struct SurfaceArgs {
    /// The colour of everything, instead of the model's colours and textures; with --texture, its
    /// tint
    ///
    /// A CSS name or #RGB, #RRGGBB, #RRGGBBAA; with an alpha the model is transparent.
    #[arg(long, value_name = "COLOUR", value_parser = colors::color)]
    #[arg(help_heading = "Appearance")]
    color: Option<[u8; 4]>,

    /// Roughness of all surfaces, 0 (mirror) to 1; draws them with --shading pbr
    #[arg(long, value_name = "R", value_parser = values::share)]
    #[arg(help_heading = "Physically based shading")]
    roughness: Option<f32>,

    /// Metallic share of all surfaces, 0 or 1 as a rule; draws them with --shading pbr
    #[arg(long, value_name = "M", value_parser = values::share)]
    #[arg(help_heading = "Physically based shading")]
    metallic: Option<f32>,

    /// Width of points in pixels, 0.1 to 256 [default: by their number and the picture's size]
    #[arg(long, value_name = "PX", value_parser = values::point_size)]
    #[arg(help_heading = "Appearance")]
    point_size: Option<f32>,

    /// Width of lines, and of the edges of wireframes, in pixels, 0.1 to 64; smooth at any width
    #[arg(long, value_name = "PX", value_parser = values::line_width)]
    #[arg(help_heading = "Appearance")]
    line_width: Option<f32>,
}

impl SurfaceArgs {
    /// Refuses options of physically based materials with another shading.
    pub(super) fn check(&self, shading: ShadingName) -> Result<(), Failure> {
        let is_pbr = matches!(shading, ShadingName::Auto | ShadingName::Pbr);
        let named = [
            ("--roughness", self.roughness.is_some()),
            ("--metallic", self.metallic.is_some()),
        ];
        match named.iter().find(|(_, is_given)| *is_given && !is_pbr) {
            Some((name, _)) => Err(Failure::Usage(format!(
                "{name} is a property of physically based materials: choose --shading pbr, or omit it"
            ))),
            None => Ok(()),
        }
    }

    /// The renderer's options with these.
    pub(super) fn apply(&self, options: RenderOptions) -> RenderOptions {
        let is_physical = self.roughness.is_some() || self.metallic.is_some();
        RenderOptions {
            shading: match options.shading {
                Shading::Automatic if is_physical => Shading::Pbr,
                chosen => chosen,
            },
            color: self.color,
            roughness: self.roughness,
            metallic: self.metallic,
            point_size_px: self.point_size,
            line_width_px: self.line_width,
            ..options
        }
    }
}
