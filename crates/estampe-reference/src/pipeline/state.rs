//! The fixed-function state of a draw.

use estampe_types::state::{
    BlendState, ColorWrites, DepthBiasState, DepthState, LogicOperation, PrimitiveState,
    ScissorRect, StencilState, Viewport,
};

/// The fixed-function state of a draw.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// Topology, facing, culling, polygon mode.
    pub primitive: PrimitiveState,
    /// The depth test; `None` neither tests nor writes depth.
    pub depth: Option<DepthState>,
    /// Depth bias of triangles.
    pub depth_bias: DepthBiasState,
    /// The unit of the bias constant: 2⁻ⁿ for a fixed-point depth attachment of n bits; `None` for
    /// a float attachment.
    pub depth_bias_unit: Option<f32>,
    /// The stencil test; `None` neither tests nor writes stencil.
    pub stencil: Option<StencilState>,
    /// The stencil references of front and back.
    pub stencil_reference: [u8; 2],
    /// The depth-bounds test: the least and the greatest stored depth at which samples pass; `None`
    /// disables it.
    pub depth_bounds: Option<[f32; 2]>,
    /// The sample mask: bit s enables sample s.
    pub sample_mask: u32,
    /// If set, alpha to coverage is enabled.
    pub alpha_to_coverage: bool,
    /// If set, shading is per sample, even if the shader does not require it.
    pub sample_shading: bool,
    /// A logic operation, in place of blending.
    pub logic_operation: Option<LogicOperation>,
    /// Blending and write masks, by target; targets beyond the list are replaced.
    pub targets: Vec<TargetState>,
    /// The constant of [`BlendFactor::Constant`](estampe_types::state::BlendFactor::Constant).
    pub blend_constant: [f32; 4],
    /// The viewport, in pixels of the target.
    pub viewport: Viewport,
    /// The scissor rectangle, in pixels of the target.
    pub scissor: ScissorRect,
}

/// The blending and the write mask of a target. The default replaces all channels.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TargetState {
    /// Blending; `None` replaces the stored colour.
    pub blend: Option<BlendState>,
    /// The channels that are written.
    pub write_mask: ColorWrites,
}

impl State {
    /// State for filled triangles over a whole target: no culling, no depth test, no blending.
    #[must_use]
    pub fn new(width: u32, height: u32) -> Self {
        Self {
            primitive: PrimitiveState::default(),
            depth: None,
            depth_bias: DepthBiasState::default(),
            depth_bias_unit: None,
            stencil: None,
            stencil_reference: [0; 2],
            depth_bounds: None,
            sample_mask: u32::MAX,
            alpha_to_coverage: false,
            sample_shading: false,
            logic_operation: None,
            targets: Vec::new(),
            blend_constant: [0.0; 4],
            viewport: Viewport {
                x: 0.0,
                y: 0.0,
                width: width as f32,
                height: height as f32,
                min_depth: 0.0,
                max_depth: 1.0,
            },
            scissor: ScissorRect {
                x: 0,
                y: 0,
                width,
                height,
            },
        }
    }
}
