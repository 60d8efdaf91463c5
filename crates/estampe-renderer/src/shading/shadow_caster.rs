//! The shaders of what casts shadows: depths alone, of whole surfaces and of those with holes.

use super::pbr::textures::MaterialTexture;
use estampe::{FragmentIn, FragmentOut, Mat4, Vec2, Vec3, Vec4, VertexIn, VertexOut};

/// Depths of a whole surface.
#[derive(Debug, Clone)]
pub struct Caster {
    pub clip_from_unit: Mat4,
}

estampe::shader! {
    impl Shader for Caster {
        type Attributes<R: Real> = Vec3<R>; // position
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(&self, _input: VertexIn<'_, R>, position: Vec3<R>) -> VertexOut<R, ()> {
            VertexOut::new(self.clip_from_unit.transform_point(position), ())
        }

        fn fragment<R: Real>(&self, _input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
            FragmentOut::none()
        }
    }
}

/// Depths of a surface where its alpha is not below the cutoff.
#[derive(Debug, Clone)]
pub struct CutOutCaster {
    pub clip_from_unit: Mat4,
    pub cut_out: CutOut,
}

/// The alpha of a surface with holes: that of the factor, the texture and the vertex colour,
/// multiplied.
#[derive(Debug, Clone)]
pub struct CutOut {
    pub factor: f32,
    pub texture: Option<MaterialTexture>,
    pub cutoff: f32,
}

estampe::shader! {
    impl Shader for CutOutCaster {
        // Position, both texture coordinates, colour.
        type Attributes<R: Real> = (Vec3<R>, (Vec2<R>, Vec2<R>), Vec4<R>);
        type Varyings<R: Real> = ((Vec2<R>, Vec2<R>), R);

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, uvs, color): (Vec3<R>, (Vec2<R>, Vec2<R>), Vec4<R>),
        ) -> VertexOut<R, ((Vec2<R>, Vec2<R>), R)> {
            VertexOut::new(self.clip_from_unit.transform_point(position), (uvs, color.w))
        }

        fn fragment<R: Real>(
            &self,
            _input: FragmentIn<'_, R>,
            (uvs, alpha): ((Vec2<R>, Vec2<R>), R),
        ) -> FragmentOut<R> {
            let mut alpha = alpha * self.cut_out.factor;
            if let Some(texture) = &self.cut_out.texture {
                alpha *= texture.sample(uvs).w;
            }
            FragmentOut::none().discard_unless(alpha.ge(self.cut_out.cutoff))
        }
    }
}
