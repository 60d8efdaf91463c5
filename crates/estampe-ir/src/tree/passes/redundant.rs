//! Results and parameters that are one value on every way.

use super::{each_branch, replace_uses};
use crate::Value;
use crate::tree::{Label, Node, Tree};
use std::collections::HashMap;

/// Replaces a parameter of a loop that no branch changes by its value in the first iteration, and a
/// result of a block by the value that every branch gives, if that is seen outside of the block.
/// The results and parameters are then dead.
pub fn redundant_parameters(tree: &mut Tree) {
    let mut arguments: HashMap<Label, Vec<Vec<Value>>> = HashMap::new();
    each_branch(&tree.body, &mut |label, values| {
        arguments.entry(label).or_default().push(values.to_vec());
    });
    let mut finder = Finder {
        arguments,
        replaced: (0..).take(tree.len()).map(Value).collect(),
        is_seen: vec![false; tree.len()],
        has_changed: true,
    };
    // A replaced value may make another one redundant: most are found in the first round, and each
    // round replaces a value at least.
    while std::mem::take(&mut finder.has_changed) {
        finder.body(&tree.body);
    }
    let new = |value: Value| finder.resolved(value);
    replace_uses(&mut tree.body, &new);
    tree.outputs
        .iter_mut()
        .for_each(|value| *value = new(*value));
}

struct Finder {
    arguments: HashMap<Label, Vec<Vec<Value>>>,
    /// The value that stands for each one: itself at first.
    replaced: Vec<Value>,
    /// Values that are seen at the place that is visited.
    is_seen: Vec<bool>,
    has_changed: bool,
}

impl Finder {
    fn resolved(&self, mut value: Value) -> Value {
        while self.replaced[value.index()] != value {
            value = self.replaced[value.index()];
        }
        value
    }

    /// Visits a body, and forgets its values at its end.
    fn body(&mut self, nodes: &[Node]) {
        let mut defined = Vec::new();
        for node in nodes {
            match node {
                Node::Op { op, first } => defined.extend(first.and_next(op.results().len())),
                Node::If { accept, reject, .. } => {
                    self.body(accept);
                    self.body(reject);
                }
                Node::Block {
                    label,
                    results,
                    body,
                } => {
                    self.body(body);
                    self.replace(*label, results, None);
                    defined.extend(results);
                }
                Node::Loop {
                    label,
                    parameters,
                    initial,
                    body,
                } => {
                    self.replace(*label, parameters, Some(initial));
                    self.see(parameters, true);
                    self.body(body);
                    self.see(parameters, false);
                }
                Node::Branch { .. } => {}
            }
            self.see(&defined, true);
        }
        self.see(&defined, false);
    }

    fn see(&mut self, values: &[Value], is_seen: bool) {
        for value in values {
            self.is_seen[value.index()] = is_seen;
        }
    }

    fn replace(&mut self, label: Label, values: &[Value], initial: Option<&[Value]>) {
        for (at, &value) in values.iter().enumerate() {
            if self.resolved(value) != value {
                continue;
            }
            let of_branches = self.arguments.get(&label).into_iter().flatten();
            let given = of_branches.map(|arguments| arguments[at]);
            let given = given.chain(initial.map(|initial| initial[at]));
            let mut others = given
                .map(|one| self.resolved(one))
                .filter(|one| *one != value);
            let Some(first) = others.next() else {
                continue;
            };
            if others.all(|other| other == first) && self.is_seen[first.index()] {
                self.replaced[value.index()] = first;
                self.has_changed = true;
            }
        }
    }
}
