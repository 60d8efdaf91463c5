//! Plots as SVG (W3C, Scalable Vector Graphics 1.1). Both axes are logarithmic, so that growth in
//! proportion is a straight line of slope 1, whatever the cost of an element.

use std::fmt::Write as _;

/// A plot of curves with common axes.
#[derive(Debug, Clone)]
pub struct Plot {
    /// The title above the plot.
    pub title: String,
    /// The label of the x axis, with its unit.
    pub x_label: String,
    /// The label of the y axis, with its unit.
    pub y_label: String,
    /// The ticks of the x axis with their labels; the axis extends from the first to the last.
    pub x_ticks: Vec<(f64, String)>,
    /// The curves, in the order of the legend.
    pub curves: Vec<Curve>,
}

/// One curve.
#[derive(Debug, Clone)]
pub struct Curve {
    /// The name in the legend.
    pub name: String,
    /// The colour, in SVG's notation.
    pub color: &'static str,
    /// If set, the line is dashed.
    pub is_dashed: bool,
    /// The points (x, y); both coordinates are positive.
    pub points: Vec<[f64; 2]>,
}

const WIDTH: f64 = 800.0;
const HEIGHT: f64 = 520.0;
/// Margins around the axes: left, top, right, bottom.
const MARGINS: [f64; 4] = [78.0, 44.0, 24.0, 62.0];
/// Distance between two lines of the legend.
const LINE_HEIGHT: f64 = 20.0;
/// Factor between the lowest curve and the reference line of slope 1.
const BELOW: f64 = 0.35;

/// A logarithmic axis: powers of ten at both ends, and the length in the drawing.
#[derive(Debug, Clone, Copy)]
struct Axis {
    first_log: f64,
    last_log: f64,
    from: f64,
    to: f64,
}

impl Axis {
    fn at(&self, value: f64) -> f64 {
        let share = (libm::log10(value) - self.first_log) / (self.last_log - self.first_log);
        self.from + share * (self.to - self.from)
    }
}

impl Plot {
    /// The plot as SVG text; without ticks or points only the frame is drawn.
    #[must_use]
    pub fn to_svg(&self) -> String {
        let [left, top, right, bottom] = MARGINS;
        let logs = |values: &mut dyn Iterator<Item = f64>| {
            let logs = values.map(libm::log10);
            logs.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], log| {
                [least.min(log), most.max(log)]
            })
        };
        let [first_x, last_x] = logs(&mut self.x_ticks.iter().map(|tick| tick.0));
        let all = self.curves.iter().flat_map(|curve| &curve.points);
        let [first_y, last_y] = logs(&mut all.map(|point| point[1]));
        let mut out = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" \
             width=\"{WIDTH}\" height=\"{HEIGHT}\" font-family=\"sans-serif\" font-size=\"13\" \
             fill=\"#222\">\n<rect width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"white\"/>\n"
        );
        text(
            &mut out,
            [WIDTH * 0.5, 26.0],
            "text-anchor=\"middle\" font-size=\"16\"",
            &self.title,
        );
        if first_x < last_x && first_y <= last_y {
            let x = Axis {
                first_log: first_x,
                last_log: last_x,
                from: left,
                to: WIDTH - right,
            };
            let y = Axis {
                first_log: first_y.floor(),
                last_log: last_y.ceil().max(first_y.floor() + 1.0),
                from: HEIGHT - bottom,
                to: top,
            };
            self.axes(&mut out, &x, &y);
            self.reference(&mut out, &x, &y);
            for curve in &self.curves {
                curve.draw(&mut out, &x, &y);
            }
            self.legend(&mut out, [left + 14.0, top + 20.0]);
        }
        out.push_str("</svg>\n");
        out
    }

    fn axes(&self, out: &mut String, x: &Axis, y: &Axis) {
        for (value, label) in &self.x_ticks {
            let at = x.at(*value);
            line(out, [at, y.from, at, y.to], "stroke=\"#ddd\"");
            let place = [at, y.from + 20.0];
            text(out, place, "text-anchor=\"middle\"", label);
        }
        let mut log = y.first_log;
        while log <= y.last_log {
            let value = libm::exp10(log);
            let at = y.at(value);
            line(out, [x.from, at, x.to, at], "stroke=\"#ddd\"");
            let place = [x.from - 8.0, at + 4.5];
            text(out, place, "text-anchor=\"end\"", &decimal(value));
            log += 1.0;
        }
        line(out, [x.from, y.from, x.to, y.from], "stroke=\"#222\"");
        line(out, [x.from, y.from, x.from, y.to], "stroke=\"#222\"");
        let middle = [(x.from + x.to) * 0.5, HEIGHT - 14.0];
        text(out, middle, "text-anchor=\"middle\"", &self.x_label);
        let up = (y.from + y.to) * 0.5;
        let turned = format!("text-anchor=\"middle\" transform=\"rotate(-90 20 {up:.1})\"");
        text(out, [20.0, up], &turned, &self.y_label);
    }

    /// Draws a line of slope 1 below all curves: parallel curves grow in proportion.
    fn reference(&self, out: &mut String, x: &Axis, y: &Axis) {
        let points = self.curves.iter().flat_map(|curve| &curve.points);
        let lowest = points.map(|[x, y]| y / x).fold(f64::INFINITY, f64::min) * BELOW;
        let last_x = libm::exp10(x.last_log);
        let first_x = libm::exp10(x.first_log).max(libm::exp10(y.first_log) / lowest);
        if first_x >= last_x {
            return;
        }
        let [x0, y0, x1, y1] = [
            x.at(first_x),
            y.at(first_x * lowest),
            x.at(last_x),
            y.at(last_x * lowest),
        ];
        let style = "stroke=\"#888\" stroke-dasharray=\"2 4\"";
        line(out, [x0, y0, x1, y1], style);
        let place = [(x0 + x1) * 0.5 + 10.0, (y0 + y1) * 0.5 + 16.0];
        text(out, place, "fill=\"#666\"", "slope 1");
    }

    fn legend(&self, out: &mut String, [x, y]: [f64; 2]) {
        let height = LINE_HEIGHT * self.curves.len() as f64 + 10.0;
        let longest = self.curves.iter().map(|curve| curve.name.chars().count());
        let width = 50.0 + 7.2 * longest.max().unwrap_or_default() as f64;
        let _ = writeln!(
            out,
            "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" \
             fill=\"white\" fill-opacity=\"0.85\" stroke=\"#ddd\"/>",
            x - 8.0,
            y - 14.0,
        );
        let mut at = y;
        for curve in &self.curves {
            line(out, [x, at, x + 26.0, at], &curve.stroke());
            text(out, [x + 34.0, at + 4.5], "", &curve.name);
            at += LINE_HEIGHT;
        }
    }
}

