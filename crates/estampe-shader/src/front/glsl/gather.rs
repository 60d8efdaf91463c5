//! `textureGather`, which naga's GLSL does not have, but its modules do.
//!
//! Each call becomes that of a function written for it, one for each component and offset that the
//! shader asks for, which samples. [`mend`] then makes a gather of what it samples.

use std::ops::Range;
use std::rc::Rc;

use naga::{Expression, Function, SampleLevel, SwizzleComponent, VectorSize};

use super::Fault;
use super::body::{Scopes, State};
use super::indices::constant;
use super::nesting::close;
use super::token::Token;
use super::unit::Unit;
use super::write::Writer;

/// The most gathers that differ in component or offset.
const MOST_GATHERS: usize = 64;

/// What a function gathers: a component, and the tokens of the offset if there is one.
#[derive(Debug, Clone)]
pub(super) struct Gather {
    component: u8,
    offset: Option<Vec<Token>>,
}

impl Gather {
    /// True if both gather the same, as they are written.
    fn is_same(&self, other: &Self) -> bool {
        let text = |gather: &Self| -> Option<Vec<Rc<str>>> {
            let tokens = gather.offset.as_ref()?.iter();
            Some(tokens.map(|token| token.text.clone()).collect())
        };
        self.component == other.component && text(self) == text(other)
    }
}

/// A call: its arguments, as ranges of tokens, and what it gathers if the texture compares or not.
struct Call {
    arguments: Vec<Range<usize>>,
    plain: Option<Gather>,
    comparing: Option<Gather>,
    /// The token after the call.
    end: usize,
}

/// A kind of texture: its coordinates, and whether a gather takes an offset and compares.
struct Kind {
    texture: &'static str,
    coordinates: &'static str,
    takes_offset: bool,
    compares: bool,
}

const fn kind(
    texture: &'static str,
    coordinates: &'static str,
    [takes_offset, compares]: [bool; 2],
) -> Kind {
    Kind {
        texture,
        coordinates,
        takes_offset,
        compares,
    }
}

/// naga samples no integers.
const KINDS: [Kind; 4] = [
    kind("texture2D", "vec2", [true, true]),
    kind("texture2DArray", "vec3", [true, true]),
    kind("textureCube", "vec3", [false, true]),
    kind("textureCubeArray", "vec4", [false, false]),
];

/// True for the functions that gather.
pub(super) fn is_gather(unit: &Unit, name: &str) -> bool {
    matches!(name, "textureGather" | "textureGatherOffset") && !unit.has_function(name)
}

/// The call whose name is at `at`.
fn call(unit: &Unit, tokens: &[Token], at: usize) -> Option<Call> {
    let end = close(tokens, at + 1)?;
    let arguments = arguments(tokens, at + 2..end);
    let tokens_of = |at: usize| arguments.get(at).map(|range| &tokens[range.clone()]);
    let component = |at: usize| match tokens_of(at) {
        None => Some(0),
        Some(argument) => {
            let component = constant(unit, argument).ok()?;
            u8::try_from(component).ok().filter(|one| *one < 4)
        }
    };
    let gather = |component: Option<u8>, offset: Option<usize>| {
        let offset = match offset {
            Some(at) => Some(tokens_of(at).filter(|one| !one.is_empty())?.to_vec()),
            None => None,
        };
        component.map(|component| Gather { component, offset })
    };
    let (plain, comparing) = match tokens[at].is("textureGather") {
        true => (gather(component(2), None), gather(Some(0), None)),
        // A last argument that is a component is no offset.
        false => match component(3) {
            Some(component) => (gather(Some(component), Some(2)), None),
            None => (None, gather(Some(0), Some(3))),
        },
    };
    (arguments.len() >= 2).then_some(Call {
        arguments,
        plain,
        comparing,
        end: end + 1,
    })
}

/// The tokens between commas outside of brackets.
fn arguments(tokens: &[Token], range: Range<usize>) -> Vec<Range<usize>> {
    let (mut depth, mut start) = (0_usize, range.start);
    let mut found = Vec::new();
    for at in range.clone() {
        match &*tokens[at].text {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth = depth.saturating_sub(1),
            "," if depth == 0 => {
                found.push(start..at);
                start = at + 1;
            }
            _ => {}
        }
    }
    found.push(start..range.end);
    found
}

