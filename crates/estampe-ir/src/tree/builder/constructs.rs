//! Blocks, loops and `if`s: constructs that are begun and ended, and branches to them.

use super::Builder;
use crate::tree::passes::each_branch;
use crate::tree::{Label, Node};
use crate::{Op, Type, Value};

/// A construct that is open.
#[derive(Debug)]
pub(super) struct Open {
    construct: Construct,
    pub(super) nodes: Vec<Node>,
    /// The operations that were first done in this body.
    pub(super) done: Vec<Op>,
    /// True after a branch: nothing more is executed here.
    pub(super) has_ended: bool,
}

#[derive(Debug)]
pub(super) enum Construct {
    Body,
    Accept(Value),
    /// The condition, the first part, and whether its end cannot be reached.
    Reject(Value, Vec<Node>, bool),
    Block(Label, Vec<Value>),
    Loop(Label, Vec<Value>, Vec<Value>),
}

/// A loop that was begun.
#[derive(Debug, Clone)]
pub struct OpenLoop {
    /// Its label.
    pub label: Label,
    /// Its parameters.
    pub parameters: Vec<Value>,
}

impl Builder {
    /// Begins a block whose results have these types.
    pub fn block_of(&mut self, types: &[Type]) -> Label {
        let label = self.label();
        let first = self.define(types);
        let results = first.and_next(types.len());
        self.open(Construct::Block(label, results));
        label
    }

    /// Begins a block with so many words as results.
    pub fn block(&mut self, results: usize) -> Label {
        self.block_of(&vec![Type::Word; results])
    }

    /// Ends the block that was begun last, and returns its results.
    ///
    /// # Panics
    /// If the construct that was begun last is no block, or if it has results and its end can be
    /// reached.
    pub fn end_block(&mut self) -> Vec<Value> {
        let mut open = self.close();
        let Construct::Block(label, results) = open.construct else {
            panic!("the construct that is open is no block");
        };
        assert!(
            open.has_ended || results.is_empty(),
            "the end of a block with results is reached without a branch"
        );
        let branches = self.branches.get(&label).copied().unwrap_or(0);
        // A block that is left at its end alone is its body.
        if branches == 1
            && let Some(Node::Branch {
                label: to,
                arguments,
            }) = open.nodes.last()
            && *to == label
        {
            let results = arguments.clone();
            open.nodes.pop();
            self.last_mut().nodes.append(&mut open.nodes);
            return results;
        }
        if branches == 0 {
            let last = self.last_mut();
            last.nodes.append(&mut open.nodes);
            last.has_ended |= open.has_ended;
            return results;
        }
        self.push(Node::Block {
            label,
            results: results.clone(),
            body: open.nodes,
        });
        results
    }

    /// Begins a loop with these values of its parameters in the first iteration.
    pub fn start_loop(&mut self, initial: &[Value]) -> OpenLoop {
        let label = self.label();
        let types: Vec<_> = initial.iter().map(|value| self.kind(*value)).collect();
        let first = self.define(&types);
        let parameters = first.and_next(types.len());
        self.open(Construct::Loop(label, parameters.clone(), initial.to_vec()));
        OpenLoop { label, parameters }
    }

    /// Ends the loop that was begun last.
    ///
    /// # Panics
    /// If the construct that was begun last is no loop.
    pub fn end_loop(&mut self) {
        let open = self.close();
        let Construct::Loop(label, parameters, initial) = open.construct else {
            panic!("the construct that is open is no loop");
        };
        self.push(Node::Loop {
            label,
            parameters,
            initial,
            body: open.nodes,
        });
        self.last_mut().has_ended |= open.has_ended;
    }

    /// Begins what is executed where a mask is set.
    pub fn start_if(&mut self, condition: Value) {
        self.open(Construct::Accept(condition));
    }

    /// Ends the first part of an `if`, and begins what is executed where the mask is not set.
    ///
    /// # Panics
    /// If the construct that was begun last is no `if`.
    pub fn start_else(&mut self) {
        let open = self.close();
        let Construct::Accept(condition) = open.construct else {
            panic!("the construct that is open is no `if` without `else`");
        };
        self.open(Construct::Reject(condition, open.nodes, open.has_ended));
    }

    /// Ends the `if` that was begun last.
    ///
    /// # Panics
    /// If the construct that was begun last is no `if`.
    pub fn end_if(&mut self) {
        let open = self.close();
        let is_over = open.has_ended;
        let (condition, [accept, reject], [accept_ends, reject_ends]) = match open.construct {
            Construct::Accept(condition) => (condition, [open.nodes, Vec::new()], [is_over, false]),
            Construct::Reject(condition, accept, accept_ends) => {
                (condition, [accept, open.nodes], [accept_ends, is_over])
            }
            _ => panic!("the construct that is open is no `if`"),
        };
        match self.mask_of(condition) {
            Some(chosen) => {
                let (nodes, is_over, dropped) = if chosen {
                    (accept, accept_ends, reject)
                } else {
                    (reject, reject_ends, accept)
                };
                each_branch(&dropped, &mut |label, _| {
                    if let Some(count) = self.branches.get_mut(&label) {
                        *count -= 1;
                    }
                });
                if !self.has_ended() {
                    self.last_mut().nodes.extend(nodes);
                    self.last_mut().has_ended |= is_over;
                }
            }
            None if accept.is_empty() && reject.is_empty() => {}
            None => {
                self.push(Node::If {
                    condition,
                    accept,
                    reject,
                });
                self.last_mut().has_ended |= accept_ends && reject_ends;
            }
        }
    }

    /// Goes to a label of a construct that is open.
    pub fn branch(&mut self, label: Label, arguments: &[Value]) {
        if !self.has_ended() {
            *self.branches.entry(label).or_default() += 1;
        }
        self.push(Node::Branch {
            label,
            arguments: arguments.to_vec(),
        });
        self.last_mut().has_ended = true;
    }

    fn label(&mut self) -> Label {
        self.labels += 1;
        Label(self.labels - 1)
    }

    fn open(&mut self, construct: Construct) {
        let has_ended = self.has_ended();
        self.open.push(Open {
            has_ended,
            ..Open::new(construct)
        });
    }

    fn close(&mut self) -> Open {
        let open = self.open.pop().expect("a construct is open");
        for op in &open.done {
            self.seen.remove(op);
        }
        open
    }
}

impl Open {
    pub(super) fn new(construct: Construct) -> Self {
        Self {
            construct,
            nodes: Vec::new(),
            done: Vec::new(),
            has_ended: false,
        }
    }
}
