//! `nbody_compute`: a step of 8,192 bodies that attract each other, painted and drawn as points.
//!
//! The first dispatch, 32 work-groups of 64 invocations with four bodies each, goes through all
//! bodies by tiles of 256 in the memory of the work-group, and writes the moved bodies with their
//! accelerations. The second one paints the picture, a storage texture: 128 × 64 cells, a body
//! each, coloured by its acceleration. A pass then keeps that and draws the bodies as points, with
//! the storage buffer as vertex buffer.
//!
//! A body is a position with its mass and a velocity, four floats each; a moved one has an
//! acceleration besides. With the random numbers r₀ to r₄ of a body, and its distance d = 0.15 +
//! 1.05·r₁: angle r₀ turns, height (r₃ − 0.5)·0.2, mass (0.5 + r₄) ÷ 8192, speed 0.9 ÷ (0.6 + d).

use super::passes::{
    Binding, ColorTarget, ComputeStep, Frame, FrameDraw, FramePipeline, PICTURE, Pass, Step,
};
use super::{Detail, Scene, vertex_layout};
use crate::frame::FrameSize;
use crate::generate::{LittleEndian, sin_cos_turns, unit_hash};
use estampe::state::{PrimitiveState, PrimitiveTopology};
use estampe::{TextureFormat, VertexFormat};

/// The bytes of a moved body.
const MOVED: u32 = 48;

pub(super) fn scene(detail: Detail, size: FrameSize) -> Scene {
    let count = detail.of(8_192, 512);
    let text = include_str!("wgsl/nbody_compute.wgsl");
    let mut frame = Frame::new(size, TextureFormat::Rgba8Unorm, text);
    let points = frame.pipeline(FramePipeline {
        vertex_buffers: vec![vertex_layout(MOVED, &[(VertexFormat::Float32x3, 0)])],
        primitive: PrimitiveState {
            topology: PrimitiveTopology::PointList,
            ..PrimitiveState::default()
        },
        ..FramePipeline::default()
    });
    frame.steps = vec![
        Step::Dispatch(ComputeStep {
            entry_point: "attract",
            bindings: vec![Binding::StorageRead(0), Binding::Storage(1)],
            workgroups: [count / 256, 1, 1],
        }),
        Step::Dispatch(ComputeStep {
            entry_point: "paint",
            bindings: vec![Binding::StorageImage(PICTURE), Binding::Storage(1)],
            workgroups: [size.width.div_ceil(8), size.height.div_ceil(8), 1],
        }),
        Step::Pass(Pass {
            colors: vec![ColorTarget {
                clear: None,
                ..ColorTarget::cleared(PICTURE, [0.0; 4])
            }],
            depth: None,
            draws: vec![FrameDraw {
                vertices: vec![1],
                ..FrameDraw::without_buffers(points, count)
            }],
        }),
    ];
    let moved = vec![0; (count * MOVED) as usize];
    let buffers = vec![bodies(count), moved];
    Scene::of_frame("nbody_compute", buffers, Vec::new(), frame)
}

fn bodies(count: u32) -> Vec<u8> {
    let mut bytes = LittleEndian::default();
    for body in 0..count {
        let random = |k: u32| unit_hash(17_000 + 8 * body + k);
        let (sin, cos) = sin_cos_turns(random(0));
        let distance = 0.15 + 1.05 * random(1);
        let speed = 0.9 / (0.6 + distance);
        let y = distance * sin * (0.8 + 0.1 * random(2));
        let mass = (0.5 + random(4)) / 8_192.0;
        bytes.reals(&[distance * cos, y, (random(3) - 0.5) * 0.2, mass]);
        bytes.reals(&[-sin * speed, cos * speed, 0.0, 0.0]);
    }
    bytes.into_bytes()
}
