//! The text of a file in windows: parts that end where a statement ends, one after the other.
//!
//! Threads read the plain lines of windows ahead, while the reader takes windows in order. Few
//! windows are in memory at a time, and their memory is used again, so that a file that is read
//! from a stream is never in memory as a whole, and costs few page faults.

use super::plain::{Run, read_runs};
use crate::model::encoding::utf8_from_utf16;
use crate::{AssetError, Limits};
use std::io::Read;

/// The text of a file.
pub(in crate::model) enum Text<'a> {
    /// The bytes.
    Memory(&'a [u8]),
    /// A stream of bytes, of about this length if it is known.
    Stream(&'a mut (dyn Read + Send), Option<u64>),
}

impl Text<'_> {
    /// True if the text is at most so long.
    pub(super) fn is_at_most(&self, len: usize) -> bool {
        match self {
            Self::Memory(bytes) => bytes.len() <= len,
            Self::Stream(_, expected) => expected.is_some_and(|expected| expected <= len as u64),
        }
    }
}

/// A part of the text, and its runs of plain lines.
#[derive(Debug, Default)]
pub(super) struct Window<'a> {
    /// The bytes, if they are not in memory anyway.
    own: Vec<u8>,
    shared: Option<&'a [u8]>,
    /// The runs in order, once they are read.
    pub(super) runs: Vec<Run>,
    /// Runs whose memory is used again.
    spare: Vec<Run>,
}

impl Window<'_> {
    /// Whole statements.
    pub(super) fn bytes(&self) -> &[u8] {
        self.shared.unwrap_or(&self.own)
    }

    /// Reads the runs of plain lines.
    pub(super) fn read_plain_lines(&mut self) {
        /// The memory of a run is up to that of a window, and a hostile window can have hundreds.
        const MOST_SPARE: usize = 4;
        self.spare.append(&mut self.runs);
        self.spare.truncate(MOST_SPARE);
        let bytes = self.shared.unwrap_or(&self.own);
        read_runs(bytes, &mut self.runs, &mut self.spare);
    }
}

/// Divides a text into windows.
pub(super) struct Windows<'a> {
    text: Text<'a>,
    /// Bytes of a window, more or less.
    size: usize,
    /// Bytes of a stream that were read and belong to the next window.
    rest: Vec<u8>,
    /// Bytes that were read of a stream so far.
    read: u64,
    most_bytes: u64,
}

impl<'a> Windows<'a> {
    pub(super) fn new(text: Text<'a>, size: usize, limits: &Limits) -> Self {
        Self {
            text,
            // Two bytes tell UTF-16.
            size: size.max(2),
            rest: Vec::new(),
            read: 0,
            most_bytes: limits.max_file_bytes,
        }
    }

    /// Fills the next window; false at the end of the text.
    pub(super) fn next(&mut self, window: &mut Window<'a>) -> Result<bool, AssetError> {
        match &mut self.text {
            Text::Memory(rest) => {
                let end = end_from(rest, self.size - 1).unwrap_or(rest.len());
                let (bytes, others) = rest.split_at(end);
                *rest = others;
                window.shared = Some(bytes);
                Ok(!bytes.is_empty())
            }
            Text::Stream(..) => self.next_of_stream(&mut window.own),
        }
    }

    fn next_of_stream(&mut self, window: &mut Vec<u8>) -> Result<bool, AssetError> {
        let is_first = self.read == 0;
        window.clear();
        window.append(&mut self.rest);
        loop {
            let before = window.len();
            self.read_more(self.size as u64, window)?;
            if is_first && before == 0 && matches!(**window, [0xff, 0xfe, ..] | [0xfe, 0xff, ..]) {
                self.read_more(u64::MAX, window)?;
                *window = utf8_from_utf16(window).unwrap_or_default();
                return Ok(!window.is_empty());
            }
            if window.len() == before {
                // The end of the file.
                return Ok(!window.is_empty());
            }
            if let Some(end) = last_end(window, before) {
                self.rest.extend_from_slice(&window[end..]);
                window.truncate(end);
                return Ok(true);
            }
        }
    }

    /// Appends at most so many bytes of the stream, none at its end alone.
    fn read_more(&mut self, most: u64, window: &mut Vec<u8>) -> Result<(), AssetError> {
        let Text::Stream(stream, _) = &mut self.text else {
            return Ok(());
        };
        let allowed = self.most_bytes.saturating_sub(self.read);
        let before = window.len();
        window.reserve(self.size);
        let mut part = stream.take(most.min(allowed.saturating_add(1)));
        let failed = |error: std::io::Error| {
            AssetError::io(error.to_string(), "check the path and its permissions")
        };
        part.read_to_end(window).map_err(failed)?;
        self.read += (window.len() - before) as u64;
        Limits::check("bytes", self.read, self.most_bytes)
    }
}

/// The end of the first statement that ends with a line feed at `from` or later.
fn end_from(bytes: &[u8], from: usize) -> Option<usize> {
    let later = bytes.get(from..)?.iter().enumerate();
    { later.filter(|&(_, &byte)| byte == b'\n') }
        .map(|(index, _)| from + index + 1)
        .find(|&end| ends_statement(&bytes[..end]))
}

/// The end of the last statement that ends with a line feed at `from` or later.
fn last_end(bytes: &[u8], from: usize) -> Option<usize> {
    let later = bytes.get(from..)?.iter().enumerate();
    { later.rev().filter(|&(_, &byte)| byte == b'\n') }
        .map(|(index, _)| from + index + 1)
        .find(|&end| ends_statement(&bytes[..end]))
}

/// True unless a backslash before the line feed at the end of `bytes` continues the statement.
/// Where it ends a comment it does not, which makes no difference: windows are only longer.
fn ends_statement(bytes: &[u8]) -> bool {
    !(bytes.ends_with(b"\\\n") || bytes.ends_with(b"\\\r\n"))
}
