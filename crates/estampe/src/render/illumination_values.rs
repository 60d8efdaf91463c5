//! Parsers for the values of the options of light.

use crate::colors::opaque as color;
use crate::values::{direction, number_between, vector};
use estampe_renderer::transforms::round_to_f32;
use estampe_renderer::{Specular, SpecularModel};
use glam::DVec3;

/// A light: `[dir:|pos:]X,Y,Z[:COLOUR][:INTENSITY]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LightValue {
    /// True for a position, false for a direction.
    pub(super) is_positional: bool,
    pub(super) vector: DVec3,
    /// sRGB.
    pub(super) color: [u8; 3],
    pub(super) intensity: f32,
}

/// Fog: `[START:]END[,COLOUR]`, in world units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FogValue {
    pub(super) start: f64,
    pub(super) end: f64,
    /// sRGB.
    pub(super) color: Option<[u8; 3]>,
}

/// Reads a light.
pub(super) fn light(text: &str) -> Result<LightValue, String> {
    let (is_positional, rest) = match text.split_once(':') {
        Some(("pos", rest)) => (true, rest),
        Some(("dir", rest)) => (false, rest),
        Some((word, _)) if word.chars().all(|c| c.is_ascii_alphabetic()) => {
            return Err(format!(
                "`{word}` is no kind of light; write dir: before a direction, pos: before a position"
            ));
        }
        _ => (false, text),
    };
    let mut fields = rest.split(':');
    let place = fields.next().unwrap_or_default();
    let read = if is_positional { vector } else { direction };
    let vector = read(place).map_err(|error| format!("`{place}`: {error}"))?;
    let (mut of_color, mut of_intensity) = (None, None);
    for field in fields {
        let is_number = field.parse::<f64>().is_ok() && !is_six_digits(field);
        let is_again = if is_number {
            let read = number_between(field, 0.0, 1000.0)
                .map_err(|error| format!("`{field}` is not an intensity: {error}"))?;
            of_intensity.replace(read).is_some()
        } else {
            let read = color(field).map_err(|error| {
                format!("`{field}` is neither an intensity, 0 to 1000, nor a colour: {error}")
            })?;
            of_color.replace(read).is_some()
        };
        if is_again {
            return Err(format!(
                "`{field}` is one too many; write one colour and one intensity"
            ));
        }
    }
    Ok(LightValue {
        is_positional,
        vector,
        color: of_color.unwrap_or([255; 3]),
        intensity: round_to_f32(of_intensity.unwrap_or(1.0)),
    })
}

/// True for a colour that could be a number, such as 400000.
fn is_six_digits(field: &str) -> bool {
    field.len() == 6 && field.bytes().all(|byte| byte.is_ascii_hexdigit())
}

/// Reads a distance in world units, more than 0.
pub(super) fn distance(text: &str) -> Result<f64, String> {
    let number: Option<f64> = text.trim().parse().ok();
    let positive = number.filter(|number| number.is_finite() && *number > 0.0);
    positive.ok_or_else(|| format!("`{text}` is not a distance; write a number above 0"))
}

/// Reads fog.
pub(super) fn fog(text: &str) -> Result<FogValue, String> {
    let (range, of_color) = match text.split_once(',') {
        Some((range, field)) => {
            let read = color(field).map_err(|error| format!("`{field}`: {error}"))?;
            (range, Some(read))
        }
        None => (text, None),
    };
    let (start, end) = match range.split_once(':') {
        Some((start, end)) => {
            let start = number_between(start, 0.0, f64::MAX)
                .map_err(|_| format!("`{start}` is not a distance; write a number, 0 or more"))?;
            (start, distance(end)?)
        }
        None => (0.0, distance(range)?),
    };
    if end <= start {
        return Err(format!(
            "fog that begins at {start} cannot be complete at {end}; write the nearer distance \
             first"
        ));
    }
    Ok(FogValue {
        start,
        end,
        color: of_color,
    })
}

