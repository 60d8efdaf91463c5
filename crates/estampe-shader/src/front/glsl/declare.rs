//! Reading the declarations at file scope.

use std::collections::{HashMap, HashSet};
use std::rc::Rc;

use estampe_ir::interface::Stage;

use super::super::suggest;
use super::Fault;
use super::items::{bad_structure, flatten};
use super::preprocess::{Preprocessed, evaluate};
use super::token::{Kind, Place, Token};
use super::types::{self, Member, Structures, Type};
use super::unit::{Qualifiers, Unit};

/// The most elements of an array.
const LONGEST_ARRAY: i64 = 1 << 24;

/// Reads the declarations of a shader.
pub(super) fn unit(source: Preprocessed, stage: Stage, is_vulkan: bool) -> Result<Unit, Fault> {
    let tokens = source.tokens;
    let mut prefix = "e_".to_owned();
    while tokens.iter().any(|token| token.text.starts_with(&prefix)) {
        prefix.insert(0, 'e');
    }
    let mut reader = Reader {
        tokens: &tokens,
        at: 0,
        unit: Unit {
            stage,
            version: source.version,
            is_vulkan,
            structures: Structures::new(is_vulkan),
            items: Vec::new(),
            constants: HashMap::new(),
            workgroup_size: [1; 3],
            has_early_tests: false,
            clip_distances: 0,
            used: HashSet::new(),
            prefix,
        },
    };
    while reader.at < tokens.len() {
        reader.declaration()?;
    }
    flatten(reader.unit)
}

pub(super) struct Reader<'a> {
    pub(super) tokens: &'a [Token],
    pub(super) at: usize,
    pub(super) unit: Unit,
}

