//! Sheets: a title, panels beside each other with captions, and a legend below.

use super::heat::{NOTHING, Rgb, share};
use crate::failure::Failure;
use estampe::Device;
use estampe_scene::Image;
use estampe_visibility::plot::{Anchor, Drawing, Stroke, Text};

/// The greatest number of strokes that are drawn at once.
const STROKES: usize = 50_000;

/// The least width of a panel of pixels; smaller pictures are enlarged by a whole number.
const LEAST_WIDTH: u32 = 200;
/// The greatest height to which they are.
const GREATEST_ENLARGED: u32 = 1024;

const INK: Rgb = [30, 36, 48];
const GREY: Rgb = [110, 118, 130];
const MARGIN: u32 = 10;
/// The height of a line of the title, of a caption and of the legend, with the space around them.
const LINE: u32 = 15;
const CAPTION: u32 = 18;
const LEGEND: u32 = 30;

/// A picture in a sheet.
pub(super) struct Panel {
    pub(super) caption: String,
    pub(super) image: Image,
}

/// The meaning of the colours.
pub(super) enum Legend {
    /// Colours with names.
    Names(Vec<(Rgb, &'static str)>),
    /// Counts from 0 to the greatest one.
    Counts(u32, &'static str),
    /// Greys from black to white: the names of both ends.
    Greys(String, String, Vec<(Rgb, &'static str)>),
}

/// Panels with a title and a legend.
pub(super) struct Sheet {
    pub(super) title: String,
    pub(super) columns: u32,
    pub(super) panels: Vec<Panel>,
    pub(super) legend: Legend,
}

impl Panel {
    /// A panel of one colour.
    pub(super) fn blank(caption: String, [width, height]: [u32; 2], color: Rgb) -> Self {
        let [r, g, b] = color;
        let rgba = [r, g, b, 255].repeat(width as usize * height as usize);
        let image = Image {
            width,
            height,
            rgba,
        };
        Self { caption, image }
    }

    /// A panel with a colour for each pixel of a picture, enlarged if it is small.
    pub(super) fn of_pixels(
        caption: String,
        size: [u32; 2],
        color: impl Fn([u32; 2]) -> Rgb,
    ) -> Self {
        let zoom = zoom(size);
        let mut panel = Self::blank(caption, size.map(|side| side * zoom), NOTHING);
        let [width, height] = size;
        for y in 0..height {
            for x in 0..width {
                panel.fill([x * zoom, y * zoom], [zoom; 2], color([x, y]));
            }
        }
        panel
    }

    /// Fills a rectangle; what lies outside is left out.
    pub(super) fn fill(&mut self, [x, y]: [u32; 2], [width, height]: [u32; 2], [r, g, b]: Rgb) {
        let image = &mut self.image;
        let right = x.saturating_add(width).min(image.width);
        for row in y..y.saturating_add(height).min(image.height) {
            let at = |column: u32| (row as usize * image.width as usize + column as usize) * 4;
            if x < right {
                for pixel in image.rgba[at(x)..at(right)].as_chunks_mut().0 {
                    *pixel = [r, g, b, 255];
                }
            }
        }
    }

    /// Fills a square around a point, which may lie outside.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "inside the panel"
    )]
    pub(super) fn dot(&mut self, at: [f32; 2], side: u32, color: Rgb) {
        let corner = at.map(|along| along - side as f32 * 0.5 + 0.5);
        let sides = [self.image.width, self.image.height];
        let is_inside = |axis: usize| 0.0 <= corner[axis] && corner[axis] < sides[axis] as f32;
        if is_inside(0) && is_inside(1) {
            self.fill(corner.map(|along| along as u32), [side; 2], color);
        }
    }

    /// Draws strokes, some at a time, so that they need little memory.
    pub(super) fn draw(
        &mut self,
        device: &Device,
        strokes: impl Iterator<Item = Stroke>,
    ) -> Result<(), Failure> {
        // Far ends would lose the precision of those that are seen, and lines that miss the panel
        // take time.
        let sides = [self.image.width as f32, self.image.height as f32];
        let touches = |stroke: &Stroke| {
            let axis = |axis: usize| {
                let along = || stroke.points.iter().map(move |point| point[axis]);
                along().any(|at| at >= 0.0) && along().any(|at| at <= sides[axis])
            };
            stroke.points.iter().flatten().all(|at| at.abs() < 1e6) && axis(0) && axis(1)
        };
        let mut strokes = strokes.filter(touches).peekable();
        while strokes.peek().is_some() {
            let drawing = Drawing {
                size: [self.image.width, self.image.height],
                strokes: strokes.by_ref().take(STROKES).collect(),
                texts: Vec::new(),
            };
            self.image = over(&drawing, device, &self.image)?;
        }
        Ok(())
    }

    /// Draws texts.
    pub(super) fn write(&mut self, device: &Device, texts: Vec<Text>) -> Result<(), Failure> {
        let drawing = Drawing {
            size: [self.image.width, self.image.height],
            strokes: Vec::new(),
            texts,
        };
        self.image = over(&drawing, device, &self.image)?;
        Ok(())
    }

    fn caption(&self) -> Text {
        Text {
            at: [0.0; 2],
            anchor: Anchor::Start,
            height: 6.5,
            color: GREY,
            text: self.caption.clone(),
        }
    }

    /// Copies another image to a place.
    fn paste(&mut self, [left, top]: [u32; 2], other: &Image) {
        let row_bytes = other.width as usize * 4;
        for (y, row) in (top as usize..).zip(other.rgba.chunks_exact(row_bytes)) {
            let at = (y * self.image.width as usize + left as usize) * 4;
            self.image.rgba[at..at + row_bytes].copy_from_slice(row);
        }
    }
}

/// The whole number by which a panel of pixels is enlarged.
pub(super) fn zoom([width, height]: [u32; 2]) -> u32 {
    let that_fits = (GREATEST_ENLARGED / height.max(1)).max(1);
    LEAST_WIDTH.div_ceil(width.max(1)).min(that_fits)
}

/// A place in a panel, in f32 as strokes have it.
#[expect(clippy::cast_possible_truncation, reason = "rounding is meant")]
pub(super) fn place(at: [f64; 2]) -> [f32; 2] {
    at.map(|along| along as f32)
}

/// A line through two points.
pub(super) fn line(points: [[f32; 2]; 2], color: Rgb, width: f32) -> Stroke {
    Stroke {
        points: points.to_vec(),
        color,
        width,
    }
}

fn over(drawing: &Drawing, device: &Device, below: &Image) -> Result<Image, Failure> {
    let drawn = drawing.over(device, below);
    drawn.map_err(|error| Failure::Output(format!("{error}; try a smaller --size")))
}

impl Sheet {
    /// The stage, and its totals in as many lines as the width needs.
    fn title(&self, width: u32) -> Vec<Text> {
        let line = |number: usize, text: &str| Text {
            at: [MARGIN as f32, 17.0 + number as f32 * LINE as f32],
            anchor: Anchor::Start,
            height: 8.0,
            color: INK,
            text: text.to_owned(),
        };
        let mut lines: Vec<Text> = Vec::new();
        for part in self.title.split_inclusive(", ") {
            let longer = lines.last().map(|last| format!("{}{part}", last.text));
            match (longer, lines.last_mut()) {
                (Some(longer), Some(last))
                    if line(0, longer.trim_end()).width() <= width as f32 =>
                {
                    last.text = longer;
                }
                _ => lines.push(line(lines.len(), part)),
            }
        }
        lines
    }

    /// The whole sheet as an image.
    pub(super) fn draw(&self, device: &Device) -> Result<Image, Failure> {
        let (mut writing, legend_width) = self.legend.boxes_and_texts();
        let columns = self.columns.max(1);
        let sides = |side: fn(&Panel) -> u32| self.panels.iter().map(side).max().unwrap_or(1);
        let cell = [
            sides(|panel| panel.image.width.max(whole(panel.caption().width()))) + MARGIN,
            sides(|panel| panel.image.height) + CAPTION,
        ];
        let rows = u32::try_from(self.panels.len())
            .unwrap_or(1)
            .div_ceil(columns);
        let width = (columns * cell[0] + MARGIN).max(whole(legend_width) + 2 * MARGIN);
        let title = self.title(width - 2 * MARGIN);
        let title_height = LINE * u32::try_from(title.len()).unwrap_or(1) + 10;
        writing.texts.extend(title);
        let legend_top = title_height + rows * cell[1];
        let height = legend_top + LEGEND;
        let mut sheet = Panel::blank(String::new(), [width, height], [255; 3]);

        for (number, panel) in (0u32..).zip(&self.panels) {
            let left = MARGIN + number % columns * cell[0];
            let top = title_height + number / columns * cell[1];
            sheet.paste([left, top + CAPTION - 6], &panel.image);
            let caption = panel.caption();
            writing.texts.push(Text {
                at: [left as f32, top as f32 + 7.0],
                ..caption
            });
        }
        let moved = |[x, y]: [f32; 2]| [x + MARGIN as f32, y + legend_top as f32 + 4.0];
        for (at, size, color) in &writing.boxes {
            let at = moved(*at).map(whole);
            sheet.fill(at, *size, *color);
        }
        let (texts, count) = (writing.texts, writing.legend_texts);
        let texts = texts.into_iter().enumerate().map(|(number, text)| Text {
            at: if number < count {
                moved(text.at)
            } else {
                text.at
            },
            ..text
        });
        sheet.write(device, texts.collect())?;
        Ok(sheet.image)
    }
}

/// The boxes and texts of a legend, and then the other texts of a sheet.
struct Writing {
    boxes: Vec<([f32; 2], [u32; 2], Rgb)>,
    texts: Vec<Text>,
    legend_texts: usize,
}

impl Legend {
    /// What is drawn, from the legend's corner on, and its width.
    fn boxes_and_texts(&self) -> (Writing, f32) {
        let mut writing = Writing {
            boxes: Vec::new(),
            texts: Vec::new(),
            legend_texts: 0,
        };
        let mut x = 0.0;
        match self {
            Self::Names(names) => x = writing.names(x, names),
            Self::Counts(greatest, of) => {
                x = writing.names(x, &[(NOTHING, "0")]);
                x = writing.text(x, "1") + 5.0;
                x = writing.bar(x, &share);
                x = writing.text(x + 5.0, &format!("{greatest} {of}"));
            }
            Self::Greys(black, white, names) => {
                x = writing.text(x, black) + 5.0;
                x = writing.bar(x, &|share| super::heat::mix([0; 3], [255; 3], share));
                x = writing.text(x + 5.0, white) + 14.0;
                x = writing.names(x, names);
            }
        }
        writing.legend_texts = writing.texts.len();
        (writing, x)
    }
}

impl Writing {
    /// Adds a text, and returns its right end.
    fn text(&mut self, x: f32, text: &str) -> f32 {
        let text = Text {
            at: [x, 12.0],
            anchor: Anchor::Start,
            height: 6.5,
            color: INK,
            text: text.to_owned(),
        };
        let end = x + text.width();
        self.texts.push(text);
        end
    }

    /// Adds colours with names.
    fn names(&mut self, mut x: f32, names: &[(Rgb, &'static str)]) -> f32 {
        for (color, name) in names {
            self.boxes.push(([x, 3.0], [12, 12], [150, 156, 166]));
            self.boxes.push(([x + 1.0, 4.0], [10, 10], *color));
            x = self.text(x + 17.0, name) + 14.0;
        }
        x
    }

    /// Adds a scale of colours from 0 to 1.
    fn bar(&mut self, x: f32, color: &dyn Fn(f64) -> Rgb) -> f32 {
        const LENGTH: u16 = 120;
        self.boxes
            .push(([x, 3.0], [u32::from(LENGTH) + 2, 12], [150, 156, 166]));
        for step in 0..LENGTH {
            let share = f64::from(step) / f64::from(LENGTH - 1);
            self.boxes
                .push(([x + 1.0 + f32::from(step), 4.0], [1, 10], color(share)));
        }
        x + f32::from(LENGTH) + 2.0
    }
}

/// A length in pixels, rounded up.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "lengths on the sheet"
)]
fn whole(length: f32) -> u32 {
    length.ceil() as u32
}
