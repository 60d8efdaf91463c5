//! Operations that give the same value in each iteration of a loop.

use crate::tree::{Node, Tree};
use crate::{Op, Value};

/// Moves pure operations whose operands are known before a loop to before it. Operations under a
/// condition stay: they may be rare.
pub fn loop_invariants(tree: &mut Tree) {
    let written = tree
        .interface
        .buffers
        .iter()
        .map(|buffer| buffer.is_written);
    let mut mover = Mover {
        is_written: written.collect(),
        // Values of the bodies around the loop, in the order of their definition.
        depth_of: vec![usize::MAX; tree.len()],
    };
    let mut body = std::mem::take(&mut tree.body);
    mover.body(&mut body, 0);
    tree.body = body;
}

struct Mover {
    is_written: Vec<bool>,
    /// The number of loops around the definition of a value.
    depth_of: Vec<usize>,
}

impl Mover {
    fn body(&mut self, nodes: &mut Vec<Node>, depth: usize) {
        let mut done = Vec::with_capacity(nodes.len());
        for mut node in nodes.drain(..) {
            match &mut node {
                Node::Op { op, first } => self.define(op, *first, depth),
                Node::If { accept, reject, .. } => {
                    self.body(accept, depth);
                    self.body(reject, depth);
                }
                Node::Block { results, body, .. } => {
                    self.body(body, depth);
                    self.note(results, depth);
                }
                Node::Loop {
                    parameters, body, ..
                } => {
                    self.note(parameters, depth + 1);
                    self.body(body, depth + 1);
                    self.take(body, depth, &mut done);
                }
                Node::Branch { .. } => {}
            }
            done.push(node);
        }
        *nodes = done;
    }

    fn note(&mut self, values: &[Value], depth: usize) {
        for value in values {
            self.depth_of[value.index()] = depth;
        }
    }

    fn define(&mut self, op: &Op, first: Value, depth: usize) {
        self.note(&first.and_next(op.results().len()), depth);
    }

    /// Takes the invariant operations of a loop's body, which is deeper than `depth`.
    fn take(&mut self, nodes: &mut Vec<Node>, depth: usize, done: &mut Vec<Node>) {
        let mut left = Vec::with_capacity(nodes.len());
        for mut node in nodes.drain(..) {
            match &mut node {
                Node::Op { op, first } if self.is_invariant(op, depth) => {
                    self.define(op, *first, depth);
                    done.push(node);
                    continue;
                }
                // What is moved out of a block is seen in it all the same.
                Node::Block { body, .. } => self.take(body, depth, done),
                _ => {}
            }
            left.push(node);
        }
        *nodes = left;
    }

    fn is_invariant(&self, op: &Op, depth: usize) -> bool {
        let mut is_known = true;
        op.each_operand(|value, _| is_known &= self.depth_of[value.index()] <= depth);
        let is_written = |buffer: u32| self.is_written.get(buffer as usize).is_none_or(|is| *is);
        is_known && op.is_pure(is_written)
    }
}
