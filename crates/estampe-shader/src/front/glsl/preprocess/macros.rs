//! Macros, and their replacement.
//!
//! A macro's text is scanned again with the macro disabled; a name that meets its own macro is
//! painted and never replaced. Arguments are replaced first, each on its own (as in C, to which
//! GLSL refers). Tokens of a macro's text get the place of its use, arguments keep theirs.

use std::collections::{HashMap, HashSet};
use std::rc::Rc;

use super::super::Fault;
use super::super::token::{Kind, Place, Token};

/// How deeply arguments of macros nest in arguments of macros.
const DEEPEST: u32 = 64;

/// The most parameters of a macro.
const MOST_PARAMETERS: usize = 256;

/// A macro.
#[derive(Debug, Clone)]
pub(super) struct Macro {
    /// The names of the parameters; `None` for a macro without `()`.
    pub parameters: Option<Vec<Rc<str>>>,
    pub body: Vec<Token>,
}

/// The macros of a text.
#[derive(Debug)]
pub(super) struct Macros {
    pub defined: HashMap<Rc<str>, Rc<Macro>>,
    /// How many more tokens macros may make.
    pub budget: usize,
}

enum Item {
    Token(Token),
    /// The end of a macro's text: it is enabled again.
    End(Rc<str>),
}

impl Macros {
    /// The tokens with macros replaced. `line_of` gives the value of `__LINE__`.
    pub(super) fn replace(
        &mut self,
        tokens: Vec<Token>,
        line_of: &dyn Fn(Place) -> u32,
    ) -> Result<Vec<Token>, Fault> {
        self.replace_at(tokens, line_of, &mut HashSet::new(), 0)
    }

    fn replace_at(
        &mut self,
        tokens: Vec<Token>,
        line_of: &dyn Fn(Place) -> u32,
        disabled: &mut HashSet<Rc<str>>,
        depth: u32,
    ) -> Result<Vec<Token>, Fault> {
        let mut output = Vec::with_capacity(tokens.len());
        let mut stack: Vec<Item> = tokens.into_iter().rev().map(Item::Token).collect();
        while let Some(item) = stack.pop() {
            let mut token = match item {
                Item::End(name) => {
                    disabled.remove(&name);
                    continue;
                }
                Item::Token(token) => token,
            };
            self.spend(1, token.place)?;
            if token.kind != Kind::Word || token.is_painted {
                output.push(token);
                continue;
            }
            if token.is("__LINE__") {
                let line = line_of(token.place).to_string();
                output.push(Token {
                    kind: Kind::Number,
                    text: line.into(),
                    ..token
                });
                continue;
            }
            let Some(found) = self.defined.get(&token.text) else {
                output.push(token);
                continue;
            };
            if disabled.contains(&token.text) {
                token.is_painted = true;
                output.push(token);
                continue;
            }
            let found = Rc::clone(found);
            let body = match &found.parameters {
                None => self.substitute(&found.body, &[], &[], &[], token.place)?,
                Some(parameters) => {
                    if depth > DEEPEST {
                        return Err(Fault::new("macros nest too deeply here", token.place));
                    }
                    let Some((arguments, end)) = arguments(&mut stack, disabled, &token)? else {
                        output.push(token);
                        continue;
                    };
                    check_count(&token, parameters, &arguments, end)?;
                    let mut replaced = Vec::with_capacity(arguments.len());
                    for argument in &arguments {
                        self.spend(disabled.len(), token.place)?;
                        let mut fresh = disabled.clone();
                        let argument = argument.clone();
                        replaced.push(self.replace_at(argument, line_of, &mut fresh, depth + 1)?);
                    }
                    self.substitute(&found.body, parameters, &arguments, &replaced, token.place)?
                }
            };
            let body = paste(body);
            disabled.insert(token.text.clone());
            stack.push(Item::End(token.text.clone()));
            for (index, mut part) in body.into_iter().enumerate().rev() {
                part.starts_line = index == 0 && token.starts_line;
                part.has_space |= index == 0 && token.has_space;
                stack.push(Item::Token(part));
            }
        }
        Ok(output)
    }

