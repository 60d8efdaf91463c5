//! The directives of the preprocessor, one line each.

use std::rc::Rc;

use super::super::super::suggest;
use super::super::Fault;
use super::super::number::{Number, number};
use super::super::token::{Kind, Place, Token};
use super::macros::Macro;
use super::{Group, Preprocessor, evaluate};

/// The directives of GLSL.
const DIRECTIVES: &[&str] = &[
    "define",
    "undef",
    "if",
    "ifdef",
    "ifndef",
    "else",
    "elif",
    "endif",
    "error",
    "pragma",
    "extension",
    "version",
    "line",
];

/// How deeply conditions nest.
const DEEPEST: usize = 256;

impl Preprocessor<'_> {
    /// Does what the line after a `#` says.
    pub(super) fn directive(
        &mut self,
        hash: &Token,
        line: &[Token],
        is_first: bool,
    ) -> Result<(), Fault> {
        let Some((name, rest)) = line.split_first() else {
            return Ok(());
        };
        let is_active = self.is_active();
        match &*name.text {
            "if" | "ifdef" | "ifndef" => self.open(name, rest, is_active),
            "elif" | "else" | "endif" => self.branch(name, rest),
            _ if !is_active => Ok(()),
            "define" => self.define_macro(name, rest),
            "undef" => {
                let macro_name = macro_name(name, rest)?;
                self.macros.defined.remove(&macro_name.text);
                Ok(())
            }
            "error" => {
                let words: Vec<&str> = rest.iter().map(|word| &*word.text).collect();
                let place = name
                    .place
                    .to(rest.last().map_or(name.place, |last| last.place));
                let message = format!("#error {}", words.join(" "));
                Err(Fault::new(message.trim_end(), place)
                    .help("the shader stops here on purpose: see the conditions around it"))
            }
            "version" if is_first => self.version(name, rest),
            "version" => Err(Fault::new(
                "#version is not the first line",
                hash.place.to(name.place),
            )
            .help("move it to the top: only comments may stand before it")),
            "line" => self.line(name, rest),
            "extension" | "pragma" => Ok(()),
            "include" => Err(
                Fault::new("GLSL has no #include", hash.place.to(name.place))
                    .help("put the text of the file here before the shader is loaded"),
            ),
            unknown => {
                let fault = Fault::new(
                    format!("there is no directive `#{unknown}`"),
                    hash.place.to(name.place),
                );
                Err(
                    match suggest::nearest(unknown, DIRECTIVES.iter().copied()) {
                        Some(near) => fault.help(format!("did you mean `#{near}`?")),
                        None => fault,
                    },
                )
            }
        }
    }

    fn open(&mut self, name: &Token, rest: &[Token], is_active: bool) -> Result<(), Fault> {
        if self.groups.len() >= DEEPEST {
            return Err(Fault::new("conditions nest too deeply here", name.place));
        }
        let holds = is_active
            && match &*name.text {
                "if" => self.condition(name, rest)?,
                test => {
                    let asked = macro_name(name, rest)?;
                    self.macros.defined.contains_key(&asked.text) == (test == "ifdef")
                }
            };
        self.groups.push(Group {
            place: name.place,
            is_done: holds || !is_active,
            is_active: holds,
            has_else: false,
        });
        Ok(())
    }

    fn branch(&mut self, name: &Token, rest: &[Token]) -> Result<(), Fault> {
        let text = &*name.text;
        let Some(group) = self.groups.last_mut() else {
            return Err(Fault::new(format!("#{text} without #if"), name.place)
                .help("remove it, or begin the condition with `#if`, `#ifdef` or `#ifndef`"));
        };
        if text == "endif" {
            self.groups.pop();
            return Ok(());
        }
        if group.has_else {
            return Err(Fault::new(format!("#{text} after #else"), name.place)
                .help("#else is the last branch"));
        }
        let (was_done, is_else) = (group.is_done, text == "else");
        group.has_else = is_else;
        group.is_active = false;
        let holds = !was_done && (is_else || self.condition(name, rest)?);
        if let Some(group) = self.groups.last_mut() {
            group.is_active = holds;
            group.is_done |= holds;
        }
        Ok(())
    }

    fn define_macro(&mut self, directive: &Token, rest: &[Token]) -> Result<(), Fault> {
        let name = macro_name(directive, rest)?;
        if name.is("defined") {
            return Err(Fault::new("`defined` cannot be a macro", name.place));
        }
        let mut body = &rest[1..];
        let mut parameters = None;
        if body
            .first()
            .is_some_and(|open| open.is("(") && !open.has_space)
        {
            let mut names: Vec<Rc<str>> = Vec::new();
            let mut at = 1;
            let broken = |place: Place| {
                Fault::new(
                    "the parameters of this macro are not a list of names",
                    place,
                )
                .help("write `#define NAME(a, b) …`")
            };
            loop {
                match body.get(at) {
                    Some(close) if close.is(")") && names.is_empty() => break,
                    Some(parameter) if parameter.is_word() => {
                        if names.contains(&parameter.text) {
                            let message = format!("there are two parameters `{}`", parameter.text);
                            return Err(Fault::new(message, parameter.place));
                        }
                        names.push(parameter.text.clone());
                    }
                    Some(other) => return Err(broken(other.place)),
                    None => return Err(broken(name.place)),
                }
                at += 2;
                match body.get(at - 1) {
                    Some(comma) if comma.is(",") => {}
                    Some(close) if close.is(")") => {
                        at -= 1;
                        break;
                    }
                    Some(other) => return Err(broken(other.place)),
                    None => return Err(broken(name.place)),
                }
            }
            body = &body[at + 1..];
            parameters = Some(names);
        }
        let defined = Macro {
            parameters,
            body: body.to_vec(),
        };
        self.macros
            .defined
            .insert(name.text.clone(), Rc::new(defined));
        Ok(())
    }

    fn version(&mut self, name: &Token, rest: &[Token]) -> Result<(), Fault> {
        let known = "use 110 to 460, or `100`, `300 es`, `310 es` or `320 es`";
        let Some((token, profile)) = rest.split_first() else {
            return Err(Fault::new("#version without a number", name.place).help(known));
        };
        let number = match number(token) {
            Ok(Number::Integer { value, .. }) => u32::try_from(value).unwrap_or(0),
            _ => 0,
        };
        let is_es = match profile.first().map(|word| &*word.text) {
            Some("es") => true,
            Some("core" | "compatibility") => false,
            None => number == 100,
            Some(other) => {
                let message = format!("there is no profile `{other}` of GLSL");
                return Err(Fault::new(message, profile[0].place)
                    .help("use `core`, `compatibility` or `es`, or leave it out"));
            }
        };
        let is_known = match is_es {
            true => matches!(number, 100 | 300 | 310 | 320),
            false => matches!(
                number,
                110 | 120 | 130 | 140 | 150 | 330 | 400 | 410 | 420 | 430 | 440 | 450 | 460
            ),
        };
        if !is_known {
            let message = format!("there is no version {} of GLSL", token.text);
            let help = match number {
                300 | 310 | 320 => format!("write `#version {number} es`"),
                _ => known.to_owned(),
            };
            return Err(Fault::new(message, token.place).help(help));
        }
        self.version = super::Version { number, is_es };
        self.define("__VERSION__", &number.to_string())?;
        if is_es {
            self.define("GL_ES", "1")?;
        } else if number >= 150 {
            self.define("GL_core_profile", "1")?;
        }
        Ok(())
    }

    /// `#line`: the next line has the number that is given.
    fn line(&mut self, name: &Token, rest: &[Token]) -> Result<(), Fault> {
        let tokens = self.replace(rest.to_vec())?;
        // The number of the source string, which may follow, is not used.
        let length = match tokens.as_slice() {
            [_, second] if second.kind == Kind::Number => 1,
            all => all.len(),
        };
        let number = evaluate(&tokens[..length], name.place, &|_| None)?;
        let line = i64::from(self.lines.line(name.place.start as usize));
        self.line_offset = number.saturating_sub(line + 1);
        Ok(())
    }
}

/// The name that a directive takes.
fn macro_name<'a>(directive: &Token, rest: &'a [Token]) -> Result<&'a Token, Fault> {
    match rest.first() {
        Some(name) if name.is_word() => Ok(name),
        Some(other) => Err(Fault::new(
            format!("`{}` is no name of a macro", other.text),
            other.place,
        )),
        None => Err(Fault::new(
            format!("#{} without the name of a macro", directive.text),
            directive.place,
        )),
    }
}
