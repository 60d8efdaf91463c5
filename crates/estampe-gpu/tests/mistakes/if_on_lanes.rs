//! An `if` takes one branch for all lanes: `R::select` chooses for each.

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
            if color.x.lt(0.5) {
                return FragmentOut::color(color.point());
            }
            FragmentOut::color(color.point())
        }
    }
}

fn main() {}
