//! Shaders for several targets, integer targets, dual-source blending, limited depth outputs and
//! many varyings.

use super::bytes_of;
use estampe_types::shader::{DepthOutput, VertexOut};
use estampe_types::{FragmentIn, FragmentOut, Int, Real, Shader, Vec4, VertexIn};

/// Writes `N` targets, each with a different colour: integers, as bits, to the targets whose bit is
/// set; numbers to the others.
#[derive(Debug, Clone, Copy)]
pub struct Layers<const N: usize>(pub u8);

/// One target.
pub type Layers1 = Layers<1>;
/// Two targets.
pub type Layers2 = Layers<2>;
/// Four targets.
pub type Layers4 = Layers<4>;
/// Three targets.
pub type Layers3 = Layers<3>;
/// Eight targets, the greatest number.
pub type Layers8 = Layers<8>;

/// Integers around the ends of every format's range, computed from a number.
#[inline(always)]
fn integer<R: Real>(value: R) -> R {
    let near = (value * 300.0).to_int();
    let high = value.to_bits();
    let is_near = value.lt(value.splat(0.75));
    R::Int::select(is_near, near, high).to_real_bits()
}

impl<const N: usize> Shader for Layers<N> {
    type Attributes<R: Real> = (Vec4<R>, Vec4<R>);
    type Varyings<R: Real> = Vec4<R>;
    // The last of eight is not set.
    const COLOR_TARGETS: usize = N;

    #[inline(always)]
    fn vertex<R: Real>(
        &self,
        _input: VertexIn<'_, R>,
        (position, color): (Vec4<R>, Vec4<R>),
    ) -> VertexOut<R, Vec4<R>> {
        VertexOut::new(position, color)
    }

    #[inline(always)]
    fn fragment<R: Real>(&self, _input: FragmentIn<'_, R>, color: Vec4<R>) -> FragmentOut<R> {
        let mut out = FragmentOut::none();
        let mut turned = color;
        for target in 0..N {
            turned = Vec4::new(turned.y, turned.z, turned.w * 1.25, turned.x);
            let given = if self.0 >> target & 1 == 1 {
                Vec4::new(
                    integer(turned.x),
                    integer(turned.y),
                    integer(turned.z),
                    integer(turned.w),
                )
            } else {
                turned
            };
            // No colour is set for the last of eight targets: zeros are stored.
            if target < 7 {
                out = out.with_color(target, given);
            }
        }
        out
    }
}

/// [`Layers`] that discards stripes of the first value.
#[derive(Debug, Clone, Copy)]
pub struct CutLayers<const N: usize>(pub u8);

/// One target.
pub type CutLayers1 = CutLayers<1>;
/// Two targets.
pub type CutLayers2 = CutLayers<2>;
/// Four targets.
pub type CutLayers4 = CutLayers<4>;

impl<const N: usize> Shader for CutLayers<N> {
    type Attributes<R: Real> = (Vec4<R>, Vec4<R>);
    type Varyings<R: Real> = Vec4<R>;
    // The last of eight is not set.
    const COLOR_TARGETS: usize = N;

    #[inline(always)]
    fn vertex<R: Real>(
        &self,
        _input: VertexIn<'_, R>,
        (position, color): (Vec4<R>, Vec4<R>),
    ) -> VertexOut<R, Vec4<R>> {
        VertexOut::new(position, color)
    }

    #[inline(always)]
    fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, color: Vec4<R>) -> FragmentOut<R> {
        let kept = (color.x * 5.0).fract().gt(color.x.splat(0.35));
        Layers::<N>(self.0)
            .fragment(input, color)
            .discard_unless(kept)
    }
}

/// Two colours for one target: dual-source blending.
#[derive(Debug, Clone, Copy)]
pub struct TwoColors;

