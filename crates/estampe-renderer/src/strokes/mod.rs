//! Strokes over or under surfaces: lines of a width in pixels that the model hides.
//!
//! ```text
//!   Stroke, in unit space ── window: projected and clipped ── ribbon: six vertices in the window
//!                                                              └── draw: buffers and a pipeline
//! ```
//!
//! A stroke lies on faces of the model, or on the ground, and must neither sink into them nor show
//! through them. Across the line its depth is that of the faces on both sides, see [`ribbon`];
//! along the line depth is linear in the window.
//!
//! *Precision* 64 bits up to the vertices, which are rounded to `f32` once.

mod draw;
mod ribbon;
mod window;

#[cfg(test)]
mod tests;

pub(crate) use draw::StrokeDraws;
pub(crate) use window::{Window, WindowPoint};

use glam::DVec3;

/// A straight line with a width.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Stroke {
    /// The ends, in unit space.
    pub(crate) ends: [DVec3; 2],
    /// For each of up to two faces that the line is an edge of, a third point of it, in unit space.
    pub(crate) faces: [Option<DVec3>; 2],
    /// Opacity at the ends.
    pub(crate) alphas: [f32; 2],
}

/// The style that strokes share.
#[derive(Debug, Clone, Copy)]
pub(crate) struct StrokeStyle {
    /// Linear.
    pub(crate) color: [f32; 3],
    pub(crate) width_px: f32,
    /// True if the strokes are edges of surfaces, and lie a little before them.
    pub(crate) is_on_surfaces: bool,
}
