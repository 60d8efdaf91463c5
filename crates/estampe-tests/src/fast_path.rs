//! The image that the fast path draws of a case, on one of the test's devices.

use crate::case::{Case, CaseDraw};
use crate::oracle::Image;
use estampe::{
    Device, DeviceDescriptor, Draw, Level, Limits, RenderPass, RenderPipeline,
    RenderPipelineDescriptor, RenderTargetDescriptor,
};
use estampe_types::state::ColorTargetState;
use std::sync::LazyLock;

/// The numbers of threads: one, an even division, and more than this machine may have.
const THREADS: [usize; 3] = [1, 2, 7];

/// A device for every level and number of threads; those of one level stand together.
static DEVICES: LazyLock<Vec<Device>> = LazyLock::new(|| {
    let device = |level: Level, threads: usize| {
        Device::new(&DeviceDescriptor {
            threads,
            level,
            limits: Limits::default(),
        })
        .expect("the system gives a few threads")
    };
    let levels = Level::all_available().into_iter();
    levels
        .flat_map(|level| THREADS.map(|threads| device(level, threads)))
        .collect()
});

/// Every level at every number of threads.
#[must_use]
pub fn all_devices() -> Vec<&'static Device> {
    DEVICES.iter().collect()
}

/// Every level, and every number of threads, but not all pairs; which ones changes with `turn`.
#[must_use]
pub fn some_devices(turn: u64) -> Vec<&'static Device> {
    let levels = DEVICES.chunks(THREADS.len());
    let turns = (turn % THREADS.len() as u64) as usize..;
    levels
        .zip(turns)
        .map(|(of_level, turn)| &of_level[turn % THREADS.len()])
        .collect()
}

/// What a device is called.
#[must_use]
pub fn name(device: &Device) -> String {
    format!("{} × {} threads", device.level().name(), device.threads())
}

/// Draws a case. A state that the API refuses is a fault of the test.
#[must_use]
pub fn draw(device: &Device, case: &Case) -> Image {
    let [width, height] = case.size;
    let mut target = device
        .create_render_target(&RenderTargetDescriptor {
            samples: case.samples,
            color_formats: case.format.into_iter().collect(),
            ..RenderTargetDescriptor::new(width, height)
        })
        .expect("a valid target");
    for (number, draws) in case.passes().into_iter().enumerate() {
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
            .map(|(draw, (pipeline, buffers))| Draw {
                pipeline,
                vertex_buffers: buffers,
                indices: draw.indices.as_ref().map(|(format, b)| (b, *format)),
                elements: draw.elements.clone(),
                instances: draw.instances.clone(),
                base_vertex: draw.base_vertex,
                bindings: Some(&draw.bindings),
                viewport: draw.viewport,
                scissor: draw.scissor,
                blend_constant: draw.blend_constant,
            })
            .collect();
        let is_first = number == 0;
        let pass = RenderPass {
            clear_colors: is_first.then(|| vec![case.clear_color]),
            clear_depth: is_first.then_some(case.clear_depth),
            draws: &commands,
        };
        device.render(&mut target, &pass);
    }
    Image {
        color: target.read_color(0),
        depth: target.read_depth().iter().map(|z| z.to_bits()).collect(),
    }
}

fn pipeline(device: &Device, case: &Case, draw: &CaseDraw) -> RenderPipeline {
    let target = |format| ColorTargetState {
        format,
        blend: draw.blend,
        write_mask: draw.write_mask,
    };
    device
        .create_render_pipeline(&RenderPipelineDescriptor {
            program: draw.shader.program(),
            vertex_buffers: draw.buffers.iter().map(|(l, _)| l.clone()).collect(),
            primitive: draw.primitive,
            depth: draw.depth,
            samples: case.samples,
            targets: case.format.into_iter().map(target).collect(),
        })
        .expect("a valid pipeline")
}
