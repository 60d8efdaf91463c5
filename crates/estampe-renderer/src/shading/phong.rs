//! Light at every fragment: Phong's smooth shading, and toon's steps.

use super::lighting::{Gloss, LightRig};
use super::{VertexTransforms, shading_normal};
use estampe::{Real, Vec3};
use std::sync::Arc;

/// How light becomes colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Tone {
    /// As it is.
    Smooth,
    /// In this many steps.
    Toon(u16),
}

/// Light at every fragment.
#[derive(Debug, Clone)]
pub(crate) struct PhongLight {
    pub(crate) transforms: VertexTransforms,
    pub(crate) rig: Arc<LightRig>,
    pub(crate) gloss: Gloss,
    pub(crate) tone: Tone,
}

impl PhongLight {
    /// The colour of a fragment of this base colour, at a point of view space, with its interpolated
    /// normal.
    #[inline(always)]
    pub(crate) fn color<R: Real>(
        &self,
        base: Vec3<R>,
        view: Vec3<R>,
        normal: Vec3<R>,
        front_facing: R::Mask,
    ) -> Vec3<R> {
        let to_eye = self.transforms.eye_direction(view);
        let normal = shading_normal(normal, to_eye, front_facing);
        match self.tone {
            Tone::Smooth => {
                let light = self.rig.illuminate(&self.gloss, normal, to_eye);
                base * light.diffuse + light.added
            }
            Tone::Toon(levels) => self.toon(base, normal, levels),
        }
    }

    /// The base colour in steps of light: min(⌊I·N⌋, N − 1)/(N − 1) of the way from shade to full light
    /// (row F3).
    #[inline(always)]
    fn toon<R: Real>(&self, base: Vec3<R>, normal: Vec3<R>, levels: u16) -> Vec3<R> {
        const SHADE: f32 = 0.3;
        const FULL: f32 = 1.0;
        let n = f32::from(levels.max(2));
        let lit = self.rig.lit_fraction(normal);
        let step = (lit * n).floor().min(lit.splat(n - 1.0)) / (n - 1.0);
        let emissive = Vec3::uniform(lit, self.gloss.emissive);
        base * (step * (FULL - SHADE) + SHADE) + emissive
    }
}
