//! Lighting at every fragment: Phong shading, and toon steps.

use super::lighting::{Gloss, Lights};
use super::{VertexTransforms, shading_normal};
use estampe::{Real, Vec3};
use std::sync::Arc;

/// Shading of a lit fragment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ShadingMode {
    /// Smooth: the light unchanged.
    Smooth,
    /// Toon: the light in this many steps.
    Toon(u16),
}

/// Lighting at every fragment.
#[derive(Debug, Clone)]
pub(crate) struct PhongLight {
    pub(crate) transforms: VertexTransforms,
    pub(crate) lights: Arc<Lights>,
    pub(crate) gloss: Gloss,
    pub(crate) mode: ShadingMode,
}

impl PhongLight {
    /// The colour of a fragment with this base colour, at a view-space point, with its interpolated
    /// normal.
    #[inline(always)]
    pub(crate) fn color<R: Real>(
        &self,
        base: Vec3<R>,
        view: Vec3<R>,
        normal: Vec3<R>,
        front_facing: R::SelectMask,
    ) -> Vec3<R> {
        let to_eye = self.transforms.eye_direction(view);
        let normal = shading_normal(normal, to_eye, front_facing);
        match self.mode {
            ShadingMode::Smooth => {
                let light = self.lights.illuminate(&self.gloss, normal, to_eye);
                base * light.diffuse + light.added
            }
            ShadingMode::Toon(levels) => self.toon(base, normal, levels),
        }
    }

    /// Toon shading: the base colour interpolated between shade and full light by min(⌊I·N⌋, N −
    /// 1)/(N − 1).
    #[inline(always)]
    fn toon<R: Real>(&self, base: Vec3<R>, normal: Vec3<R>, levels: u16) -> Vec3<R> {
        const SHADE: f32 = 0.3;
        const FULL: f32 = 1.0;
        let n = f32::from(levels.max(2));
        let lit = self.lights.lit_fraction(normal);
        let step = (lit * n).floor().min(lit.splat(n - 1.0)) / (n - 1.0);
        let emissive = Vec3::uniform(lit, self.gloss.emissive);
        base * (step * (FULL - SHADE) + SHADE) + emissive
    }
}
