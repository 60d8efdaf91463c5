//! Pictures as sixels (DEC's *VT330/VT340 Programmer Reference Manual*, chapter 14): bands of six
//! rows, in each of which every colour has a line of characters, whose six bits are its pixels from
//! the top.
//!
//! The colours are those of a GIF, chosen for the picture and dithered; sixel has 100 steps a
//! channel.

use super::kitty::CHARACTER;
use super::scale::{fitted, reduced};
use super::terminal::Terminal;
use estampe_assets::image::gif::indexed;
use estampe_scene::Image;
use std::fmt::Write;

/// Rows of a band.
const BAND: usize = 6;

/// The bytes that show a picture.
pub(super) fn bytes(image: &Image, terminal: &Terminal) -> Vec<u8> {
    let [width, height] = CHARACTER;
    let most = [terminal.columns * width, terminal.rows * height];
    let size = fitted([image.width, image.height], most);
    let small = indexed(&reduced(image, size));
    // 0;1: pixels without a colour keep the background. 1;1: pixels are square.
    let mut out = format!("\x1bP0;1;0q\"1;1;{};{}", size[0], size[1]);
    for (number, color) in small.palette.iter().enumerate() {
        let [r, g, b] = color.map(|code| (u32::from(code) * 100 + 127) / 255);
        // Writing to a string does not fail.
        let _ = write!(out, "#{number};2;{r};{g};{b}");
    }
    let width = size[0] as usize;
    for band in small.indices.chunks(BAND * width) {
        write_band(band, width, small.palette.len(), &mut out);
    }
    out.push_str("\x1b\\\n");
    out.into_bytes()
}

/// Writes a band: a line for each colour that it has.
fn write_band(band: &[u8], width: usize, colors: usize, out: &mut String) {
    let mut is_used = [false; 256];
    for &index in band {
        is_used[usize::from(index)] = true;
    }
    let mut is_first = true;
    for (color, _) in { 0..=u8::MAX }
        .zip(is_used)
        .take(colors)
        .filter(|(_, used)| *used)
    {
        if !is_first {
            // Back to the left edge.
            out.push('$');
        }
        is_first = false;
        let _ = write!(out, "#{color}");
        let mut run: (char, usize) = ('?', 0);
        for x in 0..width {
            let rows = band.chunks(width).enumerate();
            let bits = rows.fold(0_u8, |bits, (y, row)| bits | u8::from(row[x] == color) << y);
            let sixel = char::from(b'?' + bits);
            if sixel == run.0 {
                run.1 += 1;
            } else {
                write_run(run, out);
                run = (sixel, 1);
            }
        }
        // What is empty up to the right edge needs no characters.
        if run.0 != '?' {
            write_run(run, out);
        }
    }
    out.push('-');
}

fn write_run((sixel, count): (char, usize), out: &mut String) {
    if count > 3 {
        let _ = write!(out, "!{count}{sixel}");
    } else {
        out.extend(std::iter::repeat_n(sixel, count));
    }
}
