//! Contracts products and sums.

use crate::op::{Binary, Unary};
use crate::tree::{Node, Tree};
use crate::{Op, Type, Value};
use std::collections::HashMap;

/// Replaces each sum or difference that has a product as an operand, which nothing else uses, by
/// one operation that rounds once ([`Op::Fma`]). Results change, by less than a rounding; they are
/// the same on all machines, as those of the operations are. Products that are not needed any more
/// are left to [`dead_code`](super::dead_code).
///
/// Products of two uniform factors stay: they are computed once and not for each invocation, and
/// sums with them are told to be varyings at uniform shifts, as the taps of filters are.
pub fn contract(tree: &mut Tree) {
    let mut products = HashMap::new();
    let mut uses = vec![0_u32; tree.len()];
    survey(&tree.body, &mut products, &mut uses);
    let mut uniform = vec![false; tree.len()];
    find_uniform(tree, &tree.body, &mut uniform);
    products.retain(|_, factors| !factors.iter().all(|factor| uniform[factor.index()]));
    for value in &tree.outputs {
        uses[value.index()] += 1;
    }
    products.retain(|product, _| uses[product.index()] == 1);
    let mut body = std::mem::take(&mut tree.body);
    fuse(&mut tree.types, &mut body, &products);
    tree.body = body;
}

/// Finds the products, and counts the uses of all values.
fn survey(nodes: &[Node], products: &mut HashMap<Value, [Value; 2]>, uses: &mut [u32]) {
    let mut all = |values: &[Value]| values.iter().for_each(|value| uses[value.index()] += 1);
    for node in nodes {
        match node {
            Node::Op { op, first } => {
                if let Op::Binary(Binary::FMul, pair) = op {
                    products.insert(*first, *pair);
                }
                op.each_operand(|value, _| all(&[value]));
            }
            Node::If { condition, .. } => all(&[*condition]),
            Node::Loop { initial, .. } => all(initial),
            Node::Branch { arguments, .. } => all(arguments),
            Node::Block { .. } => {}
        }
    }
    for node in nodes {
        match node {
            Node::If { accept, reject, .. } => {
                survey(accept, products, uses);
                survey(reject, products, uses);
            }
            Node::Block { body, .. } | Node::Loop { body, .. } => survey(body, products, uses),
            Node::Op { .. } | Node::Branch { .. } => {}
        }
    }
}

/// Sets which values are the same in all invocations.
fn find_uniform(tree: &Tree, nodes: &[Node], uniform: &mut [bool]) {
    for node in nodes {
        match node {
            Node::Op { op, first } => {
                let mut is_uniform = tree.is_uniform(op);
                op.each_operand(|value, kind| {
                    is_uniform &= kind == Type::Mask || uniform[value.index()];
                });
                for result in first.and_next(op.results().len()) {
                    uniform[result.index()] = is_uniform;
                }
            }
            Node::If { accept, reject, .. } => {
                find_uniform(tree, accept, uniform);
                find_uniform(tree, reject, uniform);
            }
            Node::Block { body, .. } | Node::Loop { body, .. } => {
                find_uniform(tree, body, uniform);
            }
            Node::Branch { .. } => {}
        }
    }
}

fn fuse(types: &mut Vec<Type>, nodes: &mut Vec<Node>, products: &HashMap<Value, [Value; 2]>) {
    let mut done = Vec::with_capacity(nodes.len());
    for mut node in nodes.drain(..) {
        match &mut node {
            Node::Op {
                op: op @ Op::Binary(Binary::FAdd | Binary::FSub, _),
                ..
            } => {
                let mut negative = |of: Value| {
                    types.push(Type::Word);
                    let first = Value(u32::try_from(types.len() - 1).unwrap_or(u32::MAX));
                    let op = Op::Unary(Unary::FNeg, of);
                    done.push(Node::Op { op, first });
                    first
                };
                if let Some(fused) = fused(op, products, &mut negative) {
                    *op = Op::Fma(fused);
                }
            }
            Node::If { accept, reject, .. } => {
                fuse(types, accept, products);
                fuse(types, reject, products);
            }
            Node::Block { body, .. } | Node::Loop { body, .. } => fuse(types, body, products),
            Node::Op { .. } | Node::Branch { .. } => {}
        }
        done.push(node);
    }
    *nodes = done;
}

/// The factors and the summand of a sum or difference with a product.
fn fused(
    op: &Op,
    products: &HashMap<Value, [Value; 2]>,
    negative: &mut impl FnMut(Value) -> Value,
) -> Option<[Value; 3]> {
    let Op::Binary(kind, [a, b]) = *op else {
        return None;
    };
    Some(match (kind, products.get(&a), products.get(&b)) {
        (Binary::FAdd, Some(&[x, y]), _) => [x, y, b],
        (Binary::FAdd, None, Some(&[x, y])) => [x, y, a],
        (Binary::FSub, Some(&[x, y]), _) => [x, y, negative(b)],
        (Binary::FSub, None, Some(&[x, y])) => [negative(x), y, a],
        _ => return None,
    })
}
