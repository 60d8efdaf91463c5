//! Constant indices of arrays in functions.

use std::collections::BTreeSet;

use super::Fault;
use super::nesting::close;
use super::preprocess::evaluate;
use super::token::{Place, Token};
use super::unit::Unit;

/// The most colours of a fragment shader.
const MOST_COLORS: i64 = 8;

/// The elements of `gl_FragData` that a shader writes.
pub(super) fn color_targets(unit: &Unit) -> BTreeSet<i64> {
    let mut targets = BTreeSet::new();
    for function in unit.functions() {
        for (at, token) in function.body.iter().enumerate() {
            if token.is("gl_FragData")
                && let Ok(target) = color_target(unit, &function.body, at)
            {
                targets.insert(target);
            }
        }
    }
    targets
}

pub(super) fn color_target(unit: &Unit, tokens: &[Token], at: usize) -> Result<i64, Fault> {
    let place = tokens[at].place;
    let inside = group(tokens, at + 1).map(|end| &tokens[at + 2..end]);
    let value = inside.and_then(|inside| constant(unit, inside).ok());
    value
        .filter(|value| (0..MOST_COLORS).contains(value))
        .ok_or_else(|| {
            Fault::new("`gl_FragData` needs a constant index", place)
                .help(format!("use 0 to {}", MOST_COLORS - 1))
        })
}

/// The largest index of an array in functions, if all indices are constant.
pub(super) fn largest_index(unit: &Unit, name: &str) -> Option<u32> {
    let mut largest = 0;
    for function in unit.functions() {
        for (at, token) in function.body.iter().enumerate() {
            if token.is(name) {
                let end = group(&function.body, at + 1)?;
                let index = constant(unit, &function.body[at + 2..end]).ok()?;
                largest = largest.max(u32::try_from(index).ok()?);
            }
        }
    }
    Some(largest)
}

pub(super) fn constant(unit: &Unit, tokens: &[Token]) -> Result<i64, Fault> {
    let whole = tokens.first().map_or(Place::default(), |first| first.place);
    evaluate(tokens, whole, &|name| unit.constants.get(name).copied())
}

/// The position of the `]` of the `[` at `at`.
pub(super) fn group(tokens: &[Token], at: usize) -> Option<usize> {
    close(tokens, at).filter(|_| tokens[at].is("["))
}
