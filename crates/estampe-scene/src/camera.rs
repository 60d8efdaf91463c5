//! The camera of a scene.

use glam::Vec3;

/// A camera in world space; it looks from `eye` to `target`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Position of the eye.
    pub eye_world: Vec3,
    /// The point in the middle of the picture.
    pub target_world: Vec3,
    /// The direction that points up in the picture; need not be unit or perpendicular.
    pub up_world: Vec3,
    /// Projection from view space to the picture.
    pub projection: Projection,
}

/// A camera that a file describes.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedCamera {
    /// Name in the file; may be empty.
    pub name: String,
    /// The camera; the target is one unit in front of the eye.
    pub camera: Camera,
    /// Width divided by height of the picture; `None` is that of the output.
    pub aspect: Option<f32>,
}

/// Projection from view space to the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Projection {
    /// Perspective: size decreases with distance.
    Perspective {
        /// Vertical opening angle, in (0, π).
        fov_y_rad: f32,
        /// Distance of the near plane, > 0.
        near: f32,
        /// Distance of the far plane, > near; files may have ∞.
        far: f32,
    },
    /// Size does not depend on distance.
    Orthographic {
        /// Half of the visible height, in world units.
        half_height: f32,
        /// Distance of the near plane; may be negative (behind the eye).
        near: f32,
        /// Distance of the far plane, > near.
        far: f32,
    },
}
