//! Transforms from NDC to the window as matrices. The pipeline has its own code; these
//! matrices document it.

use glam::{DMat4, DVec4};

/// A rectangle of the window and a range of depths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ViewportRectangle {
    /// Left edge, in pixels.
    pub x: f64,
    /// Top edge, in pixels.
    pub y: f64,
    /// Width in pixels.
    pub width: f64,
    /// Height in pixels.
    pub height: f64,
    /// Depth of NDC z = 0.
    pub depth_min: f64,
    /// Depth of NDC z = 1.
    pub depth_max: f64,
}

/// The pipeline's viewport: origin at the top left, y down, pixel centres at ½.
#[must_use]
pub fn window_from_ndc(v: &ViewportRectangle) -> DMat4 {
    let (sx, sy) = (v.width / 2.0, -v.height / 2.0);
    DMat4::from_cols(
        DVec4::new(sx, 0.0, 0.0, 0.0),
        DVec4::new(0.0, sy, 0.0, 0.0),
        DVec4::new(0.0, 0.0, v.depth_max - v.depth_min, 0.0),
        DVec4::new(v.x + sx, v.y - sy, v.depth_min, 1.0),
    )
}

/// The teaching form: y up and pixel centres at integers, so that NDC (−1, −1) is (−½, −½) and
/// NDC (1, 1) is (width − ½, height − ½); z is unchanged.
#[must_use]
pub fn window_from_ndc_teaching(width: f64, height: f64) -> DMat4 {
    DMat4::from_cols(
        DVec4::new(width / 2.0, 0.0, 0.0, 0.0),
        DVec4::new(0.0, height / 2.0, 0.0, 0.0),
        DVec4::Z,
        DVec4::new((width - 1.0) / 2.0, (height - 1.0) / 2.0, 0.0, 1.0),
    )
}

/// The teaching form that magnifies the image about its middle by `zoom` and maps z to 100 + 100·z,
/// which a grey value can show.
#[must_use]
pub fn window_from_ndc_zoomed(width: f64, height: f64, zoom: f64) -> DMat4 {
    DMat4::from_cols(
        DVec4::new(zoom * width / 2.0, 0.0, 0.0, 0.0),
        DVec4::new(0.0, zoom * height / 2.0, 0.0, 0.0),
        DVec4::new(0.0, 0.0, 100.0, 0.0),
        DVec4::new((width - 1.0) / 2.0, (height - 1.0) / 2.0, 100.0, 1.0),
    )
}
