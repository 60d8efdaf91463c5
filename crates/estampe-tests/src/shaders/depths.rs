//! Shaders that discard and that write depth.

use estampe_types::shader::VertexOut;
use estampe_types::{FragmentIn, FragmentOut, Real, Vec4, VertexIn};

/// Discards stripes of the first value.
#[derive(Debug, Clone, Copy)]
pub struct Cutout;

estampe_types::shader! {
    impl Shader for Cutout {
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
            let kept = (color.x * 9.0).fract().gt(color.x.splat(0.4));
            FragmentOut::color(color).discard_unless(kept)
        }
    }
}

/// The depth that a shader writes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GivenDepth {
    /// The fourth value, which may lie anywhere.
    Value,
    /// The interpolated depth, scaled and shifted.
    Moved,
    /// None, although the shader declares one: the window position's z is used.
    Nothing,
}

#[inline(always)]
fn with_given_depth<R: Real>(
    given: GivenDepth,
    position: Vec4<R>,
    color: Vec4<R>,
) -> FragmentOut<R> {
    let out = FragmentOut::color(color);
    match given {
        GivenDepth::Value => out.with_depth(color.w),
        GivenDepth::Moved => out.with_depth(position.z * 0.75 + 0.125),
        GivenDepth::Nothing => out,
    }
}

/// Writes depth.
#[derive(Debug, Clone, Copy)]
pub struct DepthGiven(pub GivenDepth);

estampe_types::shader! {
    impl Shader for DepthGiven {
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
            with_given_depth(self.0, input.position, color)
        }
    }
}

/// Writes depth and discards stripes.
#[derive(Debug, Clone, Copy)]
pub struct CutoutDepth(pub GivenDepth);

estampe_types::shader! {
    impl Shader for CutoutDepth {
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
            let kept = (color.y * 5.0).fract().lt(color.x.splat(0.6));
            with_given_depth(self.0, input.position, color).discard_unless(kept)
        }
    }
}

/// Writes no colour: for a target with depth only.
#[derive(Debug, Clone, Copy)]
pub struct DepthOnly;

estampe_types::shader! {
    impl Shader for DepthOnly {
        type Attributes<R: Real> = (Vec4<R>, Vec4<R>);
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, _values): (Vec4<R>, Vec4<R>),
        ) -> VertexOut<R, ()> {
            VertexOut::new(position, ())
        }

        fn fragment<R: Real>(&self, _input: FragmentIn<'_, R>, _nothing: ()) -> FragmentOut<R> {
            FragmentOut::none()
        }
    }
}
