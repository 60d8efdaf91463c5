//! The order in which functions are written: those that are called come first, as naga wants it,
//! wherever the author defines them. Prototypes of functions that are defined are left out.

use std::collections::{HashMap, HashSet};

use super::unit::{Function, Unit};

/// The functions of a shader in the order of calls. Functions of one name stay together.
pub(super) fn functions(unit: &Unit) -> Vec<&Function> {
    let mut groups: HashMap<&str, Vec<&Function>> = HashMap::new();
    for function in unit.functions() {
        groups.entry(&function.name).or_default().push(function);
    }
    for group in groups.values_mut() {
        if group.iter().any(|function| !function.body.is_empty()) {
            group.retain(|function| !function.body.is_empty());
        }
    }
    let mut ordered = Vec::new();
    let mut seen = HashSet::new();
    // A name, and how far its calls are followed: no recursion, as chains of calls may be long.
    let mut stack: Vec<(&str, Vec<&str>)> = Vec::new();
    let calls = |name: &str| -> Vec<&str> {
        let group = groups.get(name).into_iter().flatten();
        let pairs = group.flat_map(|function| function.body.windows(2));
        pairs
            .filter(|pair| pair[0].is_word() && pair[1].is("("))
            .filter_map(|pair| groups.get_key_value(&*pair[0].text).map(|(name, _)| *name))
            .rev()
            .collect()
    };
    for function in unit.functions() {
        if seen.insert(&*function.name) {
            stack.push((&function.name, calls(&function.name)));
        }
        while let Some((name, rest)) = stack.last_mut() {
            let name = *name;
            match rest.pop() {
                Some(called) if seen.insert(called) => stack.push((called, calls(called))),
                Some(_) => {}
                None => {
                    ordered.extend(groups.get(name).into_iter().flatten().copied());
                    stack.pop();
                }
            }
        }
    }
    ordered
}
