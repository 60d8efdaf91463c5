//! State of a pipeline, in WebGPU's words and, beyond those, Vulkan's. Every value is plain data;
//! every default is stated.

mod blend;
mod depth_stencil;
mod multisample;
mod primitive;
mod tessellation;
mod vertex;
mod viewport;

pub use blend::{
    BlendComponent, BlendFactor, BlendOperation, BlendState, ColorTargetState, ColorWrites,
    LogicOperation,
};
pub use depth_stencil::{
    CompareFunction, DepthBiasState, DepthState, DepthStencilState, StencilFaceState,
    StencilOperation, StencilState,
};
pub use multisample::MultisampleState;
pub use primitive::{
    ConservativeMode, CullMode, FrontFace, LineRasterization, LineState, LineStipple, PolygonMode,
    PrimitiveState, PrimitiveTopology, ProvokingVertex,
};
pub use tessellation::{
    MAX_PATCH_POINTS, MAX_TESSELLATION_LEVEL, TessellationDomain, TessellationMode,
    TessellationSpacing,
};
pub use vertex::{VertexAttribute, VertexBufferLayout, VertexStepMode};
pub use viewport::{ScissorRect, Viewport};
