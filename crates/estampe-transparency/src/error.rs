//! Errors of transparent draws.

use estampe::{BindGroupError, PipelineError, RenderPassError, TextureError};

/// The reason why transparent draws are not blended.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TransparencyError {
    /// A layer or a sum does not fit the device, or memory is short.
    #[error(transparent)]
    Texture(#[from] TextureError),
    /// The picture's depths cannot be read by shaders.
    #[error(transparent)]
    BindGroup(#[from] BindGroupError),
    /// A state is not valid.
    #[error(transparent)]
    Pipeline(#[from] PipelineError),
    /// A draw does not fit the pass.
    #[error(transparent)]
    Pass(#[from] RenderPassError),
}
