//! Lights of a scene.

use glam::Vec3;

/// A directional light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Light {
    /// Direction from the surface towards the light, in world space; need not be unit.
    pub towards_light_world: Vec3,
    /// Linear colour times intensity.
    pub color: Vec3,
}
