//! Viewport and scissor rectangle.

/// Image of NDC in the target: a rectangle in window space and a range of depths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Viewport {
    /// Left edge, in pixels.
    pub x: f32,
    /// Top edge, in pixels.
    pub y: f32,
    /// Width in pixels, > 0.
    pub width: f32,
    /// Height in pixels, > 0.
    pub height: f32,
    /// Depth of NDC z = 0, in 0..=1.
    pub min_depth: f32,
    /// Depth of NDC z = 1, in 0..=1.
    pub max_depth: f32,
}

impl Viewport {
    /// The viewport of a draw that sets none: all of a target of this size, depths 0 to 1.
    #[must_use]
    pub const fn of_target(width: u32, height: u32) -> Self {
        Self {
            x: 0.0,
            y: 0.0,
            width: width as f32,
            height: height as f32,
            min_depth: 0.0,
            max_depth: 1.0,
        }
    }
}

/// A rectangle of pixels outside which nothing is drawn; half-open.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ScissorRect {
    /// Left column.
    pub x: u32,
    /// Top row.
    pub y: u32,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
}
