//! Shaders with clip and cull distances.

use super::bytes_of;
use estampe_types::shader::VertexOut;
use estampe_types::{Flat, FragmentIn, FragmentOut, NoPerspective, Vec4, VertexIn};

/// The varyings from which the shown value is chosen.
type Shown<R> = (Vec4<R>, NoPerspective<[R; 1]>, Flat<[R; 1]>);

/// Two clip and two cull distances: the four values minus a shift. The colour has the bits of a
/// smooth, an affine or a flat varying, of depth, or of the facing.
#[derive(Debug, Clone, Copy)]
pub struct Distant {
    /// Subtracted from each value.
    pub shift: f32,
    /// The shown value: 0 smooth, 1 affine, 2 flat, 3 depth, 4 facing, else the fourth value.
    pub shown: u32,
}

estampe_types::shader! {
    impl Shader for Distant {
        type Attributes<R: Real> = (Vec4<R>, Vec4<R>);
        type Varyings<R: Real> = Shown<R>;

        fn vertex<R: Real>(
            &self,
            input: VertexIn<'_, R>,
            (position, v): (Vec4<R>, Vec4<R>),
        ) -> VertexOut<R, Shown<R>> {
            let shift = input.real(self.shift);
            VertexOut::new(position, (v, NoPerspective([v.x]), Flat([v.y])))
                .with_clip_distance(0, v.x - shift)
                .with_clip_distance(1, v.y - shift)
                .with_cull_distance(0, v.z - shift)
                .with_cull_distance(1, v.w - shift)
        }

        fn fragment<R: Real>(
            &self,
            input: FragmentIn<'_, R>,
            (smooth, NoPerspective([affine]), Flat([flat])): Shown<R>,
        ) -> FragmentOut<R> {
            let one = affine.splat(1.0);
            FragmentOut::color(bytes_of(match self.shown {
                0 => smooth.x,
                1 => affine,
                2 => flat,
                3 => input.position.z,
                4 => R::select(input.front_facing, one, one * 2.0),
                _ => smooth.w,
            }))
        }
    }
}

/// Eight clip and eight cull distances, mixtures of the values; point sizes. One distance is
/// declared and not written.
#[derive(Debug, Clone, Copy)]
pub struct ManyDistances(pub f32);

estampe_types::shader! {
    impl Shader for ManyDistances {
        type Attributes<R: Real> = (Vec4<R>, Vec4<R>);
        type Varyings<R: Real> = Vec4<R>;
        // The last is not set.
        const CLIP_DISTANCES: usize = 8;
        const CULL_DISTANCES: usize = 8;

        fn vertex<R: Real>(
            &self,
            input: VertexIn<'_, R>,
            (position, v): (Vec4<R>, Vec4<R>),
        ) -> VertexOut<R, Vec4<R>> {
            let shift = input.real(self.0);
            let mut out = VertexOut::new(position, v).with_point_size(v.x * 6.0);
            for k in 0..7 {
                let weight = 0.25 * k as f32;
                out = out
                    .with_clip_distance(k, v.x + v.y * weight + v.w * (1.5 - weight) - shift)
                    .with_cull_distance(k, v.z - v.y * weight + v.w * weight - shift);
            }
            out
        }

        fn fragment<R: Real>(&self, _input: FragmentIn<'_, R>, color: Vec4<R>) -> FragmentOut<R> {
            FragmentOut::color(color)
        }
    }
}
