//! `wire`: hidden lines. A terrain of 274 × 274 cells is filled, 150,152 triangles with a depth
//! bias, and the edges of its cells are drawn over it: 150,700 lines of one pixel.
//!
//! The fill is *less*, culled, with a constant bias of 2 and a slope factor of 1.5; its normal is
//! the cross product of the position's derivatives. Lines are *less or equal* without write. A
//! vertex is its position: 12 bytes. Lines are rectangular, as Vulkan's strict lines are: by the
//! diamond-exit rule 2.2 % of the pixels at 1280×720 differ from lavapipe's, because it covers
//! fewer pixels where lines end. The uniform is the matrix from world to clip space.

use super::passes::{Binding, Frame, FrameDraw, FramePipeline};
use super::{ASPECT, CLEAR_COLOR, Detail, Scene, vertex_layout};
use crate::frame::FrameSize;
use crate::generate::{LittleEndian, look_at, perspective, sin_cos_turns};
use estampe::state::{
    CompareFunction, CullMode, DepthBiasState, DepthStencilState, LineRasterization, LineState,
    PrimitiveState, PrimitiveTopology,
};
use estampe::{TextureFormat, VertexFormat};

pub(super) fn scene(detail: Detail, size: FrameSize) -> Scene {
    let cells = detail.of(274, 27);
    let text = include_str!("wgsl/wire.wgsl");
    let mut frame = Frame::new(size, TextureFormat::Rgba8Unorm, text);
    let pipeline = FramePipeline {
        vertex_buffers: vec![vertex_layout(12, &[(VertexFormat::Float32x3, 0)])],
        bindings: vec![Binding::Uniform(3)],
        ..FramePipeline::default()
    };
    let fill = frame.pipeline(FramePipeline {
        fragment: "fill",
        primitive: PrimitiveState {
            cull_mode: CullMode::Back,
            ..PrimitiveState::default()
        },
        depth_stencil: DepthStencilState {
            bias: DepthBiasState {
                constant: 2.0,
                slope_scale: 1.5,
                clamp: 0.0,
            },
            ..DepthStencilState::LESS_WRITE
        },
        ..pipeline.clone()
    });
    let line = frame.pipeline(FramePipeline {
        fragment: "line",
        primitive: PrimitiveState {
            topology: PrimitiveTopology::LineList,
            line: LineState {
                rasterization: LineRasterization::Rectangular,
                ..LineState::default()
            },
            ..PrimitiveState::default()
        },
        depth_stencil: DepthStencilState {
            depth_compare: CompareFunction::LessEqual,
            ..DepthStencilState::LESS_READ
        },
        ..pipeline
    });
    let draws = vec![
        FrameDraw::indexed(fill, 0, 1, 6 * cells * cells),
        FrameDraw::indexed(line, 0, 2, 4 * cells * (cells + 1)),
    ];
    let clear = CLEAR_COLOR.map(f64::from);
    frame.picture_pass(1, TextureFormat::Depth32Float, clear, draws);
    let view_from_world = look_at([0.0, 2.6, 4.6], [0.0, -0.2, 0.4], [0.0, 1.0, 0.0]);
    let clip_from_view = perspective(0.125, ASPECT, 0.1, 20.0);
    let mut uniforms = LittleEndian::default();
    uniforms.matrix(&clip_from_view.times(&view_from_world));
    let buffers = vec![
        vertices(cells),
        triangles(cells),
        lines(cells),
        uniforms.into_bytes(),
    ];
    Scene::of_frame("wire", buffers, Vec::new(), frame)
}

/// A grid over −4..4 in x and z, row by row.
fn vertices(cells: u32) -> Vec<u8> {
    let place = |step: u32| 8.0 * f64::from(step) / f64::from(cells) - 4.0;
    let mut bytes = LittleEndian::default();
    for row in 0..=cells {
        for column in 0..=cells {
            let (x, z) = (place(column), place(row));
            let hills = 0.35 * sin_cos_turns(0.31 * x + 0.1).0 * sin_cos_turns(0.27 * z).1;
            let height = hills
                + 0.12 * sin_cos_turns(0.9 * x + 0.4 * z).0
                + 0.03 * sin_cos_turns(2.1 * z - 1.3 * x).0;
            bytes.reals(&[x, height, z]);
        }
    }
    bytes.into_bytes()
}

fn triangles(cells: u32) -> Vec<u8> {
    let width = cells + 1;
    let mut indices = LittleEndian::default();
    for row in 0..cells {
        for column in 0..cells {
            let here = row * width + column;
            let opposite = here + width + 1;
            indices.words(&[here, here + width, opposite, here, opposite, here + 1]);
        }
    }
    indices.into_bytes()
}

/// All lines along x, row by row, then all along z, column by column.
fn lines(cells: u32) -> Vec<u8> {
    let width = cells + 1;
    let mut indices = LittleEndian::default();
    for row in 0..=cells {
        for column in 0..cells {
            let here = row * width + column;
            indices.words(&[here, here + 1]);
        }
    }
    for column in 0..=cells {
        for row in 0..cells {
            let here = row * width + column;
            indices.words(&[here, here + width]);
        }
    }
    indices.into_bytes()
}
