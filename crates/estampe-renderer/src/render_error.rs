//! Why a frame cannot be drawn.

use estampe::{BufferError, InspectError, PipelineError, RenderPassError, TextureError};
use estampe_transparency::TransparencyError;

/// Errors of [`render`](crate::render).
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RenderError {
    /// The size is zero or too large.
    #[error("a picture of {width}x{height} pixels is not possible: each side is 1 to {limit}")]
    Size {
        /// The requested width.
        width: u32,
        /// The requested height.
        height: u32,
        /// The greatest possible side.
        limit: u32,
    },
    /// One mesh has more corners than can be counted in 32 bits.
    #[error(
        "a mesh of {elements} triangle corners is too large: 4294967295 are possible; split it"
    )]
    TooManyElements {
        /// Number of triangle corners, line ends or points.
        elements: usize,
    },
    /// The scene has more triangles than numbers in colours tell apart.
    #[error(
        "{faces} triangles are too many for data passes: 16777216 are possible; split the model"
    )]
    TooManyFaces {
        /// Number of triangles.
        faces: usize,
    },
    /// Planes cut the whole model away.
    #[error("the section leaves nothing of the model: move its planes, or turn them round")]
    EmptySection,
    /// A pipeline state breaks a rule.
    #[error(transparent)]
    Pipeline(#[from] PipelineError),
    /// An image of the frame cannot be created.
    #[error("the images of the frame: {0}")]
    Target(TextureError),
    /// A vertex buffer cannot be created.
    #[error(transparent)]
    Buffer(#[from] BufferError),
    /// A texture cannot be created.
    #[error(transparent)]
    Texture(#[from] TextureError),
    /// A draw does not fit the target.
    #[error(transparent)]
    Pass(#[from] RenderPassError),
    /// Layers or sums of transparent surfaces cannot be drawn.
    #[error("transparent surfaces: {0}")]
    Transparency(#[from] TransparencyError),
    /// The bind groups of [`RenderOptions::program`](crate::RenderOptions::program) cannot be made.
    #[error("{0}")]
    Bindings(String),
    /// A pixel cannot be inspected.
    #[error(transparent)]
    Inspect(#[from] InspectError),
    /// A frame of several passes cannot be inspected.
    #[error(
        "only sorted transparency can be inspected: choose it for a model with transparent surfaces"
    )]
    InspectUnsorted,
}
