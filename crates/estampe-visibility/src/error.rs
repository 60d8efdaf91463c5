//! Errors of drawing.

use estampe::{BindGroupError, BufferError, PipelineError, RenderPassError, TextureError};

/// The reason why the pipeline draws no picture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum DrawError {
    /// The image is too large for the device.
    #[error(transparent)]
    Texture(#[from] TextureError),
    /// The vertices are too many for the device.
    #[error(transparent)]
    Buffer(#[from] BufferError),
    /// A texture of the device's own does not fit its binding.
    #[error(transparent)]
    BindGroup(#[from] BindGroupError),
    /// A state is not valid, such as a line's width that is not above 0 and at most 64.
    #[error(transparent)]
    Pipeline(#[from] PipelineError),
    /// The pass is not valid.
    #[error(transparent)]
    Pass(#[from] RenderPassError),
}
