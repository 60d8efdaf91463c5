//! What is known of constructs before they are lowered: where their branches go, and their cost.

use crate::Op;
use crate::op::{Binary, Unary};
use crate::tree::{Label, Node, Tree};
use std::collections::{HashMap, HashSet};

/// The labels that are branched to in each construct, without those of constructs inside of it.
pub(super) struct Leaving {
    of_node: HashMap<*const Node, HashSet<Label>>,
    empty: HashSet<Label>,
}

impl Leaving {
    pub(super) fn new(tree: &Tree) -> Self {
        let mut leaving = Self {
            of_node: HashMap::new(),
            empty: HashSet::new(),
        };
        leaving.body(&tree.body);
        leaving
    }

    /// The labels outside of a construct to which a branch inside goes.
    pub(super) fn of(&self, node: &Node) -> &HashSet<Label> {
        let of_node = self.of_node.get(&std::ptr::from_ref(node));
        of_node.unwrap_or(&self.empty)
    }

    fn body(&mut self, nodes: &[Node]) -> HashSet<Label> {
        let mut targets = HashSet::new();
        for node in nodes {
            let of_node = match node {
                Node::Op { .. } => continue,
                Node::Branch { label, .. } => {
                    targets.insert(*label);
                    continue;
                }
                Node::If { accept, reject, .. } => {
                    let mut of_sides = self.body(accept);
                    of_sides.extend(self.body(reject));
                    of_sides
                }
                Node::Block { label, body, .. } | Node::Loop { label, body, .. } => {
                    let mut of_body = self.body(body);
                    of_body.remove(label);
                    of_body
                }
            };
            targets.extend(&of_node);
            self.of_node.insert(node, of_node);
        }
        targets
    }
}

/// The cost, in simple operations, from which a side of an `if` is worth a branch.
pub(super) const WORTH_A_BRANCH: usize = 12;

/// The cost of a body in simple operations.
pub(super) fn cost(nodes: &[Node]) -> usize {
    let of_node = |node: &Node| match node {
        Node::Op { op, .. } => cost_of(op),
        Node::Branch { arguments, .. } => arguments.len(),
        Node::If { accept, reject, .. } => 1 + cost(accept) + cost(reject),
        Node::Block { body, .. } => cost(body),
        Node::Loop { .. } => WORTH_A_BRANCH,
    };
    nodes.iter().map(of_node).sum()
}

fn cost_of(op: &Op) -> usize {
    match op {
        Op::Constant(_) | Op::MaskConstant(_) | Op::Input(_) | Op::InputMask(_) => 0,
        Op::Math(..) | Op::Math2(..) | Op::Texture(_) => WORTH_A_BRANCH,
        Op::Unary(Unary::FSqrt, _)
        | Op::Binary(Binary::FDiv | Binary::SDiv | Binary::SRem | Binary::UDiv | Binary::URem, _) => {
            6
        }
        Op::LoadLocal { .. }
        | Op::LoadBuffer { .. }
        | Op::LoadWorkgroup(_)
        | Op::StoreLocal { .. }
        | Op::StoreBuffer { .. }
        | Op::StoreWorkgroup { .. }
        | Op::Atomic { .. }
        | Op::CompareExchange { .. } => 4,
        _ => 1,
    }
}
