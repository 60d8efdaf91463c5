//! What makes trees smaller and faster without changing their results.
//!
//! [`Builder`](super::Builder) folds constants and finds common subexpressions while a tree grows.
//! [`optimise`] does what needs the whole tree:
//!
//! 1. [`straight_blocks`]: blocks that are left only at their end, which become their bodies.
//! 2. [`redundant_parameters`]: results and parameters that are the same value on every way. Front
//!    ends pass every variable that a construct may change; most are not changed.
//! 3. [`loop_invariants`]: operations that give the same value in each iteration move before the
//!    loop.
//! 4. [`unroll_loops`]: loops of a few iterations become straight code. Blocks and parameters are
//!    looked at again after it.
//! 5. [`dead_code`]: operations, results and parameters that nothing uses.
//! 6. [`unused_inputs`]: inputs that nothing reads.
//!
//! [`contract`], which does change results, is for those who ask for it, and [`access_packed`] for
//! those who bind textures of one kind.

mod contract;
mod dead;
pub(crate) mod fold;
mod invariant;
mod packed;
mod redundant;
mod straight;
mod unroll;
mod unused_inputs;

pub use contract::contract;
pub use dead::dead_code;
pub use invariant::loop_invariants;
pub use packed::{PackedTexture, access_packed, packed_textures};
pub use redundant::redundant_parameters;
pub use straight::straight_blocks;
pub use unroll::unroll_loops;
pub use unused_inputs::unused_inputs;

use super::{Label, Node, Tree};
use crate::Value;

/// All passes, in order.
pub fn optimise(tree: &mut Tree) {
    straight_blocks(tree);
    redundant_parameters(tree);
    loop_invariants(tree);
    unroll_loops(tree);
    straight_blocks(tree);
    redundant_parameters(tree);
    dead_code(tree);
    unused_inputs(tree);
}

/// Calls `visit` with each branch, in order.
pub(super) fn each_branch<'a>(nodes: &'a [Node], visit: &mut impl FnMut(Label, &'a [Value])) {
    for node in nodes {
        match node {
            Node::Op { .. } => {}
            Node::If { accept, reject, .. } => {
                each_branch(accept, visit);
                each_branch(reject, visit);
            }
            Node::Block { body, .. } | Node::Loop { body, .. } => each_branch(body, visit),
            Node::Branch { label, arguments } => visit(*label, arguments),
        }
    }
}

/// Replaces every use of a value by another.
fn replace_uses(nodes: &mut [Node], new: &impl Fn(Value) -> Value) {
    let all = |values: &mut [Value]| values.iter_mut().for_each(|value| *value = new(*value));
    for node in nodes {
        match node {
            Node::Op { op, .. } => op.each_operand_mut(|value, _| *value = new(*value)),
            Node::If {
                condition,
                accept,
                reject,
            } => {
                *condition = new(*condition);
                replace_uses(accept, new);
                replace_uses(reject, new);
            }
            Node::Block { body, .. } => replace_uses(body, new),
            Node::Loop { initial, body, .. } => {
                all(initial);
                replace_uses(body, new);
            }
            Node::Branch { arguments, .. } => all(arguments),
        }
    }
}
