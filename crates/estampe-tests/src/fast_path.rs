//! The fast path's image of a case, on one of the tests' devices.

use crate::case::{Case, CaseDraw};
use crate::oracle::Image;
use crate::readback;
use crate::target::Target;
use estampe::{
    BindGroup, BindGroupDescriptor, BindGroupLayoutEntry, BindingResource, BindingType,
    BufferBindingType, BufferSlice, Device, DeviceDescriptor, Draw, Level, OcclusionQueries,
    RenderPass, RenderPipeline, RenderPipelineDescriptor, Statistics,
};
use estampe_types::state::{ColorTargetState, DepthStencilState, MultisampleState};
use estampe_types::{Bindings, BoundResource, BufferData, TextureFormat};
use std::sync::LazyLock;

/// Numbers of threads: one, an even division, and more than this machine may have; the last with
/// hardly any memory for bins, so that batches end early and tiles are drawn in bands.
const THREADS: [(usize, bool); 4] = [(1, false), (2, false), (7, false), (3, true)];

/// A device for every SIMD level and number of threads, sorted by level.
static DEVICES: LazyLock<Vec<Device>> = LazyLock::new(|| {
    let device = |level: Level, (threads, has_small_bins): (usize, bool)| {
        let device = Device::new(&DeviceDescriptor {
            threads,
            level,
            ..DeviceDescriptor::default()
        });
        let device = device.expect("the system starts a few threads");
        match has_small_bins {
            true => device.with_small_bins(),
            false => device,
        }
    };
    let levels = Level::all_available().into_iter();
    levels
        .flat_map(|level| THREADS.map(|threads| device(level, threads)))
        .collect()
});

/// The devices of every SIMD level at every number of threads.
#[must_use]
pub fn all_devices() -> Vec<&'static Device> {
    DEVICES.iter().collect()
}

/// The devices of every SIMD level with hardly any memory for bins.
#[must_use]
pub fn devices_with_small_bins() -> Vec<&'static Device> {
    let devices = DEVICES.iter().zip(THREADS.iter().cycle());
    let small = devices.filter(|(_, (_, has_small_bins))| *has_small_bins);
    small.map(|(device, _)| device).collect()
}

/// One device of every SIMD level; the numbers of threads differ from level to level and rotate
/// with `turn`.
#[must_use]
pub fn some_devices(turn: u64) -> Vec<&'static Device> {
    let levels = DEVICES.chunks(THREADS.len());
    let turns = usize::try_from(turn % THREADS.len() as u64).unwrap_or_default()..;
    levels
        .zip(turns)
        .map(|(of_level, turn)| &of_level[turn % THREADS.len()])
        .collect()
}

/// The devices that draw the random case of a seed: those of [`some_devices`], the scalar level
/// only of every third seed. In dev builds it takes as long as all others together.
#[must_use]
pub fn devices_of_seed(seed: u64) -> Vec<&'static Device> {
    let is_scalar_due = seed.is_multiple_of(3);
    // The numbers of threads of every third seed rotate, too.
    let mut devices = some_devices(seed + seed / 3);
    devices.retain(|device| is_scalar_due || !device.level().is_scalar());
    devices
}

/// The name of a device, for messages: its SIMD level and number of threads.
#[must_use]
pub fn name(device: &Device) -> String {
    format!("{} × {} threads", device.level().name(), device.threads())
}

/// The image and statistics of a case on one device.
#[derive(Debug)]
pub struct Drawn {
    /// The part that must agree with the oracle.
    pub image: Image,
    /// Statistics of all passes.
    pub statistics: Statistics,
}

/// Draws a case. A state that the API refuses is a fault of the test, and panics.
#[must_use]
pub fn draw(device: &Device, case: &Case) -> Drawn {
    let [width, height] = case.size;
    let target = Target::of_case(device, case);
    let queries = OcclusionQueries::new(case.draws.len());
    let first_draws = case.passes()[0].len();
    let mut statistics = Statistics::default();
    for (number, draws) in case.passes().into_iter().enumerate() {
        let is_first = number == 0;
        let first_draw = if is_first { 0 } else { first_draws };
        let attachments = target.pass(case, is_first);
        let pass = RenderPass {
            occlusion_queries: Some(&queries),
            ..attachments.pass()
        };
        statistics += draw_pass(device, case, (draws, first_draw), pass);
    }
    let stored = target.read(device);
    let color = match case.format {
        Some(format) if readback::is_read_as_color(format) => {
            let resolved = stored.resolved.first();
            resolved.unwrap_or(&stored.texels[0]).clone()
        }
        _ => Vec::new(),
    };
    let counted = (0u32..).zip(&case.draws);
    let counts = counted
        .filter(|(_, draw)| draw.is_counted)
        .map(|(number, _)| queries.samples_passed(number))
        .collect();
    let depth = stored.depths.first().cloned().unwrap_or_default();
    let image = Image {
        pixels: width as usize * height as usize,
        color,
        depth,
        stored,
        primitives: statistics.primitives_in,
        counts,
    };
    Drawn { image, statistics }
}

/// Draws a pass; the number is the index of its first draw in the case.
pub(crate) fn draw_pass(
    device: &Device,
    case: &Case,
    (draws, first_draw): (&[CaseDraw], usize),
    pass: RenderPass<'_>,
) -> Statistics {
    with_pass(device, case, (draws, first_draw), pass, |pass| {
        device.render(pass).expect("a pass that fits its target")
    })
}

