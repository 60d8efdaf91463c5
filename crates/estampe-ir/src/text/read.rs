//! Words and punctuation of a text, and the values that it names.

use super::ParseError;
use crate::{Type, Value};

/// The greatest number of a value, so that a short text makes no long list.
const MAX_VALUE: u32 = 1 << 22;

/// A part of the text: a name, a number, or a sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Token<'a> {
    text: &'a str,
    line: u32,
    column: u32,
}

/// Reads a text from the beginning on.
pub(super) struct Reader<'a> {
    tokens: Vec<Token<'a>>,
    next: usize,
    /// What is known of each value that was named.
    values: Vec<Option<(Type, bool)>>,
}

pub(super) type Read<T> = Result<T, ParseError>;

impl<'a> Reader<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self {
            tokens: tokens(text),
            next: 0,
            values: Vec::new(),
        }
    }

    /// An error at the part that was read last, or that is next if none was.
    pub(super) fn error<T>(&self, what: impl Into<String>) -> Read<T> {
        let token = self.tokens.get(self.next.saturating_sub(1));
        let token = token.or(self.tokens.first());
        Err(ParseError {
            line: token.map_or(1, |token| token.line),
            column: token.map_or(1, |token| token.column),
            what: what.into(),
        })
    }

    /// The part that comes next; nothing at the end.
    pub(super) fn peek(&self) -> &'a str {
        self.tokens.get(self.next).map_or("", |token| token.text)
    }

    pub(super) fn next(&mut self) -> Read<&'a str> {
        let Some(token) = self.tokens.get(self.next) else {
            return self.error("the text ends too early");
        };
        self.next += 1;
        Ok(token.text)
    }

    /// Reads this part if it is next.
    pub(super) fn eat(&mut self, text: &str) -> bool {
        let is_next = self.peek() == text;
        self.next += usize::from(is_next);
        is_next
    }

    pub(super) fn expect(&mut self, text: &str) -> Read<()> {
        let found = self.next()?;
        if found == text {
            return Ok(());
        }
        self.error(format!("expected `{text}`, found `{found}`"))
    }

    /// A number that is not negative.
    pub(super) fn number(&mut self) -> Read<u32> {
        let text = self.next()?;
        match text.parse() {
            Ok(number) => Ok(number),
            Err(_) => self.error(format!("expected a number, found `{text}`")),
        }
    }

    /// A number with a letter before it.
    pub(super) fn numbered(&mut self, letter: char, what: &str) -> Read<u32> {
        let text = self.next()?;
        let number = text.strip_prefix(letter).and_then(|text| text.parse().ok());
        number.map_or_else(
            || {
                self.error(format!(
                    "expected {what} such as `{letter}0`, found `{text}`"
                ))
            },
            Ok,
        )
    }

    /// An integer of either sign.
    pub(super) fn signed(&mut self) -> Read<i32> {
        let text = self.next()?;
        match text.parse() {
            Ok(number) => Ok(number),
            Err(_) => self.error(format!("expected an integer, found `{text}`")),
        }
    }

    /// A word: an integer, or the bits of a float.
    pub(super) fn word(&mut self) -> Read<u32> {
        let text = self.next()?;
        let word = if let Some(digits) = text.strip_prefix("0x") {
            u32::from_str_radix(digits, 16).ok()
        } else if text.contains(['.', 'e']) {
            text.parse().ok().map(f32::to_bits)
        } else if text.starts_with('-') {
            text.parse().ok().map(i32::cast_unsigned)
        } else {
            text.parse().ok()
        };
        word.map_or_else(
            || self.error(format!("expected a word, found `{text}`")),
            Ok,
        )
    }

    /// Numbers in brackets; none if there are no brackets.
    pub(super) fn numbers(&mut self) -> Read<Vec<u32>> {
        let mut numbers = Vec::new();
        if self.eat("(") {
            while !self.eat(")") {
                if !numbers.is_empty() {
                    self.expect(",")?;
                }
                numbers.push(self.number()?);
            }
        }
        Ok(numbers)
    }

    /// True if the next part is the name of a value.
    pub(super) fn is_value(&self) -> bool {
        value(self.peek()).is_some()
    }

    pub(super) fn value(&mut self) -> Read<Value> {
        let text = self.next()?;
        let Some((kind, is_uniform, number)) = value(text) else {
            return self.error(format!("expected a value such as `v0`, found `{text}`"));
        };
        if number >= MAX_VALUE {
            return self.error(format!(
                "the number of a value is at most {}",
                MAX_VALUE - 1
            ));
        }
        let at = Value(number);
        if self.values.len() <= at.index() {
            self.values.resize(at.index() + 1, None);
        }
        let known = self.values[at.index()].get_or_insert((kind, is_uniform));
        if *known != (kind, is_uniform) {
            return self.error(format!("value {number} has another type elsewhere"));
        }
        Ok(at)
    }

    /// Values between commas; none if the next part is no value.
    pub(super) fn values(&mut self) -> Read<Vec<Value>> {
        let mut values = Vec::new();
        if self.is_value() {
            values.push(self.value()?);
            while self.eat(",") {
                values.push(self.value()?);
            }
        }
        Ok(values)
    }

    /// Values in brackets; none if there are no brackets.
    pub(super) fn bracketed(&mut self) -> Read<Vec<Value>> {
        if !self.eat("(") {
            return Ok(Vec::new());
        }
        let values = self.values()?;
        self.expect(")")?;
        Ok(values)
    }

    /// True if a value is called uniform.
    pub(super) fn names_uniform(&self) -> bool {
        let is_uniform = |known: &Option<(Type, bool)>| known.is_some_and(|(_, is)| is);
        self.values.iter().any(is_uniform)
    }

    /// Type and uniformity of all values, once the text is read.
    pub(super) fn known(self) -> Read<Vec<(Type, bool)>> {
        if let Some(at) = self.values.iter().position(Option::is_none) {
            return self.error(format!("value {at} is not named, but greater numbers are"));
        }
        Ok(self.values.into_iter().flatten().collect())
    }
}

/// Type, uniformity and number of a value's name.
fn value(text: &str) -> Option<(Type, bool, u32)> {
    let (is_uniform, rest) = match text.strip_prefix('u') {
        Some(rest) => (true, rest),
        None => (false, text),
    };
    let (kind, digits) = match (rest.strip_prefix('v'), rest.strip_prefix('m')) {
        (Some(digits), _) => (Type::Word, digits),
        (_, Some(digits)) => (Type::Mask, digits),
        _ => return None,
    };
    let is_number = digits.bytes().all(|byte| byte.is_ascii_digit());
    let number = digits.parse().ok().filter(|_| is_number)?;
    Some((kind, is_uniform, number))
}

fn tokens(text: &str) -> Vec<Token<'_>> {
    let mut tokens = Vec::new();
    for (line, text) in (1..).zip(text.lines()) {
        let text = text.split("//").next().unwrap_or("");
        let is_sign = |c: char| "()[]{},=:?".contains(c);
        let mut rest = text;
        loop {
            rest = rest.trim_start();
            let Some(first) = rest.chars().next() else {
                break;
            };
            let len = if is_sign(first) {
                1
            } else {
                rest.find(|c: char| c.is_whitespace() || is_sign(c))
                    .unwrap_or(rest.len())
            };
            let (found, after) = rest.split_at(len);
            let before = &text[..text.len() - rest.len()];
            tokens.push(Token {
                text: found,
                line,
                column: u32::try_from(before.chars().count() + 1).unwrap_or(u32::MAX),
            });
            rest = after;
        }
    }
    tokens
}
