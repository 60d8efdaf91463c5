//! The sum of the light on a point of a surface.
//!
//! ```text
//!   C = Cₐ·Co + Σ a·( max(n·l, 0)·Cl·Co  +  [n·l > 0]·s^e·Cl·Cs )
//!
//!   Co base colour, Cs specular colour, e shininess      n unit normal
//!   Cₐ ambient light, Cl a light's colour                l unit direction towards the light
//!   a = 1 − min(distance ÷ reach, 1), 1 for directions   v unit direction towards the eye
//!
//!   s = max(r·v, 0), r = 2(n·l)n − l    Phong 1975: the reflected light
//!   s = max(n·h, 0), h = (l + v)/‖l + v‖    Blinn 1977: the half vector
//! ```
//!
//! Ambient light is added once, not by each light. One function computes the sum, for vertices,
//! faces and fragments ([`super::interpolation`] chooses), in `f32` and in lanes. It returns
//! ambient and diffuse light apart from the rest, because the base colour may be known only at the
//! fragment. `estampe_reference::illumination` is the same in f64. Row F3.

mod lights;

pub use lights::{DEFAULT_AMBIENT, Directional, Lights, Positional, ViewLight, luminance};

use super::shadow::Visibilities;
use estampe::{Real, Vec3, maths};

/// Reflection and emission of a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gloss {
    /// Specular colour, linear.
    pub specular: [f32; 3],
    /// Specular exponent, a whole number, so that powers are a few products.
    pub shininess: u32,
    /// Emitted light, linear.
    pub emissive: [f32; 3],
    /// The cosine that is raised to the exponent.
    pub highlight: Highlight,
}

/// The cosine of the specular term.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Highlight {
    /// r·v, of the reflected light and the direction to the eye.
    Reflection,
    /// n·h, of the normal and the half vector.
    HalfVector,
}

/// A point of a surface, in view space.
#[derive(Debug, Clone, Copy)]
pub struct SurfacePoint<R> {
    pub position: Vec3<R>,
    /// Unit shading normal.
    pub normal: Vec3<R>,
    /// Unit direction to the eye.
    pub to_eye: Vec3<R>,
    /// The shares of the lights that reach it.
    pub visibilities: Visibilities<R>,
}

/// Light at a point: a factor of the base colour, and light that is added.
#[derive(Debug, Clone, Copy)]
pub struct Illumination<R> {
    /// Ambient and diffuse light.
    pub diffuse: Vec3<R>,
    /// Specular and emitted light.
    pub added: Vec3<R>,
}

impl Lights {
    /// The light on a point of a surface.
    #[inline(always)]
    pub fn illuminate<R: Real>(&self, gloss: &Gloss, point: SurfacePoint<R>) -> Illumination<R> {
        let zero = point.normal.x.splat(0.0);
        let mut sum = Illumination {
            diffuse: self.ambient(point.normal),
            added: Vec3::uniform(zero, gloss.emissive),
        };
        // r·v is symmetric: the reflected light towards the eye equals the reflected eye towards
        // the light, which is the same for all lights.
        let reflected_eye = -point.to_eye.reflect(point.normal);
        for light in &self.directional {
            let (towards, mut color) = (
                Vec3::uniform(zero, light.source.0),
                Vec3::uniform(zero, light.color),
            );
            if let Some(share) = point.visibilities.of(light.shadow_map) {
                color *= share;
            }
            let n_dot_l = point.normal.dot(towards).max(zero);
            sum.diffuse += color * n_dot_l;
            if gloss.shines(light.highlight) {
                let cosine = gloss.cosine(point, towards, reflected_eye);
                sum.added += gloss.specular(color, n_dot_l, cosine, light.highlight);
            }
        }
        for light in &self.positional {
            let (towards, share) = light.source.arrive(point.position);
            let mut color = Vec3::uniform(zero, light.color) * share;
            if let Some(share) = point.visibilities.of(light.shadow_map) {
                color *= share;
            }
            let n_dot_l = point.normal.dot(towards).max(zero);
            sum.diffuse += color * n_dot_l;
            if gloss.shines(light.highlight) {
                let cosine = gloss.cosine(point, towards, reflected_eye);
                sum.added += gloss.specular(color, n_dot_l, cosine, light.highlight);
            }
        }
        sum
    }

    /// Share of the lights' diffuse light that falls on a point, weighted by their luminances: 0
    /// dark, 1 fully lit.
    #[inline(always)]
    pub fn lit_fraction<R: Real>(&self, point: SurfacePoint<R>) -> R {
        let zero = point.normal.x.splat(0.0);
        let mut sum = zero;
        for light in &self.directional {
            let mut n_dot_l = point.normal.dot_uniform(light.source.0).max(zero);
            if let Some(share) = point.visibilities.of(light.shadow_map) {
                n_dot_l *= share;
            }
            sum += n_dot_l * luminance(light.color);
        }
        for light in &self.positional {
            let (towards, mut share) = light.source.arrive(point.position);
            if let Some(visible) = point.visibilities.of(light.shadow_map) {
                share *= visible;
            }
            sum += point.normal.dot(towards).max(zero) * luminance(light.color) * share;
        }
        sum.saturate()
    }
}

impl Gloss {
    /// True if a light with highlights of this strength gives one on the surface.
    fn shines(&self, highlight: f32) -> bool {
        self.specular != [0.0; 3] && highlight > 0.0
    }

    /// The cosine of the specular term, 0 to 1.
    #[inline(always)]
    fn cosine<R: Real>(
        &self,
        point: SurfacePoint<R>,
        towards: Vec3<R>,
        reflected_eye: Vec3<R>,
    ) -> R {
        let cosine = match self.highlight {
            Highlight::Reflection => reflected_eye.dot(towards),
            Highlight::HalfVector => point.normal.dot((towards + point.to_eye).normalize()),
        };
        // NaN, of a half vector between opposite directions, becomes 0.
        cosine.saturate()
    }

    /// The specular term; zero where the light is behind the surface.
    #[inline(always)]
    fn specular<R: Real>(&self, color: Vec3<R>, n_dot_l: R, cosine: R, highlight: f32) -> Vec3<R> {
        let zero = n_dot_l.splat(0.0);
        let power = maths::powi(cosine, self.shininess) * highlight;
        let lit = R::select(n_dot_l.gt(zero), power, zero);
        color * Vec3::uniform(zero, self.specular) * lit
    }
}
