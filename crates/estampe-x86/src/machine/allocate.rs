//! Register allocation by regalloc2.

use super::{Function, Instruction};
use crate::{Isa, Tier};
use regalloc2::{
    Algorithm, Block, Inst, InstRange, MachineEnv, Operand, Output, PReg, PRegSet, RegAllocError,
    RegClass, RegallocOptions, VReg,
};

/// General-purpose registers that code may change without saving them: all of them that a called
/// function may change, too. `rbx` points to the frame.
const FREE_GPRS: [usize; 9] = [0, 1, 2, 6, 7, 8, 9, 10, 11];

fn registers_of(class: RegClass, numbers: impl IntoIterator<Item = usize>) -> PRegSet {
    let mut set = PRegSet::empty();
    for number in numbers {
        set.add(PReg::new(number, class));
    }
    set
}

fn vectors(isa: Isa) -> PRegSet {
    registers_of(super::VECTOR, 0..if isa == Isa::Avx512 { 32 } else { 16 })
}

fn masks() -> PRegSet {
    // k0 means all lanes where an instruction takes a mask.
    registers_of(super::MASK, 1..8)
}

/// Finds registers for a function.
pub(crate) fn allocate(function: &Function, isa: Isa, tier: Tier) -> Result<Output, RegAllocError> {
    let environment = MachineEnv {
        preferred_regs_by_class: [registers_of(super::GPR, FREE_GPRS), vectors(isa), masks()],
        non_preferred_regs_by_class: [PRegSet::empty(); 3],
        scratch_by_class: [None; 3],
        fixed_stack_slots: Vec::new(),
    };
    let algorithm = match tier {
        Tier::Fast => Algorithm::Fastalloc,
        Tier::Optimised => Algorithm::Ion,
    };
    let options = RegallocOptions {
        verbose_log: false,
        validate_ssa: cfg!(debug_assertions),
        algorithm,
    };
    regalloc2::run(function, &environment, &options)
}

/// The registers that a call changes.
pub(super) fn clobbers(isa: Isa) -> PRegSet {
    let mut all = registers_of(super::GPR, FREE_GPRS);
    all.union_from(vectors(isa));
    if isa == Isa::Avx512 {
        all.union_from(masks());
    }
    all
}

impl regalloc2::Function for Function {
    fn num_insts(&self) -> usize {
        self.instructions.len()
    }

    fn num_blocks(&self) -> usize {
        self.blocks.len()
    }

    fn entry_block(&self) -> Block {
        Block::new(0)
    }

    fn block_insns(&self, block: Block) -> InstRange {
        self.blocks[block.index()].instructions
    }

    fn block_succs(&self, block: Block) -> &[Block] {
        &self.blocks[block.index()].successors
    }

    fn block_preds(&self, block: Block) -> &[Block] {
        &self.blocks[block.index()].predecessors
    }

    fn block_params(&self, block: Block) -> &[VReg] {
        &self.blocks[block.index()].parameters
    }

    fn is_ret(&self, instruction: Inst) -> bool {
        matches!(self.instructions[instruction.index()], Instruction::Return)
    }

    fn is_branch(&self, instruction: Inst) -> bool {
        self.instructions[instruction.index()].ends_block()
    }

    fn branch_blockparams(&self, block: Block, _: Inst, _: usize) -> &[VReg] {
        // Only blocks with one successor give arguments: critical edges are split.
        &self.blocks[block.index()].arguments
    }

    fn inst_operands(&self, instruction: Inst) -> &[Operand] {
        self.operands_of(instruction.index())
    }

    fn inst_clobbers(&self, instruction: Inst) -> PRegSet {
        match self.instructions[instruction.index()] {
            Instruction::Call(_) | Instruction::Barrier => self.clobbers,
            _ => PRegSet::empty(),
        }
    }

    fn num_vregs(&self) -> usize {
        self.registers
    }

    fn spillslot_size(&self, class: RegClass) -> usize {
        if class == super::VECTOR {
            self.vector_slots
        } else {
            1
        }
    }
}
