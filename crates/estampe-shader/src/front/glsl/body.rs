//! Rewriting functions and initial values, token by token.
//!
//! Names of combined textures and samplers become the texture and the sampler: `sampler2D(t, s)`
//! in calls of the language's functions, `t, s` in calls of the author's. Built-in variables and
//! functions get naga's names. Sizes of arrays are turned round, as naga takes the first as the
//! innermost, and those that are left out are counted.

use std::collections::HashMap;
use std::rc::Rc;

use super::super::suggest;
use super::Fault;
use super::builtins::{self, BuiltIn};
use super::indices::{color_target, constant, group};
use super::items::count_elements;
use super::number;
use super::token::{Kind, Place, Token};
use super::types::{self, Type};
use super::unit::Unit;
use super::write::{Pair, Writer};
use super::{atomics, gather};

/// The names that functions declare, innermost scope last. A pair is that of a sampler.
#[derive(Debug, Default)]
pub(super) struct Scopes {
    scopes: Vec<HashMap<Rc<str>, Option<Pair>>>,
}

impl Scopes {
    pub(super) fn open(&mut self) {
        self.scopes.push(HashMap::new());
    }

    /// Adds a variable.
    pub(super) fn add(&mut self, name: &str) {
        if let Some(scope) = self.scopes.last_mut() {
            scope.insert(name.into(), None);
        }
    }

    /// Adds a parameter that is a combined texture and sampler.
    pub(super) fn add_sampler(&mut self, name: &str, pair: Pair) {
        if let Some(scope) = self.scopes.last_mut() {
            scope.insert(name.into(), Some(pair));
        }
    }

    /// The sampler that a parameter is.
    pub(super) fn sampler(&self, name: &str) -> Option<&Pair> {
        self.find(name)?.as_ref()
    }

    /// True if a function declares the name.
    pub(super) fn is_declared(&self, name: &str) -> bool {
        self.find(name).is_some()
    }

    fn find(&self, name: &str) -> Option<&Option<Pair>> {
        self.scopes.iter().rev().find_map(|scope| scope.get(name))
    }
}

/// What an open bracket belongs to.
enum Bracket {
    /// A call of a function of the author.
    OwnCall,
    /// A call of another function.
    Call,
    Other,
}

/// The state of rewriting.
#[derive(Default)]
pub(super) struct State {
    brackets: Vec<Bracket>,
    /// The number of open brackets where a declaration goes on, if one does.
    declares_at: Option<usize>,
    /// True in a call that is written once for each sampler of an array.
    pub(super) is_chosen: bool,
}

impl State {
    /// Goes into the arguments of a function of the language.
    pub(super) fn open_call(&mut self) {
        self.brackets.push(Bracket::Call);
    }

    /// Goes into the arguments of a function like the author's.
    pub(super) fn open_own_call(&mut self) {
        self.brackets.push(Bracket::OwnCall);
    }

    /// Leaves brackets.
    pub(super) fn close(&mut self) {
        self.brackets.pop();
    }
}

