//! What is wrong with a GLSL text, and where.

use super::super::ShaderError;
use super::super::lines::Lines;
use super::token::Place;

/// What is wrong, at a place of the author's text.
#[derive(Debug, Clone)]
pub(super) struct Fault {
    message: String,
    help: Option<String>,
    place: Option<Place>,
}

impl Fault {
    pub(super) fn new(message: impl Into<String>, place: Place) -> Self {
        Self {
            message: message.into(),
            help: None,
            place: Some(place),
        }
    }

    /// A fault at a place that may be unknown.
    pub(super) fn at(message: impl Into<String>, place: Option<Place>) -> Self {
        Self {
            message: message.into(),
            help: None,
            place,
        }
    }

    /// The fault with advice.
    pub(super) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// The error in a text.
    pub(super) fn in_text(self, lines: &Lines<'_>) -> ShaderError {
        let error = ShaderError {
            help: self.help,
            ..ShaderError::new(self.message)
        };
        match self.place {
            Some(place) => error.at(lines, place.start as usize, place.end as usize),
            None => error,
        }
    }
}
