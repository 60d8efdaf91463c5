//! Errors of drawing.

use estampe::{BufferError, PipelineError, RenderPassError, TextureError};
use estampe_transparency::TransparencyError;

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
    /// A state is not valid, such as a line's width that is not above 0 and at most 64.
    #[error(transparent)]
    Pipeline(#[from] PipelineError),
    /// The pass is not valid.
    #[error(transparent)]
    Pass(#[from] RenderPassError),
    /// Layers or sums of transparent polygons do not fit the device.
    #[error(transparent)]
    Transparency(Box<TransparencyError>),
}

impl From<TransparencyError> for DrawError {
    fn from(error: TransparencyError) -> Self {
        Self::Transparency(Box::new(error))
    }
}
