//! Machine instructions with virtual registers: what selection makes and allocation reads.
//!
//! | module | does |
//! |---|---|
//! | [`mod@allocate`] | shows a function to regalloc2 and runs it |
//! | [`emit`] | encodes instructions with the registers that were found |
//! | [`lane_loop`] | encodes loops over the lanes of a packet |
//! | [`strided`] | encodes loads of words with a stride |
//! | [`quadruple`] | encodes loads of four words beside each other |
//! | [`passes`] | encodes the loop over packets around them |

pub(crate) mod allocate;
pub(crate) mod emit;
pub(crate) mod lane_loop;
pub(crate) mod passes;
pub(crate) mod quadruple;
pub(crate) mod scalars;
pub(crate) mod strided;

use crate::Isa;
use crate::encoder::VectorOp;
use lane_loop::LaneLoop;
use quadruple::Quadruple;
use regalloc2::{InstRange, Operand, PRegSet, RegClass, VReg};
use scalars::Scalars;
use strided::Strided;

/// The class of general-purpose registers.
pub(crate) const GPR: RegClass = RegClass::Int;
/// The class of vector registers.
pub(crate) const VECTOR: RegClass = RegClass::Float;
/// The class of AVX-512's mask registers.
pub(crate) const MASK: RegClass = RegClass::Vector;

/// What an operand is in its instruction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// ModRM.reg.
    Reg,
    /// The operand in the prefix.
    Vvvv,
    /// ModRM.rm: a register, or where it was spilled.
    Rm,
    /// The base of the address.
    Base,
    /// The vector of indices of the address.
    Index,
    /// The mask register of an EVEX prefix.
    Mask,
    /// The register in the immediate.
    Fourth,
    /// The same register as another operand's, or a register that only waits.
    Silent,
}

/// A place in memory that an instruction names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Memory {
    pub(crate) base: MemoryBase,
    pub(crate) offset: i32,
    pub(crate) is_broadcast: bool,
}

/// What a place in memory counts from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum MemoryBase {
    /// The frame.
    Frame,
    /// The pool of constants.
    Pool,
    /// The operand whose role is [`Role::Base`].
    Operand,
}

/// An instruction, or a short sequence of them. Operands are listed beside it.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Instruction {
    /// A row of the encoder's table, at the full length of vectors. Its operands have roles.
    Vector {
        op: &'static VectorOp,
        immediate: Option<u8>,
        memory: Option<Memory>,
        roles: [Role; 6],
    },
    /// A vector of zeros: `[def]`.
    Zero,
    /// A mask register with all lanes (or none): `[def]`.
    MaskConstant(bool),
    /// A pointer of the frame: `[def]`.
    LoadPointer(i32),
    /// The address of a byte of the pool: `[def]`.
    PoolPointer(u32),
    /// The address of a byte of the frame: `[def]`.
    FramePointer(i32),
    /// Quads of which a lane (or every lane) is set, in mask registers: `[def, use, temporary,
    /// temporary]`.
    Quads { needs_all: bool },
    /// All lanes if a lane is set, in mask registers: `[def, use, temporary]`.
    AnyMask,
    /// All lanes if a lane is set, in vectors: `[def, use, temporary]`.
    AnyVector,
    /// The signs of a vector's lanes as bits of a byte in memory: `[vector, pointer, temporary]`;
    /// without a pointer in the frame.
    StoreSigns { offset: i32, has_pointer: bool },
    /// A word of a buffer in all lanes, by its number in the lowest lane, which is shifted to the
    /// left: `[def, use, temporary, temporary, temporary]`.
    LoadScalar { buffer: u32, shift: u8 },
    /// Words of a buffer near each other, each in all lanes, by a place in the lowest lane: `[def,
    /// .., use, temporary, temporary, temporary, temporary]`.
    LoadScalars(Scalars),
    /// Words of a buffer whose numbers have a stride: `[def, numbers, pointer, temporary,
    /// temporary, temporary mask]`, and with a stride over 1 a temporary vector.
    LoadStrided(Strided),
    /// Four words of a buffer beside each other: `[def, def, def, def, numbers, pointer, temporary,
    /// temporary, temporary mask, temporary vector, temporary vector]`.
    LoadQuadruple(Quadruple),
    /// Calls the function that serves what code does not do itself.
    Call(u32),
    /// Changes words of memory, lane after lane: `[pointer, temporary, temporary, temporary,
    /// temporary, temporary]`.
    EachLane(LaneLoop),
    /// Waits until all packets of the work-group are here.
    Barrier,
    /// Goes to the only successor. Jumps backwards use the budget.
    Jump { is_back: bool },
    /// Goes to the first successor if a lane is set, else to the second: `[mask]`, with masks in
    /// vectors `[mask, temporary]`.
    Branch,
    /// The end.
    Return,
}

