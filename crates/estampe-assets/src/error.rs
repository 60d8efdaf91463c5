//! Errors of readers and writers: the kind, the problem, its location, and advice.

use std::fmt;

/// The reason why a file could not be read or written.
///
/// The variant is the cause; the [`Fault`] describes the problem, its location, and advice.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum AssetError {
    /// The system refused the operation: no such file, no permission, a failed read or write.
    #[error("{0}")]
    Io(Fault),
    /// The bytes break the rules of their format.
    #[error("{0}")]
    Malformed(Fault),
    /// The bytes may be valid, but use a feature that is not supported here.
    #[error("{0}")]
    Unsupported(Fault),
    /// The file asks for more than [`Limits`](crate::Limits) allow.
    #[error("{0}")]
    LimitExceeded(Fault),
}

/// The problem, its location, and advice.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// Name of the file; empty while it is not known (the caller adds it).
    pub file: String,
    /// JSON Pointer (RFC 6901) of the value, such as `/accessors/3/count`; empty if the file is not
    /// JSON.
    pub json_pointer: Box<str>,
    /// Location in the file.
    pub location: Option<Location>,
    /// The problem.
    pub what: String,
    /// Advice for the user.
    pub advice: String,
}

/// A location in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Location {
    /// A line of a text file, counted from 1.
    Line(u64),
    /// A character of a text file in which lines may be long.
    LineColumn {
        /// The line, counted from 1.
        line: u32,
        /// The character in the line, counted from 1.
        column: u32,
    },
    /// A byte of a binary file, counted from 0.
    Byte(u64),
}

impl AssetError {
    /// The system refused; `what` names the operation and the system's message.
    pub fn io(what: impl Into<String>, advice: impl Into<String>) -> Self {
        Self::Io(Fault::new(what, advice))
    }

    /// The bytes break their format's rules.
    pub fn malformed(what: impl Into<String>, advice: impl Into<String>) -> Self {
        Self::Malformed(Fault::new(what, advice))
    }

    /// A feature that is not supported here.
    pub fn unsupported(what: impl Into<String>, advice: impl Into<String>) -> Self {
        Self::Unsupported(Fault::new(what, advice))
    }

    /// More than the limits allow.
    pub fn limit_exceeded(what: impl Into<String>, advice: impl Into<String>) -> Self {
        Self::LimitExceeded(Fault::new(what, advice))
    }

    /// Adds the location in the file.
    #[must_use]
    pub fn at(mut self, location: Location) -> Self {
        self.fault_mut().location = Some(location);
        self
    }

    /// Adds the JSON Pointer of the value.
    #[must_use]
    pub fn at_json(mut self, pointer: impl Into<String>) -> Self {
        self.fault_mut().json_pointer = pointer.into().into_boxed_str();
        self
    }

    /// Adds the file's name, unless there is one already.
    #[must_use]
    pub fn in_file(mut self, file: &str) -> Self {
        let fault = self.fault_mut();
        if fault.file.is_empty() {
            file.clone_into(&mut fault.file);
        }
        self
    }

    /// The problem, its location, and advice.
    #[must_use]
    pub fn fault(&self) -> &Fault {
        match self {
            Self::Io(fault)
            | Self::Malformed(fault)
            | Self::Unsupported(fault)
            | Self::LimitExceeded(fault) => fault,
        }
    }

    fn fault_mut(&mut self) -> &mut Fault {
        match self {
            Self::Io(fault)
            | Self::Malformed(fault)
            | Self::Unsupported(fault)
            | Self::LimitExceeded(fault) => fault,
        }
    }
}

impl Fault {
    fn new(what: impl Into<String>, advice: impl Into<String>) -> Self {
        Self {
            file: String::new(),
            json_pointer: Box::default(),
            location: None,
            what: what.into(),
            advice: advice.into(),
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write_place(f, &self.file, &self.json_pointer, self.location)?;
        write!(f, "{}", self.what)?;
        if self.advice.is_empty() {
            Ok(())
        } else {
            write!(f, "; {}", self.advice)
        }
    }
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::LineColumn { line, column } => write!(f, "line {line}, column {column}"),
            Self::Byte(offset) => write!(f, "byte {offset}"),
        }
    }
}

/// Writes `file, /nodes/3, line 3: `, or as much of it as is known.
pub(crate) fn write_place(
    f: &mut fmt::Formatter<'_>,
    file: &str,
    json_pointer: &str,
    location: Option<Location>,
) -> fmt::Result {
    let mut separator = "";
    for part in [file, json_pointer] {
        if !part.is_empty() {
            write!(f, "{separator}{part}")?;
            separator = ", ";
        }
    }
    if let Some(location) = location {
        write!(f, "{separator}{location}")?;
        separator = ", ";
    }
    f.write_str(if separator.is_empty() { "" } else { ": " })
}
