//! The shaders of surfaces.
//!
//! There are three: plain surfaces lit at their fragments or at their vertices, and surfaces with a
//! texture or vertex colours, with either lighting in one shader. Separate shaders would be a
//! little clearer, but each shader that samples a texture compiles the sampler at all SIMD levels
//! again, which takes a minute.

use super::phong::PhongLight;
use super::vertex_lit::{self, BothSides, VertexLight};
use estampe::SampledTexture;
use estampe::{FragmentIn, FragmentOut, Vec2, Vec3, Vec4, VertexIn, VertexOut};

/// A surface of one colour, lit at every fragment.
#[derive(Debug, Clone)]
pub(crate) struct PlainPhong {
    pub(crate) light: PhongLight,
    /// Linear RGBA.
    pub(crate) color: [f32; 4],
}

estampe::shader! {
    impl Shader for PlainPhong {
        type Attributes<R: Real> = (Vec3<R>, Vec3<R>); // position, normal
        type Varyings<R: Real> = (Vec3<R>, Vec3<R>); // view position, normal

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, normal): (Vec3<R>, Vec3<R>),
        ) -> VertexOut<R, (Vec3<R>, Vec3<R>)> {
            let transforms = &self.light.transforms;
            let varyings = (transforms.view(position), transforms.normal(normal));
            VertexOut::new(transforms.clip(position), varyings)
        }

        fn fragment<R: Real>(
            &self,
            input: FragmentIn<'_, R>,
            (view, normal): (Vec3<R>, Vec3<R>),
        ) -> FragmentOut<R> {
            let base = Vec4::uniform(input.zero, self.color);
            let color = self.light.color(base.xyz(), view, normal, input.front_facing);
            FragmentOut::color(color.extend(base.w))
        }
    }
}

/// A surface of one colour, lit at its vertices.
#[derive(Debug, Clone)]
pub(crate) struct PlainVertexLit {
    pub(crate) light: VertexLight,
    /// Linear RGBA.
    pub(crate) color: [f32; 4],
}

estampe::shader! {
    impl Shader for PlainVertexLit {
        type Attributes<R: Real> = (Vec3<R>, Vec3<R>); // position, normal
        type Varyings<R: Real> = BothSides<R>;

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, normal): (Vec3<R>, Vec3<R>),
        ) -> VertexOut<R, BothSides<R>> {
            let sides = self.light.both_sides(position, normal);
            VertexOut::new(self.light.transforms.clip(position), sides)
        }

        fn fragment<R: Real>(
            &self,
            input: FragmentIn<'_, R>,
            sides: BothSides<R>,
        ) -> FragmentOut<R> {
            let base = Vec4::uniform(input.zero, self.color);
            let color = vertex_lit::color(base.xyz(), sides, input.front_facing);
            FragmentOut::color(color.extend(base.w))
        }
    }
}

/// A surface with a texture or vertex colours.
#[derive(Debug, Clone)]
pub(crate) struct Painted {
    pub(crate) light: SurfaceLight,
    /// Linear RGBA, multiplied by the texture and the vertex colour.
    pub(crate) factor: [f32; 4],
    /// The base-colour texture.
    pub(crate) texture: Option<SampledTexture>,
    /// Use of alpha.
    pub(crate) alpha: Alpha,
}

/// Lighting of a surface.
#[derive(Debug, Clone)]
pub(crate) enum SurfaceLight {
    /// At every fragment.
    Fragments(PhongLight),
    /// At the vertices.
    Vertices(VertexLight),
}

/// Use of the texture's and the vertices' alpha.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Alpha {
    /// Alpha is 1.
    Ignored,
    /// Fragments below ½ are discarded.
    CutsOut,
    /// Alpha is written with the colour.
    Kept,
}

estampe::shader! {
    impl Shader for Painted {
        type Attributes<R: Real> = (Vec3<R>, Vec3<R>, Vec2<R>, Vec4<R>); // position, normal, uv, color
        // Vertex lighting uses all four values; fragment lighting uses two of them, for the view
        // position and the normal.
        type Varyings<R: Real> = (BothSides<R>, Vec2<R>, Vec4<R>);

        fn vertex<R: Real>(
            &self,
            input: VertexIn<'_, R>,
            (position, normal, uv, color): (Vec3<R>, Vec3<R>, Vec2<R>, Vec4<R>),
        ) -> VertexOut<R, (BothSides<R>, Vec2<R>, Vec4<R>)> {
            let (transforms, lit) = match &self.light {
                SurfaceLight::Fragments(light) => {
                    let transforms = &light.transforms;
                    let none = Vec3::repeat(input.zero);
                    let (view, normal) = (transforms.view(position), transforms.normal(normal));
                    (transforms, (view, normal, none, none))
                }
                SurfaceLight::Vertices(light) => {
                    (&light.transforms, light.both_sides(position, normal))
                }
            };
            VertexOut::new(transforms.clip(position), (lit, uv, color))
        }

        fn fragment<R: Real>(
            &self,
            input: FragmentIn<'_, R>,
            (lit, uv, color): (BothSides<R>, Vec2<R>, Vec4<R>),
        ) -> FragmentOut<R> {
            let mut base = color * Vec4::uniform(input.zero, self.factor);
            if let Some(texture) = &self.texture {
                base *= texture.sample(uv);
            }
            if self.alpha == Alpha::Ignored {
                base.w = input.real(1.0);
            }
            let color = match &self.light {
                SurfaceLight::Fragments(light) => {
                    light.color(base.xyz(), lit.0, lit.1, input.front_facing)
                }
                SurfaceLight::Vertices(_) => {
                    vertex_lit::color(base.xyz(), lit, input.front_facing)
                }
            };
            let out = FragmentOut::color(color.extend(base.w));
            if self.alpha == Alpha::CutsOut {
                out.discard_unless(base.w.ge(input.real(0.5)))
            } else {
                out
            }
        }
    }
}
