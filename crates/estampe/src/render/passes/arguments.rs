//! The options of passes.

use crate::values::ImageFormatName;
use clap::{Args, ValueEnum};

/// What is drawn besides the picture.
#[derive(Debug, Clone, Args)]
pub(crate) struct PassArgs {
    /// Images of the same camera, separated by commas: color, depth, normal, albedo, …
    ///
    /// OUT is one OpenEXR with all of them, or has {pass} in its name: a file for each.
    ///
    /// color: the picture; in OpenEXR and Radiance HDR its light before the tone map. depth:
    /// distance along the view direction. normal: unit, world space, on the side that is seen.
    /// albedo: colours without light. position: world space. object-id and material-id: the number
    /// in the model, from 1. uv: texture coordinates. All but color and albedo are of the centre of
    /// the pixel, 0 on the background; transparent surfaces are solid in them. OpenEXR has floats
    /// and 32-bit numbers. PNG has 16 bits: depth in steps of the option below, normal as
    /// (n + 1)/2, the fraction of uv; position is not possible.
    #[arg(long, value_name = "PASSES", value_enum, value_delimiter = ',')]
    #[arg(hide_possible_values = true, help_heading = "Data passes")]
    pub(crate) pass: Vec<PassName>,

    /// The world's units of a step of depth in a PNG
    #[arg(long, value_name = "LENGTH", default_value_t = 0.001, value_parser = length)]
    #[arg(help_heading = "Data passes")]
    pub(crate) depth_unit: f64,
}

/// Formats of pictures and of passes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum OutputFormatName {
    /// Lossless, with alpha
    Png,
    /// Small, without alpha
    #[value(alias = "jpg")]
    Jpeg,
    /// Lossless, with alpha, simple
    Tga,
    /// Lossless, with alpha, smaller than PNG
    Webp,
    /// Floats: light that is not clipped, with the passes of --pass
    Exr,
    /// Light that is not clipped, without alpha
    Hdr,
}

impl OutputFormatName {
    /// The format of a picture.
    pub(crate) fn of_picture(self) -> Option<ImageFormatName> {
        match self {
            Self::Png => Some(ImageFormatName::Png),
            Self::Jpeg => Some(ImageFormatName::Jpeg),
            Self::Tga => Some(ImageFormatName::Tga),
            Self::Webp => Some(ImageFormatName::Webp),
            Self::Exr | Self::Hdr => None,
        }
    }
}

/// Names of passes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, ValueEnum)]
pub(crate) enum PassName {
    /// The picture
    #[value(alias = "colour")]
    Color,
    /// Distance along the view direction
    Depth,
    /// Unit normals in world space
    Normal,
    /// Colours without light
    Albedo,
    /// Positions in world space
    Position,
    /// The number of the mesh, from 1
    ObjectId,
    /// The number of the material, from 1
    MaterialId,
    /// Texture coordinates
    Uv,
}

impl PassName {
    /// As in options and names of files.
    pub(crate) fn name(self) -> String {
        let value = self.to_possible_value();
        value.map_or_else(String::new, |value| value.get_name().to_owned())
    }

    /// True for what is known of the surface at a pixel's centre.
    pub(super) fn is_of_surfaces(self) -> bool {
        !matches!(self, Self::Color | Self::Albedo)
    }
}

/// A length above 0.
fn length(text: &str) -> Result<f64, String> {
    let number = text.trim().parse().ok();
    let length = number.filter(|length: &f64| length.is_finite() && *length > 0.0);
    length.ok_or_else(|| "give a length above 0, as in 0.001".to_owned())
}
