//! Plots of curves over two logarithmic axes.
//!
//! ```text
//! Plot (curves, labels) -> Drawing (strokes and texts in pixels) -> SVG, or an image by the
//!                                                                   pipeline's smooth lines
//! ```
//!
//! A law y = c·xᵏ is a straight line of slope k. The image has no font: letters are strokes.

mod chart;
mod drawing;
mod glyphs;
mod raster;
mod svg;
#[cfg(test)]
mod tests;

pub use chart::{Curve, Plot};
pub use drawing::{Anchor, Drawing, Stroke, Text};
