//! `gbuffer`: deferred shading. The torus and the ground of `shadow` go with the textures of
//! `mid_tris` into albedo (RGBA8 sRGB) and world normal with roughness (RGBA16F); then 16 point
//! lights are added per pixel into RGBA16F, at the position that depth gives; then the sum is
//! tone-mapped into the picture, BGRA8 sRGB.
//!
//! The uniforms of the first pass are those of `mid_tris` for torus and ground, at a stride of 256.
//! Those of the second are the eye, the view rays right, up and forward, whose w are a and b of
//! the view's depth b ÷ (depth + a), 0, and for each light its position, radius, colour and 0.

use super::passes::{Binding, ColorTarget, Frame, FrameDraw, FramePipeline, PICTURE, Pass, Step};
use super::{Detail, Scene, mid_tris, shadow, vertex_layout};
use crate::frame::FrameSize;
use crate::generate::{
    LittleEndian, Matrix, diffuse_texture, normal_texture, quad_indices, torus, unit_hash,
    view_rays,
};
use estampe::state::{CullMode, PrimitiveState};
use estampe::{SamplerDescriptor, TextureFormat, VertexFormat, ViewDimension};

/// Bytes between the uniforms of torus and ground, and their size.
const UNIFORM_STRIDE: u32 = 256;
const UNIFORM_BYTES: u64 = 160;
const LIGHTS: u32 = 16;

pub(super) fn scene(detail: Detail, size: FrameSize) -> Scene {
    let (ring_cells, tube_cells) = detail.of((264, 132), (33, 16));
    let texture_size = detail.of(1024, 256);
    let mesh = torus(ring_cells, tube_cells);
    let text = include_str!("wgsl/gbuffer.wgsl");
    let mut frame = Frame::new(size, TextureFormat::Bgra8UnormSrgb, text);
    frame.textures = vec![(TextureFormat::Rgba8Unorm, ViewDimension::D2); 2];
    let pixels = [size.width, size.height];
    let albedo = frame.image(TextureFormat::Rgba8UnormSrgb, pixels);
    let normal = frame.image(TextureFormat::Rgba16Float, pixels);
    let depth = frame.image(TextureFormat::Depth32Float, pixels);
    let lit = frame.image(TextureFormat::Rgba16Float, pixels);
    let surface = frame.pipeline(FramePipeline {
        vertex: "surface_vertex",
        fragment: "surface_fragment",
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
        bindings: vec![
            Binding::UniformAtOffset(4, UNIFORM_BYTES),
            Binding::Sampler(SamplerDescriptor::trilinear_repeat()),
            Binding::Texture(0),
            Binding::Texture(1),
        ],
        ..FramePipeline::default()
    });
    let torus_draw = FrameDraw {
        dynamic_offset: Some(0),
        ..FrameDraw::indexed(surface, 0, 1, 6 * ring_cells * tube_cells)
    };
    let ground_draw = FrameDraw {
        dynamic_offset: Some(UNIFORM_STRIDE),
        ..FrameDraw::indexed(surface, 2, 3, 6)
    };
    frame.steps.push(Step::Pass(Pass {
        colors: [albedo, normal]
            .map(|image| ColorTarget::cleared(image, [0.0; 4]))
            .to_vec(),
        depth: Some(depth),
        draws: vec![torus_draw, ground_draw],
    }));
    let on_screen = |fragment: &'static str, bindings: Vec<Binding>| FramePipeline {
        vertex: "screen_vertex",
        fragment,
        bindings,
        ..FramePipeline::default()
    };
    let inputs = vec![
        Binding::Uniform(5),
        Binding::Image(albedo),
        Binding::Image(normal),
        Binding::Image(depth),
    ];
    let light = frame.pipeline(on_screen("light", inputs));
    frame.screen_pass(light, lit);
    let tone_map = frame.pipeline(on_screen("tone_map", vec![Binding::Image(lit)]));
    frame.screen_pass(tone_map, PICTURE);
    let buffers = vec![
        mesh.vertices,
        mesh.indices,
        shadow::ground_vertices(),
        quad_indices(1),
        surface_uniforms(),
        light_uniforms(),
    ];
    let textures = vec![
        diffuse_texture(texture_size, mid_tris::NOISE_SEED),
        normal_texture(texture_size, mid_tris::NOISE_SEED),
    ];
    Scene::of_frame("gbuffer", buffers, textures, frame)
}

fn surface_uniforms() -> Vec<u8> {
    let mut bytes = LittleEndian::default();
    for (end, world_from_object) in (1..).zip([mid_tris::world_from_object(), Matrix::IDENTITY]) {
        mid_tris::append_matrices(&mut bytes, &world_from_object);
        mid_tris::append_lighting(&mut bytes);
        bytes.pad_to(end * UNIFORM_STRIDE);
    }
    bytes.into_bytes()
}

fn light_uniforms() -> Vec<u8> {
    let [view_from_world, clip_from_view] = mid_tris::camera();
    let [right, up, forward] = view_rays(&view_from_world, &clip_from_view);
    let projection = &clip_from_view.columns;
    let mut bytes = LittleEndian::default();
    for (ray, w) in [
        (mid_tris::EYE, 1.0),
        (right, projection[2][2]),
        (up, projection[3][2]),
        (forward, 0.0),
    ] {
        bytes.reals(&ray);
        bytes.reals(&[w]);
    }
    for light in 0..LIGHTS {
        let random = |k: u32| unit_hash(8000 + 8 * light + k);
        let (x, z) = (3.6 * random(0) - 1.8, 3.6 * random(2) - 1.8);
        bytes.reals(&[x, 1.3 * random(1) - 0.5, z, 1.2 + 0.8 * random(3)]);
        bytes.reals(&[4, 5, 6].map(|k| 0.05 + 0.5 * random(k)));
        bytes.reals(&[0.0]);
    }
    bytes.into_bytes()
}
