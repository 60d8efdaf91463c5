//! Errors of a command by their cause, which determines the exit code.

use estampe::InspectError;
use estampe_assets::AssetError;
use estampe_ladder::LadderError;
use estampe_renderer::RenderError;
use std::fmt;

/// The command succeeded.
pub(crate) const DONE: u8 = 0;

/// An error: one sentence with the problem, its place, and advice.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Failure {
    /// The input is missing, malformed, or has nothing to draw. Exit code 1.
    Input(String),
    /// The input exceeds a limit. Exit code 1.
    Limit(String),
    /// The command line is invalid. Exit code 2.
    Usage(String),
    /// The output cannot be written, or the system refuses a resource. Exit code 3.
    Output(String),
}

impl Failure {
    /// The process's exit code.
    pub(crate) fn exit_code(&self) -> u8 {
        match self {
            Self::Input(_) | Self::Limit(_) => 1,
            Self::Usage(_) => 2,
            Self::Output(_) => 3,
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Input(message)
            | Self::Limit(message)
            | Self::Usage(message)
            | Self::Output(message) => f.write_str(message),
        }
    }
}

/// Maps reader errors to their cause.
impl From<AssetError> for Failure {
    fn from(error: AssetError) -> Self {
        let message = crate::terminal::one_line(&error.to_string()).into_owned();
        match error {
            AssetError::LimitExceeded(_) => Self::Limit(message),
            _ => Self::Input(message),
        }
    }
}

impl From<RenderError> for Failure {
    fn from(error: RenderError) -> Self {
        match error {
            RenderError::Inspect(InspectError::Outside { .. }) => {
                Self::Usage(format!("{error}; choose another --pixel"))
            }
            RenderError::Inspect(InspectError::TooLarge { .. }) => {
                Self::Output(format!("{error}; try a smaller --size or --samples 1"))
            }
            RenderError::Size { .. } => Self::Usage(format!("{error}; choose another --size")),
            RenderError::EmptySection => Self::Usage(error.to_string()),
            RenderError::TooManyElements { .. }
            | RenderError::Texture(_)
            | RenderError::Bindings(_) => Self::Input(error.to_string()),
            RenderError::Target(_) | RenderError::Pass(_) => {
                Self::Output(format!("{error}; try a smaller --size or --samples 1"))
            }
            _ => Self::Output(error.to_string()),
        }
    }
}

impl From<LadderError> for Failure {
    fn from(error: LadderError) -> Self {
        let message = error.to_string();
        match error {
            LadderError::NoSuchRung { .. } | LadderError::Usage(_) => Self::Usage(message),
            LadderError::Asset(_) | LadderError::NoTriangles { .. } => Self::Input(message),
            _ => Self::Output(message),
        }
    }
}
