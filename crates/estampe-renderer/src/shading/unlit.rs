//! The base colour itself.

use super::VertexTransforms;
use super::base_color::BaseColor;
use estampe::{FragmentIn, FragmentOut, Vec3, VertexIn, VertexOut};

/// The shader of surfaces without light.
#[derive(Debug, Clone)]
pub(crate) struct Unlit<B> {
    pub(crate) transforms: VertexTransforms,
    /// Added to the base colour.
    pub(crate) emissive: [f32; 3],
    pub(crate) base: B,
}

estampe::shader! {
    impl<B: BaseColor> Shader for Unlit<B> {
        type Attributes<R: Real> = (Vec3<R>, B::Attributes<R>); // position
        type Varyings<R: Real> = B::Varyings<R>;
        const DISCARDS: bool = B::MASKS;

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, base): (Vec3<R>, B::Attributes<R>),
        ) -> VertexOut<R, B::Varyings<R>> {
            VertexOut::new(self.transforms.clip(position), self.base.vertex(base))
        }

        fn fragment<R: Real>(
            &self,
            input: FragmentIn<'_, R>,
            base: B::Varyings<R>,
        ) -> FragmentOut<R> {
            let base = self.base.fragment(base, input.zero);
            let color = base.xyz() + Vec3::uniform(input.zero, self.emissive);
            let out = FragmentOut::color(color.extend(base.w));
            if B::MASKS { out.keep_where(base.w.ge(input.real(0.5))) } else { out }
        }
    }
}
