//! `quad_draws`: 10,000 draws of a small quad, each with a position and colour in one uniform
//! buffer: the cost of a draw. It is not in `peerbench`.
//!
//! Quad n is in column n mod 100 and row n / 100 of a grid over the frame, with random depth and
//! size. The uniforms are the matrix from object to clip space and the colour, 80 bytes at a stride
//! of 256. A vertex is its position (2 floats).

use super::{Detail, Scene, SceneDraw, vertex_layout};
use crate::generate::{LittleEndian, Matrix, QUAD_CORNERS, quad_indices, unit_hash};
use estampe::{
    FragmentIn, FragmentOut, RenderPipelineDescriptor, Vec2, Vec3, Vec4, VertexFormat, VertexIn,
    VertexOut,
};

/// Bytes between the uniforms of consecutive draws.
const UNIFORM_STRIDE: u32 = 256;
/// Offset of the colour in the uniforms, in bytes.
const COLOR_OFFSET: u32 = 64;

/// Outputs the colour of the draw's uniforms.
struct BoundColor;

estampe::shader! {
    impl Shader for BoundColor {
        type Attributes<R: Real> = Vec2<R>; // position
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, position: Vec2<R>) -> VertexOut<R, ()> {
            let clip_from_object = input.bindings.mat4(0, 0, 0);
            let position = Vec3::new(position.x, position.y, input.real(0.0));
            VertexOut::new(clip_from_object.transform_point(position), ())
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
            let color: [f32; 4] = input.bindings.f32s(0, 0, COLOR_OFFSET);
            FragmentOut::color(Vec4::uniform(input.zero, color))
        }
    }
}

pub(super) fn scene(detail: Detail) -> Scene {
    let side = detail.of(100, 10);
    let mut corners = LittleEndian::default();
    for corner in QUAD_CORNERS {
        corners.reals(&corner);
    }
    let mut uniforms = LittleEndian::default();
    for number in 0..side * side {
        let random = |k: u32| unit_hash(9000 + 4 * number + k);
        let center = |index: u32| (f64::from(index) + 0.5) / f64::from(side) * 2.0 - 1.0;
        let place = [center(number % side), center(number / side), random(0)];
        let size = Matrix::scaling((0.5 + 0.5 * random(1)) / f64::from(side));
        uniforms.matrix(&Matrix::translation(place).times(&size));
        uniforms.reals(&[1, 2, 3].map(|k| 0.2 + 0.8 * random(k)));
        uniforms.reals(&[1.0]);
        uniforms.pad_to((number + 1) * UNIFORM_STRIDE);
    }
    let pipeline = RenderPipelineDescriptor {
        vertex_buffers: vec![vertex_layout(8, &[(VertexFormat::Float32x2, 0)])],
        ..RenderPipelineDescriptor::new(BoundColor)
    };
    let buffers = vec![corners.into_bytes(), quad_indices(1), uniforms.into_bytes()];
    let draws = (0..side * side).map(|number| SceneDraw {
        dynamic_offset: number * UNIFORM_STRIDE,
        ..SceneDraw::new(0, 0, 1)
    });
    Scene {
        uniforms: Some(2),
        draws: draws.collect(),
        ..Scene::of_one_draw("quad_draws", buffers, Vec::new(), pipeline)
    }
}
