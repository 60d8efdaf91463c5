//! `instances`: 2,000 draws of a sphere of 500 triangles, Lambert per fragment, back faces culled;
//! each draw has a dynamic offset into one uniform buffer.
//!
//! Sphere n is in column n mod 50 and row n / 50 of a grid, with random depth, rotation and colour.
//! The uniforms are the matrix from object to clip space and the colour, 80 bytes at a stride of
//! 256.
//!
//! `many_draws`: each sphere as five draws of 100 triangles, with the same picture.

use super::{ASPECT, Detail, Scene, SceneDraw, vertex_layout};
use crate::generate::{LittleEndian, Matrix, look_at, perspective, unit_hash, uv_sphere};
use estampe::state::{CullMode, PrimitiveState};
use estampe::{
    FragmentIn, FragmentOut, RenderPipelineDescriptor, Vec3, VertexFormat, VertexIn, VertexOut,
};

/// Bytes between the uniforms of consecutive draws.
const UNIFORM_STRIDE: u32 = 256;
/// Offset of the colour in the uniforms, in bytes.
const COLOR_OFFSET: u32 = 64;
/// Direction towards the light, in object space: the spheres' normals are not rotated.
const TOWARDS_LIGHT: [f32; 3] = [0.48, 0.64, 0.6];

/// Lambert's cosine law with a colour from the draw's uniforms.
struct Lambert;

estampe::shader! {
    impl Shader for Lambert {
        type Attributes<R: Real> = (Vec3<R>, Vec3<R>); // position, normal
        type Varyings<R: Real> = Vec3<R>;              // normal

        fn vertex<R: Real>(
            &self,
            input: VertexIn<'_, R>,
            (position, normal): (Vec3<R>, Vec3<R>),
        ) -> VertexOut<R, Vec3<R>> {
            let clip_from_object = input.bindings.mat4(0, 0, 0);
            VertexOut::new(clip_from_object.transform_point(position), normal)
        }

        fn fragment<R: Real>(&self, input: FragmentIn<'_, R>, normal: Vec3<R>) -> FragmentOut<R> {
            let color: [f32; 3] = input.bindings.f32s(0, 0, COLOR_OFFSET);
            let light = normal.normalize().dot_uniform(TOWARDS_LIGHT).max(input.zero);
            let color = Vec3::uniform(input.zero, color) * (light * 0.75 + 0.25);
            FragmentOut::color(color.point())
        }
    }
}

pub(super) fn scene(detail: Detail) -> Scene {
    of_parts("instances", detail, 1)
}

pub(super) fn many_draws(detail: Detail) -> Scene {
    of_parts("many_draws", detail, 5)
}

/// The spheres, each in this many draws.
fn of_parts(name: &'static str, detail: Detail, parts: u32) -> Scene {
    let (columns, rows) = detail.of((50, 40), (10, 8));
    // Fewer spheres are larger and farther apart.
    let unit = detail.of(1.0, 5.0);
    let mesh = uv_sphere(25, 11, |_, _| 1.0);
    let clip_from_view = perspective(0.125, ASPECT, 0.1, 20.0);
    let view_from_world = look_at([0.0, 0.0, 10.0], [0.0; 3], [0.0, 1.0, 0.0]);
    let clip_from_world = clip_from_view.times(&view_from_world);

    let mut uniforms = LittleEndian::default();
    for number in 0..columns * rows {
        let random = |k: u32| unit_hash(5000 + 4 * number + k);
        let from_middle = |index: u32, count: u32| f64::from(index) - f64::from(count - 1) * 0.5;
        let place = Matrix::translation([
            from_middle(number % columns, columns) * (0.29 * unit),
            from_middle(number / columns, rows) * (0.205 * unit),
            (random(0) - 0.5) * 2.0,
        ]);
        let turned = Matrix::rotation_y(random(1)).times(&Matrix::scaling(0.16 * unit));
        let world_from_object = place.times(&turned);
        uniforms.matrix(&clip_from_world.times(&world_from_object));
        uniforms.reals(&[1, 2, 3].map(|k| 0.3 + 0.7 * random(k)));
        uniforms.reals(&[1.0]);
        uniforms.pad_to((number + 1) * UNIFORM_STRIDE);
    }
    let pipeline = RenderPipelineDescriptor {
        vertex_buffers: vec![vertex_layout(
            28,
            &[(VertexFormat::Float32x3, 0), (VertexFormat::Float32x3, 12)],
        )],
        primitive: PrimitiveState {
            cull_mode: CullMode::Back,
            ..PrimitiveState::default()
        },
        ..RenderPipelineDescriptor::new(Lambert)
    };
    let buffers = vec![mesh.vertices, mesh.indices, uniforms.into_bytes()];
    let scene = Scene {
        uniforms: Some(2),
        ..Scene::of_one_draw(name, buffers, Vec::new(), pipeline)
    }
    .cut_into(parts);
    let draws = (0..columns * rows).flat_map(|number| {
        let of_sphere = |part: &SceneDraw| SceneDraw {
            dynamic_offset: number * UNIFORM_STRIDE,
            ..*part
        };
        scene.draws.iter().map(of_sphere).collect::<Vec<_>>()
    });
    Scene {
        draws: draws.collect(),
        ..scene
    }
}
