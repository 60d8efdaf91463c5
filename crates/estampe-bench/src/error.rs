//! What can go wrong in a benchmark.

use estampe::{DeviceError, LevelError, PipelineError, TargetError};
use std::path::PathBuf;

/// Why a benchmark stopped.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BenchError {
    /// There is no scene of that name.
    #[error("no scene is named '{name}'; the scenes are {known}")]
    UnknownScene {
        /// What was asked for.
        name: String,
        /// What there is.
        known: String,
    },
    /// There is no state of that name.
    #[error("no state and no group of states is named '{name}'; the states are {known}")]
    UnknownState {
        /// What was asked for.
        name: String,
        /// What there is.
        known: String,
    },
    /// The SIMD level cannot be used.
    #[error(transparent)]
    Level(#[from] LevelError),
    /// There is no device.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// A scene's pipeline was refused.
    #[error(transparent)]
    Pipeline(#[from] PipelineError),
    /// A render target was refused.
    #[error(transparent)]
    Target(#[from] TargetError),
    /// A texture was refused.
    #[error("{0}")]
    Texture(String),
    /// A file cannot be read or written.
    #[error("{path}: {source}")]
    File {
        /// Which file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
    },
    /// A picture or another file does not hold what it should.
    #[error("{path}: {reason}")]
    Picture {
        /// Which file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// Something that a comparison needs is not there.
    #[error("{what}; {remedy}")]
    Missing {
        /// What.
        what: String,
        /// What to do about it.
        remedy: String,
    },
    /// Another program failed.
    #[error("{command}: {reason}")]
    Command {
        /// Its command line.
        command: String,
        /// How it ended, and what it said.
        reason: String,
    },
}

impl BenchError {
    /// Whether the command line is at fault.
    #[must_use]
    pub fn is_usage(&self) -> bool {
        matches!(
            self,
            Self::UnknownScene { .. }
                | Self::UnknownState { .. }
                | Self::Level(_)
                | Self::Device(_)
                | Self::Target(_)
        )
    }
}
