//! Texture reads that are made before a shader runs, as inputs of its tree.

use estampe_ir::interface::{Input, Interface};
use estampe_ir::tree::Node;
use estampe_ir::{Op, Value};
use std::collections::HashMap;

/// A body in which reads, whose numbers are given by their first results, are inputs.
pub(super) fn with_inputs(
    interface: &mut Interface,
    body: Vec<Node>,
    numbers: &HashMap<Value, usize>,
) -> Vec<Node> {
    let mut nodes = Vec::with_capacity(body.len());
    for node in body {
        match node {
            Node::Op { op, first } if numbers.contains_key(&first) => {
                let results = op.results().len();
                push_inputs((interface, &mut nodes), numbers[&first], (first, results));
            }
            Node::Block {
                label,
                results,
                body,
            } => nodes.push(Node::Block {
                label,
                results,
                body: with_inputs(interface, body, numbers),
            }),
            node => nodes.push(node),
        }
    }
    nodes
}

/// Reads a read's texel: inputs in place of the results of the sample.
fn push_inputs(
    (interface, nodes): (&mut Interface, &mut Vec<Node>),
    read: usize,
    (first, results): (Value, usize),
) {
    let number = |count: usize| u32::try_from(count).expect("a tree of fewer than 2^32 values");
    let Interface { inputs, .. } = interface;
    for (component, first) in (0..).zip(first.and_next(results)) {
        let op = Op::Input(number(inputs.len()));
        inputs.push(Input::TextureRead {
            read: number(read),
            component,
        });
        nodes.push(Node::Op { op, first });
    }
}
