//! A shader as many lanes run it: basic blocks, and masks that are values.
//!
//! A kernel runs on packets of lanes together, as many as the back end likes. Control flow is that
//! of all lanes at once: a [`Terminator::Branch`] is taken if *any* lane of its mask is set. What
//! lanes do that took another way is undone by masks: stores act only in the lanes that run, and
//! where ways join, [`Op::Select`] chooses in each lane.
//!
//! Lanes that do not run compute all the same; their numbers are not used.

mod dominators;
mod from_tree;
pub mod uniform;
mod verify;

pub use verify::{VerifyError, verify};

use crate::interface::{Interface, Stage};
use crate::{Op, Type, Value};

/// The position of a basic block in its kernel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct BlockId(pub u32);

impl BlockId {
    /// The position.
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A shader as many lanes run it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Kernel {
    /// The stage.
    pub stage: Stage,
    /// The interface.
    pub interface: Interface,
    /// What is known of each value.
    pub values: Vec<ValueInfo>,
    /// The basic blocks. The first one is where the kernel begins; it has no parameters and no
    /// predecessors. Blocks stand in an order in which every block but loop headers comes after all
    /// of its predecessors.
    pub blocks: Vec<BasicBlock>,
}

impl Kernel {
    /// True if a jump leads backwards.
    #[must_use]
    pub fn has_loops(&self) -> bool {
        let mut blocks = self.blocks.iter().enumerate();
        blocks.any(|(at, block)| {
            let mut jumps = block.terminator.jumps();
            jumps.any(|jump| jump.to.index() <= at)
        })
    }

    /// True if a run must be one work-group: there are barriers, or memory that it shares.
    #[must_use]
    pub fn runs_workgroups(&self) -> bool {
        let mut ops = self.blocks.iter().flat_map(|block| &block.ops);
        self.interface.workgroup_words > 0 || ops.any(|(op, _)| matches!(op, Op::Barrier))
    }
}

/// What is known of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ValueInfo {
    /// The type.
    pub kind: Type,
    /// True if it is the same in all lanes that run. A back end may hold it once.
    pub is_uniform: bool,
}

/// Operations that run one after the other.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BasicBlock {
    /// Values that the jumps to the block give.
    pub parameters: Vec<Value>,
    /// The operations, each with its first result.
    pub ops: Vec<(Op, Value)>,
    /// What comes after.
    pub terminator: Terminator,
}

/// A jump to a block, with the values of its parameters.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Jump {
    /// The block.
    pub to: BlockId,
    /// The values of its parameters. A uniform value may be given to a parameter that is not.
    pub arguments: Vec<Value>,
}

/// What comes after the operations of a block.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Terminator {
    /// Another block.
    Jump(Jump),
    /// One of two blocks.
    Branch {
        /// A mask.
        mask: Value,
        /// Taken if a lane of the mask is set.
        any: Jump,
        /// Taken if none is.
        none: Jump,
    },
    /// The end: the value of each output of the interface.
    Return(Vec<Value>),
}

impl Terminator {
    /// The jumps.
    pub fn jumps(&self) -> impl Iterator<Item = &Jump> {
        let (first, second) = match self {
            Self::Jump(jump) => (Some(jump), None),
            Self::Branch { any, none, .. } => (Some(any), Some(none)),
            Self::Return(_) => (None, None),
        };
        first.into_iter().chain(second)
    }

    /// The jumps, to change them.
    pub fn jumps_mut(&mut self) -> impl Iterator<Item = &mut Jump> {
        let (first, second) = match self {
            Self::Jump(jump) => (Some(jump), None),
            Self::Branch { any, none, .. } => (Some(any), Some(none)),
            Self::Return(_) => (None, None),
        };
        first.into_iter().chain(second)
    }
}
