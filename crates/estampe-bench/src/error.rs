//! Errors of the benchmarks.

use estampe::{
    BindGroupError, BufferError, ComputePipelineError, DeviceError, DispatchError, LevelError,
    PipelineError, RenderPassError, ShaderErrors, ShaderModuleError, TextureError,
};
use std::path::PathBuf;

/// The reason why a benchmark stopped.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BenchError {
    /// No scene has this name.
    #[error("no scene is named '{name}'; the scenes are {known}")]
    UnknownScene {
        /// The requested name.
        name: String,
        /// The names of all scenes.
        known: String,
    },
    /// No state has this name.
    #[error("no state and no group of states is named '{name}'; the states are {known}")]
    UnknownState {
        /// The requested name.
        name: String,
        /// The names of all states.
        known: String,
    },
    /// No operation has this name.
    #[error(
        "no operation and no group of operations is named '{name}'; the operations are {known}"
    )]
    UnknownOperation {
        /// The requested name.
        name: String,
        /// The names of all operations.
        known: String,
    },
    /// The scenes have no shaders in Rust.
    #[error("{scenes}: written in WGSL alone; draw with --shaders wgsl")]
    WgslOnly {
        /// Their names.
        scenes: String,
    },
    /// The SIMD level cannot be used.
    #[error(transparent)]
    Level(#[from] LevelError),
    /// The device cannot be created.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// A scene's pipeline was refused.
    #[error(transparent)]
    Pipeline(#[from] PipelineError),
    /// A scene's compute pipeline was refused.
    #[error(transparent)]
    ComputePipeline(#[from] ComputePipelineError),
    /// A scene's module was refused.
    #[error(transparent)]
    Module(#[from] ShaderErrors),
    /// The entry points of a scene's module do not make a program.
    #[error(transparent)]
    Program(#[from] ShaderModuleError),
    /// A buffer was refused.
    #[error(transparent)]
    Buffer(#[from] BufferError),
    /// A bind group was refused.
    #[error(transparent)]
    BindGroup(#[from] BindGroupError),
    /// A texture was refused.
    #[error(transparent)]
    Texture(#[from] TextureError),
    /// A dispatch was refused.
    #[error(transparent)]
    Dispatch(#[from] DispatchError),
    /// A pass was refused.
    #[error(transparent)]
    Pass(#[from] RenderPassError),
    /// A file cannot be read or written.
    #[error("{path}: {source}")]
    File {
        /// The file's path.
        path: PathBuf,
        /// The system's message.
        source: std::io::Error,
    },
    /// A picture or another file has unexpected contents.
    #[error("{path}: {reason}")]
    Picture {
        /// The file's path.
        path: PathBuf,
        /// The unexpected contents.
        reason: String,
    },
    /// A requirement of the comparison is missing.
    #[error("{what}; {remedy}")]
    Missing {
        /// The missing requirement.
        what: String,
        /// Advice for the user.
        remedy: String,
    },
    /// Another program failed.
    #[error("{command}: {reason}")]
    Command {
        /// Its command line.
        command: String,
        /// The exit status and the error output, or another reason why the command failed.
        reason: String,
    },
}

impl BenchError {
    /// Returns true if the command line is at fault, and not a file or the system.
    #[must_use]
    pub fn is_usage(&self) -> bool {
        matches!(
            self,
            Self::UnknownScene { .. }
                | Self::UnknownState { .. }
                | Self::UnknownOperation { .. }
                | Self::WgslOnly { .. }
                | Self::Level(_)
                | Self::Device(_)
                | Self::Buffer(_)
                | Self::BindGroup(_)
        )
    }
}
