//! Light at every fragment: Phong's smooth shading, and toon's steps.

use super::base_color::BaseColor;
use super::lighting::{Gloss, LightRig};
use super::{VertexTransforms, shading_normal};
use estampe::{FragmentIn, FragmentOut, Real, Vec3, VertexIn, VertexOut};
use std::sync::Arc;

/// How light becomes colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Tone {
    /// As it is.
    Smooth,
    /// In this many steps.
    Toon(u16),
}

/// The shader of surfaces lit at every fragment.
#[derive(Debug, Clone)]
pub(crate) struct Phong<B> {
    pub(crate) transforms: VertexTransforms,
    pub(crate) rig: Arc<LightRig>,
    pub(crate) gloss: Gloss,
    pub(crate) tone: Tone,
    pub(crate) base: B,
}

estampe::shader! {
    impl<B: BaseColor> Shader for Phong<B> {
        type Attributes<R: Real> = (Vec3<R>, Vec3<R>, B::Attributes<R>); // position, normal
        type Varyings<R: Real> = (Vec3<R>, Vec3<R>, B::Varyings<R>); // view position, normal
        const DISCARDS: bool = B::MASKS;

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, normal, base): (Vec3<R>, Vec3<R>, B::Attributes<R>),
        ) -> VertexOut<R, (Vec3<R>, Vec3<R>, B::Varyings<R>)> {
            let view = self.transforms.view(position);
            let normal = self.transforms.normal(normal);
            VertexOut::new(self.transforms.clip(position), (view, normal, self.base.vertex(base)))
        }

        fn fragment<R: Real>(
            &self,
            input: FragmentIn<'_, R>,
            (view, normal, base): (Vec3<R>, Vec3<R>, B::Varyings<R>),
        ) -> FragmentOut<R> {
            let to_eye = self.transforms.eye_direction(view);
            let normal = shading_normal(normal, to_eye, input.front_facing);
            let base = self.base.fragment(base, input.zero);
            let color = match self.tone {
                Tone::Smooth => {
                    let light = self.rig.illuminate(&self.gloss, normal, to_eye);
                    base.xyz() * light.diffuse + light.added
                }
                Tone::Toon(levels) => self.toon(base.xyz(), normal, levels),
            };
            let out = FragmentOut::color(color.extend(base.w));
            if B::MASKS { out.keep_where(base.w.ge(input.real(0.5))) } else { out }
        }
    }
}

impl<B> Phong<B> {
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
