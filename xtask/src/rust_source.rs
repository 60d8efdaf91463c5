//! Just enough of Rust's grammar to read sources without a compiler: code apart from comments and
//! literals, identifiers, and paths with their `use` groups unfolded.
//!
//! The rejected alternative is `syn`: exact, but it sees neither the inside of macros (where shaders
//! are written) nor code under `cfg`, and costs more build time than all of `xtask`.

/// The text with comments, strings and character literals replaced by spaces. Line breaks stay, so
/// that line numbers hold.
pub(crate) fn code_only(text: &str) -> String {
    let chars: Vec<char> = text.chars().collect();
    let mut code = String::with_capacity(text.len());
    let mut at = 0;
    while at < chars.len() {
        let end = end_of_skipped(&chars, at);
        if end == at {
            code.push(chars[at]);
            at += 1;
        } else {
            code.extend(
                chars[at..end]
                    .iter()
                    .map(|&c| if c == '\n' { '\n' } else { ' ' }),
            );
            at = end;
        }
    }
    code
}

/// Where the comment or literal that starts at `at` ends; `at` itself where none starts.
fn end_of_skipped(chars: &[char], at: usize) -> usize {
    let next = chars.get(at + 1).copied();
    match chars[at] {
        '/' if next == Some('/') => position(chars, at, |c| c == '\n').unwrap_or(chars.len()),
        '/' if next == Some('*') => end_of_block_comment(chars, at),
        '"' => end_of_string(chars, at),
        'r' if !continues_identifier(chars, at) => end_of_raw_string(chars, at),
        '\'' => end_of_char(chars, at),
        _ => at,
    }
}

fn end_of_block_comment(chars: &[char], start: usize) -> usize {
    let mut depth = 0_usize;
    let mut at = start;
    while at + 1 < chars.len() {
        match (chars[at], chars[at + 1]) {
            ('/', '*') => (depth, at) = (depth + 1, at + 2),
            ('*', '/') => {
                (depth, at) = (depth - 1, at + 2);
                if depth == 0 {
                    return at;
                }
            }
            _ => at += 1,
        }
    }
    chars.len()
}

fn end_of_string(chars: &[char], start: usize) -> usize {
    let mut at = start + 1;
    while at < chars.len() {
        match chars[at] {
            '\\' => at += 2,
            '"' => return at + 1,
            _ => at += 1,
        }
    }
    chars.len()
}

/// `r"…"`, `r#"…"#` and so on; the `r` of `br` and `cr` strings is preceded by an identifier's
/// character and handled by the caller's test, which those prefixes pass through [`end_of_string`].
fn end_of_raw_string(chars: &[char], start: usize) -> usize {
    let Some(quote) = position(chars, start + 1, |c| c != '#') else {
        return start;
    };
    if chars[quote] != '"' {
        return start;
    }
    let hashes = quote - start - 1;
    (quote + 1..chars.len())
        .find(|&end| {
            chars[end] == '"'
                && chars.len() > end + hashes
                && chars[end + 1..=end + hashes].iter().all(|&c| c == '#')
        })
        .map_or(chars.len(), |end| end + hashes + 1)
}

/// A character literal, told from a lifetime by its closing quote.
fn end_of_char(chars: &[char], start: usize) -> usize {
    match chars.get(start + 1) {
        Some('\\') => position(chars, start + 3, |c| c == '\'').map_or(start, |quote| quote + 1),
        Some(_) if chars.get(start + 2) == Some(&'\'') => start + 3,
        _ => start,
    }
}

fn position(chars: &[char], from: usize, wanted: impl Fn(char) -> bool) -> Option<usize> {
    (from..chars.len()).find(|&at| wanted(chars[at]))
}

/// Whether the character before `at` belongs to an identifier other than the string prefixes `b` and
/// `c`.
fn continues_identifier(chars: &[char], at: usize) -> bool {
    let is_part = |index: usize| chars[index].is_alphanumeric() || chars[index] == '_';
    match at.checked_sub(1) {
        Some(before) if is_part(before) => {
            let is_prefix = matches!(chars[before], 'b' | 'c');
            !is_prefix || before.checked_sub(1).is_some_and(is_part)
        }
        _ => false,
    }
}

/// An identifier, a punctuation mark or `::`, and the line it stands on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Token<'code> {
    /// The text of the token.
    pub(crate) text: &'code str,
    /// From 1.
    pub(crate) line: usize,
}

/// Splits code (see [`code_only`]) into tokens.
pub(crate) fn tokens(code: &str) -> Vec<Token<'_>> {
    let mut tokens = Vec::new();
    let mut line = 1;
    let mut rest = code;
    while let Some(first) = rest.chars().next() {
        let len_bytes = if first.is_alphanumeric() || first == '_' {
            rest.find(|c: char| !(c.is_alphanumeric() || c == '_'))
                .unwrap_or(rest.len())
        } else if rest.starts_with("::") {
            2
        } else {
            first.len_utf8()
        };
        let (text, after) = rest.split_at(len_bytes);
        if first == '\n' {
            line += 1;
        } else if !first.is_whitespace() {
            tokens.push(Token { text, line });
        }
        rest = after;
    }
    tokens
}

