//! Pinhole cameras as computer vision writes them.
//!
//! A point p of the world is seen at the pixel (x, y), where
//!
//! ```text
//!   q = R·p + t        q: x to the right, y down, z forward
//!   x = f_x·q_x/q_z + c_x,   y = f_y·q_y/q_z + c_y
//! ```
//!
//! in pixels from the upper left corner of the picture, whose first pixel's centre is (½, ½).
//! Hartley and Zisserman, *Multiple View Geometry*, 2nd edition, §6.1.

use super::placement::{CameraOptions, Eye, ProjectionKind};
use crate::transforms::view::CameraFrame;
use glam::DVec3;

/// Intrinsics of a pinhole camera without skew, in pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Intrinsics {
    /// Focal lengths f_x and f_y, above 0.
    pub focal_px: [f64; 2],
    /// The principal point (c_x, c_y), from the picture's upper left corner. It may lie outside of
    /// the picture.
    pub principal_px: [f64; 2],
}

/// A pinhole camera: intrinsics and pose.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pinhole {
    /// K.
    pub intrinsics: Intrinsics,
    /// The rows of R, orthonormal: the picture's right, its down and its forward direction, in
    /// world space.
    pub rotation: [DVec3; 3],
    /// t, in world units.
    pub translation: DVec3,
}

impl Pinhole {
    /// The pixel of a point, and its distance along the view direction.
    #[must_use]
    pub fn project(&self, point_world: DVec3) -> ([f64; 2], f64) {
        let [x, y, z] = self.rotation.map(|row| row.dot(point_world));
        let seen = DVec3::new(x, y, z) + self.translation;
        let Intrinsics {
            focal_px: [fx, fy],
            principal_px: [cx, cy],
        } = self.intrinsics;
        (
            [fx * seen.x / seen.z + cx, fy * seen.y / seen.z + cy],
            seen.z,
        )
    }
}

/// The camera of a picture that this pinhole sees.
impl From<Pinhole> for CameraOptions {
    fn from(pinhole: Pinhole) -> Self {
        let [right, down, forward] = pinhole.rotation;
        let t = pinhole.translation;
        Self {
            eye: Eye::Posed(CameraFrame {
                right_world: right,
                up_world: -down,
                back_world: -forward,
                // p = Rᵀ·(q − t), at q = 0.
                eye_world: -(right * t.x + down * t.y + forward * t.z),
            }),
            projection: ProjectionKind::Pinhole(pinhole.intrinsics),
            ..Self::default()
        }
    }
}

/// The window through which a picture sees, on the plane at distance 1 before the eye.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// The left edge; below the right one.
    pub left: f64,
    /// The right edge.
    pub right: f64,
    /// The lower edge; below the upper one.
    pub bottom: f64,
    /// The upper edge.
    pub top: f64,
}

impl Window {
    /// The window of a picture of this size.
    #[must_use]
    pub fn new(intrinsics: Intrinsics, (width, height): (f64, f64)) -> Self {
        let [fx, fy] = intrinsics.focal_px;
        let [cx, cy] = intrinsics.principal_px;
        Self {
            left: -cx / fx,
            right: (width - cx) / fx,
            bottom: (cy - height) / fy,
            top: cy / fy,
        }
    }

    /// The window that is smaller by this factor about its middle.
    pub(super) fn zoomed(self, zoom: f64) -> Self {
        let about = |low: f64, high: f64| {
            let (middle, half) = ((low + high) / 2.0, (high - low) / 2.0 / zoom);
            (middle - half, middle + half)
        };
        let (left, right) = about(self.left, self.right);
        let (bottom, top) = about(self.bottom, self.top);
        Self {
            left,
            right,
            bottom,
            top,
        }
    }

    /// The intrinsics that see a picture of this size through the window.
    #[must_use]
    pub fn intrinsics(self, (width, height): (f64, f64)) -> Intrinsics {
        let (fx, fy) = (
            width / (self.right - self.left),
            height / (self.top - self.bottom),
        );
        Intrinsics {
            focal_px: [fx, fy],
            principal_px: [-self.left * fx, self.top * fy],
        }
    }

    /// The angle between the upper and the lower edge, in radians.
    #[must_use]
    pub fn fov_y_rad(self) -> f64 {
        libm::atan(self.top) - libm::atan(self.bottom)
    }
}
