//! The draw of a gradient behind everything.
//!
//! It comes after the opaque surfaces and passes where nothing was drawn: at the far plane, which
//! no surface reaches. Ground and transparent surfaces are blended over it.

use crate::geometry::vertex_data::{StreamData, VertexStream};
use crate::render_error::RenderError;
use crate::shading::backdrop::{Backdrop, BackdropSurface};
use crate::surface_pipelines::FrameStyle;
use estampe::state::{BlendState, CompareFunction, DepthState, MultisampleState, PrimitiveState};
use estampe::{BufferSlice, Device, Draw, RenderPipeline, RenderPipelineDescriptor};

/// The backdrop, ready to be drawn.
#[derive(Debug)]
pub(crate) struct BackdropDraw {
    pipeline: RenderPipeline,
    vertex_buffers: [BufferSlice; 1],
}

/// A triangle at the far plane that covers the window.
const CORNERS: [[f32; 3]; 3] = [[-1.0, -1.0, 1.0], [3.0, -1.0, 1.0], [-1.0, 3.0, 1.0]];

impl BackdropDraw {
    /// The backdrop of a frame.
    pub(crate) fn new(
        device: &Device,
        style: &FrameStyle,
        backdrop: Backdrop,
    ) -> Result<Self, RenderError> {
        let positions = StreamData::per_vertex(device, CORNERS.into_iter())?;
        let pipeline = device.create_render_pipeline(&RenderPipelineDescriptor {
            vertex_buffers: vec![positions.layout(VertexStream::Position, 0)],
            primitive: PrimitiveState::default(),
            depth_stencil: Some(
                DepthState {
                    write_enabled: false,
                    compare: CompareFunction::LessEqual,
                }
                .into(),
            ),
            multisample: MultisampleState::new(style.samples),
            targets: style.targets(Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING)),
            ..RenderPipelineDescriptor::new(BackdropSurface(backdrop))
        })?;
        Ok(Self {
            pipeline,
            vertex_buffers: [positions.buffer()],
        })
    }

    /// The draw, after opaque surfaces and before the ground.
    pub(crate) fn draw(&self) -> Draw<'_> {
        Draw {
            vertex_buffers: &self.vertex_buffers,
            ..Draw::new(&self.pipeline, 0..3)
        }
    }
}
