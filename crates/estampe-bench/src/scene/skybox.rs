//! `skybox`: a ground with a texture of 2048², trilinear with anisotropy 16; 200 reflecting spheres
//! in one instanced draw of 100,000 triangles; then the sky, a full-screen triangle at z = 1.
//!
//! Spheres and sky sample one cube map of 512² with mip levels. The ground lies in x −30..30,
//! z −40..10. A sphere's instance is its centre and radius (4 floats) and its colour (4 bytes). The
//! uniforms are the matrix from world to clip space, the eye, and the view rays: right, up,
//! forward. Depth is Depth24Plus; of ground and spheres *less* and culled, of the sky *less or
//! equal* without write.

use super::passes::{Binding, Frame, FrameDraw, FramePipeline};
use super::{ASPECT, CLEAR_COLOR, Detail, Scene, vertex_layout};
use crate::frame::FrameSize;
use crate::generate::{
    LittleEndian, diffuse_texture, look_at, perspective, quad_indices, sky_cube, unit_hash,
    uv_sphere, view_rays,
};
use estampe::state::{
    CompareFunction, CullMode, DepthStencilState, PrimitiveState, VertexBufferLayout,
    VertexStepMode,
};
use estampe::{SamplerDescriptor, TextureFormat, VertexFormat, ViewDimension};

const EYE: [f64; 3] = [0.0, 1.5, 6.0];

pub(super) fn scene(detail: Detail, size: FrameSize) -> Scene {
    let (segments, rings) = detail.of((25, 11), (8, 4));
    let sphere = uv_sphere(segments, rings, |_, _| 1.0);
    let mut ground = LittleEndian::default();
    for [x, z] in [[-30.0, 10.0], [30.0, 10.0], [30.0, -40.0], [-30.0, -40.0]] {
        ground.reals(&[x, 0.0, z]);
    }
    let text = include_str!("wgsl/skybox.wgsl");
    let mut frame = Frame::new(size, TextureFormat::Rgba8Unorm, text);
    frame.textures = vec![
        (TextureFormat::Rgba8Unorm, ViewDimension::D2),
        (TextureFormat::Rgba8Unorm, ViewDimension::Cube),
    ];
    let primitive = PrimitiveState {
        cull_mode: CullMode::Back,
        ..PrimitiveState::default()
    };
    let anisotropic = SamplerDescriptor {
        max_anisotropy: 16,
        ..SamplerDescriptor::trilinear_repeat()
    };
    let of_ground = frame.pipeline(FramePipeline {
        vertex: "ground_vertex",
        fragment: "ground_fragment",
        vertex_buffers: vec![vertex_layout(12, &[(VertexFormat::Float32x3, 0)])],
        primitive,
        bindings: vec![
            Binding::Uniform(5),
            Binding::Sampler(anisotropic),
            Binding::Texture(0),
        ],
        ..FramePipeline::default()
    });
    let bindings = vec![
        Binding::Uniform(5),
        Binding::trilinear_clamp(),
        Binding::Texture(1),
    ];
    let instance = VertexBufferLayout {
        step_mode: VertexStepMode::Instance,
        ..VertexBufferLayout::packed_from(1, &[VertexFormat::Float32x4, VertexFormat::Unorm8x4])
    };
    let of_spheres = frame.pipeline(FramePipeline {
        vertex: "sphere_vertex",
        fragment: "sphere_fragment",
        vertex_buffers: vec![vertex_layout(28, &[(VertexFormat::Float32x3, 0)]), instance],
        primitive,
        bindings: bindings.clone(),
        ..FramePipeline::default()
    });
    let of_sky = frame.pipeline(FramePipeline {
        vertex: "sky_vertex",
        fragment: "sky_fragment",
        depth_stencil: DepthStencilState {
            depth_compare: CompareFunction::LessEqual,
            ..DepthStencilState::LESS_READ
        },
        bindings,
        ..FramePipeline::default()
    });
    let draws = vec![
        FrameDraw::indexed(of_ground, 3, 4, 6),
        FrameDraw {
            vertices: vec![0, 2],
            instances: 200,
            ..FrameDraw::indexed(of_spheres, 0, 1, 6 * segments * (rings - 1))
        },
        FrameDraw::without_buffers(of_sky, 3),
    ];
    let clear = CLEAR_COLOR.map(f64::from);
    frame.picture_pass(1, TextureFormat::Depth24Plus, clear, draws);
    let buffers = vec![
        sphere.vertices,
        sphere.indices,
        instances(),
        ground.into_bytes(),
        quad_indices(1),
        uniforms(),
    ];
    let textures = vec![diffuse_texture(detail.of(2048, 256), 23), sky_cube()];
    Scene::of_frame("skybox", buffers, textures, frame)
}

/// Ten rows of twenty spheres, displaced at random.
fn instances() -> Vec<u8> {
    let mut bytes = LittleEndian::default();
    for number in 0..200 {
        let (column, row) = (f64::from(number % 20), f64::from(number / 20));
        let random = |k: u32| unit_hash(15_000 + 8 * number + k);
        let x = (column - 9.5) * 0.8 + random(0) - 0.5;
        let z = 3.0 - 1.4 * row + random(1) - 0.5;
        bytes.reals(&[x, 0.5 + 2.2 * random(2), z, 0.16 + 0.2 * random(3)]);
        bytes.color([random(4), random(5), random(6), 1.0].map(|share| 150.0 + 105.0 * share));
    }
    bytes.into_bytes()
}

fn uniforms() -> Vec<u8> {
    let view_from_world = look_at(EYE, [0.0, 1.1, 0.0], [0.0, 1.0, 0.0]);
    let clip_from_view = perspective(0.125, ASPECT, 0.1, 100.0);
    let mut bytes = LittleEndian::default();
    bytes.matrix(&clip_from_view.times(&view_from_world));
    bytes.reals(&EYE);
    bytes.reals(&[1.0]);
    for ray in view_rays(&view_from_world, &clip_from_view) {
        bytes.reals(&ray);
        bytes.reals(&[0.0]);
    }
    bytes.into_bytes()
}
