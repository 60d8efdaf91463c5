//! The ribbon of a stroke: six vertices in the window, with depths that neither sink into the faces
//! on both sides of the line nor show through what is before them.
//!
//! ```text
//!    1 ───────────────── 4      half of the width, and a pixel for the smooth border
//!    │         side 0    │
//!    0 ═══════════════ 3        the line
//!    │         side 1    │
//!    2 ───────────────── 5
//! ```
//!
//! On each side the depth is linear: that of the nearer of the line itself and the face. A face
//! that recedes from the line (at a ridge) is behind the line's own depth, so this hides nothing of
//! it; one that comes nearer (in a groove) has the depth of the ribbon. Beyond its third corner a
//! face is followed no further. What lies before the line by more than the face's own depth hides
//! it.
//!
//! The bias is what the pipeline may differ by: it rounds vertices to 1/256 pixel, so depths by up
//! to √½/256 of the depth's gradient, and interpolates depths in `f32`.

use super::Stroke;
use super::window::{Window, WindowPoint};
use glam::DVec2;

/// The vertices of a ribbon.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ribbon {
    pub(super) points: [WindowPoint; 6],
    /// Way past the first end, way left to the second, and way across, in pixels.
    pub(super) places: [[f64; 3]; 6],
    /// Shares of the way from the stroke's first to its second end.
    pub(super) shares: [f64; 2],
    /// Length of the visible part, in pixels.
    pub(super) length_px: f64,
}

/// The rounding of depths, as a share of the range: 8 steps of `f32` near 1.
const DEPTH_STEPS: f64 = 8.0 / 16_777_216.0;
/// The rounding of positions, in pixels, of the surface and of the ribbon, twice for both axes.
const POSITION_STEPS_PX: f64 = 4.0 / 256.0;

impl Ribbon {
    /// The ribbon of a stroke, if it is visible.
    pub(super) fn new(
        stroke: &Stroke,
        window: &Window,
        half_width_px: f64,
        is_on_surfaces: bool,
    ) -> Option<Self> {
        let [(a, first), (b, last)] = window.line(stroke.ends)?;
        let way = b.at_px - a.at_px;
        let length = way.length();
        let along = way.try_normalize().unwrap_or(DVec2::X);
        let across = DVec2::new(-along.y, along.x);
        let reach = half_width_px + 1.0;
        let slope = if length >= 1.0 {
            (b.depth - a.depth) / length
        } else {
            0.0
        };
        let line = Line {
            from: a,
            along,
            across,
            slope,
        };

        let mut nearer = [0.0_f64; 2];
        let mut bias = 0.0;
        if is_on_surfaces {
            bias = DEPTH_STEPS;
        }
        for third in stroke.faces.into_iter().flatten() {
            let Some(face) = window
                .point(third)
                .and_then(|third| line.face(third, reach))
            else {
                continue;
            };
            let side = &mut nearer[usize::from(face.is_on_second_side)];
            *side = side.min(face.depth_at_reach);
            if is_on_surfaces {
                let steepest = face.slope.abs().max(slope.abs());
                bias = bias.max(DEPTH_STEPS + (steepest * POSITION_STEPS_PX).min(face.range));
            }
        }
        let corner = |x: f64, z: f64, nearer: f64| WindowPoint {
            at_px: a.at_px + along * x + across * z,
            depth: a.depth + slope * x + nearer - bias,
        };
        let (start, end) = (-reach, length + reach);
        Some(Self {
            points: [
                corner(start, 0.0, 0.0),
                corner(start, reach, nearer[0]),
                corner(start, -reach, nearer[1]),
                corner(end, 0.0, 0.0),
                corner(end, reach, nearer[0]),
                corner(end, -reach, nearer[1]),
            ],
            places: [
                [start, length - start, 0.0],
                [start, length - start, reach],
                [start, length - start, -reach],
                [end, length - end, 0.0],
                [end, length - end, reach],
                [end, length - end, -reach],
            ],
            shares: [first, last],
            length_px: length,
        })
    }
}

/// The line of a ribbon in the window.
struct Line {
    from: WindowPoint,
    along: DVec2,
    across: DVec2,
    /// Depth per pixel along.
    slope: f64,
}

/// A face beside a line.
struct Face {
    is_on_second_side: bool,
    /// Depth of the face at the ribbon's border, less that of the line.
    depth_at_reach: f64,
    /// Depth per pixel across.
    slope: f64,
    /// Depth of the third corner, less that of the line.
    range: f64,
}

impl Line {
    /// The face with this third corner; `None` if it is on the line.
    fn face(&self, third: WindowPoint, reach: f64) -> Option<Face> {
        let way = third.at_px - self.from.at_px;
        let distance = way.dot(self.across);
        let depth = third.depth - (self.from.depth + self.slope * way.dot(self.along));
        let far = distance.abs();
        let is_aside = far > 0.0;
        if !is_aside || !depth.is_finite() {
            return None;
        }
        Some(Face {
            is_on_second_side: distance < 0.0,
            depth_at_reach: depth * (reach / far).min(1.0),
            slope: depth / far,
            range: depth.abs(),
        })
    }
}
