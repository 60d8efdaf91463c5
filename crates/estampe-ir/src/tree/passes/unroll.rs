//! Loops of a few iterations, the number of which is known, become straight code.
//!
//! Shaders filter shadows and blur pictures in such loops. Unrolled, the counters are constants,
//! and the accesses to textures of all iterations stand beside each other, so that back ends can do
//! them together.
//!
//! A loop qualifies if the branch to its label is one, the last node of its body, and if its
//! counters are known: each iteration is tried with what is known of the parameters, until one is
//! known to leave the loop.

use super::each_branch;
use super::fold::{Known, fold};
use crate::tree::{Builder, Label, Node, Tree};
use crate::{Op, Type, Value};
use std::collections::{HashMap, HashSet};

/// The most iterations of a loop that is unrolled.
const MOST_ITERATIONS: usize = 64;

/// The most operations of the iterations of a loop that is unrolled.
const MOST_OPS: usize = 512;

/// The most operations by which a tree grows.
const MOST_GROWTH: usize = 2048;

/// Unrolls loops.
pub fn unroll_loops(tree: &mut Tree) {
    let mut branches: HashMap<Label, usize> = HashMap::new();
    each_branch(&tree.body, &mut |label, _| {
        *branches.entry(label).or_default() += 1;
    });
    let counter = Counter {
        branches,
        is_written: tree
            .interface
            .buffers
            .iter()
            .map(|one| one.is_written)
            .collect(),
    };
    let mut known = vec![Known::Nothing; tree.len()];
    constants(&tree.body, &mut known);
    if !counter.has_short_loop(&tree.body, &known) {
        return;
    }
    let mut builder = Builder::new(tree.stage);
    *builder.interface_mut() = tree.interface.clone();
    let mut writer = Writer {
        tree,
        counter,
        builder,
        values: vec![None; tree.len()],
        labels: HashMap::new(),
        left: MOST_GROWTH,
    };
    writer.body(&tree.body);
    let outputs = tree.outputs.iter().map(|&value| writer.value(value));
    let outputs = tree
        .interface
        .outputs
        .iter()
        .copied()
        .zip(outputs)
        .collect();
    *tree = writer.builder.finish(outputs);
}

/// What is known of values that are constants.
fn constants(nodes: &[Node], known: &mut [Known]) {
    for node in nodes {
        match node {
            Node::Op { op, first } => match op {
                Op::Constant(word) => known[first.index()] = Known::Word(*word),
                Op::MaskConstant(mask) => known[first.index()] = Known::Mask(*mask),
                _ => {}
            },
            Node::If { accept, reject, .. } => {
                constants(accept, known);
                constants(reject, known);
            }
            Node::Block { body, .. } | Node::Loop { body, .. } => constants(body, known),
            Node::Branch { .. } => {}
        }
    }
}

/// Counts iterations.
struct Counter {
    /// The number of branches to each label.
    branches: HashMap<Label, usize>,
    is_written: Vec<bool>,
}

/// Where a body ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum End {
    /// At its end, as far as is known.
    Reached,
    /// At a branch to a label.
    Left(Label),
}

impl Counter {
    /// True if there is a loop that can be unrolled, with what is known of all values.
    fn has_short_loop(&self, nodes: &[Node], known: &[Known]) -> bool {
        nodes.iter().any(|node| match node {
            Node::Op { .. } | Node::Branch { .. } => false,
            Node::If { accept, reject, .. } => {
                self.has_short_loop(accept, known) || self.has_short_loop(reject, known)
            }
            Node::Block { body, .. } => self.has_short_loop(body, known),
            Node::Loop { initial, body, .. } => {
                let initial: Vec<Known> = initial.iter().map(|at| known[at.index()]).collect();
                self.iterations(node, &initial, known.to_vec()).is_some()
                    || self.has_short_loop(body, known)
            }
        })
    }

    /// The number of iterations of a loop; `None` if it is not known, or if they are too many. What
    /// is known of the parameters at first is given.
    fn iterations(&self, of: &Node, initial: &[Known], mut known: Vec<Known>) -> Option<usize> {
        let Node::Loop {
            label,
            parameters,
            body,
            ..
        } = of
        else {
            return None;
        };
        let (
            Node::Branch {
                label: to,
                arguments,
            },
            body,
        ) = body.split_last()?
        else {
            return None;
        };
        if to != label || self.branches.get(label) != Some(&1) {
            return None;
        }
        let most = (MOST_OPS / self.ops(body, &known).max(1)).min(MOST_ITERATIONS);
        let mut next = initial.to_vec();
        for done in 1..=most {
            if !next.iter().any(|one| matches!(one, Known::Word(_))) {
                return None;
            }
            for (parameter, given) in parameters.iter().zip(&next) {
                known[parameter.index()] = *given;
            }
            if self.run(body, &mut known, &mut HashSet::new()) != End::Reached {
                return Some(done);
            }
            next = arguments.iter().map(|at| known[at.index()]).collect();
        }
        None
    }

