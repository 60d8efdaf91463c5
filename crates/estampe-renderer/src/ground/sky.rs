//! The light of the directions above the ground.

use crate::environment::EnvironmentMap;
use crate::transforms::round_to_f32;
use glam::{DMat3, DVec3, Vec3};
use std::sync::Arc;

/// Parallel light: the unit direction towards it in unit space, and its illuminance.
pub(crate) type ParallelLight = (DVec3, f32);

/// The surroundings as the ground sees them.
#[derive(Debug, Clone)]
pub(crate) struct Sky {
    pub(crate) map: Arc<EnvironmentMap>,
    pub(crate) map_from_world: DMat3,
    pub(crate) lights: Vec<ParallelLight>,
}

impl Sky {
    /// The luminance of the radiance from a unit direction in unit space, averaged over about a
    /// tenth of the sphere's half. Parallel light comes from such an area too.
    pub(super) fn luminance(&self, towards: DVec3) -> f32 {
        let from_map = self.map.blurred((self.map_from_world * towards).as_vec3());
        let from_map = from_map.dot(Vec3::new(0.2126, 0.7152, 0.0722));
        let lights = self.lights.iter().map(|(direction, illuminance)| {
            // (n + 1)/2π·cosⁿ has the integral 1.
            let cosine = round_to_f32(direction.dot(towards));
            let cosine_16 = [(); 4]
                .iter()
                .fold(cosine.max(0.0), |power, ()| power * power);
            illuminance * cosine_16 * (17.0 / std::f32::consts::TAU)
        });
        from_map + lights.sum::<f32>()
    }
}
