//! Errors in shaders: where, what, and what to do.

use core::fmt::{self, Write};

use super::lines::{Lines, Place};

/// An error in a shader.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ShaderError {
    /// The name of the file, if it was given.
    pub file: Option<String>,
    /// The line, from 1; 0 if the error has no place in the text.
    pub line: u32,
    /// The column, in characters from 1; 0 if the error has no place in the text.
    pub column: u32,
    /// The characters that the error covers on its line; 0 without a place.
    pub length: u32,
    /// What is wrong, in the words of the source language.
    pub message: String,
    /// What to do about it.
    pub help: Option<String>,
    /// The line's text. Empty without a place, and for SPIR-V.
    pub line_text: String,
}

impl ShaderError {
    /// An error without a place.
    pub(super) fn new(message: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            ..Self::default()
        }
    }

    /// The error at the bytes from `start` to `end` of a text.
    pub(super) fn at(mut self, lines: &Lines<'_>, start: usize, end: usize) -> Self {
        let Place {
            line,
            column,
            length,
            text,
        } = lines.place(start, end);
        self.line = line;
        self.column = column;
        self.length = length;
        self.line_text = text;
        self
    }

    /// The error with advice.
    pub(super) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

impl fmt::Display for ShaderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let file = self.file.as_deref().unwrap_or("shader");
        if self.line == 0 {
            write!(f, "{file}: error: {}", self.message)?;
        } else {
            let (line, column) = (self.line, self.column);
            writeln!(f, "{file}:{line}:{column}: error: {}", self.message)?;
            let shown: String = self.line_text.chars().map(printable).collect();
            writeln!(f, "  {shown}")?;
            let characters = self.line_text.chars().count();
            let before = (column as usize - 1).min(characters);
            let length = (self.length as usize).clamp(1, (characters - before).max(1));
            write!(f, "  {}{}", " ".repeat(before), "^".repeat(length))?;
        }
        if let Some(help) = &self.help {
            write!(f, "\n  help: {help}")?;
        }
        Ok(())
    }
}

/// A character that takes one column: tabs and control characters become spaces.
fn printable(character: char) -> char {
    if character.is_control() {
        ' '
    } else {
        character
    }
}

/// The errors in a shader, at least one.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ShaderErrors {
    /// The errors, in the order in which they were found.
    pub errors: Vec<ShaderError>,
}

impl ShaderErrors {
    /// The errors as JSON: `{"ok":false,"errors":[{"line":…,"column":…,"message":…}, …]}`.
    /// Each also has `length`, `help` (a string or null) and `file` (a string or null).
    #[must_use]
    pub fn to_json(&self) -> String {
        let mut json = format!("{{\"ok\":{},\"errors\":[", self.errors.is_empty());
        for (index, error) in self.errors.iter().enumerate() {
            if index > 0 {
                json.push(',');
            }
            let (line, column, length) = (error.line, error.column, error.length);
            json.push_str(&format!(
                "{{\"line\":{line},\"column\":{column},\"length\":{length},\"message\":"
            ));
            push_string(&mut json, &error.message);
            for (name, value) in [("help", &error.help), ("file", &error.file)] {
                json.push_str(&format!(",\"{name}\":"));
                match value {
                    Some(value) => push_string(&mut json, value),
                    None => json.push_str("null"),
                }
            }
            json.push('}');
        }
        json.push_str("]}");
        json
    }

    /// The errors with the name of the file.
    pub(super) fn in_file(mut self, file: Option<&str>) -> Self {
        for error in &mut self.errors {
            error.file = file.map(str::to_owned);
        }
        self
    }
}

/// Appends a string of JSON (RFC 8259, section 7).
fn push_string(json: &mut String, text: &str) {
    json.push('"');
    for character in text.chars() {
        match character {
            '"' => json.push_str("\\\""),
            '\\' => json.push_str("\\\\"),
            '\n' => json.push_str("\\n"),
            '\r' => json.push_str("\\r"),
            '\t' => json.push_str("\\t"),
            control if control < ' ' => {
                // Writing to a string cannot fail.
                let _ = write!(json, "\\u{:04x}", control as u32);
            }
            other => json.push(other),
        }
    }
    json.push('"');
}

impl From<ShaderError> for ShaderErrors {
    fn from(error: ShaderError) -> Self {
        Self {
            errors: vec![error],
        }
    }
}

impl fmt::Display for ShaderErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, error) in self.errors.iter().enumerate() {
            if index > 0 {
                writeln!(f)?;
            }
            write!(f, "{error}")?;
        }
        Ok(())
    }
}

impl core::error::Error for ShaderErrors {}
