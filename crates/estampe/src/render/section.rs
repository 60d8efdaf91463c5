//! The options of sections, and the renderer's options from them.

use crate::colors;
use crate::failure::Failure;
use clap::Args;
use estampe_renderer::{RenderOptions, Section, SectionPlane};
use glam::DVec3;

/// Planes that cut the model.
#[derive(Debug, Clone, Args)]
pub(crate) struct SectionArgs {
    /// Cut the model away on one side of a plane; repeatable: x, -z, y=0.3, NX,NY,NZ or NX,NY,NZ,D
    ///
    /// x, y, z and -x, -y, -z name the side that is cut away, of the plane through the middle of
    /// the model's box; =NUMBER is the plane's coordinate. NX,NY,NZ is a direction towards the side
    /// that is cut away, and D the plane's distance from the origin along it. Closed meshes are
    /// solid: where they are cut, they have the colour of --section-color.
    #[arg(long, value_name = "PLANE", value_parser = plane, allow_hyphen_values = true)]
    #[arg(help_heading = "Section")]
    section: Vec<SectionPlane>,

    /// The colour of cut solids [default: #c86a4e]
    #[arg(long, value_name = "COLOUR", value_parser = colors::opaque, help_heading = "Section")]
    section_color: Option<[u8; 3]>,
}

impl SectionArgs {
    /// Refuses combinations of options that would have no effect.
    pub(super) fn check(&self) -> Result<(), Failure> {
        if self.section_color.is_some() && self.section.is_empty() {
            return Err(Failure::Usage(
                "--section-color is the colour of cut solids; add a plane, as in --section x"
                    .to_owned(),
            ));
        }
        Ok(())
    }

    /// True if the model is cut.
    pub(crate) fn is_cut(&self) -> bool {
        !self.section.is_empty()
    }

    /// The renderer's options with these.
    pub(super) fn apply(&self, options: RenderOptions) -> RenderOptions {
        RenderOptions {
            section: Section {
                planes: self.section.clone(),
                cap_color: self.section_color.unwrap_or(Section::CAP_COLOR),
            },
            ..options
        }
    }
}

/// A plane: an axis with or without a sign and a coordinate, or a direction with or without a
/// distance.
fn plane(text: &str) -> Result<SectionPlane, String> {
    const FORMS: &str = "write an axis, as in x, -z or y=0.3, or a direction with or without a \
                         distance, as in 1,1,0 or 1,1,0,0.5";
    let number = |text: &str| {
        let number = text.trim().parse::<f64>().ok();
        number.filter(|number| number.abs() <= 1e30).ok_or(FORMS)
    };
    if text.contains(',') {
        let numbers: Vec<f64> = text.split(',').map(number).collect::<Result<_, _>>()?;
        let (direction, distance) = match numbers[..] {
            [x, y, z] => (DVec3::new(x, y, z), None),
            [x, y, z, d] => (DVec3::new(x, y, z), Some(d)),
            _ => return Err(FORMS.to_owned()),
        };
        let length = direction.length();
        if length < 1e-30 {
            return Err(format!("0,0,0 is not a direction; {FORMS}"));
        }
        return Ok(SectionPlane {
            normal_world: direction / length,
            offset_world: distance,
        });
    }
    let (axis, coordinate) = match text.split_once('=') {
        Some((axis, coordinate)) => (axis, Some(number(coordinate)?)),
        None => (text, None),
    };
    let (sign, axis) = match axis.strip_prefix('-') {
        Some(axis) => (-1.0, axis),
        None => (1.0, axis.strip_prefix('+').unwrap_or(axis)),
    };
    let axis = match axis {
        "x" | "X" => DVec3::X,
        "y" | "Y" => DVec3::Y,
        "z" | "Z" => DVec3::Z,
        _ => return Err(FORMS.to_owned()),
    };
    Ok(SectionPlane {
        normal_world: axis * sign,
        offset_world: coordinate.map(|coordinate| coordinate * sign),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_are_axes_or_directions() {
        let of = |normal, offset| {
            Ok(SectionPlane {
                normal_world: normal,
                offset_world: offset,
            })
        };
        assert_eq!(plane("x"), of(DVec3::X, None));
        assert_eq!(plane("-z"), of(-DVec3::Z, None));
        assert_eq!(plane("y=0.3"), of(DVec3::Y, Some(0.3)));
        assert_eq!(plane("-y=0.3"), of(-DVec3::Y, Some(-0.3)));
        assert_eq!(plane("0,2,0"), of(DVec3::Y, None));
        assert_eq!(plane("0, -2, 0, 5"), of(-DVec3::Y, Some(5.0)));
        for wrong in [
            "",
            "w",
            "x=",
            "x=a",
            "1",
            "1,2",
            "1,2,3,4,5",
            "0,0,0",
            "nan,0,0",
            "x=inf",
            "--x",
            "0,0,0,1",
            "1e31,0,0",
        ] {
            assert!(plane(wrong).is_err(), "{wrong}");
        }
    }
}
