//! Drawings: strokes and texts, in pixels from the top left corner.

use super::glyphs;

/// A drawing on white.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Drawing {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The strokes, from the lowest on.
    pub strokes: Vec<Stroke>,
    /// The texts, above the strokes.
    pub texts: Vec<Text>,
}

/// A line through points.
#[derive(Debug, Clone, PartialEq)]
pub struct Stroke {
    /// The points in pixels.
    pub points: Vec<[f32; 2]>,
    /// The colour, 0 to 255 as the file stores it.
    pub color: [u8; 3],
    /// The width in pixels.
    pub width: f32,
}

/// Which part of a text is at its position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Anchor {
    /// The text starts there.
    Start,
    /// The middle of the text is there.
    Middle,
    /// The text ends there.
    End,
}

/// One line of text.
#[derive(Debug, Clone, PartialEq)]
pub struct Text {
    /// The position on the baseline, in pixels.
    pub at: [f32; 2],
    /// The anchor of the position.
    pub anchor: Anchor,
    /// Height of digits in pixels.
    pub height: f32,
    /// The colour, 0 to 255 as the file stores it.
    pub color: [u8; 3],
    /// The text. Images show letters without case, digits and a few signs, and a box for others.
    pub text: String,
}

impl Text {
    /// The width in pixels, as images show it.
    #[must_use]
    pub fn width(&self) -> f32 {
        glyphs::width(&self.text) * (self.height / glyphs::HEIGHT)
    }

    /// The strokes of the letters.
    #[must_use]
    pub fn strokes(&self) -> Vec<Stroke> {
        let scale = self.height / glyphs::HEIGHT;
        let width = self.width();
        let left = match self.anchor {
            Anchor::Start => self.at[0],
            Anchor::Middle => self.at[0] - width * 0.5,
            Anchor::End => self.at[0] - width,
        };
        glyphs::lines(&self.text)
            .into_iter()
            .map(|line| Stroke {
                points: line
                    .into_iter()
                    .map(|[x, y]| [left + x * scale, self.at[1] - y * scale])
                    .collect(),
                color: self.color,
                width: (self.height * 0.14).max(1.0),
            })
            .collect()
    }
}

/// Cuts a line into dashes of `on` pixels with gaps of `off` pixels.
pub(super) fn dashes(points: &[[f32; 2]], on: f32, off: f32) -> Vec<Vec<[f32; 2]>> {
    let mut dashes = Vec::new();
    let mut dash: Vec<[f32; 2]> = points.first().copied().into_iter().collect();
    let (mut is_on, mut left) = (true, on);
    for pair in points.windows(2) {
        let [mut from, to] = [pair[0], pair[1]];
        loop {
            let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
            let length = (dx * dx + dy * dy).sqrt();
            if length <= left || !length.is_finite() {
                left -= length;
                if is_on {
                    dash.push(to);
                }
                break;
            }
            let share = left / length;
            from = [from[0] + dx * share, from[1] + dy * share];
            if is_on {
                dash.push(from);
                dashes.push(std::mem::take(&mut dash));
            } else {
                dash = vec![from];
            }
            is_on = !is_on;
            left = if is_on { on } else { off };
        }
    }
    if dash.len() > 1 {
        dashes.push(dash);
    }
    dashes
}
