//! Lights of a scene.

use glam::Vec3;

/// A light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Light {
    /// Where the light comes from.
    pub source: LightSource,
    /// Linear colour times intensity; negative components are taken as 0.
    pub color: Vec3,
}

/// Where light comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LightSource {
    /// Infinitely far away.
    Directional {
        /// Direction from the surface towards the light, in world space; need not be unit.
        towards_light_world: Vec3,
    },
    /// A point.
    Positional {
        /// The point, in world space.
        position_world: Vec3,
        /// Distance at which the light ends, in world units: at distance d it is 1 − min(d ÷ reach,
        /// 1) of its colour. `None` is the same light at every distance.
        reach: Option<f32>,
    },
}
