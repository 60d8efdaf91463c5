//! The flow graph as it grows: blocks, jumps, and the places where ways join.

use super::leaving::Leaving;
use super::{Constants, Lowering, RUNNING, State};
use crate::interface::{Input, Stage};
use crate::lanes::uniform::Uniformity;
use crate::lanes::{BasicBlock, BlockId, Jump, Kernel, Terminator, ValueInfo};
use crate::tree::{Node, Tree};
use crate::{Op, Type, Value};

/// A jump to a block that is not made yet.
pub(super) struct Incoming {
    from: BlockId,
    is_if_none: bool,
    arguments: Vec<Value>,
    state: State,
}

impl Incoming {
    /// The jump of a branch that is taken if its mask is empty.
    pub(super) fn if_none(from: BlockId, state: State) -> Self {
        Self {
            from,
            is_if_none: true,
            arguments: Vec::new(),
            state,
        }
    }

    /// The lanes that run.
    pub(super) fn runs(&self) -> Value {
        self.state[RUNNING]
    }
}

impl Jump {
    /// A jump without arguments.
    pub(super) fn to(to: BlockId) -> Self {
        Self {
            to,
            arguments: Vec::new(),
        }
    }

    /// A jump that is set when its block is made.
    pub(super) fn unknown() -> Self {
        Self::to(BlockId(u32::MAX))
    }
}

impl<'a> Lowering<'a> {
    pub(super) fn new(tree: &'a Tree) -> Self {
        let dummy = Value(0);
        let mut lowering = Self {
            tree,
            uniformity: Uniformity::of(tree),
            leaving: Leaving::new(tree),
            kernel: Kernel {
                stage: tree.stage,
                interface: tree.interface.clone(),
                values: Vec::new(),
                blocks: Vec::new(),
            },
            map: vec![dummy; tree.len()],
            current: None,
            state: Vec::new(),
            around: Vec::new(),
            constants: Constants {
                none: dummy,
                all: dummy,
                zero: dummy,
            },
            entry: dummy,
            not_empty: dummy,
        };
        lowering.current = Some(lowering.new_block());
        lowering.constants = Constants {
            none: lowering.emit(Op::MaskConstant(false)),
            all: lowering.emit(Op::MaskConstant(true)),
            zero: lowering.emit(Op::Constant(0)),
        };
        lowering.entry = lowering.entry_mask();
        lowering.not_empty = lowering.entry;
        lowering.state.push(lowering.entry);
        lowering
    }

    /// The lanes that run at the beginning. Where no control flow depends on it, all do.
    fn entry_mask(&mut self) -> Value {
        let is_op = |node: &Node| matches!(node, Node::Op { .. });
        if self.tree.body.iter().all(is_op) {
            return self.constants.all;
        }
        let inputs = &mut self.kernel.interface.inputs;
        let at = inputs.iter().position(|input| *input == Input::Cover);
        let at = at.unwrap_or_else(|| {
            inputs.push(Input::Cover);
            inputs.len() - 1
        });
        let at = u32::try_from(at).expect("fewer than 2^32 inputs");
        let varying = ValueInfo {
            kind: Type::Mask,
            is_uniform: false,
        };
        let cover = self.push(Op::InputMask(at), &[varying]);
        match self.tree.stage {
            // Helper invocations run for the derivatives of their quads.
            Stage::Fragment => self.emit(Op::QuadAny(cover)),
            Stage::Vertex | Stage::Compute => cover,
        }
    }

    pub(super) fn new_block(&mut self) -> BlockId {
        let at = u32::try_from(self.kernel.blocks.len()).expect("fewer than 2^32 blocks");
        self.kernel.blocks.push(BasicBlock {
            parameters: Vec::new(),
            ops: Vec::new(),
            // Set when the block ends. A block that never ends is one that is never reached.
            terminator: Terminator::Return(Vec::new()),
        });
        BlockId(at)
    }

    pub(super) fn set_terminator(&mut self, block: BlockId, terminator: Terminator) {
        self.kernel.blocks[block.index()].terminator = terminator;
    }

    /// Ends the block that grows.
    pub(super) fn end(&mut self, terminator: Terminator) {
        if let Some(block) = self.current.take() {
            self.set_terminator(block, terminator);
        }
    }

    /// Ends the block that grows with a jump to a block that is not made yet; `None` where nothing
    /// is executed.
    pub(super) fn incoming(&mut self, arguments: Vec<Value>) -> Option<Incoming> {
        let from = self.current.take()?;
        Some(Incoming {
            from,
            is_if_none: false,
            arguments,
            state: self.state.clone(),
        })
    }

    /// Makes the block to which these jumps go. Their arguments are values of the tree.
    pub(super) fn join(&mut self, incoming: Vec<Incoming>, results: &[Value]) {
        let Some(first) = incoming.first() else {
            self.current = None;
            return;
        };
        // What waits inside of a construct that was left waits nowhere any more.
        let parts = incoming
            .iter()
            .map(|one| one.state.len())
            .min()
            .unwrap_or(0);
        let mut state = first.state[..parts].to_vec();
        let differs = |at: usize| incoming.iter().any(|one| one.state[at] != first.state[at]);
        let different: Vec<usize> = (0..parts).filter(|&at| differs(at)).collect();
        let join = self.new_block();
        self.define_parameters(join, results);
        for &at in &different {
            let mut of_state = incoming
                .iter()
                .map(|one| &self.kernel.values[one.state[at].index()]);
            let info = ValueInfo {
                kind: self.kernel.values[first.state[at].index()].kind,
                is_uniform: of_state.all(|info| info.is_uniform),
            };
            state[at] = self.parameter(join, info);
        }
        for one in incoming {
            let mut arguments = one.arguments;
            arguments.extend(different.iter().map(|&at| one.state[at]));
            let jump = Jump {
                to: join,
                arguments,
            };
            let terminator = &mut self.kernel.blocks[one.from.index()].terminator;
            match terminator {
                Terminator::Branch { none, .. } if one.is_if_none => *none = jump,
                _ => *terminator = Terminator::Jump(jump),
            }
        }
        self.current = Some(join);
        self.state = state;
    }

    /// Ends the block that grows with a jump to the first block of a loop, which grows then.
    pub(super) fn start_header(&mut self, arguments: Vec<Value>) -> BlockId {
        let header = self.new_block();
        self.end(Terminator::Jump(Jump {
            to: header,
            arguments,
        }));
        self.current = Some(header);
        header
    }

    /// Makes values of the tree parameters of a block.
    pub(super) fn define_parameters(&mut self, block: BlockId, values: &[Value]) {
        for &value in values {
            let info = ValueInfo {
                kind: self.tree.types[value.index()],
                is_uniform: self.uniformity.is_uniform(value),
            };
            self.map[value.index()] = self.parameter(block, info);
        }
    }

    pub(super) fn parameter(&mut self, block: BlockId, info: ValueInfo) -> Value {
        let value = self.define(&[info]);
        self.kernel.blocks[block.index()].parameters.push(value);
        value
    }

    /// A branch around a loop, taken if no lane runs; `None` if one does.
    pub(super) fn guard(&mut self) -> Option<Incoming> {
        let running = self.state[RUNNING];
        let fork = self.current?;
        if running == self.not_empty || running == self.constants.all {
            return None;
        }
        let inside = self.new_block();
        self.set_terminator(
            fork,
            Terminator::Branch {
                mask: running,
                any: Jump::to(inside),
                none: Jump::unknown(),
            },
        );
        self.current = Some(inside);
        Some(Incoming::if_none(fork, self.state.clone()))
    }
}
