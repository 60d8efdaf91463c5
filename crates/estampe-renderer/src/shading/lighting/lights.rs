//! The lights of a frame, in view space.

use crate::shading::shadow::ShadowMapView;
use estampe::{Real, Vec3};

/// A light in view space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ViewLight<Source> {
    /// Where the light comes from.
    pub source: Source,
    /// Linear colour times intensity, not negative.
    pub color: [f32; 3],
    /// Strength of its highlights, multiplied by the surface's specular colour.
    pub highlight: f32,
    /// The number of its shadow map, if it has one.
    pub shadow_map: Option<usize>,
}

/// Light from infinitely far away: the unit direction towards it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Directional(pub [f32; 3]);

/// Light from a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Positional {
    /// The point, in view space.
    pub position: [f32; 3],
    /// 1 ÷ the distance at which the light ends, in view space; 0 if it never ends.
    pub inverse_reach: f32,
}

/// All lights of a frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Lights {
    /// Lights with a direction.
    pub directional: Vec<ViewLight<Directional>>,
    /// Lights with a position.
    pub positional: Vec<ViewLight<Positional>>,
    /// The shadow maps of lights.
    pub shadow_maps: Vec<ShadowMapView>,
    /// Ambient light on normals that point up in view space (hemispheric ambient light).
    pub sky: [f32; 3],
    /// Ambient light on normals that point down; between the two it is interpolated linearly.
    pub ground: [f32; 3],
}

/// The default ambient light.
pub const DEFAULT_AMBIENT: f32 = 0.18;

impl Lights {
    /// The default lights, fixed to the camera: a key light from above on the left, a fill light
    /// from the right, a rim light from behind, and ambient light that is a little stronger from
    /// above.
    pub fn studio(ambient: f32) -> Self {
        let light = |towards: [f64; 3], intensity: f32, tint: [f32; 3], highlight: f32| {
            let unit = glam::DVec3::from(towards).normalize().as_vec3();
            let color = tint.map(|c| c * intensity);
            ViewLight {
                source: Directional(unit.to_array()),
                color,
                highlight,
                shadow_map: None,
            }
        };
        Self {
            directional: vec![
                light([-0.45, 0.85, 0.55], 1.18, [1.0, 0.985, 0.955], 1.0),
                light([0.85, 0.15, 0.45], 0.30, [0.90, 0.95, 1.0], 0.25),
                light([0.35, 0.45, -0.75], 0.25, [1.0, 1.0, 1.0], 0.0),
            ],
            positional: Vec::new(),
            shadow_maps: Vec::new(),
            sky: [ambient * 1.15, ambient * 1.17, ambient * 1.2],
            ground: [ambient * 0.72, ambient * 0.7, ambient * 0.68],
        }
    }

    /// Ambient light alone, which does not depend on the normal.
    pub fn with_uniform_ambient(ambient: f32) -> Self {
        Self {
            directional: Vec::new(),
            positional: Vec::new(),
            shadow_maps: Vec::new(),
            sky: [ambient; 3],
            ground: [ambient; 3],
        }
    }

    /// Ambient light on a unit normal.
    #[inline(always)]
    pub fn ambient<R: Real>(&self, normal: Vec3<R>) -> Vec3<R> {
        let upward = normal.y * 0.5 + 0.5;
        Vec3::uniform(upward, self.ground).mix(Vec3::uniform(upward, self.sky), upward)
    }
}

impl Positional {
    /// Unit direction from `point` towards the light, and the share of the light that arrives
    /// there: 1 − min(distance ÷ reach, 1). At the light itself the direction is zero, so nothing
    /// is lit.
    #[inline(always)]
    pub fn arrive<R: Real>(&self, point: Vec3<R>) -> (Vec3<R>, R) {
        const NEAREST: f32 = 1e-18;
        let way = Vec3::uniform(point.x, self.position) - point;
        let distance = way.length();
        let towards = way / distance.max(NEAREST);
        (towards, 1.0 - (distance * self.inverse_reach).min(1.0))
    }
}

/// Luminance of a linear colour (Rec. 709).
pub fn luminance([r, g, b]: [f32; 3]) -> f32 {
    r * 0.2126 + g * 0.7152 + b * 0.0722
}
