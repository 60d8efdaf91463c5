//! What colour a surface has before light falls on it.

use crate::geometry::vertex_data::VertexStream;
use estampe::texture::Sampled;
use estampe::{Attributes, Real, Sample2d, Varyings, Vec2, Vec4};

/// Where the base colour comes from: attributes at the vertices, something carried to the fragments,
/// and linear RGBA there.
pub(crate) trait BaseColor: Send + Sync + 'static {
    /// Whether fragments whose alpha is below ½ are discarded.
    const MASKS: bool;
    /// The streams behind [`Self::Attributes`], in order.
    const STREAMS: &'static [VertexStream];
    /// What a vertex reads.
    type Attributes<R: Real>: Attributes<R>;
    /// What is interpolated.
    type Varyings<R: Real>: Varyings<R>;

    /// At a vertex.
    fn vertex<R: Real>(&self, attributes: Self::Attributes<R>) -> Self::Varyings<R>;
    /// At a fragment; `like` is any number. All lanes of a quad take part, for the derivatives.
    fn fragment<R: Real>(&self, varyings: Self::Varyings<R>, like: R) -> Vec4<R>;
}

/// One colour everywhere.
#[derive(Debug, Clone)]
pub(crate) struct OneColor(pub(crate) [f32; 4]);

impl BaseColor for OneColor {
    const MASKS: bool = false;
    const STREAMS: &'static [VertexStream] = &[];
    type Attributes<R: Real> = ();
    type Varyings<R: Real> = ();

    #[inline(always)]
    fn vertex<R: Real>(&self, (): ()) {}

    #[inline(always)]
    fn fragment<R: Real>(&self, (): (), like: R) -> Vec4<R> {
        Vec4::uniform(like, self.0)
    }
}

/// A factor times the texture, if there is one, times the vertex colour.
#[derive(Debug, Clone)]
pub(crate) struct Painted<const MASKS: bool> {
    /// Linear RGBA.
    pub(crate) factor: [f32; 4],
    /// The base-colour texture.
    pub(crate) texture: Option<Sampled>,
    /// Whether alpha is 1 whatever texture and vertices say.
    pub(crate) is_opaque: bool,
}

impl<const MASKS: bool> BaseColor for Painted<MASKS> {
    const MASKS: bool = MASKS;
    const STREAMS: &'static [VertexStream] = &[VertexStream::Uv, VertexStream::Color];
    type Attributes<R: Real> = (Vec2<R>, Vec4<R>);
    type Varyings<R: Real> = (Vec2<R>, Vec4<R>);

    #[inline(always)]
    fn vertex<R: Real>(&self, attributes: (Vec2<R>, Vec4<R>)) -> (Vec2<R>, Vec4<R>) {
        attributes
    }

    #[inline(always)]
    fn fragment<R: Real>(&self, (uv, color): (Vec2<R>, Vec4<R>), like: R) -> Vec4<R> {
        let mut rgba = color * Vec4::uniform(like, self.factor);
        if let Some(texture) = &self.texture {
            rgba = rgba * texture.sample(uv);
        }
        if self.is_opaque {
            rgba.w = like.splat(1.0);
        }
        rgba
    }
}
