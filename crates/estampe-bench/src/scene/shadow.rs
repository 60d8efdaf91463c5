//! `shadow`: the torus of `mid_tris` is drawn into a depth map of 2048² from the light; then torus
//! and ground are lit by Blinn-Phong, with shadows from 3×3 comparisons with the map.
//!
//! The ground is a quad of 8 × 8 units below the torus. The uniforms are three matrices (clip,
//! world and the light's clip space from object), the eye's position and the direction towards the
//! light: 224 bytes at a stride of 256, for the torus and for the ground.

use super::{DepthMap, Detail, Scene, SceneDraw, mid_tris, upload, vertex_layout};
use crate::generate::{
    LittleEndian, Matrix, diffuse_texture, look_at, orthographic, quad_indices, torus,
};
use estampe::state::{CullMode, PrimitiveState};
use estampe::{
    FragmentIn, FragmentOut, Real, RenderPipelineDescriptor, SampledTexture, Vec2, Vec3,
    VertexFormat, VertexIn, VertexOut, WithGradient, maths, sample_compare_sum,
};

/// Bytes between the torus's and the ground's uniforms.
const UNIFORM_STRIDE: u32 = 256;
const CLIP_FROM_OBJECT: u32 = 0;
const WORLD_FROM_OBJECT: u32 = 64;
const LIGHT_FROM_OBJECT: u32 = 128;
const EYE: u32 = 192;
const TOWARDS_LIGHT: u32 = 208;
/// The group and the binding of the depth map.
const DEPTH_MAP_GROUP: u32 = 1;
pub(crate) const DEPTH_MAP: u32 = 0;
/// The distance by which a fragment may be behind the map's depth and still be lit.
const DEPTH_BIAS: f32 = 0.004;

/// Writes depth as seen from the light.
struct LightDepth;

estampe::shader! {
    impl Shader for LightDepth {
        type Attributes<R: Real> = Vec3<R>; // position
        type Varyings<R: Real> = ();

        fn vertex<R: Real>(&self, input: VertexIn<'_, R>, position: Vec3<R>) -> VertexOut<R, ()> {
            let light_from_object = input.bindings.mat4(0, 0, LIGHT_FROM_OBJECT);
            VertexOut::new(light_from_object.transform_point(position), ())
        }

        fn fragment<R: Real>(&self, _input: FragmentIn<'_, R>, (): ()) -> FragmentOut<R> {
            FragmentOut::none()
        }
    }
}

/// Blinn-Phong (Blinn 1977) with a diffuse and a shadow map.
struct Shadowed {
    diffuse_map: SampledTexture,
    /// Offsets of the nine samples of the map, in (u, v), from the middle one.
    taps: [[f32; 2]; 9],
}

estampe::shader! {
    impl Shader for Shadowed {
        type Attributes<R: Real> = (Vec3<R>, Vec3<R>, Vec2<R>); // position, normal, texture coordinate
        // Position and normal in world space, texture coordinate, (u, v) in the map and depth.
        type Varyings<R: Real> = (Vec3<R>, Vec3<R>, WithGradient<Vec2<R>>, Vec3<R>);

        fn vertex<R: Real>(
            &self,
            input: VertexIn<'_, R>,
            (position, normal, uv): (Vec3<R>, Vec3<R>, Vec2<R>),
        ) -> VertexOut<R, (Vec3<R>, Vec3<R>, WithGradient<Vec2<R>>, Vec3<R>)> {
            let matrix = |offset: u32| input.bindings.mat4(0, 0, offset);
            let world_from_object = matrix(WORLD_FROM_OBJECT);
            let position_world = world_from_object.transform_point(position).xyz();
            let normal_world = world_from_object.transform_vector(normal);
            // The light's projection is orthographic: w is 1.
            let in_light = matrix(LIGHT_FROM_OBJECT).transform_point(position);
            let in_map = Vec3::new(
                in_light.x * 0.5 + 0.5,
                input.real(0.5) - in_light.y * 0.5,
                in_light.z,
            );
            VertexOut::new(
                matrix(CLIP_FROM_OBJECT).transform_point(position),
                (position_world, normal_world, uv.into(), in_map),
            )
        }

        fn fragment<R: Real>(
            &self,
            input: FragmentIn<'_, R>,
            (position, normal, uv, in_map): (Vec3<R>, Vec3<R>, WithGradient<Vec2<R>>, Vec3<R>),
        ) -> FragmentOut<R> {
            let albedo = self.diffuse_map.sample(uv).xyz();
            let n = normal.normalize();
            let towards_light = bound_vector(&input, TOWARDS_LIGHT);
            let towards_eye = (bound_vector(&input, EYE) - position).normalize();
            let half = (towards_light + towards_eye).normalize();

            let lit = match input.bindings.shadow_map(DEPTH_MAP_GROUP, DEPTH_MAP) {
                Some(map) => {
                    let (at, reference) = (Vec2::new(in_map.x, in_map.y), in_map.z - DEPTH_BIAS);
                    sample_compare_sum(map, at, &self.taps, reference) * (1.0 / 9.0)
                }
                None => input.zero,
            };
            // Outside the map nothing is in shadow.
            let (zero, one) = (input.zero, input.real(1.0));
            let before = in_map.x.lt(zero) | in_map.y.lt(zero);
            let beyond = in_map.x.gt(one) | in_map.y.gt(one);
            let lit = R::select(before | beyond, one, lit);

            let diffuse = n.dot(towards_light).max(zero) * lit * 0.85 + 0.15;
            let specular = maths::powi(n.dot(half).max(zero), 32) * 0.5 * lit;
            FragmentOut::color((albedo * diffuse + Vec3::repeat(specular)).point())
        }
    }
}