impl Writer<'_> {
    /// Rewrites tokens.
    pub(super) fn rewrite(&mut self, tokens: &[Token], scopes: &mut Scopes) -> Result<(), Fault> {
        let mut state = State::default();
        self.rewrite_range(tokens, 0..tokens.len(), scopes, &mut state)
    }

    pub(super) fn rewrite_range(
        &mut self,
        tokens: &[Token],
        range: core::ops::Range<usize>,
        scopes: &mut Scopes,
        state: &mut State,
    ) -> Result<(), Fault> {
        let mut at = range.start;
        while at < range.end {
            let token = &tokens[at];
            at = match token.kind {
                Kind::Number => {
                    self.output
                        .put(&number::spelling(token)?, Some(token.place));
                    at + 1
                }
                Kind::Sign => {
                    self.sign(tokens, at, scopes, state);
                    at + 1
                }
                Kind::Word => self.word(tokens, at, scopes, state)?,
            };
        }
        Ok(())
    }

    fn sign(&mut self, tokens: &[Token], at: usize, scopes: &mut Scopes, state: &mut State) {
        let token = &tokens[at];
        match &*token.text {
            "(" | "[" | "{" => {
                let before = at.checked_sub(1).map(|before| &tokens[before]);
                let caller = before.filter(|before| before.is_word() && token.is("("));
                state.brackets.push(match caller {
                    Some(name) if self.unit.has_function(&name.text) => Bracket::OwnCall,
                    Some(_) => Bracket::Call,
                    None => Bracket::Other,
                });
                if token.is("{") {
                    scopes.open();
                }
            }
            ")" | "]" | "}" => {
                state.brackets.pop();
                if token.is("}") {
                    scopes.scopes.pop();
                }
            }
            ";" => state.declares_at = None,
            _ => {}
        }
        self.output.put(&token.text, Some(token.place));
    }

    /// Rewrites a word, and gives where to go on.
    fn word(
        &mut self,
        tokens: &[Token],
        at: usize,
        scopes: &mut Scopes,
        state: &mut State,
    ) -> Result<usize, Fault> {
        let token = &tokens[at];
        let place = Some(token.place);
        let name = &*token.text;
        let before = at.checked_sub(1).map(|before| &tokens[before]);
        let is_after = |text: &str| before.is_some_and(|before| before.is(text));
        let is_call = tokens.get(at + 1).is_some_and(|next| next.is("("));
        if is_after(".") {
            let spelled = self.spell(name);
            self.output.put(&spelled, place);
            return Ok(at + 1);
        }
        match name {
            "lowp" | "mediump" | "highp" => return Ok(at + 1),
            "precise" | "invariant" if !is_call => return Ok(at + 1),
            "precision" => {
                let end = tokens[at..].iter().position(|end| end.is(";"));
                return Ok(end.map_or(tokens.len(), |end| at + end));
            }
            _ if name.starts_with("gl_") => {
                self.built_in(tokens, at)?;
                return Ok(at + 1);
            }
            _ => {}
        }
        if self.unit.structures.is_type(name) && types::sampler(name).is_none() {
            if is_call || builtins::is_naga_word(self.unit, name) {
                let spelled = self.spell(name);
                self.output.put(&spelled, place);
                return Ok(at + 1);
            }
            self.output.put(name, place);
            return self.sizes(tokens, at + 1, scopes, state);
        }
        if is_call {
            if name == "switch" && builtins::is_naga_word(self.unit, name) {
                let version = self.unit.version.number;
                let message = format!("GLSL has `switch` since version 1.30, not in {version}");
                return Err(Fault::new(message, token.place)
                    .help("begin the shader with `#version 330` or `#version 300 es`"));
            }
            if gather::is_gather(self.unit, name)
                && let Some(end) = self.gather_call(tokens, at, scopes, state)?
            {
                return Ok(end);
            }
            if !self.unit.has_function(name)
                && let Some(end) = self.choice(tokens, at, scopes, state)?
            {
                return Ok(end);
            }
            if atomics::is_atomic(self.unit, name) {
                return self.atomic_call(tokens, at, scopes, state);
            }
            return Ok(self.call(tokens, at));
        }
        // Declarations: a name after a type, or after a comma in a declaration.
        let follows_type = before.is_some_and(|before| {
            before.is_word() && self.unit.structures.is_type(&before.text)
                || before.is("]") && is_type_with_sizes(self.unit, tokens, at)
        });
        let goes_on = is_after(",") && state.declares_at == Some(state.brackets.len());
        if follows_type || goes_on {
            state.declares_at = Some(state.brackets.len());
            scopes.add(name);
            let spelled = self.spell(name);
            self.output.put(&spelled, place);
            return self.sizes(tokens, at + 1, scopes, state);
        }
        match scopes.find(name) {
            Some(Some(pair)) => {
                let pair = pair.clone();
                self.sampler(&pair, name, token.place, tokens.get(at + 1), state)?;
                return Ok(at + 1);
            }
            Some(None) => {}
            None => {
                let next = tokens.get(at + 1);
                if next.is_some_and(is_assignment) && self.unit.is_uniform(name) {
                    let message = format!("the uniform `{name}` cannot be assigned to");
                    return Err(Fault::new(message, token.place).help(
                        "inputs, uniforms and constants are read only: copy them to a variable",
                    ));
                }
                let member = tokens.get(at + 2).filter(|_| tokens[at + 1].is("."));
                let path = member.map(|member| (token.text.clone(), member.text.clone()));
                if let Some(seen) = path.and_then(|path| self.members.get(&path)).cloned() {
                    self.output.put(&seen, place);
                    return Ok(at + 3);
                }
                if let Some(root) = self.roots.get(&token.text).cloned()
                    && let Some(end) = self.path(tokens, at, root, state)?
                {
                    return Ok(end);
                }
            }
        }
        let spelled = self.spell(name);
        self.output.put(&spelled, place);
        Ok(at + 1)
    }

    /// The name of a function that is called.
    fn call(&mut self, tokens: &[Token], at: usize) -> usize {
        let token = &tokens[at];
        let name = &*token.text;
        if self.unit.has_function(name) {
            let spelled = self.function_name(name);
            self.output.put(&spelled, Some(token.place));
            return at + 1;
        }
        if builtins::is_memory_barrier(name) && tokens.get(at + 2).is_some_and(|end| end.is(")")) {
            return at + 3;
        }
        let name = builtins::legacy_function(name).unwrap_or(name);
        self.output.put(name, Some(token.place));
        at + 1
    }

    fn built_in(&mut self, tokens: &[Token], at: usize) -> Result<(), Fault> {
        let token = &tokens[at];
        let name = &*token.text;
        let text = match builtins::variable(self.unit, name) {
            BuiltIn::Same => name.to_owned(),
            BuiltIn::Other(text) => text,
            BuiltIn::Color => format!("{}Color", self.unit.prefix),
            BuiltIn::Colors => {
                color_target(self.unit, tokens, at)?;
                format!("{}Colors", self.unit.prefix)
            }
            BuiltIn::Unsupported(help) => {
                return Err(
                    Fault::new(format!("`{name}` is not supported"), token.place).help(help),
                );
            }
            BuiltIn::Unknown => {
                let stage = format!("{:?}", self.unit.stage).to_lowercase();
                let fault = Fault::new(
                    format!("a {stage} shader has no variable `{name}`"),
                    token.place,
                );
                let known = builtins::variables(self.unit.stage);
                return Err(match suggest::nearest(name, known.iter().copied()) {
                    Some(near) => fault.help(format!("did you mean `{near}`?")),
                    None => fault.help(format!("it has {}", known.join(", "))),
                });
            }
        };
        self.output.put(&text, Some(token.place));
        Ok(())
    }

    /// Sizes of arrays after a type or a name that is declared: turned round, and counted where
    /// they are left out.
    fn sizes(
        &mut self,
        tokens: &[Token],
        at: usize,
        scopes: &mut Scopes,
        state: &mut State,
    ) -> Result<usize, Fault> {
        let mut groups = Vec::new();
        let mut end = at;
        while let Some(close) = group(tokens, end) {
            groups.push(end..close + 1);
            end = close + 1;
        }
        let is_constructor = tokens.get(end).is_some_and(|open| open.is("("));
        for range in groups.into_iter().rev() {
            let open = &tokens[range.start];
            if range.len() == 2 && !is_constructor {
                let rest = &tokens[end..];
                let equals = rest.iter().position(|token| token.is("=") || token.is(";"));
                let init = equals.map(|equals| &rest[equals..]).unwrap_or_default();
                if let Some(count) = count_elements(init).filter(|_| equals <= Some(1)) {
                    self.output.put(&format!("[ {count} ]"), Some(open.place));
                    continue;
                }
            }
            self.rewrite_range(tokens, range, scopes, state)?;
        }
        Ok(end)
    }

    /// Writes the texture and sampler of a path from a uniform on. `None` if it leads elsewhere.
    fn path(
        &mut self,
        tokens: &[Token],
        start: usize,
        mut ty: Type,
        state: &State,
    ) -> Result<Option<usize>, Fault> {
        let root = &tokens[start];
        let mut path = root.text.to_string();
        let mut at = start + 1;
        let mut computed = None;
        loop {
            let place = root.place.to(tokens[at - 1].place);
            if let Some(&size) = ty.dimensions.first() {
                let Some(close) = group(tokens, at) else {
                    if types::sampler(&ty.name).is_none() {
                        return Ok(None);
                    }
                    let message = format!("`{path}` is an array of samplers");
                    return Err(Fault::new(message, place)
                        .help("use one of its elements, or an array texture (`sampler2DArray`)"));
                };
                let inside = &tokens[at + 1..close];
                match constant(self.unit, inside) {
                    Ok(index) if (0..i64::from(size)).contains(&index) => {
                        path.push_str(&format!("[{index}]"));
                    }
                    Ok(index) => {
                        let message = format!("index {index} is beyond the end of `{path}`");
                        return Err(
                            Fault::new(message, tokens[at].place.to(tokens[close].place))
                                .help(format!("use 0 to {}", size.saturating_sub(1))),
                        );
                    }
                    Err(_) => computed = Some(tokens[at].place.to(tokens[close].place)),
                }
                ty = ty.element();
                at = close + 1;
            } else if types::sampler(&ty.name).is_some() {
                if let Some(computed) = computed {
                    return Err(Fault::new("samplers need a constant index", computed)
                        .help("use an array texture, such as `sampler2DArray`, or `switch`"));
                }
                let Some(pair) = self.pairs.get(&path).cloned() else {
                    return Ok(None);
                };
                self.sampler(&pair, &path, place, tokens.get(at), state)?;
                return Ok(Some(at));
            } else {
                let member = tokens.get(at + 1).filter(|_| tokens[at].is("."));
                let members = self.unit.structures.get(&ty.name);
                let found = member.zip(members).and_then(|(name, members)| {
                    members.iter().find(|member| member.name == name.text)
                });
                match found {
                    Some(member) if self.unit.structures.has_sampler(&member.ty) => {
                        path.push_str(&format!(".{}", member.name));
                        ty = member.ty.clone();
                        at += 2;
                    }
                    _ => return Ok(None),
                }
            }
        }
    }

    fn sampler(
        &mut self,
        pair: &Pair,
        name: &str,
        place: Place,
        next: Option<&Token>,
        state: &State,
    ) -> Result<(), Fault> {
        let is_argument = next.is_some_and(|next| next.is(",") || next.is(")"));
        let text = match state.brackets.last() {
            Some(Bracket::OwnCall) if is_argument => format!("{} , {}", pair.texture, pair.sampler),
            Some(Bracket::Call) if is_argument => pair.combined(),
            _ => {
                let message = format!("the sampler `{name}` can only be handed to a function");
                return Err(Fault::new(message, place).help(format!(
                    "read it with `texture({name}, …)` or `texelFetch({name}, …)`"
                )));
            }
        };
        self.output.put(&text, Some(place));
        Ok(())
    }
}

/// True for `=`, `+=` and the like.
pub(super) fn is_assignment(token: &Token) -> bool {
    let is_comparison = ["==", "!=", "<=", ">="].iter().any(|sign| token.is(sign));
    token.kind == Kind::Sign && token.text.ends_with('=') && !is_comparison
}

/// True if the brackets that end before `at` belong to a type.
fn is_type_with_sizes(unit: &Unit, tokens: &[Token], at: usize) -> bool {
    let mut depth = 0_usize;
    for index in (0..at).rev() {
        match &*tokens[index].text {
            "]" => depth += 1,
            "[" => depth = depth.saturating_sub(1),
            _ if depth > 0 => {}
            name => return tokens[index].is_word() && unit.structures.is_type(name),
        }
    }
    false
}