/// Reads highlights: `none`, `phong` or `blinn`, the latter two with or without `:STRENGTH`.
pub(super) fn specular(text: &str) -> Result<Specular, String> {
    let (name, of_strength) = match text.split_once(':') {
        Some((name, strength)) => (name, Some(strength)),
        None => (text, None),
    };
    let model = match name {
        "none" => SpecularModel::None,
        "phong" => SpecularModel::Phong,
        "blinn" => SpecularModel::Blinn,
        _ => return Err(format!("`{name}` is none of none, phong and blinn")),
    };
    let read = |strength| {
        if model == SpecularModel::None {
            return Err("none has no strength; write none alone".to_owned());
        }
        number_between(strength, 0.0, 10.0)
            .map(round_to_f32)
            .map_err(|error| format!("`{strength}` is not a strength: {error}"))
    };
    Ok(Specular {
        model,
        strength: of_strength.map(read).transpose()?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lights_have_a_place_a_colour_and_an_intensity() {
        let plain = LightValue {
            is_positional: false,
            vector: DVec3::new(1.0, 0.5, -2.0),
            color: [255; 3],
            intensity: 1.0,
        };
        assert_eq!(light("1,0.5,-2"), Ok(plain));
        assert_eq!(light("dir:1,0.5,-2"), Ok(plain));
        let warm = LightValue {
            is_positional: true,
            color: [255, 128, 0],
            intensity: 2.5,
            ..plain
        };
        for text in ["pos:1,0.5,-2:ff8000:2.5", "pos:1,0.5,-2:2.5:#FF8000"] {
            assert_eq!(light(text), Ok(warm), "{text}");
        }
        assert!(light("pos:0,0,0").is_ok(), "a position may be anywhere");
    }

    #[test]
    fn messages_name_the_wrong_part() {
        for (text, part) in [
            ("lamp:1,2,3", "`lamp`"),
            ("1,2", "`1,2`"),
            ("0,0,0", "`0,0,0`"),
            ("pos:1,2,nan", "`1,2,nan`"),
            ("1,2,3:gg8000", "`gg8000`"),
            ("1,2,3:#ffff0", "`#ffff0`"),
            ("1,2,3:#fff8", "`#fff8`"),
            ("1,2,3:-1", "`-1`"),
            ("1,2,3:1001", "`1001`"),
            ("1,2,3:", "``"),
            ("1,2,3:2:3", "`3`"),
            ("1,2,3:ff0000:00ff00", "`00ff00`"),
        ] {
            let message = light(text).expect_err(text);
            assert!(message.contains(part), "{text}: {message}");
        }
        for (text, part) in [
            ("", "``"),
            ("0", "`0`"),
            ("inf", "`inf`"),
            ("-1:5", "`-1`"),
            ("5:2", "5"),
            ("5,rot", "`rot`"),
        ] {
            let message = fog(text).expect_err(text);
            assert!(message.contains(part), "{text}: {message}");
        }
        for (text, part) in [
            ("gloss", "`gloss`"),
            ("phong:11", "`11`"),
            ("phong:", "``"),
            ("none:1", "none"),
        ] {
            let message = specular(text).expect_err(text);
            assert!(message.contains(part), "{text}: {message}");
        }
        assert!(distance("0").is_err() && distance("x").is_err());
    }

    #[test]
    fn fog_and_highlights_are_read() {
        let to_black = FogValue {
            start: 2.0,
            end: 9.5,
            color: Some([0; 3]),
        };
        assert_eq!(fog("2:9.5,#000000"), Ok(to_black));
        let plain = FogValue {
            start: 0.0,
            end: 7.0,
            color: None,
        };
        assert_eq!(fog("7"), Ok(plain));
        assert_eq!(fog("5,red").map(|fog| fog.color), Ok(Some([255, 0, 0])));
        let of = |text: &str| light(text).map(|light| (light.color, light.intensity));
        assert_eq!(of("1,2,3:orange:2"), Ok(([255, 165, 0], 2.0)));
        assert_eq!(of("1,2,3:#fff:0.5"), Ok(([255; 3], 0.5)));
        assert_eq!(of("1,2,3:400000"), Ok(([0x40, 0, 0], 1.0)));
        assert_eq!(of("1,2,3:400"), Ok(([255; 3], 400.0)));
        assert_eq!(specular("phong"), Ok(Specular::default()));
        let blinn = Specular {
            model: SpecularModel::Blinn,
            strength: Some(0.5),
        };
        assert_eq!(specular("blinn:0.5"), Ok(blinn));
    }
}
