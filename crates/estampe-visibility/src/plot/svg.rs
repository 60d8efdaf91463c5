//! Drawings as SVG (W3C, Scalable Vector Graphics 1.1).

use super::{Anchor, Drawing};
use std::fmt::Write as _;

/// The reason why no write below fails.
const TO_STRING: &str = "a string takes all text";

impl Drawing {
    /// The drawing as the text of an SVG file.
    #[must_use]
    pub fn to_svg(&self) -> String {
        let [width, height] = self.size;
        let mut out = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
             width=\"{width}\" height=\"{height}\" font-family=\"sans-serif\" fill=\"none\">\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>\n"
        );
        for stroke in &self.strokes {
            let color = hex(stroke.color);
            write!(
                out,
                "<polyline stroke=\"{color}\" stroke-width=\"{}\" points=\"",
                stroke.width
            )
            .expect(TO_STRING);
            for (number, [x, y]) in stroke.points.iter().enumerate() {
                let space = if number > 0 { " " } else { "" };
                write!(out, "{space}{x:.1},{y:.1}").expect(TO_STRING);
            }
            out.push_str("\"/>\n");
        }
        for text in &self.texts {
            let anchor = match text.anchor {
                Anchor::Start => "start",
                Anchor::Middle => "middle",
                Anchor::End => "end",
            };
            let [x, y] = text.at;
            // Digits are about 0.72 of a font's size high.
            let size = text.height / 0.72;
            let color = hex(text.color);
            let escaped = escape(&text.text);
            writeln!(
                out,
                "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{size:.1}\" fill=\"{color}\" \
                 text-anchor=\"{anchor}\">{escaped}</text>"
            )
            .expect(TO_STRING);
        }
        out.push_str("</svg>\n");
        out
    }
}

fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}
