//! Places in a text: from byte offsets to lines and columns.

/// The starts of a text's lines.
#[derive(Debug)]
pub(super) struct Lines<'a> {
    text: &'a str,
    starts: Vec<usize>,
}

/// A place in a text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Place {
    /// The line, from 1.
    pub line: u32,
    /// The column, in characters from 1.
    pub column: u32,
    /// The characters that the place covers on its line, at least 1.
    pub length: u32,
    /// The line's text, at most [`LONGEST_LINE`] characters of it.
    pub text: String,
}

/// The most characters of a line that a message repeats.
pub(super) const LONGEST_LINE: usize = 200;

impl<'a> Lines<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        let ends = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
        let starts = core::iter::once(0).chain(ends.map(|(at, _)| at + 1));
        Self {
            text,
            starts: starts.collect(),
        }
    }

    /// The line, from 1, of the byte at `at`.
    pub(super) fn line(&self, at: usize) -> u32 {
        number(self.starts.partition_point(|first| *first <= at))
    }

    /// The place of the bytes from `start` to `end`. Offsets beyond the text are taken to its end.
    pub(super) fn place(&self, start: usize, end: usize) -> Place {
        let start = floor_char(self.text, start.min(self.text.len()));
        let end = floor_char(self.text, end.min(self.text.len()).max(start));
        let line = self.starts.partition_point(|first| *first <= start) - 1;
        let first = self.starts[line];
        let next = self.starts.get(line + 1).copied();
        let last = next.map_or(self.text.len(), |next| next - 1);
        let whole = self.text[first..last.max(first)].trim_end_matches('\r');
        let before = self.text[first..start].chars().count();
        let covered = self.text[start..end.min(last).max(start)].chars().count();
        Place {
            line: number(line + 1),
            column: number(before + 1),
            length: number(covered.max(1)),
            text: whole.chars().take(LONGEST_LINE).collect(),
        }
    }
}

/// The start of the character that the byte at `at` belongs to.
fn floor_char(text: &str, mut at: usize) -> usize {
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

fn number(value: usize) -> u32 {
    u32::try_from(value).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::Lines;

    #[test]
    fn places_count_characters_and_stay_in_the_text() {
        let lines = Lines::new("ab\r\n\u{fc}x y\n");
        let place = lines.place(6, 8);
        assert_eq!((place.line, place.column, place.length), (2, 2, 2));
        assert_eq!(place.text, "\u{fc}x y");
        // Inside of a character, and beyond the text.
        assert_eq!(lines.place(5, 5).column, 1);
        assert_eq!(lines.place(99, 200).line, 3);
        assert_eq!(lines.place(0, 200).length, 3);
        assert_eq!(lines.line(4), 2);
    }
}
