//! `small_tris`: a bumpy sphere of 998,000 triangles, most smaller than a pixel, Gouraud shading,
//! back faces culled.
//!
//! It has 1000 meridians and 500 parallels; the radius is 1 + 0.05·sin(8θ)·sin(6φ) in turns. The
//! uniform is the matrix from object to clip space.

use super::{ASPECT, Detail, Scene, uniforms, vertex_layout};
use crate::generate::{LittleEndian, Matrix, look_at, perspective, sin_cos_turns, uv_sphere};
use estampe::state::{CullMode, PrimitiveState};
use estampe::{
    FragmentIn, FragmentOut, Mat4, RenderPipelineDescriptor, Vec3, Vec4, VertexFormat, VertexIn,
    VertexOut,
};

/// Outputs interpolated vertex colours of a model in perspective.
struct Gouraud {
    clip_from_object: Mat4,
}

estampe::shader! {
    impl Shader for Gouraud {
        type Attributes<R: Real> = (Vec3<R>, Vec4<R>); // position, colour
        type Varyings<R: Real> = Vec4<R>;              // colour

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, color): (Vec3<R>, Vec4<R>),
        ) -> VertexOut<R, Vec4<R>> {
            VertexOut::new(self.clip_from_object.transform_point(position), color)
        }

        fn fragment<R: Real>(&self, _input: FragmentIn<'_, R>, color: Vec4<R>) -> FragmentOut<R> {
            FragmentOut::color(color)
        }
    }
}

pub(super) fn scene(detail: Detail) -> Scene {
    let (meridians, parallels) = detail.of((1000, 500), (100, 50));
    let mesh = uv_sphere(meridians, parallels, |theta, phi| {
        let (bump_theta, _) = sin_cos_turns(8.0 * theta);
        let (bump_phi, _) = sin_cos_turns(6.0 * phi);
        1.0 + 0.05 * bump_theta * bump_phi
    });
    let clip_from_view = perspective(0.125, ASPECT, 0.1, 10.0);
    let view_from_world = look_at([0.0, 0.0, 3.0], [0.0; 3], [0.0, 1.0, 0.0]);
    let world_from_object = Matrix::rotation_x(0.07).times(&Matrix::rotation_y(0.03));
    let clip_from_object = clip_from_view.times(&view_from_world.times(&world_from_object));
    let mut uniform_bytes = LittleEndian::default();
    uniform_bytes.matrix(&clip_from_object);
    let uniform_bytes = uniform_bytes.into_bytes();

    let shader = Gouraud {
        clip_from_object: uniforms::matrix(&uniform_bytes, 0),
    };
    let pipeline = RenderPipelineDescriptor {
        vertex_buffers: vec![vertex_layout(
            28,
            &[(VertexFormat::Float32x3, 0), (VertexFormat::Unorm8x4, 24)],
        )],
        primitive: PrimitiveState {
            cull_mode: CullMode::Back,
            ..PrimitiveState::default()
        },
        ..RenderPipelineDescriptor::new(shader)
    };
    let buffers = vec![mesh.vertices, mesh.indices, uniform_bytes];
    Scene::of_one_draw("small_tris", buffers, Vec::new(), pipeline)
}
