//! The preprocessor of GLSL (GLSL 4.60, section 3.3).
//!
//! Out: the tokens of the lines that are not skipped, with macros replaced, and the version.
//! `#extension` and `#pragma` are accepted and do nothing; `#line` changes `__LINE__` alone, as
//! errors are shown at the lines of the text that was given.

mod directive;
mod expression;
mod macros;

use std::collections::HashMap;
use std::rc::Rc;

pub(super) use expression::evaluate;
use macros::{Macro, Macros};

use super::super::Limits;
use super::super::lines::Lines;
use super::Fault;
use super::token::{self, Kind, Place, Token};

/// The version of GLSL that a text names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Version {
    /// 100 to 460. 110 if the text names none.
    pub number: u32,
    /// True for the version of OpenGL ES and WebGL.
    pub is_es: bool,
}

/// A text after the preprocessor.
#[derive(Debug)]
pub(super) struct Preprocessed {
    pub version: Version,
    pub tokens: Vec<Token>,
}

/// A group of `#if`.
struct Group {
    place: Place,
    /// True if a branch was taken.
    is_done: bool,
    /// True if the lines of this branch are read.
    is_active: bool,
    has_else: bool,
}

struct Preprocessor<'a> {
    lines: Lines<'a>,
    macros: Macros,
    groups: Vec<Group>,
    version: Version,
    /// What `#line` adds to `__LINE__`.
    line_offset: i64,
    output: Vec<Token>,
    /// Tokens since the last directive, whose macros are not replaced yet.
    pending: Vec<Token>,
}

/// Preprocesses a text. `defines` are macros that are defined before it.
pub(super) fn preprocess(
    text: &str,
    raw: Vec<Token>,
    defines: &[(String, String)],
    is_vulkan: bool,
    limits: Limits,
) -> Result<Preprocessed, Fault> {
    let mut preprocessor = Preprocessor {
        lines: Lines::new(text),
        macros: Macros {
            defined: HashMap::new(),
            budget: limits.tokens,
        },
        groups: Vec::new(),
        version: Version {
            number: 110,
            is_es: false,
        },
        line_offset: 0,
        output: Vec::new(),
        pending: Vec::new(),
    };
    preprocessor.define("GL_OES_standard_derivatives", "1")?;
    preprocessor.define("GL_EXT_shader_texture_lod", "1")?;
    preprocessor.define("GL_EXT_frag_depth", "1")?;
    preprocessor.define("GL_FRAGMENT_PRECISION_HIGH", "1")?;
    preprocessor.define("__FILE__", "0")?;
    if is_vulkan {
        preprocessor.define("VULKAN", "100")?;
    }
    for (name, value) in defines {
        preprocessor.define(name, value)?;
    }
    preprocessor.define("__VERSION__", "110")?;
    preprocessor.run(raw)
}

impl Preprocessor<'_> {
    /// Defines a macro that the text does not define.
    fn define(&mut self, name: &str, value: &str) -> Result<(), Fault> {
        let found = token::tokens(name).unwrap_or_default();
        let body = token::tokens(value).map_err(|_| {
            Fault::at(
                format!("the options define `{name}` with a comment that has no end"),
                None,
            )
        })?;
        match found.as_slice() {
            [only] if only.is_word() && only.is(name) => {
                let parameters = None;
                let defined = Macro { parameters, body };
                self.macros.defined.insert(name.into(), Rc::new(defined));
                Ok(())
            }
            _ => Err(Fault::at(
                format!("the options define `{name}`, which is no name"),
                None,
            )),
        }
    }

    fn run(mut self, raw: Vec<Token>) -> Result<Preprocessed, Fault> {
        let mut tokens = raw.into_iter().peekable();
        let mut is_first = true;
        while let Some(token) = tokens.next() {
            if token.starts_line && token.is("#") {
                let mut line = Vec::new();
                while let Some(next) = tokens.next_if(|next| !next.starts_line) {
                    line.push(next);
                }
                self.flush()?;
                self.directive(&token, &line, is_first)?;
            } else if self.is_active() {
                self.pending.push(token);
            }
            is_first = false;
        }
        self.flush()?;
        if let Some(open) = self.groups.last() {
            return Err(
                Fault::new("this condition has no end", open.place).help("end it with `#endif`")
            );
        }
        Ok(Preprocessed {
            version: self.version,
            tokens: self.output,
        })
    }

    fn is_active(&self) -> bool {
        self.groups.last().is_none_or(|group| group.is_active)
    }

    /// Replaces the macros of the lines since the last directive.
    fn flush(&mut self) -> Result<(), Fault> {
        if self.pending.is_empty() {
            return Ok(());
        }
        let pending = core::mem::take(&mut self.pending);
        let replaced = self.replace(pending)?;
        self.output.extend(replaced);
        Ok(())
    }

    fn replace(&mut self, tokens: Vec<Token>) -> Result<Vec<Token>, Fault> {
        let (lines, offset) = (&self.lines, self.line_offset);
        let line_of = |place: Place| {
            let line = i64::from(lines.line(place.start as usize)).saturating_add(offset);
            u32::try_from(line).unwrap_or(0)
        };
        self.macros.replace(tokens, &line_of)
    }

    /// The value of the condition of `#if` or `#elif`.
    fn condition(&mut self, name: &Token, line: &[Token]) -> Result<bool, Fault> {
        let mut tokens = Vec::with_capacity(line.len());
        let mut at = 0;
        while let Some(token) = line.get(at) {
            at += 1;
            if !token.is("defined") {
                tokens.push(token.clone());
                continue;
            }
            let (asked, length) = match &line[at..] {
                [open, asked, close, ..] if open.is("(") && close.is(")") => (asked, 3),
                [asked, ..] => (asked, 1),
                [] => (token, 0),
            };
            if !asked.is_word() || length == 0 {
                return Err(
                    Fault::new("`defined` asks for the name of a macro", token.place)
                        .help("write `defined(NAME)`"),
                );
            }
            at += length;
            let is_defined = self.macros.defined.contains_key(&asked.text);
            let number = if is_defined { "1" } else { "0" };
            tokens.push(Token::new(Kind::Number, number, asked.place));
        }
        let tokens = self.replace(tokens)?;
        let undefined = tokens.iter().find(|token| token.is_word());
        if let Some(undefined) = undefined {
            return Err(Fault::new(
                format!("the macro `{}` is not defined", undefined.text),
                undefined.place,
            )
            .help("define it, or ask with `defined(…)` or `#ifdef`"));
        }
        Ok(evaluate(&tokens, name.place, &|_| None)? != 0)
    }
}