impl<'a> Reader<'a> {
    pub(super) fn peek(&self, ahead: usize) -> Option<&'a Token> {
        self.tokens.get(self.at + ahead)
    }

    pub(super) fn is_next(&self, text: &str) -> bool {
        self.peek(0).is_some_and(|token| token.is(text))
    }

    /// Skips the next token if it is `text`.
    pub(super) fn skip(&mut self, text: &str) -> bool {
        let is_next = self.is_next(text);
        self.at += usize::from(is_next);
        is_next
    }

    /// The error that something else is next than what is expected.
    pub(super) fn expected(&self, what: &str) -> Fault {
        match self.peek(0) {
            Some(token) => Fault::new(
                format!("expected {what}, found `{}`", token.text),
                token.place,
            ),
            None => {
                let last = self.tokens.last().map(|last| last.place);
                Fault::at(
                    format!("expected {what}, found the end of the shader"),
                    last,
                )
            }
        }
    }

    pub(super) fn expect(&mut self, text: &str) -> Result<&'a Token, Fault> {
        match self.peek(0) {
            Some(token) if token.is(text) => {
                self.at += 1;
                Ok(token)
            }
            _ => Err(self.missing(text)),
        }
    }

    /// The error that a sign is missing, after the token before.
    fn missing(&self, text: &str) -> Fault {
        let before = self.at.checked_sub(1).and_then(|at| self.tokens.get(at));
        match (text, self.peek(0), before) {
            // A missing `;` is shown where it is missing, not at the next line.
            (";", Some(next), Some(before)) if next.starts_line => {
                let end = before.place.end;
                Fault::new("expected `;`", Place { start: end, end })
                    .help(format!("add `;` after `{}`", before.text))
            }
            _ => self.expected(&format!("`{text}`")),
        }
    }

    pub(super) fn name(&mut self) -> Result<&'a Token, Fault> {
        match self.peek(0) {
            Some(token) if token.is_word() && !is_keyword(&token.text) => {
                self.at += 1;
                Ok(token)
            }
            Some(token) if token.is_word() => Err(Fault::new(
                format!("`{}` is a word of the language", token.text),
                token.place,
            )
            .help("choose another name")),
            _ => Err(self.expected("a name")),
        }
    }

    /// The tokens up to one of the signs outside of brackets.
    pub(super) fn until(&mut self, ends: &[&str]) -> &'a [Token] {
        let start = self.at;
        let mut depth = 0_usize;
        while let Some(token) = self.peek(0) {
            if token.kind == Kind::Sign {
                if depth == 0 && ends.iter().any(|end| token.is(end)) {
                    break;
                }
                match &*token.text {
                    "(" | "[" | "{" => depth += 1,
                    ")" | "]" | "}" => depth = depth.saturating_sub(1),
                    _ => {}
                }
            }
            self.at += 1;
        }
        &self.tokens[start..self.at]
    }

    fn declaration(&mut self) -> Result<(), Fault> {
        if self.skip(";") {
            return Ok(());
        }
        if self.is_next("precision") {
            self.until(&[";"]);
            self.expect(";")?;
            return Ok(());
        }
        let qualifiers = self.qualifiers()?;
        if self.is_next(";") {
            self.at += 1;
            return self.lone(&qualifiers);
        }
        let Some(next) = self.peek(0) else {
            return Err(self.expected("a declaration"));
        };
        // Built-ins that are declared again, and `invariant gl_Position;`.
        let ends_soon = self.peek(1).is_some_and(|end| end.is(";") || end.is(","));
        let is_again = next.text.starts_with("gl_") || ends_soon && !next.is("struct");
        if next.is_word() && is_again && qualifiers.place.is_some() {
            self.until(&[";"]);
            self.expect(";")?;
            return Ok(());
        }
        if next.is_word() && self.peek(1).is_some_and(|open| open.is("{")) && !next.is("struct") {
            return self.block(qualifiers);
        }
        let (ty, is_struct) = self.declared_type(next)?;
        if is_struct && self.skip(";") {
            return Ok(());
        }
        let is_function = self.peek(1).is_some_and(|open| open.is("("));
        if is_function && self.peek(0).is_some_and(Token::is_word) {
            return self.function(ty);
        }
        self.variables(ty, qualifiers)
    }

    /// A type, or the definition of a structure.
    fn declared_type(&mut self, next: &Token) -> Result<(Type, bool), Fault> {
        if !next.is("struct") {
            return Ok((self.ty()?, false));
        }
        self.at += 1;
        let name: Rc<str> = match self.is_next("{") {
            true => {
                let count = self.unit.structures.order.len();
                format!("{}Struct{count}", self.unit.prefix).into()
            }
            false => self.name()?.text.clone(),
        };
        if self.unit.structures.get(&name).is_some() {
            let message = format!("there are two structures `{name}`");
            return Err(Fault::new(message, next.place).help("rename one of them"));
        }
        let members = self.members()?;
        if !self
            .unit
            .structures
            .insert(name.clone(), next.place, members)
        {
            return Err(bad_structure(&name, next.place));
        }
        let mut dimensions = Vec::new();
        self.dimensions(&mut dimensions)?;
        Ok((Type { name, dimensions }, true))
    }

    /// A declaration without a variable: `layout(local_size_x = 8) in;`.
    fn lone(&mut self, qualifiers: &Qualifiers) -> Result<(), Fault> {
        for (axis, name) in ["local_size_x", "local_size_y", "local_size_z"]
            .iter()
            .enumerate()
        {
            if qualifiers.has(name) {
                self.unit.workgroup_size[axis] = qualifiers.value(name).unwrap_or(0);
            }
        }
        self.unit.has_early_tests |= qualifiers.has("early_fragment_tests");
        match qualifiers.layout_word("row_major") {
            Some(word) => Err(row_major(word.place)),
            None => Ok(()),
        }
    }

    /// A type with the sizes of arrays that follow it.
    pub(super) fn ty(&mut self) -> Result<Type, Fault> {
        self.skip_precision();
        let Some(token) = self.peek(0).filter(|token| token.is_word()) else {
            return Err(self.expected("a type"));
        };
        self.at += 1;
        if types::is_unsupported(&token.text) {
            return Err(
                Fault::new(format!("`{}` is not supported", token.text), token.place)
                    .help("use `sampler2D` and `texelFetch`, or a buffer"),
            );
        }
        if !self.unit.structures.is_type(&token.text) {
            let known = self
                .unit
                .structures
                .names()
                .chain(types::TYPES.iter().copied());
            let fault = Fault::new(format!("there is no type `{}`", token.text), token.place);
            let is_statement = self
                .peek(0)
                .is_some_and(|next| next.kind == Kind::Sign && !next.is("[") && !next.is(";"));
            return Err(match suggest::nearest(&token.text, known) {
                None if matches!(&*token.text, "fn" | "let" | "var") => {
                    fault.help("this looks like WGSL: load it as WGSL")
                }
                _ if is_statement => Fault::new("a statement outside of a function", token.place)
                    .help("move it into a function, such as `void main() { … }`"),
                Some(near) => fault.help(format!("did you mean `{near}`?")),
                None if is_keyword(&token.text) => {
                    Fault::new("a statement outside of a function", token.place)
                        .help("move it into a function, such as `void main() { … }`")
                }
                None => fault.help("declare structures before they are used"),
            });
        }
        let mut dimensions = Vec::new();
        self.dimensions(&mut dimensions)?;
        Ok(Type {
            name: token.text.clone(),
            dimensions,
        })
    }

    pub(super) fn skip_precision(&mut self) {
        while ["lowp", "mediump", "highp"]
            .iter()
            .any(|word| self.is_next(word))
        {
            self.at += 1;
        }
    }

    /// Sizes of arrays: `[3][]`.
    pub(super) fn dimensions(&mut self, dimensions: &mut Vec<u32>) -> Result<(), Fault> {
        while self.skip("[") {
            let open = self.tokens[self.at - 1].place;
            let inside = self.until(&["]"]);
            let close = self.expect("]")?.place;
            if inside.is_empty() {
                dimensions.push(0);
                continue;
            }
            let size = self.constant(inside, open.to(close))?;
            if !(1..=LONGEST_ARRAY).contains(&size) {
                let message = format!("an array cannot have {size} elements");
                return Err(Fault::new(message, open.to(close))
                    .help(format!("use 1 to {LONGEST_ARRAY} elements")));
            }
            dimensions.push(u32::try_from(size).unwrap_or(0));
        }
        Ok(())
    }

    /// The value of a constant integer expression.
    pub(super) fn constant(&self, tokens: &[Token], whole: Place) -> Result<i64, Fault> {
        let constants = &self.unit.constants;
        evaluate(tokens, whole, &|name| constants.get(name).copied())
            .map_err(|fault| fault.help("use constant integers: numbers, macros, `const int`"))
    }

    /// The members of a structure or block, with the braces.
    pub(super) fn members(&mut self) -> Result<Vec<Member>, Fault> {
        self.expect("{")?;
        let mut members: Vec<Member> = Vec::new();
        while !self.skip("}") {
            let qualifiers = self.qualifiers()?;
            if let Some(word) = qualifiers.layout_word("row_major") {
                return Err(row_major(word.place));
            }
            let ty = self.ty()?;
            loop {
                let name = self.name()?;
                if members.iter().any(|member| member.name == name.text) {
                    let message = format!("there are two members `{}`", name.text);
                    return Err(Fault::new(message, name.place).help("rename one of them"));
                }
                let mut dimensions = Vec::new();
                self.dimensions(&mut dimensions)?;
                dimensions.extend_from_slice(&ty.dimensions);
                members.push(Member {
                    name: name.text.clone(),
                    place: name.place,
                    ty: Type {
                        name: ty.name.clone(),
                        dimensions,
                    },
                    offset: qualifiers.value("offset"),
                });
                if !self.skip(",") {
                    break;
                }
            }
            self.expect(";")?;
        }
        Ok(members)
    }
}

pub(super) fn row_major(place: Place) -> Fault {
    Fault::new("`row_major` is not supported", place)
        .help("leave it out, and transpose the matrices in the program or the shader")
}

/// Words of the language that are no names.
pub(super) fn is_keyword(word: &str) -> bool {
    matches!(
        word,
        "attribute"
            | "break"
            | "buffer"
            | "case"
            | "const"
            | "continue"
            | "default"
            | "discard"
            | "do"
            | "else"
            | "false"
            | "flat"
            | "for"
            | "highp"
            | "if"
            | "in"
            | "inout"
            | "invariant"
            | "layout"
            | "lowp"
            | "mediump"
            | "out"
            | "precision"
            | "return"
            | "struct"
            | "switch"
            | "true"
            | "uniform"
            | "varying"
            | "void"
            | "while"
    )
}
