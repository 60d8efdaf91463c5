#![forbid(unsafe_code)]
//! Visibility: which surface hides which, and how finely depth tells them apart.
//!
//! | module | contents |
//! |---|---|
//! | [`precision`] | the least separation of surfaces that a depth buffer tells apart (row D2) |
//! | [`plot`] | curves over logarithmic axes, as SVG or drawn by the pipeline's lines |
//!
//! Distances are along the view axis, positive in front of the eye, in the units of the scene.

pub mod plot;
pub mod precision;

/// The README's snippet, compiled and run as a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