impl Writer<'_> {
    /// Writes the functions that the shader's gathers need.
    pub(super) fn gathers(&mut self) -> Result<(), Fault> {
        let unit = self.unit;
        for function in unit.functions() {
            for (at, token) in function.body.iter().enumerate() {
                if !token.is_word() || !is_gather(unit, &token.text) {
                    continue;
                }
                let call = call(unit, &function.body, at).into_iter();
                let wanted = call.flat_map(|call| [call.plain, call.comparing]).flatten();
                for gather in wanted {
                    if self.gathers.iter().any(|known| known.is_same(&gather)) {
                        continue;
                    }
                    if self.gathers.len() == MOST_GATHERS {
                        let message = format!("more than {MOST_GATHERS} gathers differ");
                        return Err(Fault::new(message, token.place)
                            .help("use fewer offsets, or `texelFetch`"));
                    }
                    self.gather(&gather)?;
                    self.gathers.push(gather);
                }
            }
        }
        Ok(())
    }

    /// Writes a function, for each kind of texture.
    fn gather(&mut self, gather: &Gather) -> Result<(), Fault> {
        let name = self.gather_name(self.gathers.len(), gather.component);
        for kind in &KINDS {
            if gather.offset.is_some() && !kind.takes_offset {
                continue;
            }
            let (texture, coordinates) = (kind.texture, kind.coordinates);
            let sampler = texture.replace("texture", "sampler");
            let offset = if gather.offset.is_some() {
                "Offset"
            } else {
                ""
            };
            let head = format!(
                "vec4 {name} ( {texture} t , sampler s , {coordinates} p ) \
                 {{ return textureLod{offset} ( {sampler} ( t , s ) , p , 0.0"
            );
            self.gather_function(&head, gather, ") ; }")?;
            if kind.compares && gather.component == 0 {
                let with_reference = if coordinates == "vec2" {
                    "vec3"
                } else {
                    "vec4"
                };
                let head = format!(
                    "vec4 {name} ( {texture} t , samplerShadow s , {coordinates} p , float z ) \
                     {{ return vec4 ( texture{offset} ( {sampler}Shadow ( t , s ) , \
                     {with_reference} ( p , z )"
                );
                self.gather_function(&head, gather, ") ) ; }")?;
            }
        }
        Ok(())
    }

    fn gather_function(&mut self, head: &str, gather: &Gather, tail: &str) -> Result<(), Fault> {
        let offset = gather.offset.as_deref().unwrap_or_default();
        let place = offset.first().map(|first| first.place);
        self.output.put(head, place);
        if !offset.is_empty() {
            self.output.put(",", place);
            self.rewrite(offset, &mut Scopes::default())?;
        }
        self.output.put(tail, place);
        Ok(())
    }

    fn gather_name(&self, index: usize, component: u8) -> String {
        format!("{}gather{index}_{component}", self.unit.prefix)
    }

    /// Writes the call of a function that gathers, and gives where to go on; `None` if it has too
    /// few arguments.
    pub(super) fn gather_call(
        &mut self,
        tokens: &[Token],
        at: usize,
        scopes: &mut Scopes,
        state: &mut State,
    ) -> Result<Option<usize>, Fault> {
        let place = tokens[at].place;
        let Some(call) = call(self.unit, tokens, at) else {
            return Ok(None);
        };
        let compares = self.compares(&tokens[call.arguments[0].clone()], scopes);
        let gather = if compares { call.comparing } else { call.plain };
        let known = gather.and_then(|gather| {
            let index = self
                .gathers
                .iter()
                .position(|known| known.is_same(&gather))?;
            Some((index, gather.component))
        });
        let Some((index, component)) = known else {
            let message = format!("the arguments of `{}` are not known", tokens[at].text);
            return Err(Fault::new(message, place)
                .help("the component is a constant, 0 to 3, and so is the offset, an `ivec2`"));
        };
        let name = self.gather_name(index, component);
        self.names.add(&name, &tokens[at].text);
        self.output.put(&format!("{name} ("), Some(place));
        state.open_own_call();
        let given = if compares { 3 } else { 2 };
        for (index, range) in call.arguments.into_iter().take(given).enumerate() {
            if index > 0 {
                self.output.put(",", Some(place));
            }
            self.rewrite_range(tokens, range, scopes, state)?;
        }
        state.close();
        self.output.put(")", Some(place));
        Ok(Some(call.end))
    }

    /// True if the sampler that tokens name compares.
    fn compares(&self, tokens: &[Token], scopes: &Scopes) -> bool {
        let Some(root) = tokens.first() else {
            return false;
        };
        if let Some(pair) = scopes.sampler(&root.text) {
            return pair.ty.is_shadow;
        }
        let is_of_root = |path: &str| {
            let rest = path.strip_prefix(&*root.text);
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
        };
        let path: String = tokens.iter().map(|token| &*token.text).collect();
        let pair = self.pairs.get(&path);
        pair.or_else(|| {
            let mut of_root = self.pairs.iter().filter(|(path, _)| is_of_root(path));
            of_root.next().map(|(_, pair)| pair)
        })
        .is_some_and(|pair| pair.ty.is_shadow)
    }
}

/// Makes gathers of what the functions written here sample.
pub(super) fn mend(function: &mut Function, unit: &Unit) {
    let name = function.name.as_deref().unwrap_or_default();
    let name = name.strip_prefix(unit.prefix.as_str());
    let Some((index, component)) = name
        .and_then(|name| name.strip_prefix("gather"))
        .and_then(|name| name.split_once('_'))
    else {
        return;
    };
    let component = match component {
        "0" => SwizzleComponent::X,
        "1" => SwizzleComponent::Y,
        "2" => SwizzleComponent::Z,
        _ => SwizzleComponent::W,
    };
    if index.parse::<usize>().is_err() {
        return;
    }
    let mut gathered = None;
    for (handle, expression) in function.expressions.iter_mut() {
        match *expression {
            Expression::ImageSample {
                ref mut gather,
                ref mut level,
                ..
            } => {
                *gather = Some(component);
                *level = SampleLevel::Zero;
                gathered = Some(handle);
            }
            // A comparison gave one number, of which a vector was made.
            Expression::Splat { value, .. } if Some(value) == gathered => {
                use SwizzleComponent::{W, X, Y, Z};
                *expression = Expression::Swizzle {
                    size: VectorSize::Quad,
                    vector: value,
                    pattern: [X, Y, Z, W],
                };
            }
            _ => {}
        }
    }
}
