//! A shader as one invocation sees it: structured SSA.
//!
//! Control flow has the four constructs of WebAssembly: [`Node::If`], [`Node::Block`],
//! [`Node::Loop`] and [`Node::Branch`]. A branch names the label of a construct around it. To the
//! label of a block it leaves the block: that is `break`, an early `return`, the end of both sides
//! of an `if`. To the label of a loop it starts the next iteration: that is `continue`. A branch
//! carries the values that are different there: the results of the block, or the parameters of the
//! loop.
//!
//! So a value is seen only in the construct that defines it, after its definition. Whatever leaves
//! a loop or an arm of an `if` does so as an argument of a branch. The compiler relies on it: a
//! value that is the same in all running lanes may be a different one in each iteration, and lanes
//! leave a loop at different times.
//!
//! `discard` is no construct. The mask [`Input::Cover`](crate::interface::Input::Cover) is a value
//! like others, which `discard` replaces by false; it is the `mask` of every operation with an
//! effect, and an output.

mod builder;
mod division;
mod evaluate;
pub mod passes;
mod verify;

pub use builder::Builder;
pub use evaluate::{Surroundings, evaluate};
pub use verify::{VerifyError, verify};

use crate::interface::{Input, Interface, Stage};
use crate::{Op, Type, Value};

/// Names a [`Node::Block`] or a [`Node::Loop`]. No two of a tree have the same label.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Label(pub u32);

/// A shader as one invocation sees it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Tree {
    /// The stage.
    pub stage: Stage,
    /// The interface.
    pub interface: Interface,
    /// The type of each value.
    pub types: Vec<Type>,
    /// What is executed. Its last node is not a branch.
    pub body: Vec<Node>,
    /// The value of each output of the interface.
    pub outputs: Vec<Value>,
}

/// A part of a tree.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Node {
    /// An operation. Its results are consecutive values.
    Op {
        /// The operation.
        op: Op,
        /// The first result; meaningless if the operation has none.
        first: Value,
    },
    /// Executes one of two bodies, and goes on after it unless that ends with a branch.
    If {
        /// The mask that chooses.
        condition: Value,
        /// Executed where it is set.
        accept: Vec<Self>,
        /// Executed where it is not.
        reject: Vec<Self>,
    },
    /// Executes a body, which branches to the label to leave it. The end of the body may be reached
    /// only if the block has no results.
    Block {
        /// The label.
        label: Label,
        /// Values that branches to the label give, and that are seen after the block.
        results: Vec<Value>,
        /// The body.
        body: Vec<Self>,
    },
    /// Executes a body, again for each branch to the label. At the end of the body, the loop ends.
    Loop {
        /// The label.
        label: Label,
        /// Values that are seen in the body: the arguments of the branch that began the iteration.
        parameters: Vec<Value>,
        /// The parameters in the first iteration.
        initial: Vec<Value>,
        /// The body.
        body: Vec<Self>,
    },
    /// Goes to a label of a construct around it. It is the last node of its body.
    Branch {
        /// The label.
        label: Label,
        /// The results of the block, or the parameters of the loop.
        arguments: Vec<Value>,
    },
}

impl Tree {
    /// The number of values.
    #[must_use]
    pub fn len(&self) -> usize {
        self.types.len()
    }

    /// True if the tree has no values.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.types.is_empty()
    }

    /// True if the kernel stores to the buffer at a position of the interface.
    #[must_use]
    pub fn is_written(&self, buffer: u32) -> bool {
        let buffers = &self.interface.buffers;
        buffers
            .get(buffer as usize)
            .is_none_or(|buffer| buffer.is_written)
    }

    /// True if an operation gives the same words in all invocations of a draw or dispatch, where
    /// its operands are the same in all.
    #[must_use]
    pub fn is_uniform(&self, op: &Op) -> bool {
        match op {
            Op::Constant(_) | Op::Unary(..) | Op::Binary(..) | Op::Fma(_) => true,
            Op::Input(at) => {
                let input = self.interface.inputs.get(*at as usize);
                matches!(input, Some(Input::PushConstant(_)))
            }
            Op::LoadBuffer { buffer, .. } => !self.is_written(*buffer),
            Op::Texture(op) => op.query.is_of_shape(),
            _ => false,
        }
    }
}