/// Removes what is compiled for tests only: an item after `#[cfg(test)]`, to its closing brace or
/// semicolon.
pub(crate) fn without_test_items<'code>(tokens: &[Token<'code>]) -> Vec<Token<'code>> {
    const CFG_TEST: [&str; 7] = ["#", "[", "cfg", "(", "test", ")", "]"];
    let mut kept = Vec::with_capacity(tokens.len());
    let mut at = 0;
    while at < tokens.len() {
        let is_test = tokens[at..]
            .iter()
            .map(|token| token.text)
            .take(7)
            .eq(CFG_TEST);
        if is_test {
            at = end_of_item(tokens, at + CFG_TEST.len());
        } else {
            kept.push(tokens[at]);
            at += 1;
        }
    }
    kept
}

fn end_of_item(tokens: &[Token<'_>], start: usize) -> usize {
    let mut depth = 0_usize;
    for (at, token) in tokens.iter().enumerate().skip(start) {
        match token.text {
            "{" => depth += 1,
            "}" if depth <= 1 => return at + 1,
            "}" => depth -= 1,
            ";" if depth == 0 => return at + 1,
            _ => {}
        }
    }
    tokens.len()
}

/// A path that starts at `crate`, `super` or `self`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct PathUse<'code> {
    /// The segments, the first included; the groups of a `use` are unfolded.
    pub(crate) segments: Vec<&'code str>,
    /// The line of its last segment, from 1.
    pub(crate) line: usize,
}

/// Every path that starts at `crate`, `super` or `self`.
pub(crate) fn relative_paths<'code>(tokens: &[Token<'code>]) -> Vec<PathUse<'code>> {
    let mut paths = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        let follows_path = at > 0 && tokens[at - 1].text == "::";
        let is_root = matches!(tokens[at].text, "crate" | "super" | "self");
        let is_path = tokens.get(at + 1).is_some_and(|next| next.text == "::");
        if is_root && is_path && !follows_path {
            at = unfold(tokens, at, &mut Vec::new(), &mut paths);
        } else {
            at += 1;
        }
    }
    paths
}

/// Reads one path tree (`a::b`, `a::{b, c::d}`, `a::*`) and returns where it ends.
fn unfold<'code>(
    tokens: &[Token<'code>],
    start: usize,
    prefix: &mut Vec<&'code str>,
    paths: &mut Vec<PathUse<'code>>,
) -> usize {
    let depth = prefix.len();
    let mut at = start;
    let mut line = tokens.get(start).map_or(0, |token| token.line);
    while let Some(token) = tokens.get(at) {
        if token.text == "{" {
            at += 1;
            while tokens.get(at).is_some_and(|inner| inner.text != "}") {
                let end = unfold(tokens, at, prefix, paths);
                let is_comma = tokens.get(end).is_some_and(|after| after.text == ",");
                at = if is_comma || end == at { end + 1 } else { end };
            }
            prefix.truncate(depth);
            return at + 1;
        }
        let is_segment = token.text.chars().all(|c| c.is_alphanumeric() || c == '_');
        if !is_segment && token.text != "*" {
            break;
        }
        prefix.push(token.text);
        line = token.line;
        at += 1;
        if tokens
            .get(at)
            .is_none_or(|separator| separator.text != "::")
        {
            break;
        }
        at += 1;
    }
    if prefix.len() > depth {
        paths.push(PathUse {
            segments: prefix.clone(),
            line,
        });
    }
    prefix.truncate(depth);
    // `crate::a as b`: the new name is no part of the path.
    if tokens.get(at).is_some_and(|token| token.text == "as") {
        at + 2
    } else {
        at
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn paths_of(source: &str) -> Vec<String> {
        let code = code_only(source);
        let tokens = tokens(&code);
        relative_paths(&tokens)
            .iter()
            .map(|path| path.segments.join("::"))
            .collect()
    }

    #[test]
    fn comments_and_literals_are_no_code() {
        let source = concat!(
            "a // crate::x\nb /* c /* d */ e */ f \"g \\\" h\" 'i' '\\'' j<'k> r#\"l \" m\"# br\"n\"",
            " bar\"o\" r#type '\\u{7f}' p"
        );
        let code = code_only(source);
        let words: Vec<_> = tokens(&code).iter().map(|token| token.text).collect();
        assert_eq!(
            words,
            [
                "a", "b", "f", "j", "<", "'", "k", ">", "b", "bar", "r", "#", "type", "p"
            ]
        );
        assert_eq!(code.lines().count(), source.lines().count());
    }

    #[test]
    fn an_unclosed_literal_ends_with_the_file() {
        for source in ["\"a", "r#\"a\"", "/* a", "'", "'\\", "r", "\"\\"] {
            let _ = code_only(source);
        }
    }

    #[test]
    fn groups_are_unfolded() {
        let source =
            "use crate::{raster::{edge::Edge, *}, tiles as t, self};\nlet x = super::cull();";
        assert_eq!(
            paths_of(source),
            [
                "crate::raster::edge::Edge",
                "crate::raster::*",
                "crate::tiles",
                "crate::self",
                "super::cull"
            ]
        );
    }

    #[test]
    fn paths_inside_expressions_and_macros_are_seen() {
        assert_eq!(
            paths_of("vectorize!(|| crate::raster::run(self.x, a::super_b, pub(crate) fn))"),
            ["crate::raster::run"]
        );
        assert!(paths_of("crate::{ {").is_empty());
    }

    #[test]
    fn test_items_are_removed() {
        let code = code_only(
            "fn a() {} #[cfg(test)] mod tests { fn b() { {} } } #[cfg(test)] use c; fn d() {}",
        );
        let tokens = tokens(&code);
        let words: Vec<_> = without_test_items(&tokens).iter().map(|t| t.text).collect();
        assert_eq!(words.join(" "), "fn a ( ) { } fn d ( ) { }");
    }
}
