//! A cursor over the statements of OBJ and MTL: lines of words, with any line end.
//!
//! Lines end with LF, CR or CR LF. A backslash before a line end continues the statement; it counts
//! as a blank, without copying the text. `#` starts a comment where a word would start.

use super::number;
use crate::Location;

/// A position in a statement.
#[derive(Debug, Clone)]
pub(super) struct Statements<'a> {
    bytes: &'a [u8],
    at: usize,
    line: u64,
}

fn is_line_end(byte: u8) -> bool {
    byte == b'\n' || byte == b'\r'
}

/// Blanks are all control characters that do not end a line, and the space.
fn is_blank(byte: u8) -> bool {
    byte <= b' ' && !is_line_end(byte)
}

impl<'a> Statements<'a> {
    /// Starts at the first statement; a byte-order mark is skipped.
    pub(super) fn new(bytes: &'a [u8]) -> Self {
        let at = if bytes.starts_with(b"\xef\xbb\xbf") {
            3
        } else {
            0
        };
        Self { bytes, at, line: 1 }
    }

    /// Starts at a byte inside a line, after the header reader.
    pub(super) fn starting_at(bytes: &'a [u8], at: usize, line: u64) -> Self {
        Self { bytes, at, line }
    }

    /// The location of the current line.
    pub(super) fn location(&self) -> Location {
        Location::Line(self.line)
    }

    /// The number of the current line.
    #[inline]
    pub(super) fn line(&self) -> u64 {
        self.line
    }

    /// The current position, in bytes.
    #[inline]
    pub(super) fn at(&self) -> usize {
        self.at
    }

    /// Moves to a later position, over `line_ends` line ends.
    pub(super) fn jump(&mut self, at: usize, line_ends: u64) {
        self.at = at;
        self.line += line_ends;
    }

    /// Moves over a line end with a line feed, if it is the next byte; the line number counts it.
    #[inline]
    pub(super) fn take_line_feed(&mut self) -> bool {
        let rest = &self.bytes[self.at..];
        let is_there = rest.starts_with(b"\n") || rest.starts_with(b"\r\n");
        if is_there {
            self.take_line_end();
        }
        is_there
    }

    /// Moves after the next statement's keyword and returns it; `None` at the end of the file.
    #[inline]
    pub(super) fn next_keyword(&mut self) -> Option<&'a [u8]> {
        if self.find_word() {
            Some(self.take_word())
        } else {
            None
        }
    }

    /// Moves to the end of the statement.
    #[inline]
    pub(super) fn skip_statement(&mut self) {
        loop {
            let rest = &self.bytes[self.at..];
            let Some(length) = rest.iter().position(|&byte| is_line_end(byte)) else {
                self.at = self.bytes.len();
                return;
            };
            self.at += length;
            if length == 0 || rest[length - 1] != b'\\' {
                return;
            }
            self.take_line_end();
        }
    }

    /// Comments are not continued: they may end with the backslash of a path.
    fn skip_comment(&mut self) {
        let rest = &self.bytes[self.at..];
        self.at += rest
            .iter()
            .position(|&byte| is_line_end(byte))
            .unwrap_or(rest.len());
    }

    /// The next word of the statement; `None` at its end or at a comment.
    #[inline]
    pub(super) fn word(&mut self) -> Option<&'a [u8]> {
        if self.is_at_end() {
            None
        } else {
            Some(self.take_word())
        }
    }

    /// True if no word is left in the statement.
    #[inline]
    pub(super) fn is_at_end(&mut self) -> bool {
        self.skip_blanks();
        matches!(self.bytes.get(self.at), None | Some(b'\n' | b'\r' | b'#'))
    }

    /// The next word as a number: `None` at the end, `Some(None)` if it is not a number (it is
    /// skipped).
    #[inline]
    pub(super) fn number(&mut self) -> Option<Option<f32>> {
        if self.is_at_end() {
            return None;
        }
        if let Some((value, length)) = number::parse_f32(&self.bytes[self.at..]) {
            let end = self.at + length;
            if self
                .bytes
                .get(end)
                .is_none_or(|&byte| byte <= b' ' || byte == b'\\')
            {
                self.at = end;
                return Some(Some(value));
            }
        }
        self.take_word();
        Some(None)
    }

    /// Moves over blanks, line ends and comments to the next word; `false` at the end of the file.
    #[inline]
    pub(super) fn find_word(&mut self) -> bool {
        loop {
            self.skip_blanks();
            match self.bytes.get(self.at) {
                None => return false,
                Some(b'\n' | b'\r') => self.take_line_end(),
                Some(b'#') => self.skip_comment(),
                Some(_) => return true,
            }
        }
    }

    /// The text up to the end of the statement, without blanks around it. A `#` is part of it,
    /// because file names may contain it. Continued lines are not joined: no name crosses a line
    /// end.
    pub(super) fn rest(&mut self) -> &'a [u8] {
        self.skip_blanks();
        let start = self.at;
        self.skip_statement();
        self.bytes[start..self.at].trim_ascii()
    }

    /// True if the next word starts with `prefix`.
    pub(super) fn remaining_starts_with(&mut self, prefix: &[u8]) -> bool {
        self.skip_blanks();
        self.bytes[self.at..].starts_with(prefix)
    }

    /// The bytes from the cursor on, for the reader of face corners.
    #[inline]
    pub(super) fn remaining(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }

    /// Moves by `count` bytes of the text of [`Self::remaining`], which contain no line end.
    #[inline]
    pub(super) fn advance(&mut self, count: usize) {
        self.at += count;
    }

    #[inline]
    fn take_word(&mut self) -> &'a [u8] {
        let rest = &self.bytes[self.at..];
        let ends = |i: usize| rest[i] <= b' ' || (rest[i] == b'\\' && is_continued(&rest[i..]));
        let length = (0..rest.len()).find(|&i| ends(i)).unwrap_or(rest.len());
        self.at += length;
        &rest[..length]
    }

    #[inline]
    fn skip_blanks(&mut self) {
        while let Some(&byte) = self.bytes.get(self.at) {
            if is_blank(byte) {
                self.at += 1;
            } else if byte == b'\\' && is_continued(&self.bytes[self.at..]) {
                self.at += 1;
                self.take_line_end();
            } else {
                return;
            }
        }
    }

    #[inline]
    fn take_line_end(&mut self) {
        let is_pair = self.bytes[self.at..].starts_with(b"\r\n");
        self.at += 1 + usize::from(is_pair);
        self.line += 1;
    }
}

/// True if a backslash at the start of `rest` is at its line's end. At the end of the file it is
/// not: there it is a word.
fn is_continued(rest: &[u8]) -> bool {
    rest.get(1).is_some_and(|&byte| is_line_end(byte))
}
