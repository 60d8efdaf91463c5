//! Warnings: tolerated errors with their location, bounded in number.

use crate::{Location, error::write_place};
use std::fmt;

/// An irregularity in a file that did not stop its reading.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Warning {
    /// Name of the file, which may be a side file (a material library, a texture).
    pub file: String,
    /// JSON Pointer (RFC 6901) of the value; empty if the file is not JSON.
    pub json_pointer: String,
    /// Location in the file.
    pub location: Option<Location>,
    /// The irregularity and how it was handled.
    pub message: String,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write_place(f, &self.file, &self.json_pointer, self.location)?;
        write!(f, "{}", self.message)
    }
}

/// Collects warnings: the first ones are kept as text, all are counted.
///
/// A hostile file can cause one per byte, so texts are only made for those that are kept.
#[derive(Debug)]
pub(crate) struct Warnings {
    kept: Vec<Warning>,
    count: u64,
    max_kept: usize,
}

impl Warnings {
    pub(crate) fn new(max_kept: usize) -> Self {
        Self {
            kept: Vec::new(),
            count: 0,
            max_kept,
        }
    }

    pub(crate) fn add(
        &mut self,
        file: &str,
        location: impl Into<Option<Location>>,
        message: impl FnOnce() -> String,
    ) {
        self.count += 1;
        if self.kept.len() < self.max_kept {
            let warning = Warning {
                file: file.to_owned(),
                json_pointer: String::new(),
                location: location.into(),
                message: message(),
            };
            self.kept.push(warning);
        }
    }

    /// Adds a warning of a JSON file; `message` returns the JSON Pointer and the text.
    pub(crate) fn add_at_json(&mut self, file: &str, message: impl FnOnce() -> (String, String)) {
        self.count += 1;
        if self.kept.len() < self.max_kept {
            let (json_pointer, message) = message();
            let warning = Warning {
                file: file.to_owned(),
                json_pointer,
                location: None,
                message,
            };
            self.kept.push(warning);
        }
    }

    /// The kept warnings, and the number of all.
    pub(crate) fn finish(self) -> (Vec<Warning>, u64) {
        (self.kept, self.count)
    }
}
