//! A draw of the core as the oracle draws it: the same shaders, state and buffers.

use crate::Device;
use estampe_reference::program::ProgramShaders;
use estampe_reference::viewport::is_drawable;
use estampe_reference::{Draw, PixelBounds, State, Target, TargetState};
use estampe_types::state::{DepthStencilState, VertexBufferLayout};
use estampe_types::{Bindings, BufferData, TextureFormat};

/// What the oracle needs to draw.
pub(super) struct OracleDraw<'a> {
    pub(super) shaders: &'a ProgramShaders<'a>,
    pub(super) state: &'a State,
    pub(super) draw: &'a Draw<'a>,
}

impl OracleDraw<'_> {
    /// The pixels of a target that the draw may write, stored or not.
    pub(super) fn bounds(&self, target: &Target) -> PixelBounds {
        let State {
            viewport, scissor, ..
        } = self.state;
        if is_drawable(viewport) {
            PixelBounds::new(
                viewport,
                scissor,
                [target.width, target.height],
                target.samples,
            )
        } else {
            PixelBounds { x: 0..0, y: 0..0 }
        }
    }
}

/// The target of a draw, as far as its state depends on it.
#[derive(Debug, Clone, Copy)]
pub(super) struct TargetShape {
    size: [u32; 2],
    depth_stencil: Option<TextureFormat>,
}

impl TargetShape {
    pub(super) fn of(target: &Target) -> Self {
        Self {
            size: [target.width, target.height],
            depth_stencil: target.depth_stencil,
        }
    }
}

/// Gives a draw into a target to `use_draw` in the oracle's terms.
pub(super) fn with_draw<T>(
    device: &Device,
    draw: &estampe_core::Draw<'_>,
    target: TargetShape,
    use_draw: impl FnOnce(&OracleDraw<'_>) -> T,
) -> T {
    let state = state(draw, target);
    let descriptor = draw.pipeline.descriptor();
    let shaders = ProgramShaders::new(&*descriptor.program, device.level());
    let layouts = descriptor.vertex_buffers.iter().enumerate();
    let buffers: Vec<(VertexBufferLayout, BufferData)> = layouts
        .map(|(at, layout)| {
            let buffer = draw.vertex_buffers.get(at).cloned();
            let none = || BufferData::from_bytes(&[]);
            (layout.clone(), buffer.unwrap_or_else(none))
        })
        .collect();
    let no_bindings = Bindings::default();
    let oracle = OracleDraw {
        shaders: &shaders,
        state: &state,
        draw: &Draw {
            buffers: &buffers,
            indices: draw.indices.map(|(buffer, format)| (format, buffer)),
            vertices: draw.elements.clone(),
            instances: draw.instances.clone(),
            base_vertex: draw.base_vertex,
            bindings: draw.bindings.unwrap_or(&no_bindings),
        },
    };
    use_draw(&oracle)
}

/// The state of a draw, as the oracle names it.
fn state(draw: &estampe_core::Draw<'_>, target: TargetShape) -> State {
    let descriptor = draw.pipeline.descriptor();
    let whole = State::new(target.size[0], target.size[1]);
    let tests = descriptor.depth_stencil;
    let targets = descriptor.targets.iter().map(|target| {
        target.map_or_else(TargetState::default, |target| TargetState {
            blend: target.blend,
            write_mask: target.write_mask,
        })
    });
    State {
        primitive: descriptor.primitive,
        depth: tests.map(|tests| tests.depth()),
        depth_bias: tests.map_or_else(Default::default, |tests: DepthStencilState| tests.bias),
        depth_bias_unit: match target.depth_stencil {
            Some(TextureFormat::Depth16Unorm) => Some(1.0 / 65_536.0),
            Some(TextureFormat::Depth24Plus | TextureFormat::Depth24PlusStencil8) => {
                Some(1.0 / 16_777_216.0)
            }
            _ => None,
        },
        stencil: tests.and_then(|tests| tests.stencil),
        stencil_reference: draw.stencil_reference,
        depth_bounds: draw.depth_bounds,
        sample_mask: descriptor.multisample.mask,
        alpha_to_coverage: descriptor.multisample.alpha_to_coverage_enabled,
        sample_shading: descriptor.multisample.sample_shading_enabled,
        logic_operation: descriptor.logic_operation,
        targets: targets.collect(),
        blend_constant: draw.blend_constant,
        viewport: draw.viewport.unwrap_or(whole.viewport),
        scissor: draw.scissor.unwrap_or(whole.scissor),
    }
}
