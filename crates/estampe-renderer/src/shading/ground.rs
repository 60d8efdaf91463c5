//! The shader of the ground: black, with the alpha of a texture.

use super::VertexTransforms;
use estampe::{FragmentIn, FragmentOut, SampledTexture, Vec2, Vec3, Vec4, VertexIn, VertexOut};

/// The ground, which shows a shadow.
#[derive(Debug, Clone)]
pub struct GroundSurface {
    pub transforms: VertexTransforms,
    /// The share of the light that is hidden.
    pub hidden: SampledTexture,
}

estampe::shader! {
    impl Shader for GroundSurface {
        type Attributes<R: Real> = (Vec3<R>, Vec2<R>); // position, uv
        type Varyings<R: Real> = Vec2<R>;

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, uv): (Vec3<R>, Vec2<R>),
        ) -> VertexOut<R, Vec2<R>> {
            VertexOut::new(self.transforms.clip(position), uv)
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, uv: Vec2<R>) -> FragmentOut<R> {
            let zero = input.zero;
            let hidden = self.hidden.sample_level(uv, zero).x;
            FragmentOut::color(Vec4::new(zero, zero, zero, hidden))
        }
    }
}
