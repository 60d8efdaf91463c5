//! The terms of the illumination that a surface has, in two steps: light, which depends on the
//! point and can be interpolated, and the colour that the base colour has in this light.

use super::lighting::{Gloss, Illumination, Lights, SurfacePoint};
use super::steps::quantised;
use estampe::{Real, Vec3};
use std::sync::Arc;

/// The terms of a surface, with its lights.
#[derive(Debug, Clone)]
pub struct Reflectance {
    pub lights: Arc<Lights>,
    pub gloss: Gloss,
    pub terms: Terms,
}

/// The terms of the illumination.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Terms {
    /// Ambient, diffuse and specular light.
    All,
    /// The diffuse light in this many steps between shade and full light, without a highlight.
    Toon(u16),
    /// The base colour unchanged.
    Unlit,
}

impl Reflectance {
    /// The light on a point, which may be interpolated before [`Self::color`] uses it.
    #[inline(always)]
    pub fn light<R: Real>(&self, point: SurfacePoint<R>) -> Illumination<R> {
        let emissive = Vec3::uniform(point.normal.x, self.gloss.emissive);
        match self.terms {
            Terms::All => self.lights.illuminate(&self.gloss, point),
            Terms::Toon(_) => Illumination {
                diffuse: Vec3::repeat(point.normal.x.out_of_line(
                    #[inline(always)]
                    || self.lights.lit_fraction(point),
                )),
                added: emissive,
            },
            Terms::Unlit => Illumination {
                diffuse: Vec3::uniform(point.normal.x, [1.0; 3]),
                added: emissive,
            },
        }
    }

    /// The base colour in this light.
    #[inline(always)]
    pub fn color<R: Real>(&self, base: Vec3<R>, light: Illumination<R>) -> Vec3<R> {
        const SHADE: f32 = 0.3;
        const FULL: f32 = 1.0;
        match self.terms {
            Terms::All | Terms::Unlit => base * light.diffuse + light.added,
            Terms::Toon(levels) => {
                let step = quantised(light.diffuse.x, levels);
                base * (step * (FULL - SHADE) + SHADE) + light.added
            }
        }
    }
}
