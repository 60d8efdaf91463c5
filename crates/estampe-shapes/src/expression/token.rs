//! Tokens: numbers, names and marks, with their place in the text.

use std::ops::Range;

use super::error::ExpressionError;

/// A token and its range of bytes in the text.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Token {
    pub(super) kind: TokenKind,
    pub(super) span: Range<usize>,
}

/// The kinds of tokens. Names are read from the text at the token's span.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum TokenKind {
    Number(f64),
    Name,
    /// One of `+ - * / ^ ( ) , =`.
    Mark(u8),
    /// The end of the text.
    End,
}

/// Characters that people write for one that the grammar has.
const LOOKALIKES: &[(char, &str)] = &[
    ('−', "-"),
    ('–', "-"),
    ('×', "*"),
    ('·', "*"),
    ('÷', "/"),
    ('π', "pi"),
    ('τ', "tau"),
    ('√', "sqrt( )"),
    ('²', "^2"),
    ('³', "^3"),
    ('[', "("),
    (']', ")"),
    ('{', "("),
    ('}', ")"),
    ('|', "abs( )"),
];

/// The tokens of a text; the last is [`TokenKind::End`].
pub(super) fn tokens(text: &str) -> Result<Vec<Token>, ExpressionError> {
    let bytes = text.as_bytes();
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(&byte) = bytes.get(at) {
        let (kind, end) = match byte {
            b' ' | b'\t' | b'\r' | b'\n' => {
                at += 1;
                continue;
            }
            b'0'..=b'9' | b'.' => number(text, at)?,
            b'A'..=b'Z' | b'a'..=b'z' | b'_' => {
                let is_part = |byte: &u8| byte.is_ascii_alphanumeric() || *byte == b'_';
                (TokenKind::Name, end_of(bytes, at, is_part))
            }
            b'+' | b'-' | b'*' | b'/' | b'^' | b'(' | b')' | b',' | b'=' => {
                (TokenKind::Mark(byte), at + 1)
            }
            _ => return Err(unknown_character(text, at)),
        };
        tokens.push(Token {
            kind,
            span: at..end,
        });
        at = end;
    }
    tokens.push(Token {
        kind: TokenKind::End,
        span: text.len()..text.len(),
    });
    Ok(tokens)
}

/// The end of the run of bytes from `at` that satisfy a condition.
fn end_of(bytes: &[u8], at: usize, is_part: impl Fn(&u8) -> bool) -> usize {
    at + bytes[at..].iter().take_while(|byte| is_part(byte)).count()
}

/// A number at `at`, and its end: `12`, `1.5`, `.5`, `2e-3`. An `e` without digits is a name.
fn number(text: &str, at: usize) -> Result<(TokenKind, usize), ExpressionError> {
    let bytes = text.as_bytes();
    let mut end = end_of(bytes, at, u8::is_ascii_digit);
    if bytes.get(end) == Some(&b'.') {
        end = end_of(bytes, end + 1, u8::is_ascii_digit);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let digits = end_of(bytes, (end + 1 + sign).min(bytes.len()), u8::is_ascii_digit);
        if digits > end + 1 + sign {
            end = digits;
        }
    }
    let written = &text[at..end];
    match written.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok((TokenKind::Number(value), end)),
        Ok(_) => Err(ExpressionError::new(
            text,
            at..end,
            "this number is too large; the largest is 1.797e308",
        )),
        Err(_) => Err(ExpressionError::new(
            text,
            at..end,
            format!("`{written}` is not a number; write digits, as in 0.5"),
        )),
    }
}

fn unknown_character(text: &str, at: usize) -> ExpressionError {
    let character = text[at..].chars().next().unwrap_or(' ');
    let shown = character.escape_debug();
    let known = LOOKALIKES.iter().find(|(known, _)| *known == character);
    let message = match known {
        Some((_, instead)) => format!("unknown character `{shown}`; write `{instead}`"),
        None => format!("unknown character `{shown}`; remove it"),
    };
    ExpressionError::new(text, at..at + character.len_utf8(), message)
}
