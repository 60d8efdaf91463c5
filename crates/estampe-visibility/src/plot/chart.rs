//! Charts: axes, grid, curves and legend, laid out as a drawing.

use super::drawing::dashes;
use super::{Anchor, Drawing, Stroke, Text};

/// A plot of curves with common axes, both logarithmic.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Plot {
    /// Width and height in pixels, at least 200×150.
    pub size: [u32; 2],
    /// The title above the plot.
    pub title: String,
    /// The name of the x axis, below it.
    pub x_name: String,
    /// The name of the y axis, above it.
    pub y_name: String,
    /// The curves, from the lowest on; the legend lists those with a name.
    pub curves: Vec<Curve>,
}

/// One curve.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Curve {
    /// The name in the legend.
    pub name: String,
    /// The colour, 0 to 255 as the file stores it.
    pub color: [u8; 3],
    /// The width in pixels.
    pub width: f32,
    /// If set, the curve is dashed.
    pub is_dashed: bool,
    /// The points; the curve is interrupted where a coordinate is not positive and finite.
    pub points: Vec<[f64; 2]>,
}

const MARGINS: Margins = Margins {
    left: 62.0,
    top: 52.0,
    right: 16.0,
    bottom: 46.0,
};
/// Height of digits in pixels.
const TEXT: f32 = 9.0;
const INK: [u8; 3] = [30, 30, 30];
const GRID: [u8; 3] = [222, 222, 222];
/// The most lines of the grid along an axis.
const MOST_TICKS: i32 = 10;

struct Margins {
    left: f32,
    top: f32,
    right: f32,
    bottom: f32,
}

/// A logarithmic axis from one power of ten to another.
#[derive(Debug, Clone, Copy)]
struct Axis {
    /// The exponents at both ends.
    exponents: [i32; 2],
    /// The pixels at both ends.
    pixels: [f32; 2],
}

impl Axis {
    /// The axis of values; from 1 to 10 if none is positive and finite.
    fn new(values: impl Iterator<Item = f64>, pixels: [f32; 2]) -> Self {
        let logs = values.filter(|value| is_shown(*value)).map(libm::log10);
        let [least, most] = logs.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], log| {
            [least.min(log), most.max(log)]
        });
        #[expect(
            clippy::cast_possible_truncation,
            reason = "exponents of f64 are below 400"
        )]
        let exponents = if least <= most {
            [(least + 1e-6).floor() as i32, (most - 1e-6).ceil() as i32]
        } else {
            [0, 1]
        };
        let exponents = [exponents[0], exponents[1].max(exponents[0] + 1)];
        Self { exponents, pixels }
    }

    fn at(&self, value: f64) -> f32 {
        let [first, last] = self.exponents.map(f64::from);
        let share = (libm::log10(value) - first) / (last - first);
        #[expect(clippy::cast_possible_truncation, reason = "pixels")]
        let share = share as f32;
        self.pixels[0] + share * (self.pixels[1] - self.pixels[0])
    }

    /// The powers of ten that get a line of the grid.
    fn ticks(&self) -> impl Iterator<Item = i32> {
        let [first, last] = self.exponents;
        let step = (last - first).div_euclid(MOST_TICKS) + 1;
        (first..=last).filter(move |exponent| exponent.rem_euclid(step) == 0)
    }
}

fn is_shown(value: f64) -> bool {
    value > 0.0 && value.is_finite()
}

/// A power of ten as text.
fn power(exponent: i32) -> String {
    match exponent {
        -3..=0 => format!(
            "{:.*}",
            exponent.unsigned_abs() as usize,
            libm::exp10(f64::from(exponent))
        ),
        1..=4 => format!("{:.0}", libm::exp10(f64::from(exponent))),
        _ => format!("1e{exponent}"),
    }
}

