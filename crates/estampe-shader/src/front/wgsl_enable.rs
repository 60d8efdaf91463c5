//! `enable subgroups;`, which naga does not read although it has subgroups: it is blanked out, so
//! that all places in the text stay where they are.

use std::borrow::Cow;
use std::ops::Range;

/// The extension that naga has without the directive.
const SUBGROUPS: &str = "subgroups";

/// The text without the extension in its directives.
pub(super) fn without_subgroups(text: &str) -> Cow<'_, str> {
    let mut found: Option<Vec<u8>> = None;
    let mut at = 0;
    // Directives are before everything else (WGSL, section 4).
    while let Some(directive) = directive(text, at) {
        at = directive.end;
        if text[directive.clone()].starts_with("enable") {
            for range in blanked(text, directive) {
                let bytes = found.get_or_insert_with(|| text.as_bytes().to_vec());
                let blank = bytes[range].iter_mut().filter(|byte| **byte != b'\n');
                blank.for_each(|byte| *byte = b' ');
            }
        }
    }
    // Whole words are replaced by spaces.
    match found.and_then(|bytes| String::from_utf8(bytes).ok()) {
        Some(text) => Cow::Owned(text),
        None => Cow::Borrowed(text),
    }
}

/// The next directive from a place on, with its semicolon.
fn directive(text: &str, mut at: usize) -> Option<Range<usize>> {
    loop {
        let rest = &text[at..];
        let trimmed = rest.trim_start();
        at += rest.len() - trimmed.len();
        at += if trimmed.starts_with("//") {
            trimmed.find('\n').unwrap_or(trimmed.len())
        } else if trimmed.starts_with("/*") {
            comment(trimmed)
        } else {
            let directives = ["enable", "requires", "diagnostic"];
            let is_directive = directives.iter().any(|word| {
                let rest = trimmed.strip_prefix(word);
                rest.is_some_and(|rest| rest.starts_with(|next: char| !is_of_word(next)))
            });
            let end = trimmed.find(';').filter(|_| is_directive)?;
            return Some(at..at + end + 1);
        };
    }
}

/// The bytes of the block comment with which a text begins. Such comments nest.
fn comment(text: &str) -> usize {
    let (mut depth, mut at) = (0_usize, 0);
    while let Some(next) = text[at..].find(['/', '*']) {
        at += next;
        if text[at..].starts_with("/*") {
            depth += 1;
            at += 2;
        } else if text[at..].starts_with("*/") {
            depth = depth.saturating_sub(1);
            at += 2;
            if depth == 0 {
                return at;
            }
        } else {
            at += 1;
        }
    }
    text.len()
}

/// What of a directive is left out: the name with the comma beside it, or all if it has no other.
fn blanked(text: &str, directive: Range<usize>) -> Vec<Range<usize>> {
    let names = directive.start + "enable".len()..directive.end - 1;
    let mut start = names.start;
    let mut ranges = Vec::new();
    for name in text[names.clone()].split(',') {
        ranges.push(start..start + name.len());
        start += name.len() + 1;
    }
    let is_it = |range: &Range<usize>| text[range.clone()].trim() == SUBGROUPS;
    if !ranges.iter().any(is_it) {
        return Vec::new();
    }
    if ranges.iter().all(is_it) {
        return vec![directive];
    }
    let mut left_out = Vec::new();
    for range in ranges.iter().filter(|range| is_it(range)) {
        // With the comma before it; the first one with that after it.
        left_out.push(match range.start == names.start {
            true => range.start..range.end + 1,
            false => range.start - 1..range.end,
        });
    }
    left_out
}

fn is_of_word(character: char) -> bool {
    character.is_alphanumeric() || character == '_'
}

#[cfg(test)]
mod tests {
    use super::without_subgroups;

    #[test]
    fn the_extension_is_blanked_out_and_nothing_moves() {
        for (text, wanted) in [
            (
                "enable subgroups;\nfn f() {}",
                "                 \nfn f() {}",
            ),
            ("enable f16, subgroups;", "enable f16           ;"),
            ("enable subgroups , f16;", "enable             f16;"),
            (
                "// enable subgroups;\n/* /* */ */ requires a;\nenable\nsubgroups ;",
                "// enable subgroups;\n/* /* */ */ requires a;\n      \n           ",
            ),
            ("enable f16;", "enable f16;"),
            ("enabled subgroups;", "enabled subgroups;"),
            ("fn f() {} enable subgroups;", "fn f() {} enable subgroups;"),
            ("/* enable subgroups;", "/* enable subgroups;"),
            ("enable subgroups", "enable subgroups"),
        ] {
            assert_eq!(without_subgroups(text), wanted);
        }
    }
}
