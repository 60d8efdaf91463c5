//! Shaders that show the inputs of the vertex stage.

use super::bytes_of_int;
use estampe_types::shader::VertexOut;
use estampe_types::{Flat, FragmentIn, FragmentOut, Vec2, Vec3, Vec4, VertexIn};

/// Adds a third attribute (for example one stepped by instance) to the position. Shows the low
/// bytes of the vertex and the instance index, and a value.
#[derive(Debug, Clone, Copy)]
pub struct Indexed;

estampe_types::shader! {
    impl Shader for Indexed {
        type Attributes<R: Real> = (Vec4<R>, Vec4<R>, Vec4<R>);
        type Varyings<R: Real> = (Flat<Vec4<R>>, [R; 1]);

        fn vertex<R: Real>(
            &self,
            input: VertexIn<'_, R>,
            (position, values, shift): (Vec4<R>, Vec4<R>, Vec4<R>),
        ) -> VertexOut<R, Self::Varyings<R>> {
            let vertex = bytes_of_int::<R>(input.vertex_index);
            let instance = bytes_of_int::<R>(input.instance_index);
            // The highest byte is shown too, because indices may wrap.
            let shown = Vec4::new(vertex.x, vertex.y, instance.x, vertex.w);
            VertexOut::new(position + shift, (Flat(shown), [values.x]))
        }

        fn fragment<R: Real>(
            &self,
            _input: FragmentIn<'_, R>,
            (Flat(shown), [smooth]): Self::Varyings<R>,
        ) -> FragmentOut<R> {
            FragmentOut::color(Vec4::new(shown.x, shown.y, shown.z, (shown.w + smooth) * 0.5))
        }
    }
}

/// Shows the bits of one of ten numbers of four attributes with 4, 2, 3 and 1 components; location
/// 0 is the position.
#[derive(Debug, Clone, Copy)]
pub struct Formats(pub usize);

estampe_types::shader! {
    impl Shader for Formats {
        type Attributes<R: Real> = (Vec4<R>, Vec4<R>, Vec2<R>, Vec3<R>, [R; 1]);
        type Varyings<R: Real> = Flat<[R; 1]>;

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, four, two, three, [one]): Self::Attributes<R>,
        ) -> VertexOut<R, Flat<[R; 1]>> {
            let all = [
                four.x, four.y, four.z, four.w, two.x, two.y, three.x, three.y, three.z, one,
            ];
            VertexOut::new(position, Flat([all[self.0 % 10]]))
        }

        fn fragment<R: Real>(
            &self,
            _input: FragmentIn<'_, R>,
            Flat([shown]): Flat<[R; 1]>,
        ) -> FragmentOut<R> {
            // As integers: exact also if the bits are those of a NaN.
            FragmentOut::color(bytes_of_int::<R>(shown.to_bits()))
        }
    }
}
