//! A number of the shader's value is the same for all lanes: `input.real` repeats it.

use estampe::{Vec2, Vec3, Vec4, FragmentIn, FragmentOut, VertexIn, VertexOut};

struct Tint {
    scale: f32,
}

estampe::shader! {
    impl Shader for Tint {
        type Attributes<R: Real> = Vec2<R>;
        type Varyings<R: Real> = Vec3<R>;

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, at: Vec2<R>) -> VertexOut<R, Vec3<R>> {
            let _ = &input;
            VertexOut::new(Vec4::new(at.x, at.y, at.x.splat(0.0), at.x.splat(1.0)), at.extend(at.x))
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, color: Vec3<R>) -> FragmentOut<R> {
            let _ = &input;
            FragmentOut::color(Vec4::new(color.x, color.y, color.z, self.scale))
        }
    }
}

fn main() {}