    /// Executes what is known of a body. Adds the labels that may be branched to.
    fn run(&self, nodes: &[Node], known: &mut [Known], perhaps: &mut HashSet<Label>) -> End {
        for node in nodes {
            match node {
                Node::Op { op, first } => {
                    let is_written = |at: u32| self.is_written.get(at as usize) != Some(&false);
                    let result = if op.is_pure(is_written) {
                        fold(op.clone(), known)
                    } else {
                        Err(op.clone())
                    };
                    let found = match result {
                        Ok(value) => known[value.index()],
                        Err(Op::Constant(word)) => Known::Word(word),
                        Err(Op::MaskConstant(mask)) => Known::Mask(mask),
                        Err(_) => Known::Nothing,
                    };
                    for value in first.and_next(op.results().len()) {
                        known[value.index()] = found;
                    }
                }
                Node::If {
                    condition,
                    accept,
                    reject,
                } => {
                    let taken = match known[condition.index()] {
                        Known::Mask(true) => accept,
                        Known::Mask(false) => reject,
                        _ => {
                            each_branch(accept, &mut |label, _| _ = perhaps.insert(label));
                            each_branch(reject, &mut |label, _| _ = perhaps.insert(label));
                            continue;
                        }
                    };
                    let end = self.run(taken, known, perhaps);
                    if end != End::Reached {
                        return end;
                    }
                }
                Node::Block { label, body, .. } => {
                    let end = self.run(body, known, perhaps);
                    let goes_on = [End::Reached, End::Left(*label)].contains(&end);
                    if !goes_on && !perhaps.contains(label) {
                        return end;
                    }
                }
                Node::Loop { body, .. } => {
                    each_branch(body, &mut |label, _| _ = perhaps.insert(label));
                }
                Node::Branch { label, .. } => return End::Left(*label),
            }
        }
        End::Reached
    }

    /// The number of operations, when the loops inside are unrolled.
    fn ops(&self, nodes: &[Node], known: &[Known]) -> usize {
        let of_node = |node: &Node| match node {
            Node::Op { .. } => 1,
            Node::Branch { .. } => 0,
            Node::If { accept, reject, .. } => self.ops(accept, known) + self.ops(reject, known),
            Node::Block { body, .. } => self.ops(body, known),
            Node::Loop { initial, body, .. } => {
                let initial: Vec<Known> = initial.iter().map(|at| known[at.index()]).collect();
                let iterations = self.iterations(node, &initial, known.to_vec());
                iterations.unwrap_or(1) * self.ops(body, known)
            }
        };
        nodes.iter().map(of_node).sum()
    }
}

/// Writes a tree anew.
struct Writer<'a> {
    tree: &'a Tree,
    counter: Counter,
    builder: Builder,
    /// The new value of each value that was defined.
    values: Vec<Option<Value>>,
    labels: HashMap<Label, Label>,
    /// The operations by which the tree may still grow.
    left: usize,
}

impl Writer<'_> {
    fn value(&mut self, value: Value) -> Value {
        // A value that is not seen from here: what uses it is never executed.
        self.values[value.index()].unwrap_or_else(|| match self.tree.types[value.index()] {
            Type::Word => self.builder.word(0),
            Type::Mask => self.builder.mask(false),
        })
    }

    fn all(&mut self, values: &[Value]) -> Vec<Value> {
        values.iter().map(|&value| self.value(value)).collect()
    }

    fn set(&mut self, values: &[Value], new: &[Value]) {
        for (value, new) in values.iter().zip(new) {
            self.values[value.index()] = Some(*new);
        }
    }

    /// Writes a body, as far as it can be reached.
    fn body(&mut self, nodes: &[Node]) {
        for node in nodes {
            if self.builder.has_ended() {
                return;
            }
            self.node(node);
        }
    }

    fn node(&mut self, node: &Node) {
        match node {
            Node::Op { op, first } => {
                let mut op = op.clone();
                op.each_operand_mut(|value, _| *value = self.value(*value));
                let results = self.builder.op(op);
                self.set(&first.and_next(results.len()), &results);
            }
            Node::If {
                condition,
                accept,
                reject,
            } => {
                let condition = self.value(*condition);
                self.builder.start_if(condition);
                self.body(accept);
                self.builder.start_else();
                self.body(reject);
                self.builder.end_if();
            }
            Node::Block {
                label,
                results,
                body,
            } => {
                let types: Vec<_> = results
                    .iter()
                    .map(|at| self.tree.types[at.index()])
                    .collect();
                let new = self.builder.block_of(&types);
                self.labels.insert(*label, new);
                self.body(body);
                let new = self.builder.end_block();
                self.set(results, &new);
            }
            Node::Loop {
                label,
                parameters,
                initial,
                body,
            } => {
                let mut arguments = self.all(initial);
                if let Some((
                    Node::Branch {
                        arguments: next, ..
                    },
                    body,
                )) = body.split_last()
                {
                    for _ in 0..self.iterations(node, &arguments) {
                        self.set(parameters, &arguments);
                        self.body(body);
                        if self.builder.has_ended() {
                            return;
                        }
                        arguments = self.all(next);
                    }
                }
                let new = self.builder.start_loop(&arguments);
                self.labels.insert(*label, new.label);
                self.set(parameters, &new.parameters);
                self.body(body);
                self.builder.end_loop();
            }
            Node::Branch { label, arguments } => {
                let arguments = self.all(arguments);
                if let Some(&label) = self.labels.get(label) {
                    self.builder.branch(label, &arguments);
                }
            }
        }
    }

    /// The iterations of a loop that are written one after the other: all, or none.
    fn iterations(&mut self, of: &Node, initial: &[Value]) -> usize {
        let Node::Loop { body, .. } = of else {
            return 0;
        };
        // The opposite of a mask names a value of the new tree, which has its own numbers: it says
        // nothing of the values of the tree that is read.
        let constant = |value: Value| match self.builder.known(value) {
            Known::Not(_) => Known::Nothing,
            known => known,
        };
        let known = |value: &Option<Value>| value.map_or(Known::Nothing, constant);
        let known: Vec<Known> = self.values.iter().map(known).collect();
        let initial: Vec<Known> = initial.iter().map(|&at| constant(at)).collect();
        let ops = self.counter.ops(body, &known);
        let Some(iterations) = self.counter.iterations(of, &initial, known) else {
            return 0;
        };
        match self.left.checked_sub((iterations - 1) * ops) {
            Some(left) => {
                self.left = left;
                iterations
            }
            None => 0,
        }
    }
}
