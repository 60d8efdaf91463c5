//! `particles`: 100,000 soft quads of 4 to 24 pixels (at 720 lines) in a disc around a sphere, one
//! instanced draw of a triangle strip without vertex buffer, added into RGBA16F; then tone mapping
//! into the picture.
//!
//! Depth of the sphere is *less*, culled; of particles *less* without write: some lie inside the
//! sphere, behind it, outside the frame or behind the eye. A particle is its position and size (4
//! floats) and its colour (4 bytes), of which alpha scales the others. The texture is 64² with one
//! channel, trilinear, clamped. The uniforms are the matrix from world to clip space, and the size
//! of a pixel of a frame of 720 lines in normalised device coordinates.

use super::passes::{Binding, ColorTarget, Frame, FrameDraw, FramePipeline, PICTURE, Pass, Step};
use super::{ASPECT, Detail, Scene, vertex_layout};
use crate::frame::FrameSize;
use crate::generate::{
    LittleEndian, MipChain, look_at, perspective, sin_cos_turns, unit_hash, uv_sphere,
};
use estampe::state::{
    BlendState, CullMode, DepthStencilState, PrimitiveState, PrimitiveTopology, VertexBufferLayout,
    VertexStepMode,
};
use estampe::{TextureFormat, VertexFormat, ViewDimension};

pub(super) fn scene(detail: Detail, size: FrameSize) -> Scene {
    let count = detail.of(100_000, 1000);
    let (segments, rings) = detail.of((96, 48), (24, 12));
    let sphere = uv_sphere(segments, rings, |theta, phi| {
        1.0 + 0.04 * sin_cos_turns(5.0 * theta).0 * sin_cos_turns(9.0 * phi).0
    });
    let text = include_str!("wgsl/particles.wgsl");
    let mut frame = Frame::new(size, TextureFormat::Rgba8Unorm, text);
    frame.textures = vec![(TextureFormat::R8Unorm, ViewDimension::D2)];
    let pixels = [size.width, size.height];
    let lit = frame.image(TextureFormat::Rgba16Float, pixels);
    let depth = frame.image(TextureFormat::Depth32Float, pixels);
    let of_sphere = frame.pipeline(FramePipeline {
        vertex: "sphere_vertex",
        fragment: "sphere_fragment",
        vertex_buffers: vec![vertex_layout(
            28,
            &[(VertexFormat::Float32x3, 0), (VertexFormat::Float32x3, 12)],
        )],
        primitive: PrimitiveState {
            cull_mode: CullMode::Back,
            ..PrimitiveState::default()
        },
        bindings: vec![Binding::Uniform(3)],
        ..FramePipeline::default()
    });
    let instance = [
        VertexFormat::Float32x3,
        VertexFormat::Float32,
        VertexFormat::Unorm8x4,
    ];
    let of_particles = frame.pipeline(FramePipeline {
        vertex: "particle_vertex",
        fragment: "particle_fragment",
        vertex_buffers: vec![VertexBufferLayout {
            step_mode: VertexStepMode::Instance,
            ..VertexBufferLayout::packed(&instance)
        }],
        primitive: PrimitiveState {
            topology: PrimitiveTopology::TriangleStrip,
            ..PrimitiveState::default()
        },
        depth_stencil: DepthStencilState::LESS_READ,
        blend: Some(BlendState::ADDITIVE),
        bindings: vec![
            Binding::Uniform(3),
            Binding::trilinear_clamp(),
            Binding::Texture(0),
        ],
        ..FramePipeline::default()
    });
    frame.steps.push(Step::Pass(Pass {
        colors: vec![ColorTarget::cleared(lit, [0.01, 0.015, 0.03, 1.0])],
        depth: Some(depth),
        draws: vec![
            FrameDraw::indexed(of_sphere, 0, 1, 6 * segments * (rings - 1)),
            FrameDraw {
                vertices: vec![2],
                instances: count,
                ..FrameDraw::without_buffers(of_particles, 4)
            },
        ],
    }));
    let tone_map = frame.pipeline(FramePipeline {
        vertex: "screen_vertex",
        fragment: "tone_map",
        bindings: vec![Binding::Image(lit)],
        ..FramePipeline::default()
    });
    frame.screen_pass(tone_map, PICTURE);
    let buffers = vec![
        sphere.vertices,
        sphere.indices,
        particles(count),
        uniforms(size),
    ];
    Scene::of_frame("particles", buffers, vec![soft_disc()], frame)
}

fn particles(count: u32) -> Vec<u8> {
    let mut bytes = LittleEndian::default();
    for number in 0..count {
        let random = |k: u32| unit_hash(12_000 + 8 * number + k);
        let (sine, cosine) = sin_cos_turns(random(0));
        let distance = 0.9 + 5.9 * random(1);
        let height = (random(2) - random(3)) * 0.6;
        // Few are large: the twelfth power.
        let cubed = random(4) * random(4) * random(4);
        let sixth = cubed * cubed;
        bytes.reals(&[distance * cosine, height, distance * sine]);
        bytes.reals(&[4.0 + 20.0 * (sixth * sixth)]);
        let near = (6.8 - distance) / 5.9;
        bytes.color([
            40.0 + 180.0 * near,
            60.0 + 80.0 * random(5),
            40.0 + 200.0 * (1.0 - near),
            48.0 + 160.0 * random(6),
        ]);
    }
    bytes.into_bytes()
}

fn uniforms(size: FrameSize) -> Vec<u8> {
    let view_from_world = look_at([0.0, 1.6, 4.2], [0.0; 3], [0.0, 1.0, 0.0]);
    let clip_from_view = perspective(0.125, ASPECT, 0.1, 20.0);
    let pixel = f64::from(size.height) / 720.0;
    let mut bytes = LittleEndian::default();
    bytes.matrix(&clip_from_view.times(&view_from_world));
    let [width, height] = [size.width, size.height].map(f64::from);
    bytes.reals(&[2.0 / width * pixel, 2.0 / height * pixel, 0.0, 0.0]);
    bytes.into_bytes()
}

/// 64² of one channel: (1 − r²)², for r the distance from the centre in halves of the side.
fn soft_disc() -> MipChain {
    const RADIUS_SQUARED: u32 = 63 * 63;
    let mut texels = Vec::new();
    for y in 0..64_u32 {
        for x in 0..64_u32 {
            let [across, down] = [x, y].map(|place| (2 * place).abs_diff(63));
            let inside = RADIUS_SQUARED.saturating_sub(across * across + down * down);
            // The product has 33 bits.
            let inside = u64::from(inside);
            let value = inside * inside * 255 / u64::from(RADIUS_SQUARED * RADIUS_SQUARED);
            texels.push(u8::try_from(value).expect("a share of 255"));
        }
    }
    MipChain::halving(64, 1, texels)
}
