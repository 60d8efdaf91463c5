//! A shader that outputs the bits of one of its inputs.

use super::bytes_of;
use crate::Random;
use estampe_types::shader::VertexOut;
use estampe_types::{Flat, FragmentIn, FragmentOut, NoPerspective, Vec2, Vec4, VertexIn};

/// The inputs that [`Probe`] can show.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scalar {
    /// A smooth varying.
    Smooth,
    /// A varying that is linear in the window.
    NoPerspective,
    /// The provoking vertex's value.
    Flat,
    /// Window x.
    X,
    /// Window y.
    Y,
    /// Depth.
    Z,
    /// 1/w.
    InverseW,
    /// Fine derivative of a smooth varying in x.
    Ddx,
    /// Fine derivative of a smooth varying in y.
    Ddy,
    /// Coarse derivative of a varying that is linear in the window.
    DdxCoarse,
    /// Coarse derivative of a varying that is linear in the window, in y.
    DdyCoarse,
    /// The derivative of depth in x.
    DepthSlope,
    /// 1 if the primitive is front facing, else 0.
    FrontFacing,
}

impl Scalar {
    /// Every input.
    pub const ALL: [Self; 13] = [
        Self::Smooth,
        Self::NoPerspective,
        Self::Flat,
        Self::X,
        Self::Y,
        Self::Z,
        Self::InverseW,
        Self::Ddx,
        Self::Ddy,
        Self::DdxCoarse,
        Self::DdyCoarse,
        Self::DepthSlope,
        Self::FrontFacing,
    ];
}

/// Outputs the bits of an input.
#[derive(Debug, Clone, Copy)]
pub struct Probe(pub Scalar);

impl Probe {
    /// Probes a random input.
    pub fn random(random: &mut Random) -> Self {
        Self(random.pick(&Scalar::ALL))
    }
}

estampe_types::shader! {
    impl Shader for Probe {
        type Attributes<R: Real> = (Vec4<R>, Vec4<R>);
        type Varyings<R: Real> = (Vec2<R>, NoPerspective<Vec2<R>>, Flat<[R; 1]>);

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, v): (Vec4<R>, Vec4<R>),
        ) -> VertexOut<R, Self::Varyings<R>> {
            let varyings = (
                Vec2::new(v.x, v.y),
                NoPerspective(Vec2::new(v.z, v.x)),
                Flat([v.w]),
            );
            VertexOut::new(position, varyings)
        }

        fn fragment<R: Real>(
            &self,
            input: FragmentIn<'_, R>,
            (smooth, NoPerspective(affine), Flat([flat])): Self::Varyings<R>,
        ) -> FragmentOut<R> {
            let p = input.position;
            FragmentOut::color(bytes_of(match self.0 {
                Scalar::Smooth => smooth.x,
                Scalar::NoPerspective => affine.x,
                Scalar::Flat => flat,
                Scalar::X => p.x,
                Scalar::Y => p.y,
                Scalar::Z => p.z,
                Scalar::InverseW => p.w,
                Scalar::Ddx => smooth.y.ddx(),
                Scalar::Ddy => smooth.x.ddy(),
                Scalar::DdxCoarse => affine.y.ddx_coarse(),
                Scalar::DdyCoarse => affine.x.ddy_coarse(),
                Scalar::DepthSlope => p.z.ddx(),
                Scalar::FrontFacing => R::select(input.front_facing, p.x.splat(1.0), p.x.splat(0.0)),
            }))
        }
    }
}
