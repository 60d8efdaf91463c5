//! A shader over any texture, so that each side brings its own sampling.

use super::bytes_of;
use estampe_types::shader::{Sample2d, VertexOut};
use estampe_types::{FragmentIn, FragmentOut, Vec2, Vec4, VertexIn};

/// A texture that a shader can own.
pub trait TexelSource: Sample2d + 'static {}
impl<T: Sample2d + 'static> TexelSource for T {}

/// The texture at the first two values; or the bits of one of its channels.
#[derive(Debug, Clone)]
pub struct Textured<T> {
    /// The texture.
    pub texels: T,
    /// Which channel shows its bits; `None` shows the colour.
    pub channel: Option<usize>,
}

estampe_types::shader! {
    impl<T: TexelSource> Shader for Textured<T> {
        type Attributes<R: Real> = (Vec4<R>, Vec4<R>);
        type Varyings<R: Real> = Vec2<R>;

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, values): (Vec4<R>, Vec4<R>),
        ) -> VertexOut<R, Vec2<R>> {
            VertexOut::new(position, Vec2::new(values.x, values.y))
        }

        fn fragment<R: Real>(&self, _input: FragmentIn<'_, R>, uv: Vec2<R>) -> FragmentOut<R> {
            let texel = self.texels.sample(uv);
            FragmentOut::color(match self.channel {
                None => texel,
                Some(0) => bytes_of(texel.x),
                Some(1) => bytes_of(texel.y),
                Some(2) => bytes_of(texel.z),
                Some(_) => bytes_of(texel.w),
            })
        }
    }
}
