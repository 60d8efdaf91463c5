//! A shader has a vertex and a fragment function.

use estampe::{Vec4, VertexIn, VertexOut};

struct Half;

estampe::shader! {
    impl Shader for Half {
        type Attributes<R: Real> = ();
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, (): ()) -> VertexOut<R, ()> {
            VertexOut::new(Vec4::repeat(input.real(1.0)), ())
        }
    }
}

fn main() {}
