//! Removes what nothing uses.

use super::each_branch;
use crate::tree::{Label, Node, Tree};
use crate::{Op, Value};
use std::collections::HashMap;

/// Removes operations without effect whose results are not used, and results of blocks and
/// parameters of loops that are not used, with the arguments that give them.
pub fn dead_code(tree: &mut Tree) {
    let is_live = live(tree);
    let mut sweeper = Sweeper {
        is_live,
        kept: HashMap::new(),
    };
    sweeper.note(&tree.body);
    let body = std::mem::take(&mut tree.body);
    tree.body = sweeper.body(body);
}

/// For each value, true if an output or an effect depends on it.
fn live(tree: &Tree) -> Vec<bool> {
    let mut uses = Uses {
        of_value: HashMap::new(),
        open: tree.outputs.clone(),
    };
    let mut arguments: HashMap<Label, Vec<&[Value]>> = HashMap::new();
    each_branch(&tree.body, &mut |label, values| {
        arguments.entry(label).or_default().push(values);
    });
    uses.body(&tree.body, &arguments);
    let mut is_live = vec![false; tree.len()];
    while let Some(value) = uses.open.pop() {
        if !std::mem::replace(&mut is_live[value.index()], true)
            && let Some(sources) = uses.of_value.get(&value)
        {
            uses.open.extend(sources);
        }
    }
    is_live
}

/// The values on which values depend.
struct Uses {
    of_value: HashMap<Value, Vec<Value>>,
    /// Values that are used by effects, and by conditions on which those or branches depend.
    open: Vec<Value>,
}

impl Uses {
    /// Returns true if the body has an effect or a branch.
    fn body(&mut self, nodes: &[Node], arguments: &HashMap<Label, Vec<&[Value]>>) -> bool {
        let mut acts = false;
        for node in nodes {
            match node {
                Node::Op { op, first } => acts |= self.op(op, *first),
                Node::If {
                    condition,
                    accept,
                    reject,
                } => {
                    let accept = self.body(accept, arguments);
                    if self.body(reject, arguments) || accept {
                        self.open.push(*condition);
                        acts = true;
                    }
                }
                Node::Block {
                    label,
                    results,
                    body,
                } => {
                    self.given(results, arguments.get(label), None);
                    acts |= self.body(body, arguments);
                }
                Node::Loop {
                    label,
                    parameters,
                    initial,
                    body,
                } => {
                    self.given(parameters, arguments.get(label), Some(initial));
                    // A loop may be endless, which is an effect.
                    self.body(body, arguments);
                    acts = true;
                }
                Node::Branch { .. } => acts = true,
            }
        }
        acts
    }

    fn op(&mut self, op: &Op, first: Value) -> bool {
        let mut operands = Vec::new();
        op.each_operand(|value, _| operands.push(value));
        for result in first.and_next(op.results().len()) {
            self.of_value.insert(result, operands.clone());
        }
        let has_effect = op.has_effect();
        if has_effect {
            self.open.extend(operands);
        }
        has_effect
    }

    fn given(
        &mut self,
        values: &[Value],
        branches: Option<&Vec<&[Value]>>,
        initial: Option<&[Value]>,
    ) {
        for (at, value) in values.iter().enumerate() {
            let of_branches = branches
                .into_iter()
                .flatten()
                .map(|arguments| arguments[at]);
            let sources = of_branches.chain(initial.map(|initial| initial[at]));
            self.of_value.insert(*value, sources.collect());
        }
    }
}

struct Sweeper {
    is_live: Vec<bool>,
    /// For each label, the positions of the results or parameters that stay.
    kept: HashMap<Label, Vec<usize>>,
}

impl Sweeper {
    /// Notes what stays of each label: branches stand before the end of their block.
    fn note(&mut self, nodes: &[Node]) {
        for node in nodes {
            match node {
                Node::Op { .. } | Node::Branch { .. } => {}
                Node::If { accept, reject, .. } => {
                    self.note(accept);
                    self.note(reject);
                }
                Node::Block {
                    label,
                    results: values,
                    body,
                }
                | Node::Loop {
                    label,
                    parameters: values,
                    body,
                    ..
                } => {
                    let is_live = |at: &usize| self.is_live[values[*at].index()];
                    let kept = (0..values.len()).filter(is_live).collect();
                    self.kept.insert(*label, kept);
                    self.note(body);
                }
            }
        }
    }

    fn body(&self, nodes: Vec<Node>) -> Vec<Node> {
        let swept = nodes.into_iter().filter_map(|node| self.node(node));
        swept.collect()
    }

    fn node(&self, node: Node) -> Option<Node> {
        Some(match node {
            Node::Op { op, first } => {
                let results = first.and_next(op.results().len());
                let is_used = results.iter().any(|value| self.is_live[value.index()]);
                if !is_used && !op.has_effect() {
                    return None;
                }
                Node::Op { op, first }
            }
            Node::If {
                condition,
                accept,
                reject,
            } => {
                let (accept, reject) = (self.body(accept), self.body(reject));
                if accept.is_empty() && reject.is_empty() {
                    return None;
                }
                Node::If {
                    condition,
                    accept,
                    reject,
                }
            }
            Node::Block {
                label,
                results,
                body,
            } => {
                let body = self.body(body);
                if body.is_empty() {
                    return None;
                }
                Node::Block {
                    label,
                    results: self.kept_of(label, &results),
                    body,
                }
            }
            Node::Loop {
                label,
                parameters,
                initial,
                body,
            } => Node::Loop {
                label,
                parameters: self.kept_of(label, &parameters),
                initial: self.kept_of(label, &initial),
                body: self.body(body),
            },
            Node::Branch { label, arguments } => Node::Branch {
                label,
                arguments: self.kept_of(label, &arguments),
            },
        })
    }

    fn kept_of(&self, label: Label, values: &[Value]) -> Vec<Value> {
        match self.kept.get(&label) {
            Some(kept) => kept.iter().map(|&at| values[at]).collect(),
            None => values.to_vec(),
        }
    }
}
