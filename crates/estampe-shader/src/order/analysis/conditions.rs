//! The conditions on the way to an access: masks, and the forms that they refine.

use super::Analysis;
use crate::order::form::{Coefficient, Form};
use estampe_ir::op::Compare;
use estampe_ir::tree::{Label, Node};
use estampe_ir::{Op, Value};

/// What a mask is made of.
#[derive(Debug, Clone, Copy)]
pub(super) enum Mask {
    Constant(bool),
    Below(Value, Value),
    AtMost(Value, Value),
    Not(Value),
    And(Value, Value),
    Or(Value, Value),
    /// The second where the first is set, else the third.
    Choice(Value, Value, Value),
}

impl Analysis<'_> {
    pub(super) fn forget(&mut self, refined: Vec<(Value, Form)>) {
        // The first change of a value is undone last.
        for (value, before) in refined.into_iter().rev() {
            self.forms.insert(value, before);
        }
    }

    /// Refines forms by a mask that is set, or is not.
    pub(super) fn assume(&mut self, mask: Value, truth: bool, refined: &mut Vec<(Value, Form)>) {
        match (self.masks.get(&mask).copied(), truth) {
            (Some(Mask::Not(other)), _) => self.assume(other, !truth, refined),
            (Some(Mask::And(a, b)), true) | (Some(Mask::Or(a, b)), false) => {
                self.assume(a, truth, refined);
                self.assume(b, truth, refined);
            }
            (Some(Mask::Choice(condition, yes, no)), _) => {
                let is_not = |value: &Value| matches!(self.masks.get(value), Some(Mask::Constant(is)) if *is != truth);
                if is_not(&yes) {
                    self.assume(condition, false, refined);
                    self.assume(no, truth, refined);
                } else if is_not(&no) {
                    self.assume(condition, true, refined);
                    self.assume(yes, truth, refined);
                }
            }
            (Some(Mask::Below(a, b)), true) => self.is_below(a, b, 0, refined),
            (Some(Mask::AtMost(a, b)), true) => self.is_below(a, b, 1, refined),
            // Not a < b: b ≤ a.
            (Some(Mask::Below(a, b)), false) => self.is_below(b, a, 1, refined),
            (Some(Mask::AtMost(a, b)), false) => self.is_below(b, a, 0, refined),
            _ => {}
        }
    }

    /// a < b + more.
    fn is_below(&mut self, a: Value, b: Value, more: i64, refined: &mut Vec<(Value, Form)>) {
        let Some(limit) = self.form(b).coefficient() else {
            return;
        };
        let before = self.form(a);
        let mut form = before.clone();
        if let Some(axis) = before.global_axis() {
            // A symbol and one more is no coefficient.
            if limit.symbol.is_none() || more == 0 {
                let limit = Coefficient {
                    factor: limit.factor + if limit.symbol.is_none() { more } else { 0 },
                    ..limit
                };
                form.bounds[axis] = Some(limit);
            }
        } else if before.words().is_some() && limit.symbol.is_none() && limit.factor >= 0 {
            form.high = form.high.min(limit.factor + more - 1).max(form.low);
        } else {
            return;
        }
        refined.push((a, before));
        self.forms.insert(a, form);
    }
}

pub(super) fn mask_of(op: &Op) -> Option<Mask> {
    match *op {
        Op::MaskConstant(is) => Some(Mask::Constant(is)),
        Op::Compare(Compare::ULt, [a, b]) => Some(Mask::Below(a, b)),
        Op::Compare(Compare::ULe, [a, b]) => Some(Mask::AtMost(a, b)),
        Op::MaskNot(a) => Some(Mask::Not(a)),
        Op::MaskBinary(estampe_ir::op::MaskBinary::And, [a, b]) => Some(Mask::And(a, b)),
        Op::MaskBinary(estampe_ir::op::MaskBinary::Or, [a, b]) => Some(Mask::Or(a, b)),
        _ => None,
    }
}

/// True if a body ends with a branch on every way.
pub(super) fn always_leaves(body: &[Node]) -> bool {
    match body.last() {
        Some(Node::Branch { .. }) => true,
        Some(Node::If { accept, reject, .. }) => always_leaves(accept) && always_leaves(reject),
        Some(Node::Block { label, body, .. }) => {
            count_branches(*label, body) == 0 && always_leaves(body)
        }
        _ => false,
    }
}

/// The conditions on the way to the one branch to a label, as far as they are seen.
pub(super) fn way_to(label: Label, body: &[Node], conditions: &mut Vec<(Value, bool)>) {
    for node in body {
        let Node::If {
            condition,
            accept,
            reject,
        } = node
        else {
            continue;
        };
        if count_branches(label, accept) > 0 {
            conditions.push((*condition, true));
            return way_to(label, accept, conditions);
        }
        if count_branches(label, reject) > 0 {
            conditions.push((*condition, false));
            return way_to(label, reject, conditions);
        }
        if always_leaves(accept) {
            conditions.push((*condition, false));
        } else if always_leaves(reject) {
            conditions.push((*condition, true));
        }
    }
}

/// The result of a block that ends with a choice: `a || b` that evaluates b only if it must.
pub(super) fn choice(label: Label, body: &[Node]) -> Option<Mask> {
    let argument = |body: &[Node]| match body.last()? {
        Node::Branch {
            label: to,
            arguments,
        } if *to == label => match arguments[..] {
            [one] => Some(one),
            _ => None,
        },
        _ => None,
    };
    let Node::If {
        condition,
        accept,
        reject,
    } = body.last()?
    else {
        return None;
    };
    // No other branch goes to the block.
    let count = count_branches(label, body);
    (count == 2).then_some(())?;
    Some(Mask::Choice(
        *condition,
        argument(accept)?,
        argument(reject)?,
    ))
}

pub(super) fn count_branches(label: Label, body: &[Node]) -> usize {
    let of = |node: &Node| match node {
        Node::Op { .. } => 0,
        Node::If { accept, reject, .. } => {
            count_branches(label, accept) + count_branches(label, reject)
        }
        Node::Block { body, .. } | Node::Loop { body, .. } => count_branches(label, body),
        Node::Branch { label: to, .. } => usize::from(*to == label),
    };
    body.iter().map(of).sum()
}