impl Instruction {
    fn ends_block(&self) -> bool {
        matches!(self, Self::Jump { .. } | Self::Branch)
    }
}

/// A basic block.
#[derive(Debug, Clone)]
pub(crate) struct Block {
    pub(crate) instructions: InstRange,
    pub(crate) parameters: Vec<VReg>,
    pub(crate) successors: Vec<regalloc2::Block>,
    pub(crate) predecessors: Vec<regalloc2::Block>,
    /// The values that the only successor is given.
    pub(crate) arguments: Vec<VReg>,
}

impl Default for Block {
    fn default() -> Self {
        let start = regalloc2::Inst::new(0);
        Self {
            instructions: InstRange::new(start, start),
            parameters: Vec::new(),
            successors: Vec::new(),
            predecessors: Vec::new(),
            arguments: Vec::new(),
        }
    }
}

/// Machine instructions with virtual registers.
#[derive(Debug, Default)]
pub(crate) struct Function {
    pub(crate) instructions: Vec<Instruction>,
    operands: Vec<Operand>,
    /// The end of each instruction's operands.
    operand_ends: Vec<usize>,
    pub(crate) blocks: Vec<Block>,
    registers: usize,
    /// The first instruction of the block that grows.
    block_start: usize,
    /// The units of eight bytes in which vectors are spilled.
    vector_slots: usize,
    /// The registers that a call changes.
    clobbers: PRegSet,
}

impl Function {
    /// A function without instructions.
    pub(crate) fn new(isa: Isa) -> Self {
        Self {
            vector_slots: isa.lanes() / 2,
            clobbers: allocate::clobbers(isa),
            ..Self::default()
        }
    }

    /// A new virtual register.
    pub(crate) fn register(&mut self, class: RegClass) -> VReg {
        self.registers += 1;
        VReg::new(self.registers - 1, class)
    }

    /// The number of virtual registers.
    pub(crate) fn registers(&self) -> usize {
        self.registers
    }

    /// Adds an instruction.
    pub(crate) fn push(&mut self, instruction: Instruction, operands: &[Operand]) {
        self.instructions.push(instruction);
        self.operands.extend(operands);
        self.operand_ends.push(self.operands.len());
    }

    /// A block without instructions, which is filled from [`Self::start_block`] on.
    pub(crate) fn new_block(&mut self) -> regalloc2::Block {
        self.blocks.push(Block::default());
        regalloc2::Block::new(self.blocks.len() - 1)
    }

    /// Says that the next instruction starts a block.
    pub(crate) fn start_block(&mut self) {
        self.block_start = self.instructions.len();
    }

    /// Says that the started block ended with the last instruction, and where it goes.
    pub(crate) fn end_block(&mut self, block: regalloc2::Block, successors: &[regalloc2::Block]) {
        let end = regalloc2::Inst::new(self.instructions.len());
        let ended = &mut self.blocks[block.index()];
        ended.instructions = InstRange::new(regalloc2::Inst::new(self.block_start), end);
        ended.successors = successors.to_vec();
        for successor in successors {
            self.blocks[successor.index()].predecessors.push(block);
        }
    }

    fn operands_of(&self, at: usize) -> &[Operand] {
        let start = at
            .checked_sub(1)
            .map_or(0, |before| self.operand_ends[before]);
        &self.operands[start..self.operand_ends[at]]
    }
}