impl Curve {
    fn draw(&self, out: &mut String, x: &Axis, y: &Axis) {
        let mut path = String::new();
        for &[px, py] in &self.points {
            let _ = write!(path, "{:.1},{:.1} ", x.at(px), y.at(py));
        }
        let stroke = self.stroke();
        let path = path.trim_end();
        let _ = writeln!(out, "<polyline points=\"{path}\" fill=\"none\" {stroke}/>");
        for &[px, py] in &self.points {
            let (cx, cy, color) = (x.at(px), y.at(py), self.color);
            let _ = writeln!(
                out,
                "<circle cx=\"{cx:.1}\" cy=\"{cy:.1}\" r=\"2.6\" fill=\"{color}\"/>"
            );
        }
    }

    fn stroke(&self) -> String {
        let dashes = if self.is_dashed {
            " stroke-dasharray=\"6 4\""
        } else {
            ""
        };
        format!("stroke=\"{}\" stroke-width=\"1.8\"{dashes}", self.color)
    }
}

fn line(out: &mut String, [x0, y0, x1, y1]: [f64; 4], style: &str) {
    let _ = writeln!(
        out,
        "<line x1=\"{x0:.1}\" y1=\"{y0:.1}\" x2=\"{x1:.1}\" y2=\"{y1:.1}\" {style}/>"
    );
}

fn text(out: &mut String, [x, y]: [f64; 2], style: &str, words: &str) {
    let words = words
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;");
    let _ = writeln!(
        out,
        "<text x=\"{x:.1}\" y=\"{y:.1}\" {style}>{words}</text>"
    );
}

/// A power of ten in decimal notation: 0.01, 1, 1000.
fn decimal(value: f64) -> String {
    let places = (-libm::log10(value)).max(0.0).round();
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a logarithm of binary64 is at most a few hundred"
    )]
    let places = places as usize;
    format!("{value:.places$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plot(points: Vec<[f64; 2]>) -> String {
        let tick = |value: f64| (value, format!("{value} px"));
        Plot {
            title: "A < B".to_owned(),
            x_label: "pixels".to_owned(),
            y_label: "frame, ms".to_owned(),
            x_ticks: vec![tick(100.0), tick(1000.0), tick(10_000.0)],
            curves: vec![Curve {
                name: "clear".to_owned(),
                color: "#123456",
                is_dashed: true,
                points,
            }],
        }
        .to_svg()
    }

    #[test]
    fn points_lie_where_their_logarithms_are() {
        let svg = plot(vec![[100.0, 0.01], [1000.0, 0.1], [10_000.0, 1.0]]);
        // From corner to corner, and the middle is in the middle.
        let [left, top, right, bottom] = MARGINS;
        let (low, high) = (HEIGHT - bottom, top);
        let points = format!(
            "points=\"{left:.1},{low:.1} {:.1},{:.1} {:.1},{high:.1}\"",
            (left + WIDTH - right) * 0.5,
            (low + high) * 0.5,
            WIDTH - right,
        );
        assert!(svg.contains(&points), "{points} in {svg}");
        assert_eq!(svg.matches("<circle").count(), 3);
    }

    #[test]
    fn axes_are_marked_and_named() {
        let svg = plot(vec![[100.0, 0.02], [10_000.0, 2.0]]);
        for words in [
            "100 px", "1000 px", ">0.01<", ">0.1<", ">10<", "pixels", "slope 1",
        ] {
            assert!(svg.contains(words), "{words}");
        }
        assert!(svg.contains("frame, ms") && svg.contains("clear") && svg.contains("A &lt; B"));
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
        // Every element is closed.
        assert_eq!(svg.matches("<text").count(), svg.matches("</text>").count());
        assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
    }

    #[test]
    fn without_points_there_is_a_frame() {
        let svg = plot(Vec::new());
        assert!(!svg.contains("<polyline") && svg.ends_with("</svg>\n"));
    }
}
