//! Tokens of GLSL: what the preprocessor works on.
//!
//! Comments become white space, and a backslash before the end of a line joins the line with the
//! next (GLSL 4.60, section 3.1). Every token keeps its place in the author's text.

use std::rc::Rc;

use super::Fault;

/// Bytes of the author's text: half-open.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Place {
    pub start: u32,
    pub end: u32,
}

impl Place {
    pub(super) fn new(start: usize, end: usize) -> Self {
        // Sources are smaller than 4 GiB: see `Limits`.
        let number = |at: usize| u32::try_from(at).unwrap_or(u32::MAX);
        Self {
            start: number(start),
            end: number(end),
        }
    }

    /// The place from the start of this one to the end of another one.
    pub(super) fn to(self, end: Self) -> Self {
        Self {
            start: self.start,
            end: end.end.max(self.end),
        }
    }
}

/// The kind of a token.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Kind {
    /// A name or keyword.
    Word,
    /// A number.
    Number,
    /// An operator, a bracket or another sign.
    Sign,
}

/// A token.
#[derive(Debug, Clone)]
pub(super) struct Token {
    pub kind: Kind,
    pub text: Rc<str>,
    pub place: Place,
    /// True if it is the first of its line.
    pub starts_line: bool,
    /// True if white space stands before it.
    pub has_space: bool,
    /// True for a word that is never replaced again, as it came from its own macro.
    pub is_painted: bool,
}

impl Token {
    /// A token that the author did not write, for something at a place of theirs.
    pub(super) fn new(kind: Kind, text: &str, place: Place) -> Self {
        Self {
            kind,
            text: text.into(),
            place,
            starts_line: false,
            has_space: true,
            is_painted: false,
        }
    }

    pub(super) fn is(&self, text: &str) -> bool {
        &*self.text == text
    }

    pub(super) fn is_word(&self) -> bool {
        self.kind == Kind::Word
    }
}

/// The signs of more than one character, longest first.
const LONG_SIGNS: &[&str] = &[
    "<<=", ">>=", "++", "--", "<=", ">=", "==", "!=", "&&", "||", "^^", "+=", "-=", "*=", "/=",
    "%=", "&=", "|=", "^=", "<<", ">>", "##",
];

/// The signs of one character.
const SIGNS: &str = "()[]{}.,;:?+-*/%<>=!~&|^#";

/// The error at a character that GLSL does not have.
pub(super) fn check_sign(token: &Token) -> Result<(), Fault> {
    let first = token.text.chars().next().unwrap_or(' ');
    if token.kind != Kind::Sign || token.text.len() > 1 && first.is_ascii() || SIGNS.contains(first)
    {
        return Ok(());
    }
    let shown: String = first.escape_default().collect();
    let message = match first {
        '"' | '\'' => format!("GLSL has no strings and no `{first}`"),
        _ if first.is_ascii_graphic() => format!("GLSL has no character `{first}`"),
        _ => format!("GLSL has no character `{first}` ({shown}) outside of comments"),
    };
    Err(Fault::new(message, token.place).help("remove it"))
}

/// The tokens of a text.
pub(super) fn tokens(text: &str) -> Result<Vec<Token>, Fault> {
    Scanner {
        text,
        at: 0,
        starts_line: true,
        has_space: false,
    }
    .all()
}

struct Scanner<'a> {
    text: &'a str,
    at: usize,
    starts_line: bool,
    has_space: bool,
}

impl Scanner<'_> {
    fn all(mut self) -> Result<Vec<Token>, Fault> {
        let mut tokens = Vec::new();
        while self.skip_space()? {
            let start = self.at;
            let rest = &self.text[start..];
            let first = rest.chars().next().unwrap_or(' ');
            let second_is_digit =
                rest[first.len_utf8()..].starts_with(|c: char| c.is_ascii_digit());
            let kind = if first.is_ascii_alphabetic() || first == '_' {
                Kind::Word
            } else if first.is_ascii_digit() || first == '.' && second_is_digit {
                Kind::Number
            } else {
                Kind::Sign
            };
            let text: Rc<str> = match kind {
                Kind::Word => self.run(|_, next| next.is_ascii_alphanumeric() || next == '_'),
                Kind::Number => self.run(|before, next| {
                    next.is_ascii_alphanumeric()
                        || matches!(next, '.' | '_')
                        || matches!(next, '+' | '-') && matches!(before, 'e' | 'E')
                }),
                Kind::Sign => self.sign(first),
            };
            tokens.push(Token {
                kind,
                text,
                place: Place::new(start, self.at),
                starts_line: self.starts_line,
                has_space: self.has_space,
                is_painted: false,
            });
            self.starts_line = false;
            self.has_space = false;
        }
        Ok(tokens)
    }

    /// Skips white space, comments and joined lines. True if something follows.
    fn skip_space(&mut self) -> Result<bool, Fault> {
        loop {
            let rest = &self.text[self.at..];
            if rest.starts_with("//") {
                // A joined line continues the comment.
                let mut before = ' ';
                for character in rest.chars() {
                    if character == '\n' && before != '\\' {
                        break;
                    }
                    if character != '\r' {
                        before = character;
                    }
                    self.at += character.len_utf8();
                }
                self.has_space = true;
            } else if let Some(inside) = rest.strip_prefix("/*") {
                let Some(end) = inside.find("*/") else {
                    let place = Place::new(self.at, self.at + 2);
                    return Err(
                        Fault::new("this comment has no end", place).help("close it with `*/`")
                    );
                };
                self.at += end + 4;
                self.has_space = true;
            } else if let Some(length) = joined_line(rest) {
                self.at += length;
            } else {
                match rest.chars().next() {
                    None => return Ok(false),
                    Some('\n') => {
                        self.starts_line = true;
                        self.has_space = true;
                        self.at += 1;
                    }
                    Some(space) if space.is_whitespace() || space == '\u{feff}' => {
                        self.has_space = true;
                        self.at += space.len_utf8();
                    }
                    Some(_) => return Ok(true),
                }
            }
        }
    }

    /// The characters for which `belongs`, given the one before and the next, is true.
    fn run(&mut self, belongs: impl Fn(char, char) -> bool) -> Rc<str> {
        let start = self.at;
        let mut joined: Option<String> = None;
        let mut before = ' ';
        loop {
            let rest = &self.text[self.at..];
            if let Some(length) = joined_line(rest) {
                joined.get_or_insert_with(|| self.text[start..self.at].to_owned());
                self.at += length;
                continue;
            }
            match rest.chars().next() {
                Some(next) if self.at == start || belongs(before, next) => {
                    if let Some(joined) = &mut joined {
                        joined.push(next);
                    }
                    before = next;
                    self.at += next.len_utf8();
                }
                _ => break,
            }
        }
        match joined {
            Some(joined) => joined.into(),
            None => self.text[start..self.at].into(),
        }
    }

    fn sign(&mut self, first: char) -> Rc<str> {
        let rest = &self.text[self.at..];
        let long = LONG_SIGNS.iter().find(|sign| rest.starts_with(**sign));
        let length = match long {
            Some(sign) => sign.len(),
            // A character that GLSL does not have: an error, unless nothing reads it.
            None => first.len_utf8(),
        };
        let text = rest[..length].into();
        self.at += length;
        text
    }
}

/// The bytes of a backslash with the end of its line.
fn joined_line(rest: &str) -> Option<usize> {
    let ends = ["\\\n", "\\\r\n"];
    ends.iter()
        .find(|end| rest.starts_with(**end))
        .map(|end| end.len())
}