estampe_types::shader! {
    impl Shader for TwoColors {
        type Attributes<R: Real> = (Vec4<R>, Vec4<R>);
        type Varyings<R: Real> = Vec4<R>;

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, color): (Vec4<R>, Vec4<R>),
        ) -> VertexOut<R, Vec4<R>> {
            VertexOut::new(position, color)
        }

        fn fragment<R: Real>(&self, _input: FragmentIn<'_, R>, color: Vec4<R>) -> FragmentOut<R> {
            let second = Vec4::new(color.w, color.x * 2.0 - 0.5, color.y, color.z);
            FragmentOut::color(color).with_second_color(second)
        }
    }
}

/// Declares depths that are not below (`true`) or not above (`false`) the interpolated one, and
/// writes depths on both sides of it, which must be clamped.
#[derive(Debug, Clone, Copy)]
pub struct HeldDepth<const GREATER: bool>;

/// Declared to be greater.
pub type GreaterDepth = HeldDepth<true>;
/// Declared to be less.
pub type LessDepth = HeldDepth<false>;

impl<const GREATER: bool> Shader for HeldDepth<GREATER> {
    type Attributes<R: Real> = (Vec4<R>, Vec4<R>);
    type Varyings<R: Real> = Vec4<R>;
    const DEPTH_OUTPUT: DepthOutput = if GREATER {
        DepthOutput::Greater
    } else {
        DepthOutput::Less
    };

    #[inline(always)]
    fn vertex<R: Real>(
        &self,
        _input: VertexIn<'_, R>,
        (position, color): (Vec4<R>, Vec4<R>),
    ) -> VertexOut<R, Vec4<R>> {
        VertexOut::new(position, color)
    }

    #[inline(always)]
    fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, color: Vec4<R>) -> FragmentOut<R> {
        let z = input.position.z;
        FragmentOut::color(bytes_of(z)).with_depth(z + (color.x - 0.5) * 0.5)
    }
}

/// Writes logarithmic depth, log₂(1 + w) ÷ log₂(1 + far); the field is far.
#[derive(Debug, Clone, Copy)]
pub struct LogarithmicDepth(pub f32);

estampe_types::shader! {
    impl Shader for LogarithmicDepth {
        type Attributes<R: Real> = (Vec4<R>, Vec4<R>);
        type Varyings<R: Real> = Vec4<R>;

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, color): (Vec4<R>, Vec4<R>),
        ) -> VertexOut<R, Vec4<R>> {
            VertexOut::new(position, color)
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, color: Vec4<R>) -> FragmentOut<R> {
            let one = input.real(1.0);
            let w = one / input.position.w;
            let scale = one / estampe_types::maths::log2(input.real(1.0 + self.0));
            let depth = estampe_types::maths::log2(w + 1.0) * scale;
            FragmentOut::color(color).with_depth(depth)
        }
    }
}

/// Four vectors of four numbers.
type Sixteen<R> = (Vec4<R>, Vec4<R>, Vec4<R>, Vec4<R>);

/// The greatest numbers of attributes and varyings: 16 of four numbers each. The first attribute is
/// the position.
#[derive(Debug, Clone, Copy)]
pub struct Crowded;

estampe_types::shader! {
    impl Shader for Crowded {
        type Attributes<R: Real> = (Sixteen<R>, Sixteen<R>, Sixteen<R>, Sixteen<R>);
        type Varyings<R: Real> = (Sixteen<R>, Sixteen<R>, Sixteen<R>, Sixteen<R>);

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            attributes: Self::Attributes<R>,
        ) -> VertexOut<R, Self::Varyings<R>> {
            VertexOut::new(attributes.0.0, attributes)
        }

        fn fragment<R: Real>(
            &self,
            input: FragmentIn<'_, R>,
            (a, b, c, d): Self::Varyings<R>,
        ) -> FragmentOut<R> {
            let half = input.real(0.5);
            let mix = |v: Sixteen<R>| ((v.3 * half + v.2) * half + v.1) * half + v.0;
            FragmentOut::color(((mix(d) * half + mix(c)) * half + mix(b)) * half + mix(a))
        }
    }
}
