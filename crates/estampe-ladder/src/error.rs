//! Errors of the ladder.

use estampe::{
    BindGroupError, BufferError, DeviceError, PipelineError, ShaderErrors, ShaderModuleError,
    TextureError, UniformError,
};
use estampe_assets::AssetError;
use estampe_shapes::expression::ExpressionError;
use estampe_shapes::implicit::ImplicitError;
use estampe_shapes::polygon::PolygonError;

/// The reason why a rung has no picture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LadderError {
    /// No rung has this number.
    #[error("there is no rung {number}; the rungs are 1 to 23, or all")]
    NoSuchRung {
        /// The given number.
        number: u32,
    },
    /// The command line of an example is wrong.
    #[error("{0}")]
    Usage(String),
    /// A model or texture cannot be read, or the picture cannot be encoded.
    #[error(transparent)]
    Asset(#[from] AssetError),
    /// The model has no triangles.
    #[error("{name}: the model has no triangles to draw; take another model")]
    NoTriangles {
        /// The model's name.
        name: String,
    },
    /// The picture cannot be written.
    #[error("{path}: {cause}; check the folder, its permissions and space")]
    Write {
        /// The file.
        path: String,
        /// The system's reason.
        cause: std::io::Error,
    },
    /// A function is not an expression.
    #[error(transparent)]
    Expression(#[from] ExpressionError),
    /// An implicit function cannot be meshed.
    #[error(transparent)]
    Implicit(#[from] ImplicitError),
    /// A polygon cannot be filled.
    #[error(transparent)]
    Polygon(#[from] PolygonError),
    /// The system starts no threads.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// A buffer is too large for the device.
    #[error(transparent)]
    Buffer(#[from] BufferError),
    /// A texture is too large for the device.
    #[error(transparent)]
    Texture(#[from] TextureError),
    /// A bind group does not fit its layout.
    #[error(transparent)]
    BindGroup(#[from] BindGroupError),
    /// The text of a shader has mistakes.
    #[error(transparent)]
    ShaderText(#[from] ShaderErrors),
    /// The shaders of a program do not fit each other.
    #[error(transparent)]
    ShaderModule(#[from] ShaderModuleError),
    /// A shader has no uniform of this name and type.
    #[error(transparent)]
    Uniform(#[from] UniformError),
    /// A pipeline is not valid.
    #[error(transparent)]
    Pipeline(#[from] PipelineError),
    /// A pass is not valid.
    #[error(transparent)]
    Pass(#[from] estampe::RenderPassError),
}