/// A vector in the draw's uniforms, at an offset in bytes.
#[inline(always)]
fn bound_vector<R: Real>(input: &FragmentIn<'_, R>, offset: u32) -> Vec3<R> {
    Vec3::uniform(input.zero, input.bindings.f32s::<3>(0, 0, offset))
}

pub(super) fn scene(detail: Detail) -> Scene {
    let (ring_cells, tube_cells) = detail.of((264, 132), (33, 16));
    let map_size = detail.of(2048, 256);
    let mesh = torus(ring_cells, tube_cells);
    let diffuse = diffuse_texture(detail.of(1024, 256), mid_tris::NOISE_SEED);
    let texel = 1.0 / map_size as f32;
    let mut taps = [[0.0; 2]; 9];
    for (index, tap) in taps.iter_mut().enumerate() {
        *tap = [index % 3, index / 3].map(|step| (step as f32 - 1.0) * texel);
    }
    let shader = Shadowed {
        diffuse_map: upload::trilinear(&diffuse),
        taps,
    };
    let layout = |attributes: &[(VertexFormat, u32)]| vec![vertex_layout(48, attributes)];
    let primitive = PrimitiveState {
        cull_mode: CullMode::Back,
        ..PrimitiveState::default()
    };
    let depth_pipeline = RenderPipelineDescriptor {
        vertex_buffers: layout(&[(VertexFormat::Float32x3, 0)]),
        primitive,
        targets: Vec::new(),
        ..RenderPipelineDescriptor::new(LightDepth)
    };
    let lit_pipeline = RenderPipelineDescriptor {
        vertex_buffers: layout(&[
            (VertexFormat::Float32x3, 0),
            (VertexFormat::Float32x3, 12),
            (VertexFormat::Float32x2, 40),
        ]),
        primitive,
        ..RenderPipelineDescriptor::new(shader)
    };
    Scene {
        name: "shadow",
        buffers: vec![
            mesh.vertices,
            mesh.indices,
            ground_vertices(),
            quad_indices(1),
            uniform_bytes(),
        ],
        textures: vec![diffuse],
        samples: 1,
        pipelines: vec![depth_pipeline, lit_pipeline],
        uniforms: Some(4),
        depth_map: Some(DepthMap {
            size: map_size,
            draws: vec![SceneDraw::new(0, 0, 1)],
        }),
        draws: vec![
            SceneDraw::new(1, 0, 1),
            SceneDraw {
                dynamic_offset: UNIFORM_STRIDE,
                ..SceneDraw::new(1, 2, 3)
            },
        ],
        wgsl: None,
        strict_math: true,
        frame: None,
    }
}

pub(super) fn ground_vertices() -> Vec<u8> {
    let mut vertices = LittleEndian::default();
    for [x, z] in [[-4.0, 4.0], [4.0, 4.0], [4.0, -4.0], [-4.0, -4.0]] {
        vertices.reals(&[x, -0.8, z]);
        vertices.reals(&[0.0, 1.0, 0.0]);
        vertices.reals(&[1.0, 0.0, 0.0, 1.0]);
        vertices.reals(&[x + 4.0, z + 4.0]);
    }
    vertices.into_bytes()
}

fn uniform_bytes() -> Vec<u8> {
    let place = mid_tris::towards_light().map(|component| component * 5.0);
    let view_from_world = look_at(place, [0.0; 3], [0.0, 1.0, 0.0]);
    let light_from_world = orthographic(2.5, 1.0, 9.0).times(&view_from_world);
    let mut bytes = LittleEndian::default();
    for (end, world_from_object) in (1..).zip([mid_tris::world_from_object(), Matrix::IDENTITY]) {
        mid_tris::append_matrices(&mut bytes, &world_from_object);
        bytes.matrix(&light_from_world.times(&world_from_object));
        mid_tris::append_lighting(&mut bytes);
        bytes.pad_to(end * UNIFORM_STRIDE);
    }
    bytes.into_bytes()
}
