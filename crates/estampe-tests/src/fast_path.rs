//! The fast path's image of a case, on one of the tests' devices.

use crate::case::{Case, CaseDraw};
use crate::oracle::Image;
use crate::readback;
use estampe::{
    Device, DeviceDescriptor, Draw, Level, Limits, LoadOp, OcclusionQueries, RenderPass,
    RenderPipeline, RenderPipelineDescriptor, RenderTarget, RenderTargetDescriptor, Statistics,
};
use estampe_types::TextureFormat;
use estampe_types::state::ColorTargetState;
use std::sync::LazyLock;

/// Numbers of threads: one, an even division, and more than this machine may have.
const THREADS: [usize; 3] = [1, 2, 7];

/// A device for every SIMD level and number of threads, sorted by level.
static DEVICES: LazyLock<Vec<Device>> = LazyLock::new(|| {
    let device = |level: Level, threads: usize| {
        Device::new(&DeviceDescriptor {
            threads,
            level,
            limits: Limits::default(),
        })
        .expect("the system starts a few threads")
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
    let mut target = device
        .create_render_target(&RenderTargetDescriptor {
            samples: case.samples,
            color_formats: case.formats(),
            depth_stencil: case.depth_stencil,
            ..RenderTargetDescriptor::new(width, height)
        })
        .expect("a valid target");
    let queries = OcclusionQueries::new(case.draws.len());
    let first_draws = case.passes()[0].len();
    let mut statistics = Statistics::default();
    for (number, draws) in case.passes().into_iter().enumerate() {
        let is_first = number == 0;
        let mut clear = RenderPass {
            load_colors: vec![LoadOp::Clear(case.clear_color.map(f64::from)); case.formats().len()],
            load_depth: LoadOp::Clear(case.clear_depth),
            load_stencil: LoadOp::Clear(case.clear_stencil),
            occlusion_queries: Some(&queries),
            ..RenderPass::default()
        };
        if !is_first {
            clear.load_colors = vec![LoadOp::Load; case.formats().len()];
            clear.load_depth = LoadOp::Load;
            clear.load_stencil = LoadOp::Load;
        }
        let first_draw = if is_first { 0 } else { first_draws };
        statistics += draw_pass(device, &mut target, case, (draws, first_draw), clear);
    }
    let color = match case.format {
        Some(format) if readback::is_read_as_color(format) => target.read_color(0),
        _ => Vec::new(),
    };
    let stored = readback::stored(device, &target);
    let counted = (0u32..).zip(&case.draws);
    let counts = counted
        .filter(|(_, draw)| draw.is_counted)
        .map(|(number, _)| queries.samples_passed(number))
        .collect();
    let depth = target.read_depth().iter().map(|z| z.to_bits()).collect();
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

/// Draws a pass; `first` is the index of its first draw in the case.
fn draw_pass(
    device: &Device,
    target: &mut RenderTarget,
    case: &Case,
    (draws, first_draw): (&[CaseDraw], usize),
    clear: RenderPass<'_>,
) -> Statistics {
    let first_draw = u32::try_from(first_draw).expect("few draws");
    let pipelines: Vec<_> = draws
        .iter()
        .map(|draw| pipeline(device, case, draw))
        .collect();
    let buffers: Vec<Vec<_>> = draws
        .iter()
        .map(|draw| draw.buffers.iter().map(|(_, b)| b.clone()).collect())
        .collect();
    let commands: Vec<_> = draws
        .iter()
        .zip(pipelines.iter().zip(&buffers))
        .zip(first_draw..)
        .map(|((draw, (pipeline, buffers)), number)| Draw {
            vertex_buffers: buffers,
            indices: draw.indices.as_ref().map(|(format, b)| (b, *format)),
            instances: draw.instances.clone(),
            base_vertex: draw.base_vertex,
            bindings: Some(&draw.bindings),
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
        ..clear
    };
    device
        .render(target, &pass)
        .expect("a pass that fits its target")
}

fn pipeline(device: &Device, case: &Case, draw: &CaseDraw) -> RenderPipeline {
    let target = |(attachment, &format): (usize, &TextureFormat)| {
        let (blend, write_mask) = draw.target(attachment);
        ColorTargetState {
            format,
            blend,
            write_mask,
        }
    };
    device
        .create_render_pipeline(&RenderPipelineDescriptor {
            vertex_buffers: draw.buffers.iter().map(|(l, _)| l.clone()).collect(),
            primitive: draw.primitive,
            depth: draw.depth,
            stencil: draw.stencil,
            depth_bias: draw.depth_bias,
            samples: case.samples,
            sample_mask: draw.sample_mask,
            alpha_to_coverage: draw.alpha_to_coverage,
            sample_shading: draw.sample_shading,
            logic_operation: draw.logic_operation,
            targets: case.formats().iter().enumerate().map(target).collect(),
            ..RenderPipelineDescriptor::with_program(draw.shader.program())
        })
        .expect("a valid pipeline")
}
