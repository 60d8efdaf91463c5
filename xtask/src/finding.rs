//! A finding of a check: its place, its message, and its severity, which decides whether the build
//! fails.

use std::fmt;
use std::path::PathBuf;

/// The severity of a finding, which decides whether the check fails.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Severity {
    /// Printed, and answered at review.
    Note,
    /// Fails the check.
    Error,
}

/// One place that breaks a rule.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// The severity, which decides whether the check fails.
    pub severity: Severity,
    /// The file, relative to the repository's root.
    pub path: PathBuf,
    /// The line, from 1; 0 where the finding is about the whole file.
    pub line: usize,
    /// The message: the fault and its remedy.
    pub message: String,
}

impl Finding {
    /// A finding that fails the check.
    pub(crate) fn error(path: impl Into<PathBuf>, line: usize, message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Error,
            path: path.into(),
            line,
            message: message.into(),
        }
    }

    /// A finding that is only printed.
    pub(crate) fn note(path: impl Into<PathBuf>, line: usize, message: impl Into<String>) -> Self {
        Self {
            severity: Severity::Note,
            path: path.into(),
            line,
            message: message.into(),
        }
    }

    /// Returns true if the finding fails the check.
    #[must_use]
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let kind = match self.severity {
            Severity::Note => "note",
            Severity::Error => "error",
        };
        write!(f, "{kind}: {}", self.path.display())?;
        if self.line > 0 {
            write!(f, ":{}", self.line)?;
        }
        write!(f, ": {}", self.message)
    }
}
