//! The base colour of a surface, its alpha and its bump map: one colour, or texture and vertex
//! colours.

use super::bump::BumpMap;
use estampe::{Attributes, FragmentIn, Real, SampledTexture, Varyings, Vec2, Vec4, WithGradient};

/// The base colour: a part of a [`Surface`](super::surface::Surface).
pub trait BaseColor: Send + Sync + 'static {
    /// What a vertex has for it. It is interpolated unchanged.
    type Values<R: Real>: Attributes<R> + Varyings<R> + Copy;

    /// Linear RGBA at a fragment.
    fn color<R: Real>(&self, input: &FragmentIn<'_, R>, values: Self::Values<R>) -> Vec4<R>;

    /// The bump map with its texture coordinates, if there is one.
    fn bump<R: Real>(&self, values: Self::Values<R>) -> Option<(&BumpMap, Vec2<R>)>;

    /// Use of the colour's alpha.
    fn alpha(&self) -> Alpha;
}

/// One colour: linear RGBA.
#[derive(Debug, Clone)]
pub struct Plain(pub [f32; 4]);

impl BaseColor for Plain {
    type Values<R: Real> = ();

    #[inline(always)]
    fn color<R: Real>(&self, input: &FragmentIn<'_, R>, (): ()) -> Vec4<R> {
        Vec4::uniform(input.zero, self.0)
    }

    #[inline(always)]
    fn bump<R: Real>(&self, (): ()) -> Option<(&BumpMap, Vec2<R>)> {
        None
    }

    #[inline(always)]
    fn alpha(&self) -> Alpha {
        Alpha::Kept
    }
}

/// Vertex colours, or a texture, or both, or one colour with a bump map.
#[derive(Debug, Clone)]
pub struct Painted {
    /// Linear RGBA, multiplied by the texture and the vertex colour.
    pub factor: [f32; 4],
    /// The base-colour texture.
    pub texture: Option<SampledTexture>,
    /// Heights that bend the normals of fragments.
    pub bump: Option<BumpMap>,
    /// Use of alpha.
    pub alpha: Alpha,
}

/// Use of the texture's and the vertices' alpha.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Alpha {
    /// Alpha is 1.
    Ignored,
    /// Fragments below the cutoff are discarded, ½ if the material has none.
    CutsOut,
    /// As [`Self::CutsOut`], with smooth edges: so many samples of a pixel are covered in part.
    Covers(u16),
    /// Alpha is written with the colour.
    Kept,
}

impl Painted {
    /// True if something beside the texture takes derivatives: those of the bump map, or the alpha
    /// of a smooth edge.
    #[inline(always)]
    fn needs_quads(&self) -> bool {
        self.bump.is_some() || matches!(self.alpha, Alpha::Covers(_))
    }
}

impl BaseColor for Painted {
    type Values<R: Real> = (WithGradient<Vec2<R>>, Vec4<R>); // uv, color

    #[inline(always)]
    fn color<R: Real>(
        &self,
        input: &FragmentIn<'_, R>,
        (uv, color): (WithGradient<Vec2<R>>, Vec4<R>),
    ) -> Vec4<R> {
        let mut base = color * Vec4::uniform(input.zero, self.factor);
        if let Some(texture) = &self.texture {
            // Where quads are needed all the same, they cost less than derivatives of their own.
            base *= match self.needs_quads() {
                true => texture.sample(uv.value),
                false => texture.sample(uv),
            };
        }
        if self.alpha == Alpha::Ignored {
            base.w = input.real(1.0);
        }
        base
    }

    #[inline(always)]
    fn bump<R: Real>(
        &self,
        (uv, _): (WithGradient<Vec2<R>>, Vec4<R>),
    ) -> Option<(&BumpMap, Vec2<R>)> {
        self.bump.as_ref().map(|map| (map, uv.value))
    }

    #[inline(always)]
    fn alpha(&self) -> Alpha {
        self.alpha
    }
}
