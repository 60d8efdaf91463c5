//! The draw of the ground.

use super::GroundFrame;
use super::columns::Columns;
use super::occlusion::{SIDE, alphas, hidden_light};
use super::sky::Sky;
use crate::geometry::vertex_data::{StreamData, VertexStream};
use crate::render_error::RenderError;
use crate::shading::ground::GroundSurface;
use crate::surface_pipelines::{FrameStyle, light_target};
use crate::transforms::round_to_f32;
use estampe::state::{
    BlendState, CompareFunction, CullMode, DepthState, MultisampleState, PrimitiveState,
};
use estampe::{
    AddressMode, BufferSlice, Device, Draw, RenderPipeline, RenderPipelineDescriptor,
    SampledTexture, SamplerDescriptor, TextureDescriptor, TextureFormat,
};
use estampe_scene::Workers;

/// The ground, ready to be drawn.
#[derive(Debug)]
pub(crate) struct GroundShadow {
    pipeline: RenderPipeline,
    /// The pipeline of the picture of what is behind surfaces, if there is one.
    behind: Option<RenderPipeline>,
    vertex_buffers: Vec<BufferSlice>,
}

impl GroundShadow {
    /// The ground of a frame.
    pub(crate) fn new(
        device: &Device,
        style: &FrameStyle,
        (frame, columns, sky): (&GroundFrame, &Columns, &Sky),
        workers: Workers,
    ) -> Result<Self, RenderError> {
        let hidden = alphas(&hidden_light(frame, columns, sky, workers));
        let shader = GroundSurface {
            transforms: style.transforms,
            hidden: texture(device, &hidden)?,
        };
        let streams = [
            (
                VertexStream::Position,
                StreamData::per_vertex(device, positions(frame).into_iter())?,
            ),
            (
                VertexStream::Uv,
                StreamData::per_vertex(device, UVS.into_iter())?,
            ),
        ];
        let layouts = streams.iter().enumerate();
        let layouts = layouts.map(|(location, (stream, data))| data.layout(*stream, location));
        let blend = Some(BlendState::ALPHA_BLENDING);
        let mut descriptor = RenderPipelineDescriptor {
            vertex_buffers: layouts.collect(),
            primitive: PrimitiveState {
                // From below nothing is seen; and near and far planes are those of the model.
                cull_mode: CullMode::Back,
                unclipped_depth: true,
                ..PrimitiveState::default()
            },
            depth_stencil: Some(
                DepthState {
                    write_enabled: false,
                    compare: CompareFunction::LessEqual,
                }
                .into(),
            ),
            multisample: MultisampleState::new(style.samples),
            targets: style.targets(blend),
            ..RenderPipelineDescriptor::new(shader)
        };
        let pipeline = device.create_render_pipeline(&descriptor)?;
        let behind = match style.behind {
            Some(_) => {
                descriptor.targets = light_target(blend);
                Some(device.create_render_pipeline(&descriptor)?)
            }
            None => None,
        };
        Ok(Self {
            pipeline,
            behind,
            vertex_buffers: streams.iter().map(|(_, data)| data.buffer()).collect(),
        })
    }

    /// The draw, after opaque surfaces and before transparent ones.
    pub(crate) fn draw(&self) -> Draw<'_> {
        Draw {
            vertex_buffers: &self.vertex_buffers,
            ..Draw::new(&self.pipeline, 0..6)
        }
    }

    /// The draw in the picture of what is behind surfaces.
    pub(crate) fn draw_behind(&self) -> Option<Draw<'_>> {
        Some(Draw {
            vertex_buffers: &self.vertex_buffers,
            ..Draw::new(self.behind.as_ref()?, 0..6)
        })
    }
}

/// Texture coordinates of two triangles, counter-clockwise from above.
const UVS: [[f32; 2]; 6] = [
    [0.0, 1.0],
    [1.0, 1.0],
    [1.0, 0.0],
    [0.0, 1.0],
    [1.0, 0.0],
    [0.0, 0.0],
];

/// The corners in unit space, a little below the model, so that a flat bottom hides the ground.
fn positions(frame: &GroundFrame) -> [[f32; 3]; 6] {
    const BELOW: f64 = 1e-4;
    let [x, y, up] = frame.axes;
    let (middle, reach) = (frame.middle - up * BELOW, frame.reach());
    UVS.map(|[u, v]| {
        let (u, v) = (f64::from(u) * 2.0 - 1.0, 1.0 - f64::from(v) * 2.0);
        let corner = middle + x * (u * reach) + y * (v * reach);
        corner.to_array().map(round_to_f32)
    })
}

/// The shares as a texture.
fn texture(device: &Device, hidden: &[f32]) -> Result<SampledTexture, RenderError> {
    let bytes: Vec<u8> = hidden
        .iter()
        .flat_map(|share| share.to_le_bytes())
        .collect();
    let side = u32::try_from(SIDE).unwrap_or(u32::MAX);
    let descriptor = TextureDescriptor::new_2d(side, side, TextureFormat::R32Float);
    let texture = device.create_texture_with_data(&descriptor, &[&bytes])?;
    let sampler = device.create_sampler(&SamplerDescriptor {
        address_mode_u: AddressMode::ClampToEdge,
        address_mode_v: AddressMode::ClampToEdge,
        ..SamplerDescriptor::linear()
    })?;
    Ok(device.sampled_texture(&texture.view(), &sampler)?)
}
