//! A shader over any texture type, so that the oracle and the fast path each use their own
//! sampling.

use super::bytes_of;
use estampe_reference::texture::ReferenceView;
use estampe_reference::{Counts, Draw, ReferenceTexture, State, Target};
use estampe_texture::{Rgba8Texture, SampledTexture, TexelView};
use estampe_types::shader::{Sample2d, VertexOut};
use estampe_types::{
    FragmentIn, FragmentOut, Program, SamplerDescriptor, ShaderProgram, TexelData, Vec2, Vec4,
    VertexIn,
};
use std::sync::Arc;

/// A texture that a shader can own.
pub trait TexelSource: Sample2d + 'static {}
impl<T: Sample2d + 'static> TexelSource for T {}

/// A 2D texture; the oracle and the fast path each sample it with their own code.
#[derive(Debug, Clone)]
pub struct TexturedShader {
    /// The texels.
    pub texture: Arc<TexelData>,
    /// The sampler.
    pub sampler: SamplerDescriptor,
    /// The channel whose bits are shown; `None` shows the colour.
    pub channel: Option<usize>,
    /// If set, the fast path samples a view (any format and sampler), not a [`Rgba8Texture`]
    /// texture.
    pub is_view: bool,
}

impl TexturedShader {
    pub(super) fn program(&self) -> Arc<dyn Program> {
        let channel = self.channel;
        if self.is_view {
            let view = TexelView::of(self.texture.clone()).expect("a texture of one image");
            let texels = SampledTexture::new(view, self.sampler).expect("a sampler that fits");
            return Arc::new(ShaderProgram::new(Textured { texels, channel }));
        }
        let texels = Rgba8Texture::new(self.texture.clone(), self.sampler);
        Arc::new(ShaderProgram::new(Textured { texels, channel }))
    }

    pub(super) fn draw_oracle(
        &self,
        target: &mut Target,
        state: &State,
        draw: &Draw<'_>,
    ) -> Counts {
        let (texture, sampler, channel) = (self.texture.clone(), self.sampler, self.channel);
        if self.is_view {
            let texels = ReferenceView::of_image(texture, sampler);
            return estampe_reference::draw(target, &Textured { texels, channel }, state, draw);
        }
        let texels = ReferenceTexture::new(texture, sampler);
        estampe_reference::draw(target, &Textured { texels, channel }, state, draw)
    }
}

/// Samples the texture at the first two values and shows the colour, or the bits of one channel.
#[derive(Debug, Clone)]
pub struct Textured<T> {
    /// The texture.
    pub texels: T,
    /// The channel whose bits are shown; `None` shows the colour.
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
