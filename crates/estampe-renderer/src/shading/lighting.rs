//! Lights and the Phong lighting model.
//!
//! Ambient light once; for each light the diffuse term max(n·l, 0) and, where n·l > 0, the specular
//! term max(r·v, 0)ᵉ with r = 2(n·l)n − l. Lights are directional.

use estampe::{Real, Vec3, maths};

/// A directional light in view space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ViewLight {
    /// Unit direction towards the light.
    pub(crate) towards: [f32; 3],
    /// Linear colour times intensity.
    pub(crate) color: [f32; 3],
    /// Strength of its highlights, multiplied by the surface's specular colour.
    pub(crate) highlight: f32,
}

/// All lights of a scene.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Lights {
    /// Directional lights.
    pub(crate) directional: Vec<ViewLight>,
    /// Ambient light on normals that point up in view space (hemispheric ambient light).
    pub(crate) sky: [f32; 3],
    /// Ambient light on normals that point down; between the two it is interpolated linearly.
    pub(crate) ground: [f32; 3],
}

/// The default ambient light.
pub(crate) const DEFAULT_AMBIENT: f32 = 0.18;

impl Lights {
    /// The default lights, fixed to the camera: a key light from above on the left, a fill light
    /// from the right, a rim light from behind, and ambient light that is a little stronger from
    /// above.
    pub(crate) fn studio(ambient: f32) -> Self {
        let light = |towards: [f64; 3], intensity: f32, tint: [f32; 3], highlight: f32| {
            let unit = glam::DVec3::from(towards).normalize().as_vec3();
            let color = tint.map(|c| c * intensity);
            ViewLight {
                towards: unit.to_array(),
                color,
                highlight,
            }
        };
        Self {
            directional: vec![
                light([-0.55, 0.80, 0.62], 1.08, [1.0, 0.985, 0.955], 1.0),
                light([0.85, 0.10, 0.55], 0.20, [0.90, 0.95, 1.0], 0.25),
                light([0.35, 0.45, -0.75], 0.25, [1.0, 1.0, 1.0], 0.0),
            ],
            sky: [ambient * 1.15, ambient * 1.17, ambient * 1.2],
            ground: [ambient * 0.72, ambient * 0.7, ambient * 0.68],
        }
    }

    /// The given lights, and ambient light that does not depend on the normal.
    pub(crate) fn with_uniform_ambient(directional: Vec<ViewLight>, ambient: f32) -> Self {
        Self {
            directional,
            sky: [ambient; 3],
            ground: [ambient; 3],
        }
    }
}

/// Reflection and emission of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Gloss {
    /// Specular colour, linear.
    pub(crate) specular: [f32; 3],
    /// Specular exponent, a whole number, so that powers are a few products.
    pub(crate) shininess: u32,
    /// Emitted light, linear.
    pub(crate) emissive: [f32; 3],
}

/// Light at a point: a factor of the base colour, and light that is added.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Illumination<R> {
    /// Ambient and diffuse light.
    pub(crate) diffuse: Vec3<R>,
    /// Specular and emitted light.
    pub(crate) added: Vec3<R>,
}

impl Lights {
    /// The light on a surface with unit `normal`, seen from the unit direction `to_eye`.
    #[inline(always)]
    pub(crate) fn illuminate<R: Real>(
        &self,
        gloss: &Gloss,
        normal: Vec3<R>,
        to_eye: Vec3<R>,
    ) -> Illumination<R> {
        let zero = normal.x.splat(0.0);
        let mut diffuse = self.ambient(normal);
        let mut added = Vec3::uniform(zero, gloss.emissive);
        let shines = gloss.specular != [0.0; 3];
        let reflected_eye = -to_eye.reflect(normal);
        for light in &self.directional {
            let towards = Vec3::uniform(zero, light.towards);
            let n_dot_l = normal.dot(towards).max(zero);
            diffuse += Vec3::uniform(zero, light.color) * n_dot_l;
            if shines && light.highlight > 0.0 {
                // r·v is symmetric: the reflected light towards the eye equals the reflected eye
                // towards the light.
                let r_dot_v = reflected_eye.dot(towards).saturate();
                let power = maths::powi(r_dot_v, gloss.shininess) * light.highlight;
                let lit = R::select(n_dot_l.gt(zero), power, zero);
                added +=
                    Vec3::uniform(zero, light.color) * Vec3::uniform(zero, gloss.specular) * lit;
            }
        }
        Illumination { diffuse, added }
    }

    /// Ambient light on a unit normal.
    #[inline(always)]
    pub(crate) fn ambient<R: Real>(&self, normal: Vec3<R>) -> Vec3<R> {
        let upward = normal.y * 0.5 + 0.5;
        Vec3::uniform(upward, self.ground).mix(Vec3::uniform(upward, self.sky), upward)
    }

    /// Fraction of the directional light that falls on a unit normal, weighted by the lights'
    /// luminances: 0 dark, 1 fully lit.
    #[inline(always)]
    pub(crate) fn lit_fraction<R: Real>(&self, normal: Vec3<R>) -> R {
        let zero = normal.x.splat(0.0);
        let mut sum = zero;
        for light in &self.directional {
            let [r, g, b] = light.color;
            let luminance = r * 0.2126 + g * 0.7152 + b * 0.0722;
            sum += normal.dot_uniform(light.towards).max(zero) * luminance;
        }
        sum.saturate()
    }
}
