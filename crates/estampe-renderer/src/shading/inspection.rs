//! Normals, depth, texture coordinates, faces, barycentric coordinates and overdraw as colours, for
//! inspection.
//!
//! These are numbers, not light: the target stores them without sRGB encoding.

use super::base_color::{BaseColor, Painted};
use super::{VertexTransforms, shading_normal};
use estampe::{
    Flat, FragmentIn, FragmentOut, Real, Vec2, Vec3, Vec4, VertexIn, VertexOut, WithGradient,
};

/// Unit shading normals in view space, (n + 1)/2: red to the right, green up, blue towards the eye.
#[derive(Debug, Clone)]
pub struct Normals {
    pub transforms: VertexTransforms,
}

estampe::shader! {
    impl Shader for Normals {
        type Attributes<R: Real> = (Vec3<R>, Vec3<R>); // position, normal
        type Varyings<R: Real> = (Vec3<R>, Vec3<R>);

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, normal): (Vec3<R>, Vec3<R>),
        ) -> VertexOut<R, (Vec3<R>, Vec3<R>)> {
            let view = self.transforms.view(position);
            VertexOut::new(self.transforms.clip(position), (view, self.transforms.normal(normal)))
        }

        fn fragment<R: Real>(
            &self,
            input: FragmentIn<'_, R>,
            (view, normal): (Vec3<R>, Vec3<R>),
        ) -> FragmentOut<R> {
            let to_eye = self.transforms.eye_direction(view);
            let normal = shading_normal(normal, to_eye, input.front_facing);
            let half = Vec3::uniform(input.zero, [0.5; 3]);
            FragmentOut::color((normal * half + half).point())
        }
    }
}

/// Distance along the view direction: white at the model's nearest point, black at its furthest.
#[derive(Debug, Clone)]
pub struct DepthGrey {
    pub transforms: VertexTransforms,
    /// Distance of the nearest point.
    pub nearest: f32,
    /// Distance of the furthest point.
    pub furthest: f32,
}

estampe::shader! {
    impl Shader for DepthGrey {
        type Attributes<R: Real> = (Vec3<R>,); // position
        type Varyings<R: Real> = [R; 1];

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position,): (Vec3<R>,),
        ) -> VertexOut<R, [R; 1]> {
            let distance = -self.transforms.view(position).z;
            let grey = (-distance + self.furthest) / (self.furthest - self.nearest);
            VertexOut::new(self.transforms.clip(position), [grey])
        }

        fn fragment<R: Real>(&self, _input: FragmentIn<'_, R>, [grey]: [R; 1]) -> FragmentOut<R> {
            FragmentOut::color(Vec3::repeat(grey.saturate()).point())
        }
    }
}

/// Texture coordinates: u is red, v is green; outside 0..1 they repeat.
#[derive(Debug, Clone)]
pub struct UvColors {
    pub transforms: VertexTransforms,
}

estampe::shader! {
    impl Shader for UvColors {
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
            let color = Vec3::new(wrapped(uv.x), wrapped(uv.y), input.zero);
            FragmentOut::color(color.point())
        }
    }
}

/// A coordinate in 0..=1: unchanged if it is inside, else its fractional part.
#[inline(always)]
fn wrapped<R: Real>(coordinate: R) -> R {
    let is_inside = coordinate.ge(coordinate.splat(0.0)) & coordinate.le(coordinate.splat(1.0));
    R::select(is_inside, coordinate, coordinate.fract())
}

/// The colours of faces.
#[derive(Debug, Clone)]
pub struct FaceColors {
    pub transforms: VertexTransforms,
}

estampe::shader! {
    impl Shader for FaceColors {
        type Attributes<R: Real> = (Vec3<R>, Vec3<R>); // position, face
        type Varyings<R: Real> = (Flat<Vec3<R>>,);

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, face): (Vec3<R>, Vec3<R>),
        ) -> VertexOut<R, (Flat<Vec3<R>>,)> {
            VertexOut::new(self.transforms.clip(position), (Flat(face),))
        }

        fn fragment<R: Real>(
            &self,
            _input: FragmentIn<'_, R>,
            (Flat(face),): (Flat<Vec3<R>>,),
        ) -> FragmentOut<R> {
            FragmentOut::color(face.point())
        }
    }
}

/// The colours of faces that are cut out where the alpha of the base colour is below ½.
#[derive(Debug, Clone)]
pub struct CutOutFaceColors {
    pub transforms: VertexTransforms,
    pub base: Painted,
}

estampe::shader! {
    impl Shader for CutOutFaceColors {
        type Attributes<R: Real> = (Vec3<R>, Vec3<R>, Vec2<R>, Vec4<R>); // position, face, uv, color
        type Varyings<R: Real> = (Flat<Vec3<R>>, (WithGradient<Vec2<R>>, Vec4<R>));

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, face, uv, color): (Vec3<R>, Vec3<R>, Vec2<R>, Vec4<R>),
        ) -> VertexOut<R, (Flat<Vec3<R>>, (WithGradient<Vec2<R>>, Vec4<R>))> {
            VertexOut::new(self.transforms.clip(position), (Flat(face), (uv.into(), color)))
        }

        fn fragment<R: Real>(
            &self,
            input: FragmentIn<'_, R>,
            (Flat(face), painted): (Flat<Vec3<R>>, (WithGradient<Vec2<R>>, Vec4<R>)),
        ) -> FragmentOut<R> {
            let alpha = self.base.color(&input, painted).w;
            FragmentOut::color(face.point()).discard_unless(alpha.ge(input.real(0.5)))
        }
    }
}

/// Barycentric coordinates, perspective-correct: the share of the first corner is red, of the
/// second green, of the third blue.
#[derive(Debug, Clone)]
pub struct Barycentrics {
    pub transforms: VertexTransforms,
}

estampe::shader! {
    impl Shader for Barycentrics {
        type Attributes<R: Real> = (Vec3<R>, Vec3<R>); // position, corner
        type Varyings<R: Real> = Vec3<R>;

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, corner): (Vec3<R>, Vec3<R>),
        ) -> VertexOut<R, Vec3<R>> {
            VertexOut::new(self.transforms.clip(position), corner)
        }

        fn fragment<R: Real>(&self, _input: FragmentIn<'_, R>, shares: Vec3<R>) -> FragmentOut<R> {
            FragmentOut::color(shares.point())
        }
    }
}

/// One fragment of the count of fragments; the target adds them.
#[derive(Debug, Clone)]
pub struct Overdraw {
    pub transforms: VertexTransforms,
}

impl Overdraw {
    /// What a fragment adds to an 8-bit target: the codes 32, 8 and 1. Red is full at 8 fragments,
    /// green at 32, and blue counts up to 255.
    pub const ONE: [f32; 3] = [32.0 / 255.0, 8.0 / 255.0, 1.0 / 255.0];
}

estampe::shader! {
    impl Shader for Overdraw {
        type Attributes<R: Real> = (Vec3<R>,); // position
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position,): (Vec3<R>,),
        ) -> VertexOut<R, ()> {
            VertexOut::new(self.transforms.clip(position), ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
            FragmentOut::color(Vec3::uniform(input.zero, Self::ONE).point())
        }
    }
}
