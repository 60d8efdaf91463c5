//! Shaders that show what the vertex stage was given.

use super::bytes_of_int;
use estampe_types::shader::VertexOut;
use estampe_types::{Flat, FragmentIn, FragmentOut, Vec2, Vec3, Vec4, VertexIn};

/// Adds a third attribute (an instance's, say) to the position, and shows the low bytes of the vertex and
/// instance index, and values.
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
            // A high byte is seen too: the indices may wrap.
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

/// Shows the bits of one of ten numbers of four attributes of 4, 2, 3 and 1 components; location 0 is the
/// position.
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
            // Integers, too, whatever number their bits would be.
            FragmentOut::color(bytes_of_int::<R>(shown.to_bits()))
        }
    }
}
