//! Shaders whose colour comes from the vertices or from uniforms, and points of any size.

use super::bytes_of;
use estampe_types::shader::VertexOut;
use estampe_types::{Flat, FragmentIn, FragmentOut, Vec4, VertexIn};

/// The colour is a smooth varying: colour passthrough.
#[derive(Debug, Clone, Copy)]
pub struct Colored;

estampe_types::shader! {
    impl Shader for Colored {
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
            FragmentOut::color(color)
        }
    }
}

/// The colour is half of a smooth varying, with its components reversed on back faces; it takes no
/// derivatives.
#[derive(Debug, Clone, Copy)]
pub struct Halved;

estampe_types::shader! {
    impl Shader for Halved {
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
            let color = color * input.real(0.5);
            let turned = Vec4::new(color.w, color.z, color.y, color.x);
            FragmentOut::color(Vec4::select(input.front_facing, color, turned))
        }
    }
}

/// The colour is the provoking vertex's: flat over the primitive.
#[derive(Debug, Clone, Copy)]
pub struct FlatColored;

estampe_types::shader! {
    impl Shader for FlatColored {
        type Attributes<R: Real> = (Vec4<R>, Vec4<R>);
        type Varyings<R: Real> = Flat<Vec4<R>>;

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, color): (Vec4<R>, Vec4<R>),
        ) -> VertexOut<R, Flat<Vec4<R>>> {
            VertexOut::new(position, Flat(color))
        }

        fn fragment<R: Real>(
            &self,
            input: FragmentIn<'_, R>,
            Flat(color): Flat<Vec4<R>>,
        ) -> FragmentOut<R> {
            let back = bytes_of(color.x);
            FragmentOut::color(Vec4::select(input.front_facing, color, back))
        }
    }
}

/// The colour is that of group 0, binding 0, at byte 0 for front faces and at byte 16 for back
/// faces; there are no varyings.
#[derive(Debug, Clone, Copy)]
pub struct Uniform;

estampe_types::shader! {
    impl Shader for Uniform {
        type Attributes<R: Real> = (Vec4<R>, Vec4<R>);
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, _values): (Vec4<R>, Vec4<R>),
        ) -> VertexOut<R, ()> {
            VertexOut::new(position, ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, _nothing: ()) -> FragmentOut<R> {
            let front = Vec4::uniform(input.zero, input.bindings.f32s::<4>(0, 0, 0));
            let back = Vec4::uniform(input.zero, input.bindings.f32s::<4>(0, 0, 16));
            FragmentOut::color(Vec4::select(input.front_facing, front, back))
        }
    }
}

/// Points whose size is this factor times the fourth value; `None` declares a size and writes none.
#[derive(Debug, Clone, Copy)]
pub struct Sized(pub Option<f32>);

estampe_types::shader! {
    impl Shader for Sized {
        type Attributes<R: Real> = (Vec4<R>, Vec4<R>);
        type Varyings<R: Real> = (Vec4<R>, Flat<[R; 1]>);

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, color): (Vec4<R>, Vec4<R>),
        ) -> VertexOut<R, Self::Varyings<R>> {
            let out = VertexOut::new(position, (color, Flat([color.z])));
            match self.0 {
                Some(factor) => out.with_point_size(color.w * factor),
                None => out,
            }
        }

        fn fragment<R: Real>(
            &self,
            _input: FragmentIn<'_, R>,
            (color, Flat([flat])): Self::Varyings<R>,
        ) -> FragmentOut<R> {
            let shown = bytes_of(color.x);
            FragmentOut::color(Vec4::new(shown.x, shown.y, flat, color.y))
        }
    }
}