/// Lets `use_pass` use a pass with these draws; the number is the index of the first one in the
/// case.
pub(crate) fn with_pass<T>(
    device: &Device,
    case: &Case,
    (draws, first_draw): (&[CaseDraw], usize),
    pass: RenderPass<'_>,
    use_pass: impl FnOnce(&RenderPass<'_>) -> T,
) -> T {
    let first_draw = u32::try_from(first_draw).expect("few draws");
    let pipelines = pipelines(device, case, draws);
    let buffers = draws.iter().map(|draw| Buffers::new(device, draw));
    let buffers: Vec<Buffers> = buffers.collect();
    let commands: Vec<_> = draws
        .iter()
        .zip(pipelines.iter().zip(&buffers))
        .zip(first_draw..)
        .map(|((draw, (pipeline, buffers)), number)| Draw {
            vertex_buffers: &buffers.vertices,
            index_buffer: buffers
                .indices
                .as_ref()
                .zip(draw.indices.as_ref().map(|(format, _)| *format)),
            instances: draw.instances.clone(),
            base_vertex: draw.base_vertex,
            bind_groups: &buffers.groups,
            dynamic_offsets: &buffers.dynamic_offsets,
            viewport: draw.viewport,
            scissor: draw.scissor,
            blend_constant: draw.blend_constant,
            stencil_reference: draw.stencil_reference,
            depth_bounds: draw.depth_bounds,
            occlusion_query: draw.is_counted.then_some(number),
            ..Draw::new(pipeline, draw.elements.clone())
        })
        .collect();
    let pass = RenderPass {
        draws: &commands,
        ..pass
    };
    use_pass(&pass)
}

/// The buffers and bind groups of a draw.
struct Buffers {
    vertices: Vec<BufferSlice>,
    indices: Option<BufferSlice>,
    groups: Vec<BindGroup>,
    /// Those of all groups.
    dynamic_offsets: Vec<u32>,
}

impl Buffers {
    fn new(device: &Device, draw: &CaseDraw) -> Self {
        let vertices = draw.buffers.iter().map(|(_, data)| slice(device, data));
        let indices = draw.indices.as_ref();
        let groups = bind_groups(device, &draw.bindings);
        let (groups, dynamic_offsets): (Vec<_>, Vec<_>) = groups.into_iter().unzip();
        Self {
            vertices: vertices.collect(),
            indices: indices.map(|(_, data)| slice(device, data)),
            groups,
            dynamic_offsets: dynamic_offsets.concat(),
        }
    }
}

fn slice(device: &Device, data: &BufferData) -> BufferSlice {
    let buffer = device.create_buffer_of_words(data.words().to_vec());
    let buffer = buffer.expect("a small buffer");
    buffer.slice(0..data.len_bytes() as u64)
}

/// Bind groups with the same buffers.
fn bind_groups(device: &Device, bindings: &Bindings) -> Vec<(BindGroup, Vec<u32>)> {
    let groups = bindings.groups.iter().map(|bound| {
        let mut layout = Vec::new();
        let mut entries = Vec::new();
        let mut offsets = Vec::new();
        for (binding, resource) in &bound.group.entries {
            let BoundResource::Buffer {
                buffer,
                offset,
                dynamic_offset,
                ..
            } = resource
            else {
                panic!("cases bind buffers alone");
            };
            let whole = slice(device, buffer);
            let offset = u64::from(*offset);
            // A dynamic offset moves the whole binding, which must stay in the buffer.
            let dynamic = dynamic_offset.map(|at| bound.dynamic_offsets[usize::from(at)]);
            let end = whole.size - u64::from(dynamic.unwrap_or(0));
            offsets.extend(dynamic);
            layout.push(BindGroupLayoutEntry {
                binding: *binding,
                ty: BindingType::Buffer {
                    ty: BufferBindingType::Uniform,
                    has_dynamic_offset: dynamic_offset.is_some(),
                    min_binding_size: 0,
                },
            });
            let part = whole.buffer.slice(offset..end);
            entries.push((*binding, BindingResource::Buffer(part)));
        }
        let layout = device.create_bind_group_layout(&layout);
        let group = device.create_bind_group(&BindGroupDescriptor {
            label: None,
            layout: &layout.expect("a valid layout"),
            entries: &entries,
        });
        (group.expect("resources that fit the layout"), offsets)
    });
    groups.collect()
}

/// The draws' pipelines. A draw whose state is that of the one before has the same one.
fn pipelines(device: &Device, case: &Case, draws: &[CaseDraw]) -> Vec<RenderPipeline> {
    let mut pipelines: Vec<RenderPipeline> = Vec::new();
    let mut before = String::new();
    for draw in draws {
        let state = draw.pipeline_state();
        match pipelines.last() {
            Some(last) if state == before => pipelines.push(last.clone()),
            _ => pipelines.push(pipeline(device, case, draw)),
        }
        before = state;
    }
    pipelines
}

fn pipeline(device: &Device, case: &Case, draw: &CaseDraw) -> RenderPipeline {
    let target = |(attachment, &format): (usize, &TextureFormat)| {
        let (blend, write_mask) = draw.target(attachment);
        Some(ColorTargetState {
            format,
            blend,
            write_mask,
        })
    };
    device
        .create_render_pipeline(&RenderPipelineDescriptor {
            vertex_buffers: draw.buffers.iter().map(|(l, _)| l.clone()).collect(),
            primitive: draw.primitive,
            depth_stencil: Some(DepthStencilState {
                stencil: draw.stencil,
                bias: draw.depth_bias,
                ..draw
                    .depth
                    .map_or_else(DepthStencilState::default, DepthStencilState::from)
            }),
            multisample: MultisampleState {
                count: case.samples,
                mask: draw.sample_mask,
                alpha_to_coverage_enabled: draw.alpha_to_coverage,
                sample_shading_enabled: draw.sample_shading,
            },
            logic_operation: draw.logic_operation,
            targets: case.formats().iter().enumerate().map(target).collect(),
            ..RenderPipelineDescriptor::with_program(draw.shader.program())
        })
        .expect("a valid pipeline")
}
