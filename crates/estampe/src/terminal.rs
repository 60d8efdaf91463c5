//! Text from files and paths, made safe for a terminal.
//!
//! A model's names and a folder's paths may contain escape sequences, which move the cursor, change
//! a terminal's title or hide text, and marks that reorder text. They are written as `\u{1b}`.

use std::borrow::Cow;

/// The text on one line: every control character is escaped.
pub(crate) fn one_line(text: &str) -> Cow<'_, str> {
    escaped(text, |_| false)
}

/// The text with its line ends and tabs; every other control character is escaped.
pub(crate) fn lines(text: &str) -> Cow<'_, str> {
    escaped(text, |c| matches!(c, '\n' | '\t'))
}

fn escaped(text: &str, is_kept: impl Fn(char) -> bool) -> Cow<'_, str> {
    let is_escaped = |c: char| (c.is_control() || reorders(c)) && !is_kept(c);
    if !text.contains(is_escaped) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if is_escaped(c) {
            out.extend(c.escape_unicode());
        } else {
            out.push(c);
        }
    }
    Cow::Owned(out)
}

/// Explicit marks of the bidirectional algorithm, by which text can look like another one.
fn reorders(c: char) -> bool {
    matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

#[cfg(test)]
mod tests {
    use super::{lines, one_line};

    #[test]
    fn control_characters_are_escaped_and_text_stays() {
        assert_eq!(one_line("für 日本\u{1b}[2J\n"), "für 日本\\u{1b}[2J\\u{a}");
        assert_eq!(lines("a\n\tb\u{9b}\r"), "a\n\tb\\u{9b}\\u{d}");
        assert_eq!(one_line("a\u{202e}b\u{7f}"), "a\\u{202e}b\\u{7f}");
        assert_eq!(one_line("plain"), "plain");
    }
}
