//! The draws of strokes.

use super::ribbon::Ribbon;
use super::window::Window;
use super::{Stroke, StrokeStyle};
use crate::render_error::RenderError;
use crate::shading::stroke::StrokeShader;
use crate::surface_pipelines::{FrameStyle, StreamPipeline};
use crate::transforms::round_to_f32;
use estampe::state::{
    BlendState, CompareFunction, DepthState, MultisampleState, PrimitiveState, VertexAttribute,
    VertexBufferLayout,
};
use estampe::{BufferSlice, Device, RenderPipelineDescriptor, VertexFormat};
use estampe_scene::Workers;

/// The buffers and the pipeline of strokes of one style.
#[derive(Debug)]
pub(crate) struct StrokeDraws {
    pub(crate) pipeline: StreamPipeline,
    pub(crate) vertices: BufferSlice,
    pub(crate) indices: BufferSlice,
    pub(crate) index_count: u32,
}

/// The most strokes that are drawn; of more, the longest ones in the window.
const MOST_STROKES: usize = 1 << 20;
/// Words of a vertex.
const WORDS: usize = 11;
/// Vertices of a ribbon.
const VERTICES: usize = 6;
/// Two triangles for each side of a line.
const INDICES: [u32; 12] = [0, 3, 4, 0, 4, 1, 0, 2, 5, 0, 5, 3];

impl StrokeDraws {
    /// The draws of strokes; `None` if none is visible.
    pub(crate) fn new(
        device: &Device,
        style: &FrameStyle,
        (strokes, of_strokes): (&[Stroke], StrokeStyle),
        window: &Window,
        workers: Workers,
    ) -> Result<Option<Self>, RenderError> {
        let half_width = f64::from(of_strokes.width_px) / 2.0;
        let pieces = workers.map(strokes.chunks(1 << 12), |strokes| {
            let ribbon = |stroke: &Stroke| {
                let ribbon = Ribbon::new(stroke, window, half_width, of_strokes.is_on_surfaces)?;
                Some((*stroke, ribbon))
            };
            strokes.iter().filter_map(ribbon).collect::<Vec<_>>()
        });
        let mut ribbons = pieces.concat();
        keep_longest(&mut ribbons);
        if ribbons.is_empty() {
            return Ok(None);
        }
        let mut words = Vec::with_capacity(ribbons.len() * VERTICES * WORDS);
        for (stroke, ribbon) in &ribbons {
            for vertex in 0..VERTICES {
                let end = vertex / 3;
                let unit = stroke.ends[0].lerp(stroke.ends[1], ribbon.shares[end]);
                let ndc = window.ndc(ribbon.points[vertex]);
                let [x, y, z] = ribbon.places[vertex];
                let [from, to] = stroke.alphas.map(f64::from);
                let alpha = from + (to - from) * ribbon.shares[end];
                let numbers = unit.to_array().into_iter().chain(ndc.to_array());
                let numbers = numbers.chain([x, y, z, half_width, alpha]);
                words.extend(numbers.map(|number| round_to_f32(number).to_bits()));
            }
        }
        let count = u32::try_from(ribbons.len()).expect("at most 2²⁰");
        let indices = (0..count).flat_map(|ribbon| INDICES.map(|index| ribbon * 6 + index));
        let indices: Vec<u32> = indices.collect();
        Ok(Some(Self {
            pipeline: pipeline(device, style, of_strokes)?,
            vertices: BufferSlice::from(&device.create_buffer_of_words(words)?),
            index_count: u32::try_from(indices.len()).expect("at most 12·2²⁰"),
            indices: BufferSlice::from(&device.create_buffer_of_words(indices)?),
        }))
    }
}

/// Omits the shortest ribbons if there are too many.
fn keep_longest(ribbons: &mut Vec<(Stroke, Ribbon)>) {
    if ribbons.len() <= MOST_STROKES {
        return;
    }
    let mut lengths: Vec<f64> = ribbons.iter().map(|(_, ribbon)| ribbon.length_px).collect();
    lengths.sort_unstable_by(|a, b| b.total_cmp(a));
    let least = lengths[MOST_STROKES];
    ribbons.retain(|(_, ribbon)| ribbon.length_px > least);
}

fn pipeline(
    device: &Device,
    style: &FrameStyle,
    of_strokes: StrokeStyle,
) -> Result<StreamPipeline, RenderError> {
    let attributes = [
        (VertexFormat::Float32x3, 0),
        (VertexFormat::Float32x3, 12),
        (VertexFormat::Float32x4, 24),
        (VertexFormat::Float32, 40),
    ];
    let attributes = attributes.into_iter().zip(0_u32..);
    let shader = StrokeShader {
        color: of_strokes.color,
    };
    let descriptor = RenderPipelineDescriptor {
        vertex_buffers: vec![VertexBufferLayout {
            array_stride: 44,
            attributes: attributes
                .map(|((format, offset), shader_location)| VertexAttribute {
                    format,
                    offset,
                    shader_location,
                })
                .collect(),
            ..VertexBufferLayout::default()
        }],
        primitive: PrimitiveState {
            // Near and far planes are those of the model.
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
        targets: style.targets(Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING)),
        ..RenderPipelineDescriptor::new(shader)
    };
    Ok(StreamPipeline {
        pipeline: device.create_render_pipeline(&descriptor)?,
        streams: Vec::new(),
        bind_groups: Vec::new(),
    })
}