impl Plot {
    /// Lays the plot out.
    #[must_use]
    pub fn drawing(&self) -> Drawing {
        let size = [self.size[0].max(200), self.size[1].max(150)];
        let [width, height] = size.map(|side| side as f32);
        let points = || self.curves.iter().flat_map(|curve| &curve.points);
        let shown = || points().filter(|point| point.iter().all(|value| is_shown(*value)));
        let axes = [
            Axis::new(
                shown().map(|point| point[0]),
                [MARGINS.left, width - MARGINS.right],
            ),
            Axis::new(
                shown().map(|point| point[1]),
                [height - MARGINS.bottom, MARGINS.top],
            ),
        ];
        let mut drawing = Drawing {
            size,
            ..Drawing::default()
        };
        self.frame(&mut drawing, axes);
        for curve in &self.curves {
            curve.draw(&mut drawing, axes);
        }
        self.legend(&mut drawing, axes);
        drawing
    }

    /// The grid and the names of the axes.
    fn frame(&self, drawing: &mut Drawing, [x, y]: [Axis; 2]) {
        let mut line = |points: [[f32; 2]; 2], color| {
            drawing.strokes.push(Stroke {
                points: points.to_vec(),
                color,
                width: 1.0,
            });
        };
        let ([left, right], [bottom, top]) = (x.pixels, y.pixels);
        // Lines through pixel centres are sharp.
        let sharp = |at: f32| at.floor() + 0.5;
        let mut texts = Vec::new();
        for exponent in x.ticks() {
            let at = sharp(x.at(libm::exp10(f64::from(exponent))));
            line([[at, bottom], [at, top]], GRID);
            texts.push(([at, bottom + 16.0], Anchor::Middle, power(exponent)));
        }
        for exponent in y.ticks() {
            let at = sharp(y.at(libm::exp10(f64::from(exponent))));
            line([[left, at], [right, at]], GRID);
            texts.push(([left - 7.0, at + TEXT * 0.5], Anchor::End, power(exponent)));
        }
        let [left, bottom] = [left, bottom].map(sharp);
        line([[left, bottom], [right, bottom]], INK);
        line([[left, bottom], [left, top]], INK);
        let middle = (left + right) * 0.5;
        texts.push(([middle, bottom + 35.0], Anchor::Middle, self.x_name.clone()));
        texts.push(([8.0, top - 12.0], Anchor::Start, self.y_name.clone()));
        texts.push(([middle, 19.0], Anchor::Middle, self.title.clone()));
        for (at, anchor, text) in texts {
            drawing.texts.push(Text {
                at,
                anchor,
                height: TEXT,
                color: INK,
                text,
            });
        }
    }

    /// The names of the curves, in the upper left corner.
    fn legend(&self, drawing: &mut Drawing, [x, y]: [Axis; 2]) {
        let left = x.pixels[0] + 12.0;
        let mut top = y.pixels[1] + 14.0;
        for curve in self.curves.iter().filter(|curve| !curve.name.is_empty()) {
            let middle = top - TEXT * 0.5;
            curve.stroke(drawing, &[[left, middle], [left + 26.0, middle]]);
            drawing.texts.push(Text {
                at: [left + 34.0, top],
                anchor: Anchor::Start,
                height: TEXT,
                color: INK,
                text: curve.name.clone(),
            });
            top += 17.0;
        }
    }
}

impl Curve {
    fn draw(&self, drawing: &mut Drawing, [x, y]: [Axis; 2]) {
        let is_gap = |point: &[f64; 2]| !point.iter().all(|value| is_shown(*value));
        for part in self.points.split(is_gap).filter(|part| part.len() > 1) {
            let points: Vec<[f32; 2]> = part
                .iter()
                .map(|point| [x.at(point[0]), y.at(point[1])])
                .collect();
            self.stroke(drawing, &points);
        }
    }

    fn stroke(&self, drawing: &mut Drawing, points: &[[f32; 2]]) {
        let lines = if self.is_dashed {
            dashes(points, 6.0, 4.0)
        } else {
            vec![points.to_vec()]
        };
        drawing
            .strokes
            .extend(lines.into_iter().map(|points| Stroke {
                points,
                color: self.color,
                width: self.width,
            }));
    }
}
