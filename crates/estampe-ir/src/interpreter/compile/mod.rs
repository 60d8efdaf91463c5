//! From a kernel to bytecode.
//!
//! 1. [`plan`] finds the operations whose results are needed, and products that are added at once.
//! 2. [`emit`] writes instructions. Each value that differs between lanes has a register of its
//!    own; what is the same in all lanes is a scalar. Operations on scalars that read nothing that
//!    changes are moved to the *preamble*, which is executed once in a run.
//! 3. [`coalesce`] computes what a loop carries on in its place.
//! 4. [`registers`] lets values share registers whose lives do not overlap (linear scan; Poletto
//!    and Sarkar 1999).

mod coalesce;
mod emit;
mod moves;
mod ops;
mod plan;
mod registers;

use super::instruction::{Instruction, Scalar, ScalarOp};
use super::run::entry_of;
use crate::lanes::Kernel;
use crate::op::TextureQuery;
use crate::{Op, Type};
use emit::Emitter;

/// The most packets of a chunk.
pub const MAX_CHUNK: usize = 16;

/// The bytes of registers that stay in the first cache, with room for what they are computed from.
const REGISTER_BYTES: usize = 32 << 10;

/// A kernel as the interpreter runs it.
#[derive(Debug, Clone)]
pub struct Code {
    /// Executed once in a run.
    pub(super) preamble: Vec<(Scalar, ScalarOp)>,
    /// Each with the place of its function.
    pub(super) instructions: Vec<(u8, Instruction)>,
    /// The number of registers of words.
    pub(super) slots: usize,
    /// The number of registers of masks.
    pub(super) mask_slots: usize,
    /// The scalars at the start: constants, and zeros.
    pub(super) scalars: Vec<u32>,
    /// Arrays that are never stored to.
    pub(super) tables: Vec<Vec<u32>>,
    /// The words of the other arrays at the start, for one invocation.
    pub(super) locals: Vec<u32>,
    pub(super) workgroup_words: usize,
    pub(super) chunk: Chunk,
}

/// How many packets execute an instruction together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Chunk {
    Packets(usize),
    /// One, until the next barrier, where it waits for the others: a run is a work-group.
    Workgroup,
}

impl Code {
    /// The bytecode of a kernel that [`verify`](crate::lanes::verify) accepts.
    #[must_use]
    pub fn new(kernel: &Kernel) -> Self {
        let mut emitter = Emitter::new(kernel);
        emitter.kernel();
        coalesce::coalesce(&mut emitter.instructions);
        let [slots, mask_slots] = registers::allocate(&mut emitter.instructions);
        coalesce::remove_idle_copies(&mut emitter.instructions);
        let instructions = emitter.instructions.into_iter();
        let mut code = Self {
            preamble: emitter.preamble,
            instructions: instructions.map(|one| (entry_of(&one), one)).collect(),
            slots,
            mask_slots,
            scalars: emitter.scalars,
            tables: emitter.tables,
            locals: emitter.locals,
            workgroup_words: kernel.interface.workgroup_words as usize,
            chunk: Chunk::Workgroup,
        };
        if !kernel.runs_workgroups() {
            let packets = if has_effects(kernel) {
                1
            } else {
                let of_packet = (code.slots + code.locals.len()) * 64 + code.mask_slots * 2;
                (REGISTER_BYTES / of_packet.max(1)).clamp(1, MAX_CHUNK)
            };
            code.chunk = Chunk::Packets(packets);
        }
        code
    }

    /// The same, with so many packets in a chunk where results do not depend on it.
    #[must_use]
    pub fn with_chunk(mut self, packets: usize) -> Self {
        if let Chunk::Packets(2..) = self.chunk {
            self.chunk = Chunk::Packets(packets.clamp(1, MAX_CHUNK));
        }
        self
    }

    /// The number of instructions, and of registers that hold a word in each lane.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        [self.instructions.len(), self.slots]
    }
}

fn ops(kernel: &Kernel) -> impl Iterator<Item = &Op> {
    let blocks = kernel.blocks.iter();
    blocks.flat_map(|block| block.ops.iter().map(|(op, _)| op))
}

/// True if lanes of different packets must act in order.
fn has_effects(kernel: &Kernel) -> bool {
    ops(kernel).any(|op| match op {
        Op::StoreLocal { .. } => false,
        Op::Texture(op) => op.query == TextureQuery::Store,
        _ => op.has_effect(),
    })
}

fn kind_of(kernel: &Kernel, value: crate::Value) -> Type {
    let info = kernel.values.get(value.index());
    info.map_or(Type::Word, |info| info.kind)
}
