//! What a tree tells about its shader: facts that authors need not declare.

use crate::order::Accesses;
use estampe_ir::interface::{Input, Output};
use estampe_ir::op::LevelOfDetail;
use estampe_ir::tree::{Node, Tree};
use estampe_ir::{Op, Value};

/// The facts of a shader.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Facts {
    /// It takes derivatives, or samples a texture with the level of detail of the quad.
    pub(super) takes_derivatives: bool,
    /// It stores to memory that others can see.
    pub(super) stores: bool,
    /// It stores only to texels at its own pixel, and adds to words that it does not read.
    pub(super) stores_in_any_order: bool,
    /// Its result [`Output::Cover`] may be less than [`Input::Cover`].
    pub(super) discards: bool,
    /// Its colour is the first four scalars of the varyings.
    pub(super) passes_color: bool,
}

impl Facts {
    pub(super) fn of(tree: &Tree) -> Self {
        let mut facts = Self {
            discards: discards(tree),
            passes_color: passes_color(tree),
            stores_in_any_order: Accesses::of(tree).is_free_of_pixels(),
            ..Self::default()
        };
        let mut open: Vec<&[Node]> = vec![&tree.body];
        while let Some(nodes) = open.pop() {
            for node in nodes {
                match node {
                    Node::Op { op, .. } => facts.add(op),
                    Node::Branch { .. } => {}
                    Node::If { accept, reject, .. } => open.extend([&accept[..], &reject[..]]),
                    Node::Block { body, .. } | Node::Loop { body, .. } => open.push(body),
                }
            }
        }
        facts
    }

    fn add(&mut self, op: &Op) {
        match op {
            Op::Derivative { .. } | Op::QuadLane { .. } => self.takes_derivatives = true,
            Op::Texture(op) => {
                let of_quad = matches!(op.level, LevelOfDetail::Implicit | LevelOfDetail::Bias(_));
                self.takes_derivatives |= of_quad && op.sampler.is_some();
            }
            _ => {}
        }
        self.stores |= op.has_effect() && !matches!(op, Op::StoreLocal { .. });
    }
}

/// The operation that gives a value, if it stands in the outermost body.
fn operation(tree: &Tree, value: Value) -> Option<&Op> {
    tree.body.iter().find_map(|node| match node {
        Node::Op { op, first } if *first == value => Some(op),
        _ => None,
    })
}

fn value_of(tree: &Tree, output: Output) -> Option<Value> {
    let outputs = tree.interface.outputs.iter().zip(&tree.outputs);
    let mut found = outputs.filter(|(one, _)| **one == output);
    found.next().map(|(_, value)| *value)
}

fn discards(tree: &Tree) -> bool {
    let Some(cover) = value_of(tree, Output::Cover) else {
        return false;
    };
    let input = match operation(tree, cover) {
        Some(Op::InputMask(at)) => tree.interface.inputs.get(*at as usize),
        _ => None,
    };
    input != Some(&Input::Cover)
}

fn passes_color(tree: &Tree) -> bool {
    let is_passed = |component: u32| {
        let output = Output::Color {
            target: 0,
            component,
        };
        let op = value_of(tree, output).and_then(|value| operation(tree, value));
        let input = match op {
            Some(Op::Input(at)) => tree.interface.inputs.get(*at as usize),
            _ => None,
        };
        input == Some(&Input::Varying(component))
    };
    let is_color = |output: &Output| matches!(output, Output::Color { .. } | Output::Cover);
    (0..4).all(is_passed)
        && tree.interface.outputs.iter().all(is_color)
        && value_of(
            tree,
            Output::Color {
                target: 1,
                component: 0,
            },
        )
        .is_none()
        && !discards(tree)
}
