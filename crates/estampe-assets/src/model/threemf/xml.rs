//! XML as elements and their attributes, with the line and the column of each.
//!
//! Names are compared without their prefix. Declarations of document types are refused: they could
//! define entities that expand to any length. Text between elements is not used.

use crate::model::load::Context;
use crate::model::number::parse_f32;
use crate::{AssetError, Location};
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use std::borrow::Cow;

const ADVICE: &str = "export the file again";

/// A reader of one part.
pub(super) struct Xml<'a> {
    reader: Reader<&'a [u8]>,
    text: &'a str,
    /// The package and the part, for messages.
    place: String,
    /// Where the current element starts.
    start: usize,
    depth: u64,
    /// A known place: offset, line from 1, characters before it in the line. Places are asked for
    /// in order, so that all of them together take the time of one pass.
    counted: std::cell::Cell<[usize; 3]>,
}

/// The start of an element.
pub(super) type Tag<'a> = BytesStart<'a>;

impl<'a> Xml<'a> {
    /// A reader of `text`, which is the part `part`.
    pub(super) fn new(text: &'a str, part: &str, context: &Context<'_>) -> Self {
        let mut reader = Reader::from_str(text);
        // An empty element then has an end, as all others.
        reader.config_mut().expand_empty_elements = true;
        Self {
            reader,
            text,
            place: format!("{}, {part}", context.name),
            start: 0,
            depth: 0,
            counted: std::cell::Cell::new([0, 1, 0]),
        }
    }

    /// The next element within the open one, which it opens. `None` at the end of the open one,
    /// which it closes.
    pub(super) fn child(&mut self) -> Result<Option<Tag<'a>>, AssetError> {
        loop {
            self.start = self.offset();
            let event = self.reader.read_event();
            match event.map_err(|error| {
                // The place of the error itself is nearer than the start of what is read.
                self.start = usize::try_from(self.reader.error_position()).unwrap_or(self.start);
                self.malformed(format!("the XML is not well-formed: {error}"))
            })? {
                Event::Start(tag) => {
                    self.depth += 1;
                    return Ok(Some(tag));
                }
                Event::End(_) => {
                    self.depth = self.depth.saturating_sub(1);
                    return Ok(None);
                }
                Event::Eof if self.depth > 0 => {
                    return Err(self.malformed("the XML ends within an element"));
                }
                Event::Eof => return Ok(None),
                Event::DocType(_) => {
                    return Err(self.malformed("the XML declares a document type"));
                }
                _ => {}
            }
        }
    }

    /// Closes the open element with all that is in it.
    pub(super) fn skip(&mut self) -> Result<(), AssetError> {
        let outside = self.depth.saturating_sub(1);
        while self.depth > outside {
            self.child()?;
        }
        Ok(())
    }

    /// The attributes of a tag: their names without prefix, and their values as they are written.
    pub(super) fn attributes<'t>(
        &self,
        tag: &'t Tag<'_>,
    ) -> impl Iterator<Item = Result<(&'t str, Cow<'t, str>), AssetError>> {
        let mut attributes = tag.attributes();
        // The search for equal names takes the square of their number.
        attributes.with_checks(false);
        attributes.map(|attribute| match attribute {
            Ok(attribute) => {
                let name = attribute.key.into_inner();
                let name = name.split_once(':').map_or(name, |(_, local)| local);
                Ok((name, attribute.value))
            }
            Err(error) => Err(self.malformed(format!("an attribute is not well-formed: {error}"))),
        })
    }

    /// An attribute's value with its references replaced.
    pub(super) fn unescaped(&self, value: &str) -> Result<String, AssetError> {
        let text = quick_xml::escape::unescape(value);
        text.map(Cow::into_owned)
            .map_err(|error| self.malformed(format!("an attribute is not well-formed: {error}")))
    }

    /// The number of an attribute.
    pub(super) fn number(&self, name: &str, value: &str) -> Result<f32, AssetError> {
        let text = value.trim_ascii().as_bytes();
        match parse_f32(text) {
            Some((number, len)) if len == text.len() => Ok(number),
            _ => Err(self.malformed(format!("`{name}` is no number"))),
        }
    }

    /// The whole number of an attribute: an identifier or an index.
    pub(super) fn index(&self, name: &str, value: &str) -> Result<u32, AssetError> {
        let number = value.trim_ascii().parse();
        number.map_err(|_| self.malformed(format!("`{name}` is no whole number from 0 to 2³²−1")))
    }

    /// The attribute `name` of the current element is missing.
    pub(super) fn missing(&self, name: &str) -> AssetError {
        self.malformed(format!("the element has no `{name}`"))
    }

    /// The current element breaks a rule.
    pub(super) fn malformed(&self, what: impl Into<String>) -> AssetError {
        self.located(AssetError::malformed(what, ADVICE))
    }

    /// The error with the place of the current element.
    pub(super) fn located(&self, error: AssetError) -> AssetError {
        error.at(self.location()).in_file(&self.place)
    }

    /// A warning about the current element.
    pub(super) fn warn(&self, context: &mut Context<'_>, what: impl FnOnce() -> String) {
        context.warnings.add(&self.place, self.location(), what);
    }

    /// Where the current element starts.
    pub(super) fn location(&self) -> Location {
        let [mut at, mut line, mut column] = self.counted.get();
        if self.start < at {
            [at, line, column] = [0, 1, 0];
        }
        let end = self.start.min(self.text.len());
        for &byte in &self.text.as_bytes()[at..end] {
            if byte == b'\n' {
                line += 1;
                column = 0;
            } else if byte & 0xc0 != 0x80 {
                // Columns count characters, not their further bytes.
                column += 1;
            }
        }
        self.counted.set([end, line, column]);
        // Limits keep texts below 2³² bytes.
        let number = |number: usize| u32::try_from(number).unwrap_or(u32::MAX);
        Location::LineColumn {
            line: number(line),
            column: number(column).saturating_add(1),
        }
    }

    /// The package and the part.
    pub(super) fn place(&self) -> &str {
        &self.place
    }

    fn offset(&self) -> usize {
        usize::try_from(self.reader.buffer_position()).unwrap_or(usize::MAX)
    }
}
