//! View directions by azimuth and elevation, and the named views.

use glam::DVec3;

/// The direction from the target to the eye.
///
/// ```text
///            up                    d = (sin a·cos e, sin e, cos a·cos e)
///            │   ·eye
///            │  ╱                  azimuth a:   0° in front (+z), 90° to the right (+x)
///            │ ╱ e                 elevation e: 0° level, 90° above
///            └────── right
///           ╱ ╲ a
///       front
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ViewDirection {
    /// Angle around the up axis, in degrees, counted from the front towards the right.
    pub azimuth_deg: f64,
    /// Angle above the horizontal plane, in degrees, in −90..=90.
    pub elevation_deg: f64,
}

impl ViewDirection {
    /// Isometric: from the right, in front and above.
    pub const ISO: Self = Self::new(45.0, 35.264);
    /// From +z.
    pub const FRONT: Self = Self::new(0.0, 0.0);
    /// From −z.
    pub const BACK: Self = Self::new(180.0, 0.0);
    /// From −x.
    pub const LEFT: Self = Self::new(-90.0, 0.0);
    /// From +x.
    pub const RIGHT: Self = Self::new(90.0, 0.0);
    /// From +y, with the front at the picture's bottom.
    pub const TOP: Self = Self::new(0.0, 90.0);
    /// From −y, with the front at the picture's top.
    pub const BOTTOM: Self = Self::new(0.0, -90.0);

    /// The direction of these angles, in degrees.
    #[must_use]
    pub const fn new(azimuth_deg: f64, elevation_deg: f64) -> Self {
        Self {
            azimuth_deg,
            elevation_deg,
        }
    }

    /// The camera's axes, for Y up: right, up and back (towards the eye).
    ///
    /// Up is ∂back/∂e, so it is defined for elevations of ±90° too.
    #[must_use]
    pub fn axes(self) -> [DVec3; 3] {
        let (sin_a, cos_a) = sin_cos_deg(self.azimuth_deg);
        let (sin_e, cos_e) = sin_cos_deg(self.elevation_deg);
        let right = DVec3::new(cos_a, 0.0, -sin_a);
        let up = DVec3::new(-sin_a * sin_e, cos_e, -cos_a * sin_e);
        let back = DVec3::new(sin_a * cos_e, sin_e, cos_a * cos_e);
        [right, up, back]
    }
}

impl Default for ViewDirection {
    /// Three quarters from the front, a little above: (30°, 20°).
    fn default() -> Self {
        Self::new(30.0, 20.0)
    }
}

/// Sine and cosine of an angle in degrees, exact at multiples of 90°.
fn sin_cos_deg(angle_deg: f64) -> (f64, f64) {
    let turned = libm::fmod(angle_deg, 360.0);
    let quarter = libm::round(turned / 90.0);
    let (s, c) = libm::sincos((turned - quarter * 90.0).to_radians());
    match libm::fmod(quarter + 8.0, 4.0) {
        1.0 => (c, -s),
        2.0 => (-s, -c),
        3.0 => (-c, s),
        _ => (s, c),
    }
}
