//! Lights with a place or a direction, for physically based surfaces.

use crate::shading::lighting::{Directional, Positional, ViewLight};
use crate::shadows::ShadowSource;
use estampe::{Real, Vec3};

/// A light in view space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PbrLight {
    pub source: PbrSource,
    /// Illuminance of a surface that faces it; of [`PbrSource::Point`] in the distance 1.
    pub color: [f32; 3],
    /// The number of its shadow map, if it has one.
    pub shadow_map: Option<usize>,
}

/// Where light comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PbrSource {
    /// From infinitely far away.
    Directional(Directional),
    /// From a point; it decreases linearly.
    Linear(Positional),
    /// From a point; it decreases with the squared distance.
    Point {
        position: [f32; 3],
        /// 1 ÷ the distance at which the light ends; 0 if it never ends.
        inverse_range: f32,
        cone: Option<Cone>,
    },
}

/// The cone of a spot light (KHR_lights_punctual): its light is (cosine·scale + offset)², with the
/// sum clamped to 0..1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cone {
    /// Unit direction of the axis, away from the light.
    pub axis: [f32; 3],
    pub scale: f32,
    pub offset: f32,
}

impl PbrLight {
    /// A light of the options: a white diffuse surface that faces it has its colour.
    pub fn directional(light: &ViewLight<Directional>) -> Self {
        Self {
            source: PbrSource::Directional(light.source),
            color: light.color.map(|channel| channel * std::f32::consts::PI),
            shadow_map: None,
        }
    }

    /// A light of the options: a white diffuse surface that faces it nearby has its colour.
    pub fn positional(light: &ViewLight<Positional>) -> Self {
        Self {
            source: PbrSource::Linear(light.source),
            color: light.color.map(|channel| channel * std::f32::consts::PI),
            shadow_map: None,
        }
    }

    /// Where it is, or comes from, if its rays can be in a shadow map.
    pub(crate) fn shadow_source(&self) -> ShadowSource {
        match &self.source {
            PbrSource::Directional(Directional(towards)) => ShadowSource::Directional(*towards),
            PbrSource::Linear(Positional { position, .. }) | PbrSource::Point { position, .. } => {
                ShadowSource::Positional(*position)
            }
        }
    }

    /// Unit direction from a point towards the light, and the light's illuminance there.
    #[inline(always)]
    pub fn arrive<R: Real>(&self, point: Vec3<R>) -> (Vec3<R>, Vec3<R>) {
        let color = Vec3::uniform(point.x, self.color);
        match &self.source {
            PbrSource::Directional(Directional(towards)) => {
                (Vec3::uniform(point.x, *towards), color)
            }
            PbrSource::Linear(positional) => {
                let (towards, share) = positional.arrive(point);
                (towards, color * share)
            }
            PbrSource::Point {
                position,
                inverse_range,
                cone,
            } => {
                const NEAREST: f32 = 1e-12;
                let way = Vec3::uniform(point.x, *position) - point;
                let squared = way.dot(way).max(NEAREST);
                let towards = way / squared.sqrt();
                let mut share = 1.0 / squared;
                if *inverse_range > 0.0 {
                    let reached = squared * (inverse_range * inverse_range);
                    share *= (1.0 - reached * reached).saturate();
                }
                if let Some(cone) = cone {
                    let cosine = -towards.dot_uniform(cone.axis);
                    let inside = (cosine * cone.scale + cone.offset).saturate();
                    share = share * inside * inside;
                }
                (towards, color * share)
            }
        }
    }
}
