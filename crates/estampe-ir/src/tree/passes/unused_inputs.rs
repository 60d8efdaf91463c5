//! Removes inputs that nothing reads.

use crate::Op;
use crate::tree::{Node, Tree};

/// Removes the inputs that no operation reads, so that the pipeline need not compute them.
pub fn unused_inputs(tree: &mut Tree) {
    let mut is_read = vec![false; tree.interface.inputs.len()];
    each_input(&mut tree.body, &mut |at| is_read[*at as usize] = true);
    let mut kept = 0;
    let places: Vec<u32> = (is_read.iter())
        .map(|is_read| {
            let place = kept;
            kept += u32::from(*is_read);
            place
        })
        .collect();
    let mut reads = is_read.into_iter();
    tree.interface
        .inputs
        .retain(|_| reads.next().unwrap_or(true));
    each_input(&mut tree.body, &mut |at| *at = places[*at as usize]);
}

/// Calls `visit` with the number of the input that each operation reads.
fn each_input(nodes: &mut [Node], visit: &mut impl FnMut(&mut u32)) {
    for node in nodes {
        match node {
            Node::Op {
                op: Op::Input(at) | Op::InputMask(at),
                ..
            } => visit(at),
            Node::Op { .. } | Node::Branch { .. } => {}
            Node::If { accept, reject, .. } => {
                each_input(accept, visit);
                each_input(reject, visit);
            }
            Node::Block { body, .. } | Node::Loop { body, .. } => each_input(body, visit),
        }
    }
}
