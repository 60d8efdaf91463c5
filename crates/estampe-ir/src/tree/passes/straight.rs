//! Removes blocks that are left only at their end.

use super::{each_branch, replace_uses};
use crate::Value;
use crate::tree::{Label, Node, Tree};
use std::collections::HashMap;

/// Replaces each block that is left by one branch only, its last node, by its body. Front ends make
/// such blocks of functions that return at their end.
pub fn straight_blocks(tree: &mut Tree) {
    let mut branches: HashMap<Label, usize> = HashMap::new();
    each_branch(&tree.body, &mut |label, _| {
        *branches.entry(label).or_default() += 1;
    });
    let mut straightener = Straightener {
        branches,
        given: HashMap::new(),
    };
    let body = std::mem::take(&mut tree.body);
    tree.body = straightener.body(body);
    if straightener.given.is_empty() {
        return;
    }
    let new = |value: Value| straightener.source(value);
    replace_uses(&mut tree.body, &new);
    tree.outputs
        .iter_mut()
        .for_each(|value| *value = new(*value));
}

struct Straightener {
    /// The number of branches to each label.
    branches: HashMap<Label, usize>,
    /// The value that a result of a block always is.
    given: HashMap<Value, Value>,
}

impl Straightener {
    fn body(&mut self, nodes: Vec<Node>) -> Vec<Node> {
        let mut straight = Vec::with_capacity(nodes.len());
        for node in nodes {
            match node {
                Node::Block {
                    label,
                    results,
                    body,
                } => {
                    let mut body = self.body(body);
                    if let Some(arguments) = self.only_branch(label, &body) {
                        body.pop();
                        self.given.extend(results.into_iter().zip(arguments));
                        straight.append(&mut body);
                    } else {
                        straight.push(Node::Block {
                            label,
                            results,
                            body,
                        });
                    }
                }
                Node::If {
                    condition,
                    accept,
                    reject,
                } => straight.push(Node::If {
                    condition,
                    accept: self.body(accept),
                    reject: self.body(reject),
                }),
                Node::Loop {
                    label,
                    parameters,
                    initial,
                    body,
                } => straight.push(Node::Loop {
                    label,
                    parameters,
                    initial,
                    body: self.body(body),
                }),
                Node::Op { .. } | Node::Branch { .. } => straight.push(node),
            }
        }
        straight
    }

    /// The arguments of the branch that ends a block's body, if no other one leads to its label.
    fn only_branch(&self, label: Label, body: &[Node]) -> Option<Vec<Value>> {
        match body.last() {
            Some(Node::Branch {
                label: to,
                arguments,
            }) if *to == label && self.branches.get(&label) == Some(&1) => Some(arguments.clone()),
            _ => None,
        }
    }

    /// What a value is in the end: arguments may be results of other blocks.
    fn source(&self, mut value: Value) -> Value {
        while let Some(given) = self.given.get(&value) {
            value = *given;
        }
        value
    }
}
