//! A shader for rungs whose subject is not shading.

use crate::{Corner, Course};
use estampe::{FragmentIn, FragmentOut, Mat4, Vec3, VertexIn, VertexOut};

/// Both sides of a pale blue surface, lit from [`Course::EYE`]: I = |n·e|, with the vertex's normal.
#[derive(Debug, Clone, Copy)]
pub struct Lit {
    /// Clip space of the positions.
    pub clip_from_world: Mat4,
}

estampe::shader! {
    impl Shader for Lit {
        type Attributes<R: Real> = Corner<R>;
        type Varyings<R: Real> = R; // intensity

        fn vertex<R: Real>(&self, _: VertexIn<'_, R>, a: Corner<R>) -> VertexOut<R, R> {
            let to_eye = (Vec3::from(Course::EYE) - a.position).normalize();
            let clip = self.clip_from_world.transform_point(a.position);
            VertexOut::new(clip, a.normal.dot(to_eye).abs())
        }

        fn fragment<R: Real>(&self, _: FragmentIn<'_, R>, intensity: R) -> FragmentOut<R> {
            FragmentOut::color((Vec3::new(0.55, 0.8, 1.0) * intensity).point())
        }
    }
}
