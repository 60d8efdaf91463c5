//! Pictures of half blocks: each character shows two pixels, one above the other, and is about
//! twice as high as wide.

use super::scale::{fitted, reduced};
use super::terminal::{Colors, Terminal};
use estampe_scene::Image;
use std::fmt::Write;

type Rgb = [u8; 3];

/// Pixels with less alpha show the terminal's background.
const OPAQUE: u8 = 128;

/// Characters from light to dark.
const INKS: &[u8] = b" .:-=+*#%@";

/// The picture as text.
pub(super) fn text(image: &Image, terminal: &Terminal) -> String {
    let most = [terminal.columns, 2 * terminal.rows];
    let size = fitted([image.width, image.height], most);
    let small = reduced(image, size);
    let pixel = |x: u32, y: u32| {
        let [r, g, b, a] = if y < small.height {
            small.texel(x, y)
        } else {
            [0; 4]
        };
        (a >= OPAQUE).then_some([r, g, b])
    };
    let mut out = String::new();
    for row in 0..small.height.div_ceil(2) {
        let halves = (0..small.width).map(|x| [pixel(x, 2 * row), pixel(x, 2 * row + 1)]);
        if terminal.colors == Colors::None {
            let inks = halves.map(ink).collect::<String>();
            out.push_str(inks.trim_end());
        } else {
            colored(halves, terminal.colors, &mut out);
        }
        out.push('\n');
    }
    out
}

/// A line of half blocks.
fn colored(halves: impl Iterator<Item = [Option<Rgb>; 2]>, colors: Colors, out: &mut String) {
    /// What the terminal draws with: ink and paper.
    #[derive(Clone, Copy, PartialEq, Eq, Default)]
    struct Pen(Option<Rgb>, Option<Rgb>);
    let mut pen = Pen::default();
    for half in halves {
        let (character, wanted) = match half {
            [None, None] => (' ', Pen(pen.0, None)),
            [Some(upper), None] => ('▀', Pen(Some(upper), None)),
            [None, Some(lower)] => ('▄', Pen(Some(lower), None)),
            [Some(upper), Some(lower)] if upper == lower => (' ', Pen(pen.0, Some(lower))),
            [Some(upper), Some(lower)] => ('▀', Pen(Some(upper), Some(lower))),
        };
        if let Some(ink) = wanted.0.filter(|_| wanted.0 != pen.0) {
            select(38, ink, colors, out);
        }
        if wanted.1 != pen.1 {
            match wanted.1 {
                Some(paper) => select(48, paper, colors, out),
                None => out.push_str("\x1b[49m"),
            }
        }
        pen = wanted;
        out.push(character);
    }
    out.push_str("\x1b[0m");
}

/// Selects a colour of ink (38) or paper (48): SGR of ECMA-48, as xterm extends it.
fn select(what: u8, [r, g, b]: Rgb, colors: Colors, out: &mut String) {
    // Writing to a string does not fail.
    let _ = match colors {
        Colors::True => write!(out, "\x1b[{what};2;{r};{g};{b}m"),
        _ => write!(out, "\x1b[{what};5;{}m", indexed([r, g, b])),
    };
}

/// The nearest of xterm's colours 16 to 255: a cube of six levels a channel, and 24 greys.
fn indexed(color: Rgb) -> u8 {
    const LEVELS: [u8; 6] = [0, 95, 135, 175, 215, 255];
    let distance = |other: Rgb| -> u32 {
        let differences = color.iter().zip(other);
        differences
            .map(|(a, b)| u32::from(a.abs_diff(b)).pow(2))
            .sum()
    };
    let level = |code: u8| {
        let nearest = (0_u8..6)
            .zip(LEVELS)
            .min_by_key(|(_, level)| code.abs_diff(*level));
        nearest.unwrap_or((0, 0))
    };
    let [(r, red), (g, green), (b, blue)] = color.map(level);
    let grey = (0_u8..24).min_by_key(|step| distance([8 + 10 * step; 3]));
    let grey = grey.unwrap_or(0);
    if distance([8 + 10 * grey; 3]) < distance([red, green, blue]) {
        232 + grey
    } else {
        16 + 36 * r + 6 * g + b
    }
}

/// The character of two pixels, darker for darker ones.
fn ink(halves: [Option<Rgb>; 2]) -> char {
    let darkness = halves.map(|half| {
        half.map_or(0, |[r, g, b]| {
            // Luma of BT.709.
            let luma = 2126 * u32::from(r) + 7152 * u32::from(g) + 722 * u32::from(b);
            2_550_000 - luma
        })
    });
    let steps = u32::try_from(INKS.len()).unwrap_or(1);
    let step = (darkness[0] + darkness[1]) / 2 * steps / 2_550_001;
    char::from(INKS.get(step as usize).copied().unwrap_or(b'@'))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::preview::terminal::Kind;

    fn terminal(colors: Colors) -> Terminal {
        Terminal {
            kind: Kind::Blocks,
            colors,
            columns: 80,
            rows: 22,
        }
    }

    #[test]
    fn a_character_shows_two_pixels() {
        let mut image = Image::filled(3, 3, [255, 0, 0, 255]);
        image.rgba[4..8].copy_from_slice(&[0, 0, 255, 255]);
        image.rgba[8..12].fill(0);
        assert_eq!(
            text(&image, &terminal(Colors::True)),
            "\x1b[48;2;255;0;0m \x1b[38;2;0;0;255m▀\x1b[38;2;255;0;0m\x1b[49m▄\x1b[0m\n\
             \x1b[38;2;255;0;0m▀▀▀\x1b[0m\n"
        );
        assert_eq!(
            text(&image, &terminal(Colors::Indexed)),
            "\x1b[48;5;196m \x1b[38;5;21m▀\x1b[38;5;196m\x1b[49m▄\x1b[0m\n\
             \x1b[38;5;196m▀▀▀\x1b[0m\n"
        );
    }

    #[test]
    fn without_colours_characters_are_dark_and_light() {
        let mut image = Image::filled(4, 2, [255; 4]);
        for (at, code) in [(0, 0), (1, 120), (2, 200)] {
            for row in 0..2 {
                let first = (row * 4 + at) * 4;
                image.rgba[first..first + 3].fill(code);
            }
        }
        assert_eq!(text(&image, &terminal(Colors::None)), "@+:\n");
    }

    #[test]
    fn the_256_colours_are_the_nearest_ones() {
        assert_eq!(indexed([0, 0, 0]), 16);
        assert_eq!(indexed([255, 255, 255]), 231);
        assert_eq!(indexed([95, 135, 175]), 16 + 36 + 12 + 3);
        assert_eq!(indexed([128, 128, 128]), 244);
        assert_eq!(indexed([3, 250, 5]), 46);
    }
}
