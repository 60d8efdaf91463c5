//! The samples of passes.

use super::arguments::PassName;
use crate::failure::Failure;
use estampe_assets::image::{ExrChannel, ExrSamples};
use estampe_renderer::{LightImage, SurfacePoint};
use estampe_scene::Image;

/// What passes are made of.
pub(crate) struct Sources {
    pub(super) color: Option<Colors>,
    pub(super) albedo: Option<Colors>,
    pub(super) points: Vec<Option<SurfacePoint>>,
}

/// A picture, as its file holds it.
pub(super) enum Colors {
    /// Codes.
    Codes(Image),
    /// Linear floats.
    Light(LightImage),
}

impl Colors {
    /// The picture of codes.
    pub(super) fn codes(&self) -> &Image {
        match self {
            Self::Codes(image) => image,
            Self::Light(_) => unreachable!("formats of codes are drawn as codes"),
        }
    }

    /// The picture of light.
    pub(super) fn light(&self) -> &LightImage {
        match self {
            Self::Light(image) => image,
            Self::Codes(_) => unreachable!("formats of light are drawn as light"),
        }
    }
}

impl Sources {
    /// The picture of a pass of colours.
    pub(super) fn colors(&self, pass: PassName) -> &Colors {
        let colors = match pass {
            PassName::Color => &self.color,
            _ => &self.albedo,
        };
        colors
            .as_ref()
            .expect("colours that are written were drawn")
    }

    /// The channels of a pass in an OpenEXR. Colours are linear, and multiplied by alpha.
    pub(super) fn channels(&self, pass: PassName) -> Vec<ExrChannel> {
        let point = |value: fn(&SurfacePoint) -> f32| {
            let values = self.points.iter();
            ExrSamples::Float(
                values
                    .map(|point| point.as_ref().map_or(0.0, value))
                    .collect(),
            )
        };
        let number = |value: fn(&SurfacePoint) -> u32| {
            let values = self.points.iter();
            ExrSamples::Uint(
                values
                    .map(|point| point.as_ref().map_or(0, value))
                    .collect(),
            )
        };
        let named: Vec<(&str, ExrSamples)> = match pass {
            PassName::Color => light(self.colors(pass).light(), ["R", "G", "B", "A"]),
            PassName::Albedo => light(
                self.colors(pass).light(),
                ["albedo.R", "albedo.G", "albedo.B", "albedo.A"],
            ),
            PassName::Depth => vec![("Z", point(|p| p.distance))],
            PassName::Normal => vec![
                ("normal.X", point(|p| p.normal_world.x)),
                ("normal.Y", point(|p| p.normal_world.y)),
                ("normal.Z", point(|p| p.normal_world.z)),
            ],
            PassName::Position => vec![
                ("position.X", point(|p| p.position_world.x)),
                ("position.Y", point(|p| p.position_world.y)),
                ("position.Z", point(|p| p.position_world.z)),
            ],
            PassName::Uv => vec![("uv.U", point(|p| p.uv.x)), ("uv.V", point(|p| p.uv.y))],
            PassName::ObjectId => vec![("object-id.id", number(object_id))],
            PassName::MaterialId => vec![("material-id.id", number(material_id))],
        };
        let channel = |(name, samples): (&str, ExrSamples)| ExrChannel {
            name: name.to_owned(),
            samples,
        };
        named.into_iter().map(channel).collect()
    }

    /// The samples of a pass with 16 bits, one or three for each pixel.
    pub(super) fn codes(&self, pass: PassName, depth_unit: f64) -> Result<Vec<u16>, Failure> {
        let grey = |value: &dyn Fn(&SurfacePoint) -> Result<u16, Failure>| {
            let values = self.points.iter();
            values
                .map(|point| point.as_ref().map_or(Ok(0), value))
                .collect()
        };
        let color = |value: &dyn Fn(&SurfacePoint) -> [f32; 3]| {
            let values = self.points.iter();
            let codes = values.flat_map(|point| match point {
                Some(point) => value(point).map(|share| code(f64::from(share) * 65535.0)),
                None => [0; 3],
            });
            Ok(codes.collect())
        };
        match pass {
            PassName::Depth => grey(&|point| {
                let steps = f64::from(point.distance) / depth_unit;
                if steps < 65535.5 {
                    // A surface is not background.
                    return Ok(code(steps).max(1));
                }
                Err(Failure::Limit(format!(
                    "a distance of {} has more than 65535 steps of {depth_unit}; choose a larger \
                     --depth-unit, or name OUT .exr",
                    point.distance
                )))
            }),
            PassName::ObjectId => grey(&|point| small(object_id(point), "meshes")),
            PassName::MaterialId => grey(&|point| small(material_id(point), "materials")),
            PassName::Normal => color(&|point| (point.normal_world * 0.5 + 0.5).to_array()),
            PassName::Uv => color(&|point| [wrapped(point.uv.x), wrapped(point.uv.y), 0.0]),
            PassName::Color | PassName::Albedo | PassName::Position => {
                unreachable!("colours have 8 bits, and positions are refused")
            }
        }
    }
}

/// The number of the mesh, from 1.
fn object_id(point: &SurfacePoint) -> u32 {
    u32::try_from(point.mesh).map_or(u32::MAX, |number| number.saturating_add(1))
}

/// The number of the material, from 1; 0 is none.
fn material_id(point: &SurfacePoint) -> u32 {
    point.material.map_or(0, |number| {
        u32::try_from(number).map_or(u32::MAX, |number| number.saturating_add(1))
    })
}

fn small(number: u32, what: &str) -> Result<u16, Failure> {
    u16::try_from(number).map_err(|_| {
        Failure::Limit(format!(
            "a PNG tells 65535 {what} apart, and this is number {number}; name OUT .exr"
        ))
    })
}

/// The nearest code.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped before"
)]
fn code(value: f64) -> u16 {
    (value + 0.5).clamp(0.0, 65535.0) as u16
}

/// A coordinate in 0..=1: unchanged if it is inside, else its fractional part.
fn wrapped(coordinate: f32) -> f32 {
    if (0.0..=1.0).contains(&coordinate) {
        coordinate
    } else if coordinate.is_finite() {
        coordinate - coordinate.floor()
    } else {
        0.0
    }
}

/// The channels of a picture of light.
fn light<'n>(image: &LightImage, names: [&'n str; 4]) -> Vec<(&'n str, ExrSamples)> {
    let pixels = image.rgba.as_chunks::<4>().0;
    let channel = |at: usize| {
        let samples = pixels.iter().map(|pixel| pixel[at]);
        ExrSamples::Float(samples.collect())
    };
    { names.into_iter().zip(0..) }
        .map(|(name, at)| (name, channel(at)))
        .collect()
}
