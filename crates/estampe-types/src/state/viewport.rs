//! Where in the target is drawn.

/// Where NDC lands in the target: a rectangle in window space and a range of depths.
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
