//! `mid_tris`: a torus of 69,696 triangles, Blinn-Phong per fragment with a diffuse and a
//! tangent-space normal map, trilinear; back faces culled.
//!
//! The uniforms are two matrices (clip from object, world from object), the eye's position and the
//! direction towards the light, both in world space, four floats each.

use super::{ASPECT, Detail, Scene, uniforms, upload, vertex_layout};
use crate::generate::{
    LittleEndian, Matrix, Vector, diffuse_texture, look_at, normal_texture, normalize, perspective,
    torus,
};
use estampe::SampledTexture;
use estampe::state::{CullMode, MultisampleState, PrimitiveState};
use estampe::{
    FragmentIn, FragmentOut, Mat4, RenderPipelineDescriptor, Vec2, Vec3, Vec4, VertexFormat,
    VertexIn, VertexOut, WithGradient, maths,
};

/// The camera's position in world space; it looks at the origin.
pub(super) const EYE: [f64; 3] = [0.0, 2.0, 2.3];
/// Seed of both textures, so that bumps and colours agree.
pub(super) const NOISE_SEED: u32 = 11;

/// Blinn-Phong (Blinn 1977) with a normal map.
struct NormalMapped {
    clip_from_object: Mat4,
    world_from_object: Mat4,
    eye_world: [f32; 3],
    towards_light: [f32; 3],
    diffuse_map: SampledTexture,
    normal_map: SampledTexture,
}

estampe::shader! {
    impl Shader for NormalMapped {
        // Position, normal, tangent with handedness, texture coordinate.
        type Attributes<R: Real> = (Vec3<R>, Vec3<R>, Vec4<R>, Vec2<R>);
        // The same values in world space.
        type Varyings<R: Real> = (Vec3<R>, Vec3<R>, Vec4<R>, WithGradient<Vec2<R>>);

        fn vertex<R: Real>(
            &self,
            _input: VertexIn<'_, R>,
            (position, normal, tangent, uv): (Vec3<R>, Vec3<R>, Vec4<R>, Vec2<R>),
        ) -> VertexOut<R, (Vec3<R>, Vec3<R>, Vec4<R>, WithGradient<Vec2<R>>)> {
            let position_world = self.world_from_object.transform_point(position).xyz();
            let normal_world = self.world_from_object.transform_vector(normal);
            let tangent_world = self.world_from_object.transform_vector(tangent.xyz());
            VertexOut::new(
                self.clip_from_object.transform_point(position),
                (position_world, normal_world, tangent_world.extend(tangent.w), uv.into()),
            )
        }

        fn fragment<R: Real>(
            &self,
            input: FragmentIn<'_, R>,
            (position, normal, tangent, uv): (Vec3<R>, Vec3<R>, Vec4<R>, WithGradient<Vec2<R>>),
        ) -> FragmentOut<R> {
            let maps = [&self.diffuse_map, &self.normal_map];
            let [albedo, mapped] = SampledTexture::sample_all(maps, uv);
            let (albedo, mapped) = (albedo.xyz(), mapped.xyz());
            let (one, two) = (Vec3::repeat(input.real(1.0)), input.real(2.0));
            let bump = mapped * two - one;

            // Transform the mapped normal from tangent space to world space.
            let n = normal.normalize();
            let t = tangent.xyz().normalize();
            let b = n.cross(t) * tangent.w;
            let n = (t * bump.x + b * bump.y + n * bump.z).normalize();

            // Light it.
            let towards_light = Vec3::uniform(input.zero, self.towards_light);
            let towards_eye = (Vec3::uniform(input.zero, self.eye_world) - position).normalize();
            let half = (towards_light + towards_eye).normalize();
            let diffuse = n.dot(towards_light).max(input.zero) * 0.85 + 0.15;
            let specular = maths::powi(n.dot(half).max(input.zero), 32) * 0.5;
            FragmentOut::color((albedo * diffuse + Vec3::repeat(specular)).point())
        }
    }
}

pub(super) fn single_sampled(detail: Detail) -> Scene {
    scene("mid_tris", detail, 1)
}

pub(super) fn multisampled(detail: Detail) -> Scene {
    scene("msaa4", detail, 4)
}

fn scene(name: &'static str, detail: Detail, samples: u32) -> Scene {
    let (ring_cells, tube_cells) = detail.of((264, 132), (33, 16));
    let texture_size = detail.of(1024, 256);
    let mesh = torus(ring_cells, tube_cells);
    let mut uniform_bytes = LittleEndian::default();
    append_matrices(&mut uniform_bytes, &world_from_object());
    append_lighting(&mut uniform_bytes);
    let uniform_bytes = uniform_bytes.into_bytes();
    let diffuse = diffuse_texture(texture_size, NOISE_SEED);
    let normals = normal_texture(texture_size, NOISE_SEED);
    let shader = NormalMapped {
        clip_from_object: uniforms::matrix(&uniform_bytes, 0),
        world_from_object: uniforms::matrix(&uniform_bytes, 64),
        eye_world: uniforms::vector(&uniform_bytes, 128),
        towards_light: uniforms::vector(&uniform_bytes, 144),
        diffuse_map: upload::trilinear(&diffuse),
        normal_map: upload::trilinear(&normals),
    };
    let pipeline = RenderPipelineDescriptor {
        vertex_buffers: vec![vertex_layout(
            48,
            &[
                (VertexFormat::Float32x3, 0),
                (VertexFormat::Float32x3, 12),
                (VertexFormat::Float32x4, 24),
                (VertexFormat::Float32x2, 40),
            ],
        )],
        primitive: PrimitiveState {
            cull_mode: CullMode::Back,
            ..PrimitiveState::default()
        },
        multisample: MultisampleState::new(samples),
        ..RenderPipelineDescriptor::new(shader)
    };
    let buffers = vec![mesh.vertices, mesh.indices, uniform_bytes];
    Scene::of_one_draw(name, buffers, vec![diffuse, normals], pipeline)
}

/// The torus's position and rotation.
pub(super) fn world_from_object() -> Matrix {
    Matrix::rotation_x(0.06).times(&Matrix::rotation_y(0.1))
}

/// The unit direction towards the light, in world space.
pub(super) fn towards_light() -> Vector {
    normalize([0.5, 1.0, 0.3])
}

/// View from world and clip from view.
pub(super) fn camera() -> [Matrix; 2] {
    let view_from_world = look_at(EYE, [0.0; 3], [0.0, 1.0, 0.0]);
    [view_from_world, perspective(0.125, ASPECT, 0.1, 10.0)]
}

/// Appends clip from object and world from object: 128 bytes.
pub(super) fn append_matrices(bytes: &mut LittleEndian, world_from_object: &Matrix) {
    let [view_from_world, clip_from_view] = camera();
    let clip_from_world = clip_from_view.times(&view_from_world);
    bytes.matrix(&clip_from_world.times(world_from_object));
    bytes.matrix(world_from_object);
}

/// Appends eye and light: 32 bytes.
pub(super) fn append_lighting(bytes: &mut LittleEndian) {
    bytes.reals(&EYE);
    bytes.reals(&[1.0]);
    bytes.reals(&towards_light());
    bytes.reals(&[0.0]);
}