    /// Counts tokens that macros make.
    pub(super) fn spend(&mut self, tokens: usize, place: Place) -> Result<(), Fault> {
        self.budget = self.budget.checked_sub(tokens).ok_or_else(|| {
            Fault::new(
                "the shader is too large when its macros are replaced",
                place,
            )
            .help("raise the limit `tokens` of the options, or make the macros smaller")
        })?;
        Ok(())
    }

    /// The text of a macro with its parameters replaced.
    fn substitute(
        &mut self,
        body: &[Token],
        parameters: &[Rc<str>],
        arguments: &[Vec<Token>],
        replaced: &[Vec<Token>],
        place: Place,
    ) -> Result<Vec<Token>, Fault> {
        self.spend(body.len(), place)?;
        let mut output = Vec::with_capacity(body.len());
        for (index, part) in body.iter().enumerate() {
            let which = parameters.iter().position(|name| *name == part.text);
            let Some(which) = which.filter(|_| part.is_word()) else {
                output.push(Token {
                    place,
                    ..part.clone()
                });
                continue;
            };
            let is_pasted = body.get(index + 1).is_some_and(|next| next.is("##"))
                || index > 0 && body[index - 1].is("##");
            let from = if is_pasted {
                &arguments[which]
            } else {
                &replaced[which]
            };
            self.spend(from.len(), place)?;
            output.extend_from_slice(from);
        }
        Ok(output)
    }
}

/// The tokens of each argument.
type Arguments = Vec<Vec<Token>>;

/// The arguments of a macro's use, and the place of the `)`. `None` if no `(` follows.
fn arguments(
    stack: &mut Vec<Item>,
    disabled: &mut HashSet<Rc<str>>,
    name: &Token,
) -> Result<Option<(Arguments, Place)>, Fault> {
    let next = stack.iter().rev().find_map(|item| match item {
        Item::Token(token) => Some(token),
        Item::End(_) => None,
    });
    if !next.is_some_and(|next| next.is("(")) {
        return Ok(None);
    }
    let mut arguments = vec![Vec::new()];
    let mut depth = 0_usize;
    while let Some(item) = stack.pop() {
        let token = match item {
            Item::End(name) => {
                disabled.remove(&name);
                continue;
            }
            Item::Token(token) => token,
        };
        match &*token.text {
            "(" => {
                depth += 1;
                if depth == 1 {
                    continue;
                }
            }
            ")" => {
                depth -= 1;
                if depth == 0 {
                    return Ok(Some((arguments, token.place)));
                }
            }
            "," if depth == 1 => {
                if arguments.len() > MOST_PARAMETERS {
                    return Err(Fault::new("this macro has too many arguments", name.place));
                }
                arguments.push(Vec::new());
                continue;
            }
            _ => {}
        }
        if let Some(last) = arguments.last_mut() {
            last.push(token);
        }
    }
    let message = format!("the arguments of the macro `{}` have no end", name.text);
    Err(Fault::new(message, name.place).help("close them with `)`"))
}

fn check_count(
    name: &Token,
    parameters: &[Rc<str>],
    arguments: &[Vec<Token>],
    end: Place,
) -> Result<(), Fault> {
    let given = match arguments {
        [only] if only.is_empty() && parameters.is_empty() => 0,
        _ => arguments.len(),
    };
    if given == parameters.len() {
        return Ok(());
    }
    let wanted = parameters.len();
    let plural = if wanted == 1 { "" } else { "s" };
    let verb = if given == 1 { "is" } else { "are" };
    let name_text = &name.text;
    Err(Fault::new(
        format!(
            "the macro `{name_text}` takes {wanted} argument{plural}, but {given} {verb} given"
        ),
        name.place.to(end),
    ))
}

/// Joins the tokens around `##`.
fn paste(tokens: Vec<Token>) -> Vec<Token> {
    if !tokens.iter().any(|token| token.is("##")) {
        return tokens;
    }
    let mut output: Vec<Token> = Vec::with_capacity(tokens.len());
    let mut joins = false;
    for token in tokens {
        if token.is("##") {
            joins = !output.is_empty();
            continue;
        }
        match output.last_mut() {
            Some(last) if joins => {
                last.text = format!("{}{}", last.text, token.text).into();
                if last.kind == Kind::Sign {
                    last.kind = token.kind;
                }
            }
            _ => output.push(token),
        }
        joins = false;
    }
    output
}
