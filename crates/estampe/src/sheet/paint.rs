//! The sheet as an image: pictures, labels and problems.

use super::layout::Layout;
use super::wrap::{shortened, wrapped};
use estampe_renderer::{TextHeight, TextStyle, character_width_px, draw_text, text_width_px};
use estampe_scene::Image;

type Rgb = [u8; 3];

const DARK: Rgb = [0x1e, 0x24, 0x30];
const LIGHT: Rgb = [0xe4, 0xe8, 0xee];

/// Space around the text of a problem, in pixels.
const PADDING: u32 = 6;

/// A sheet that is painted.
pub(super) struct Sheet {
    pub(super) image: Image,
    layout: Layout,
    colors: Colors,
}

/// The colours of texts and of cells with a problem.
#[derive(Debug, Clone, Copy)]
struct Colors {
    label: Rgb,
    outline: Option<Rgb>,
    problem: Rgb,
    problem_cell: Rgb,
}

impl Colors {
    /// Those that are legible on a background, or on any if it is transparent.
    fn on([r, g, b, alpha]: [u8; 4]) -> Self {
        // Luma of BT.709, of the codes.
        let luma = 2126 * u32::from(r) + 7152 * u32::from(g) + 722 * u32::from(b);
        let is_dark = alpha == 255 && luma < 128 * 10_000;
        let outline = (alpha < 255).then_some([0xff; 3]);
        if is_dark {
            Self {
                label: LIGHT,
                outline,
                problem: [0xff, 0xb8, 0xb0],
                problem_cell: [0x48, 0x20, 0x20],
            }
        } else {
            Self {
                label: DARK,
                outline,
                problem: [0x8c, 0x1c, 0x14],
                problem_cell: [0xf8, 0xdc, 0xd8],
            }
        }
    }
}

impl Sheet {
    /// A sheet without pictures, of one colour.
    pub(super) fn new(layout: Layout, background: [u8; 4]) -> Self {
        let [width, height] = layout.size();
        Self {
            image: Image::filled(width, height, background),
            layout,
            colors: Colors::on(background),
        }
    }

    /// Copies a picture into its cell.
    pub(super) fn paste(&mut self, cell: usize, picture: &Image) {
        let [left, top] = self.layout.corner(cell);
        let row_bytes = picture.width as usize * 4;
        for (y, row) in (top as usize..).zip(picture.rgba.chunks_exact(row_bytes)) {
            let at = (y * self.image.width as usize + left as usize) * 4;
            self.image.rgba[at..at + row_bytes].copy_from_slice(row);
        }
    }

    /// Writes a problem into a cell, in place of a picture.
    pub(super) fn write_problem(&mut self, cell: usize, problem: &str) {
        let [width, height] = self.layout.picture;
        let [r, g, b] = self.colors.problem_cell;
        let mut picture = Image::filled(width, height, [r, g, b, 255]);
        let line_height = TextHeight::Px16;
        let style = TextStyle {
            height: line_height,
            color: self.colors.problem,
            outline: None,
        };
        let inside = |side: u32| side.saturating_sub(2 * PADDING);
        let most = inside(width) / character_width_px(line_height);
        let lines = inside(height) / line_height.px();
        let text = wrapped(problem, most as usize, lines as usize);
        for (number, line) in (0..).zip(&text) {
            let top = i64::from(PADDING) + number * i64::from(line_height.px());
            draw_text(&mut picture, (i64::from(PADDING), top), line, style);
        }
        self.paste(cell, &picture);
    }

    /// Writes a label below a cell, in its middle.
    pub(super) fn write_label(&mut self, cell: usize, label: &str, height: TextHeight) {
        let [left, top] = self.layout.corner(cell);
        let [width, picture_height] = self.layout.picture;
        let most = width / character_width_px(height);
        let text = shortened(label, most as usize);
        let free = width.saturating_sub(text_width_px(&text, height));
        let strip = self.layout.label_height.saturating_sub(height.px());
        let at = (
            i64::from(left + free / 2),
            i64::from(top + picture_height + strip / 2),
        );
        let style = TextStyle {
            height,
            color: self.colors.label,
            outline: self.colors.outline,
        };
        draw_text(&mut self.image, at, &text, style);
    }
}
