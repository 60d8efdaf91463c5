//! A shader that outputs the bits of a varying's derivative.

use super::bytes_of;
use crate::Random;
use estampe_types::shader::VertexOut;
use estampe_types::{
    Centroid, Flat, FragmentIn, FragmentOut, NoPerspective, Vec2, Vec4, VertexIn, WithGradient,
};

/// What [`Gradients`] can show.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Slope {
    /// A smooth varying itself, whose derivatives are not shown.
    Value,
    /// The derivative in x of a smooth varying.
    SmoothX,
    /// The derivative in y of a smooth varying.
    SmoothY,
    /// The derivative in x of a varying that is linear in the window.
    LinearX,
    /// The derivative in y of a varying that is linear in the window.
    LinearY,
    /// The derivative in x of a flat varying.
    FlatX,
    /// Depth; derivatives are computed beside it.
    Depth,
}

impl Slope {
    /// Every value.
    pub const ALL: [Self; 7] = [
        Self::Value,
        Self::SmoothX,
        Self::SmoothY,
        Self::LinearX,
        Self::LinearY,
        Self::FlatX,
        Self::Depth,
    ];
}

/// Outputs the bits of a derivative that the primitive gives. No derivative is taken in quads.
#[derive(Debug, Clone, Copy)]
pub struct Gradients(pub Slope);

impl Gradients {
    /// A random derivative.
    pub fn random(random: &mut Random) -> Self {
        Self(random.pick(&Slope::ALL))
    }
}

estampe_types::shader! {
    impl Shader for Gradients {
        type Attributes<R: Real> = (Vec4<R>, Vec4<R>);
        type Varyings<R: Real> = (
            R,
            WithGradient<Vec2<R>>,
            NoPerspective<WithGradient<[R; 1]>>,
            Flat<WithGradient<[R; 1]>>,
        );

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, v): (Vec4<R>, Vec4<R>),
        ) -> VertexOut<R, Self::Varyings<R>> {
            let varyings = (
                v.w,
                Vec2::new(v.x, v.y).into(),
                NoPerspective([v.z].into()),
                Flat([v.w].into()),
            );
            VertexOut::new(position, varyings)
        }

        fn fragment<R: Real>(
            &self,
            input: FragmentIn<'_, R>,
            (before, smooth, NoPerspective(linear), Flat(flat)): Self::Varyings<R>,
        ) -> FragmentOut<R> {
            FragmentOut::color(bytes_of(match self.0 {
                Slope::Value => before,
                Slope::SmoothX => smooth.ddx.x,
                Slope::SmoothY => smooth.ddy.y,
                Slope::LinearX => linear.ddx[0],
                Slope::LinearY => linear.ddy[0],
                Slope::FlatX => flat.ddx[0],
                Slope::Depth => input.position.z,
            }))
        }
    }
}

/// [`Gradients`] of a varying that is evaluated at a covered position.
#[derive(Debug, Clone, Copy)]
pub struct CentroidGradients(pub Slope);

estampe_types::shader! {
    impl Shader for CentroidGradients {
        type Attributes<R: Real> = (Vec4<R>, Vec4<R>);
        type Varyings<R: Real> = (WithGradient<R>, Centroid<WithGradient<Vec2<R>>>);

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, v): (Vec4<R>, Vec4<R>),
        ) -> VertexOut<R, Self::Varyings<R>> {
            VertexOut::new(position, (v.w.into(), Centroid(Vec2::new(v.x, v.y).into())))
        }

        fn fragment<R: Real>(
            &self,
            _input: FragmentIn<'_, R>,
            (center, Centroid(centroid)): Self::Varyings<R>,
        ) -> FragmentOut<R> {
            FragmentOut::color(bytes_of(match self.0 {
                Slope::SmoothX => centroid.ddx.x,
                Slope::SmoothY => centroid.ddy.y,
                Slope::LinearY => center.ddy,
                _ => center.ddx,
            }))
        }
    }
}
