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

/// A light that a file describes, in photometric units (KHR_lights_punctual).
#[derive(Debug, Clone, PartialEq)]
pub struct PunctualLight {
    /// Name in the file; may be empty.
    pub name: String,
    /// The form and the place.
    pub kind: PunctualLightKind,
    /// Linear colour, which is multiplied by the intensity.
    pub color: Vec3,
    /// Illuminance in lux (lm/m²) of a directional light, luminous intensity in candela (lm/sr) of
    /// the others, whose illuminance at distance d is intensity ÷ d².
    pub intensity: f32,
}

/// The form of a light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PunctualLightKind {
    /// Infinitely far away.
    Directional {
        /// Unit direction in which the light travels, in world space.
        direction_world: Vec3,
    },
    /// A point that shines in all directions.
    Point {
        /// The point, in world space.
        position_world: Vec3,
        /// Distance at which the light ends; `None` is infinite.
        range: Option<f32>,
    },
    /// A point that shines into a cone.
    Spot {
        /// The point, in world space.
        position_world: Vec3,
        /// Unit direction of the cone's axis, away from the light, in world space.
        direction_world: Vec3,
        /// Distance at which the light ends; `None` is infinite.
        range: Option<f32>,
        /// Angle from the axis up to which the light has its full intensity, ≥ 0.
        inner_cone_rad: f32,
        /// Angle from the axis from which on there is no light, > `inner_cone_rad`, ≤ π/2.
        outer_cone_rad: f32,
    },
}
