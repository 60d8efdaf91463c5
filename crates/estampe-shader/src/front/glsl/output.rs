//! The rewritten text, and the author's places of its parts.

use core::ops::Range;

use super::token::Place;

/// A text that grows, with the place that each part comes from.
#[derive(Debug, Default)]
pub(super) struct Output {
    pub text: String,
    /// Where parts begin, and the author's place of each.
    parts: Vec<(usize, Option<Place>)>,
}

impl Output {
    /// Appends a token, or text that is made for a place.
    pub(super) fn put(&mut self, text: &str, place: Option<Place>) {
        self.parts.push((self.text.len(), place));
        self.text.push_str(text);
        let ends_line = text.ends_with([';', '{', '}']);
        self.text.push(if ends_line { '\n' } else { ' ' });
    }

    /// The author's place of bytes of the rewritten text.
    pub(super) fn place(&self, range: Range<usize>) -> Option<Place> {
        let part_at = |at: usize| {
            let after = self.parts.partition_point(|(start, _)| *start <= at);
            self.parts.get(after.checked_sub(1)?)?.1
        };
        let first = part_at(range.start)?;
        let last = part_at(range.end.max(range.start + 1) - 1).unwrap_or(first);
        Some(if last.start >= first.start {
            first.to(last)
        } else {
            first
        })
    }
}
