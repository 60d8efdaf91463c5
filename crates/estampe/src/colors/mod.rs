//! Colours and backgrounds as options write them.
//!
//! ```text
//! colour      NAME  #RGB  #RGBA  #RRGGBB  #RRGGBBAA  transparent      the mark # may be omitted
//! background  COLOUR  none  linear:COLOUR,COLOUR…  radial:COLOUR,COLOUR…
//! ```

mod names;

use estampe_renderer::{Gradient, GradientShape};

/// A background of an option: a colour, a gradient over it, or none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Background {
    /// sRGB; the middle colour of a gradient. `None` if it is transparent somewhere.
    pub(crate) color: Option<[u8; 3]>,
    /// The gradient, or a colour with alpha.
    pub(crate) gradient: Option<Gradient>,
}

impl Background {
    /// The colour, or that in the middle of the gradient: sRGB and straight alpha.
    pub(crate) fn in_the_middle(&self) -> [u8; 4] {
        match (self.color, self.gradient) {
            (Some([r, g, b]), _) => [r, g, b, 255],
            (None, Some(gradient)) => gradient.middle_with_alpha(),
            (None, None) => [0; 4],
        }
    }
}

/// A colour: sRGB and alpha.
pub(crate) fn color(text: &str) -> Result<[u8; 4], String> {
    let text = text.trim();
    if text.eq_ignore_ascii_case("transparent") {
        return Ok([0; 4]);
    }
    if let Some([r, g, b]) = names::named(text) {
        return Ok([r, g, b, 255]);
    }
    of_digits(text.strip_prefix('#').unwrap_or(text)).ok_or_else(|| {
        let like = match names::nearest(text) {
            Some(name) => format!("did you mean {name}? "),
            None => String::new(),
        };
        format!(
            "{like}write a colour by its CSS name, as in tomato, or by hexadecimal digits, as in \
             '#f2f2f2' or '#fff'"
        )
    })
}

/// A colour without alpha: sRGB.
pub(crate) fn opaque(text: &str) -> Result<[u8; 3], String> {
    match color(text)? {
        [r, g, b, 255] => Ok([r, g, b]),
        _ => Err("this colour has no transparency; omit its alpha".to_owned()),
    }
}

/// A background.
pub(crate) fn background(text: &str) -> Result<Background, String> {
    let text = text.trim();
    if text.eq_ignore_ascii_case("none") {
        return Ok(Background {
            color: None,
            gradient: None,
        });
    }
    let (shape, colors) = match text.split_once(':') {
        Some(("linear", colors)) => (GradientShape::Linear, colors),
        Some(("radial", colors)) => (GradientShape::Radial, colors),
        Some((word, _)) => {
            return Err(format!(
                "`{word}` is no kind of gradient; write linear:COLOUR,COLOUR from top to bottom, or \
                 radial:COLOUR,COLOUR from the middle to the corners"
            ));
        }
        None => return single(text),
    };
    let colors: Vec<[u8; 4]> = colors
        .split(',')
        .map(|one| color(one).map_err(|error| format!("`{one}`: {error}")))
        .collect::<Result<_, _>>()?;
    if colors.len() < 2 {
        return Err(format!(
            "a gradient has two colours or more, as in linear:{},white",
            text.split_once(':').map_or("", |(_, one)| one)
        ));
    }
    let gradient = Gradient::new(shape, &colors)
        .ok_or_else(|| format!("a gradient has at most {} colours", Gradient::MOST_COLORS))?;
    Ok(Background {
        color: gradient.is_opaque().then(|| gradient.middle()),
        gradient: Some(gradient),
    })
}

/// A background of one colour.
fn single(text: &str) -> Result<Background, String> {
    let color = color(text).map_err(|error| format!("{error}, or none, linear:… or radial:…"))?;
    Ok(match color {
        [r, g, b, 255] => Background {
            color: Some([r, g, b]),
            gradient: None,
        },
        [.., 0] => Background {
            color: None,
            gradient: None,
        },
        _ => Background {
            color: None,
            gradient: Gradient::new(GradientShape::Linear, &[color]),
        },
    })
}

/// Three or four digits, or three or four pairs of them.
fn of_digits(digits: &str) -> Option<[u8; 4]> {
    if !digits.bytes().all(|byte| byte.is_ascii_hexdigit()) {
        return None;
    }
    let code = u32::from_str_radix(digits, 16).ok()?;
    let of_nibbles = |code: u32| {
        let nibble = |shift: u32| u8::try_from(code >> shift & 15).map_or(0, |four| four * 17);
        [nibble(12), nibble(8), nibble(4), nibble(0)]
    };
    match digits.len() {
        3 => Some(of_nibbles(code << 4 | 15)),
        4 => Some(of_nibbles(code)),
        6 => Some((code << 8 | 255).to_be_bytes()),
        8 => Some(code.to_be_bytes()),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::{background, color, opaque};

    #[test]
    fn colours_have_names_and_digits() {
        assert_eq!(color("tomato"), Ok([0xff, 0x63, 0x47, 255]));
        assert_eq!(color("#F2f200"), Ok([0xf2, 0xf2, 0, 255]));
        assert_eq!(color("0a0b0c"), Ok([10, 11, 12, 255]));
        assert_eq!(color("#fa3"), Ok([0xff, 0xaa, 0x33, 255]));
        assert_eq!(color("#fa38"), Ok([0xff, 0xaa, 0x33, 0x88]));
        assert_eq!(color("#01020304"), Ok([1, 2, 3, 4]));
        assert_eq!(color("Transparent"), Ok([0; 4]));
        for wrong in [
            "",
            "#",
            "#f",
            "#+12345",
            "#f2f2f2f",
            "#é1234",
            "reddish-green",
            "0x112233",
        ] {
            assert!(color(wrong).is_err(), "{wrong}");
        }
        assert_eq!(opaque("red"), Ok([255, 0, 0]));
        assert!(opaque("#ff000080").is_err() && opaque("transparent").is_err());
        assert!(color("tomatoe").is_err_and(|message| message.contains("tomato?")));
    }

    #[test]
    fn backgrounds_are_colours_gradients_or_none() {
        let of = |text: &str| background(text).expect(text);
        assert_eq!((of("none").color, of("none").gradient), (None, None));
        assert_eq!(of("transparent"), of("none"));
        assert_eq!(of("#000000"), of("black"));
        assert_eq!(of("white").color, Some([255; 3]));
        let clear = of("#ff000080");
        assert!(clear.color.is_none() && clear.gradient.is_some());
        assert_eq!(clear.in_the_middle(), [255, 0, 0, 128]);
        assert_eq!(of("none").in_the_middle(), [0; 4]);
        assert_eq!(
            of("linear:#123456,#123456").in_the_middle(),
            [0x12, 0x34, 0x56, 255]
        );
        let linear = of("linear:#fff,#fff");
        assert!(linear.color == Some([255; 3]) && linear.gradient.is_some());
        assert!(of("radial:red,transparent").color.is_none());
        for (wrong, part) in [
            ("linear:red", "two colours"),
            ("linear:", "hexadecimal"),
            ("linear:red,", "hexadecimal"),
            ("conic:red,blue", "conic"),
            ("radial:1,2,3,4,5,6,7,8,9", "`1`"),
            ("linear:red,red,red,red,red,red,red,red,red", "at most 8"),
            ("nonee", "none"),
        ] {
            let message = background(wrong).expect_err(wrong);
            assert!(message.contains(part), "{wrong}: {message}");
        }
    }
}
