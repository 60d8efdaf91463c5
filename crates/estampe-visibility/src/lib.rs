#![forbid(unsafe_code)]
//! Visibility: which surface hides which, and how finely depth tells them apart.
//!
//! | module | contents |
//! |---|---|
//! | [`polygon`], [`eye`] | convex polygons with attributes, and where they are seen from |
//! | [`painter`] | the painter's algorithm: sorted polygons, and orders by pairs (row D3) |
//! | [`bsp`] | BSP trees: cut polygons in exact order for any eye (row D4) |
//! | [`picture`] | polygons drawn in order, or by depth buffer, which is also shown from above (row D5) |
//! | [`precision`] | the least separation of surfaces that a depth buffer tells apart (row D2) |
//! | [`plot`] | curves over logarithmic axes, as SVG or drawn by the pipeline's lines |
//! | [`transparency`] | sorted, exact per pixel by depth peeling, weighted (row D6) |
//! | [`z_fighting`] | two planes that fight, and the near plane at which they begin to (row D2) |
//!
//! Distances are along the view axis, positive in front of the eye, in the units of the scene.

pub mod bsp;
mod error;
mod exact;
pub mod eye;
pub mod painter;
pub mod picture;
pub mod plot;
pub mod polygon;
pub mod precision;
#[cfg(test)]
mod random_scene;
pub mod transparency;
pub mod z_fighting;

/// The README's snippet, compiled and run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

pub use error::DrawError;
