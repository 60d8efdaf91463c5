//! Samplers at a computed index of an array, which naga does not have.
//!
//! `texture(maps[i], uv)` becomes a choice among the calls with each sampler, of which one is
//! executed: `int(i) == 0 ? texture(maps[0], uv) : …`. GLSL wants the index to be the same in all
//! invocations that run together, so that derivatives are those of one texture.

use std::ops::Range;

use super::Fault;
use super::body::{Scopes, State};
use super::builtins;
use super::indices::{constant, group};
use super::nesting::close;
use super::token::Token;
use super::types;
use super::write::{Pair, Writer};

/// The most tokens that are written for the choices of a shader: a call is written once for each
/// sampler of the array.
const MOST_TOKENS: usize = 1 << 18;

/// A path to a sampler with one index that is computed.
struct Choice {
    /// The tokens of the index.
    index: Range<usize>,
    /// The samplers, by index.
    pairs: Vec<Pair>,
    /// The token after the path.
    end: usize,
}

impl Writer<'_> {
    /// Writes the call of a function of the language whose first argument is a sampler at a
    /// computed index, and gives where to go on; `None` if it is not.
    pub(super) fn choice(
        &mut self,
        tokens: &[Token],
        at: usize,
        scopes: &mut Scopes,
        state: &mut State,
    ) -> Result<Option<usize>, Fault> {
        let Some(choice) = self.computed_path(tokens, at + 2, scopes) else {
            return Ok(None);
        };
        let Some(end) = close(tokens, at + 1) else {
            return Ok(None);
        };
        let place = Some(tokens[at].place);
        let index = &tokens[choice.index.clone()];
        let changes = ["=", "++", "--", "+=", "-=", "*=", "/="];
        if state.is_chosen
            || index
                .iter()
                .any(|token| changes.iter().any(|one| token.is(one)))
        {
            let whole = index.first().zip(index.last());
            let place = whole.map_or(tokens[at].place, |(first, last)| first.place.to(last.place));
            return Err(
                Fault::new("this index of samplers is not simple enough", place)
                    .help("compute it before, and read one texture after the other"),
            );
        }
        self.chosen_tokens += choice.pairs.len() * (end - at);
        if self.chosen_tokens > MOST_TOKENS {
            let message = "there are too many calls with samplers at computed indices";
            return Err(Fault::new(message, tokens[at].place)
                .help("use an array texture, such as `sampler2DArray`"));
        }
        state.is_chosen = true;
        self.output.put("(", place);
        let name = &*tokens[at].text;
        let name = builtins::legacy_function(name).unwrap_or(name);
        let last = choice.pairs.len() - 1;
        for (number, pair) in choice.pairs.iter().enumerate() {
            if number < last {
                self.output.put("int (", place);
                state.open_call();
                self.rewrite_range(tokens, choice.index.clone(), scopes, state)?;
                state.close();
                self.output.put(&format!(") == {number} ?"), place);
            }
            let sampler = pair.combined();
            self.output.put(&format!("{name} ( {sampler}"), place);
            state.open_call();
            self.rewrite_range(tokens, choice.end..end, scopes, state)?;
            state.close();
            self.output
                .put(if number < last { ") :" } else { ")" }, place);
        }
        self.output.put(")", place);
        state.is_chosen = false;
        Ok(Some(end + 1))
    }

    /// The path from a token on, if it leads to a sampler by one computed index.
    fn computed_path(&self, tokens: &[Token], start: usize, scopes: &Scopes) -> Option<Choice> {
        let root = tokens.get(start)?;
        if scopes.is_declared(&root.text) {
            return None;
        }
        let mut ty = self.roots.get(&root.text).cloned()?;
        let mut at = start + 1;
        // The path before and after the computed index, the number of elements, and the index.
        let (mut before, mut after) = (root.text.to_string(), String::new());
        let mut computed: Option<(u32, Range<usize>)> = None;
        loop {
            let path = match computed {
                Some(_) => &mut after,
                None => &mut before,
            };
            if let Some(&size) = ty.dimensions.first() {
                let end = group(tokens, at)?;
                match constant(self.unit, &tokens[at + 1..end]) {
                    Ok(index) => path.push_str(&format!("[{index}]")),
                    Err(_) if computed.is_none() => computed = Some((size, at + 1..end)),
                    Err(_) => return None,
                }
                ty = ty.element();
                at = end + 1;
            } else if types::sampler(&ty.name).is_some() {
                break;
            } else {
                let member = tokens.get(at + 1).filter(|_| tokens[at].is("."))?;
                let members = self.unit.structures.get(&ty.name)?;
                let found = members.iter().find(|one| one.name == member.text)?;
                path.push_str(&format!(".{}", found.name));
                ty = found.ty.clone();
                at += 2;
            }
        }
        let (size, index) = computed?;
        let is_argument = tokens
            .get(at)
            .is_some_and(|next| next.is(",") || next.is(")"));
        let pair = |number| {
            self.pairs
                .get(&format!("{before}[{number}]{after}"))
                .cloned()
        };
        let pairs: Option<Vec<_>> = (0..size).map(pair).collect();
        let pairs = pairs.filter(|pairs| is_argument && !pairs.is_empty())?;
        Some(Choice {
            index,
            pairs,
            end: at,
        })
    }
}
