//! From machine instructions and the registers that were found to bytes.

use super::passes::Passes;
use super::{Function, GPR, Instruction, MASK, Memory, MemoryBase, Role, VECTOR};
use crate::Isa;
use crate::encoder::element::Arithmetic;
use crate::encoder::scalar::Width;
use crate::encoder::{
    Address, Assembler, Base, Condition, Gpr, Label, Length, Rm, VectorInstruction, VectorOp,
    vector_op,
};
use crate::frame::{self, Frame, displacement};
use regalloc2::{Allocation, Block, Edit, InstOrEdit, Output};

/// Encodes a function. It is called with the frame, and returns 0, or 1 if its budget is used up.
/// Parts of the frame that are there for each packet of a work-group count from `r12`.
pub(crate) fn emit(
    assembler: &mut Assembler,
    (function, passes): (&Function, Passes),
    allocated: &Output,
    (isa, frame): (Isa, &Frame),
) {
    let labels = function.blocks.iter().map(|_| assembler.new_label());
    let labels: Vec<Label> = labels.collect();
    let [stop, again, advance, next] = [(); 4].map(|()| assembler.new_label());
    let mut emitter = Emitter {
        assembler,
        isa,
        frame,
        labels,
        stop,
        advance,
        next,
        has_states: matches!(passes, Passes::Workgroup { .. }),
    };
    emitter.start();
    match passes {
        Passes::Once => {}
        Passes::Many { resets_locals } => {
            emitter.assembler.bind(again);
            emitter.start_pass(function, resets_locals);
        }
        Passes::Workgroup { resets_locals } => emitter.start_workgroup(resets_locals),
    }
    for at in 0..function.blocks.len() {
        let block = Block::new(at);
        emitter.assembler.bind(emitter.labels[at]);
        for part in allocated.block_insts_and_edits(function, block) {
            match part {
                InstOrEdit::Edit(Edit::Move { from, to }) => emitter.transfer(*from, *to),
                InstOrEdit::Inst(at_instruction) => {
                    let instruction = &function.instructions[at_instruction.index()];
                    let found = allocated.inst_allocs(at_instruction);
                    emitter.instruction(instruction, found, (at, function));
                }
            }
        }
    }
    emitter.assembler.bind(advance);
    match passes {
        Passes::Once => {}
        Passes::Many { .. } => emitter.end_pass(again),
        Passes::Workgroup { .. } => emitter.end_packet(),
    }
    emitter.end(0);
    emitter.assembler.bind(stop);
    emitter.end(1);
}

pub(super) struct Emitter<'a> {
    pub(super) assembler: &'a mut Assembler,
    pub(super) isa: Isa,
    pub(super) frame: &'a Frame,
    labels: Vec<Label>,
    /// Where the budget is used up.
    stop: Label,
    /// The end of a pass, or of a packet of a work-group.
    advance: Label,
    /// Where the next packet of the work-group goes on.
    pub(super) next: Label,
    /// Each packet has a state of its own.
    pub(super) has_states: bool,
}

/// The number of a register.
pub(super) fn number(found: Allocation) -> u8 {
    let register = found.as_reg().map_or(0, regalloc2::PReg::hw_enc);
    u8::try_from(register).unwrap_or(0)
}

pub(super) fn gpr(found: Allocation) -> Gpr {
    Gpr(number(found))
}

/// A place in the frame that all packets share.
pub(super) fn in_frame(offset: i32) -> Address {
    Address::at(Gpr::RBX, offset)
}

impl Emitter<'_> {
    /// A place in the frame that may be in the state of the packet.
    fn in_state(&self, offset: i32) -> Address {
        Address::at(self.frame_base(offset), offset)
    }

    fn frame_base(&self, offset: i32) -> Gpr {
        if self.has_states && self.frame.is_in_state(offset) {
            Gpr::R12
        } else {
            Gpr::RBX
        }
    }

    pub(super) fn length(&self) -> Length {
        match self.isa {
            Isa::Avx2 => Length::L256,
            Isa::Avx512 => Length::L512,
        }
    }

    /// A row of the table with two operands.
    pub(super) fn simple(&mut self, op: &'static VectorOp, reg: u8, rm: Rm) {
        self.assembler.vector(&VectorInstruction {
            op,
            is_evex: self.isa == Isa::Avx512 && op.evex_w.is_some(),
            length: self.length(),
            reg,
            vvvv: 0,
            rm,
            mask: 0,
            immediate: None,
        });
    }

    fn spill_slot(&self, found: Allocation) -> Option<Address> {
        let slot = u32::try_from(found.as_stack()?.index()).ok()?;
        Some(self.in_state(displacement(self.frame.spills + slot * 8)))
    }

    /// Moves a value between registers and where it is spilled.
    fn transfer(&mut self, from: Allocation, to: Allocation) {
        let class = from.as_reg().or(to.as_reg()).map(regalloc2::PReg::class);
        match (self.spill_slot(from), self.spill_slot(to)) {
            (None, None) if class == Some(GPR) => {
                self.assembler.mov(Width::Qword, gpr(to), gpr(from));
            }
            (None, Some(address)) if class == Some(GPR) => {
                self.assembler.store(Width::Qword, address, gpr(from));
            }
            (Some(address), None) if class == Some(GPR) => {
                self.assembler.load(Width::Qword, gpr(to), address);
            }
            (from_memory, to_memory) => {
                let [load, store, copy] = if class == Some(MASK) {
                    [
                        &vector_op::MASK_LOAD,
                        &vector_op::MASK_STORE,
                        &vector_op::MASK_LOAD,
                    ]
                } else {
                    debug_assert_eq!(class, Some(VECTOR));
                    [&vector_op::LOAD, &vector_op::STORE, &vector_op::MOVE]
                };
                match (from_memory, to_memory) {
                    (None, None) => self.simple(copy, number(to), Rm::Register(number(from))),
                    (Some(address), None) => self.simple(load, number(to), Rm::Memory(address)),
                    (None, Some(address)) => self.simple(store, number(from), Rm::Memory(address)),
                    (Some(_), Some(_)) => unreachable!("regalloc2 never moves memory to memory"),
                }
            }
        }
    }

    fn instruction(
        &mut self,
        instruction: &Instruction,
        found: &[Allocation],
        (block, function): (usize, &Function),
    ) {
        match *instruction {
            Instruction::Vector {
                op,
                immediate,
                memory,
                roles,
            } => self.vector(op, (immediate, memory), &roles, found),
            Instruction::Zero => {
                let register = number(found[0]);
                self.zero(register);
            }
            Instruction::MaskConstant(is_set) => {
                let op = if is_set {
                    &vector_op::MASK_SAME
                } else {
                    &vector_op::MASK_XOR
                };
                self.simple(op, number(found[0]), Rm::Register(0));
            }
            Instruction::LoadPointer(offset) => {
                let to = gpr(found[0]);
                let from = self.in_state(offset);
                self.assembler.load(Width::Qword, to, from);
            }
            Instruction::PoolPointer(offset) => {
                let address = Address::in_pool(displacement(offset));
                self.assembler.lea(gpr(found[0]), address);
            }
            Instruction::FramePointer(offset) => {
                let address = self.in_state(offset);
                self.assembler.lea(gpr(found[0]), address);
            }
            Instruction::Quads { needs_all } => self.quads(needs_all, found),
            Instruction::AnyMask => {
                self.simple(
                    &vector_op::GPR_FROM_MASK,
                    number(found[2]),
                    Rm::Register(number(found[1])),
                );
                self.spread(gpr(found[2]));
                self.simple(
                    &vector_op::MASK_FROM_GPR,
                    number(found[0]),
                    Rm::Register(number(found[2])),
                );
            }
            Instruction::AnyVector => {
                self.signs(found[2], found[1]);
                self.spread(gpr(found[2]));
                let temporary = in_frame(frame::TEMPORARY);
                self.assembler.store(Width::Dword, temporary, gpr(found[2]));
                self.simple(
                    &vector_op::BROADCAST,
                    number(found[0]),
                    Rm::Memory(temporary),
                );
            }
            Instruction::StoreSigns {
                offset,
                has_pointer,
            } => {
                let (base, temporary) = if has_pointer {
                    (gpr(found[1]), found[2])
                } else {
                    (Gpr::RBX, found[1])
                };
                self.signs(temporary, found[0]);
                let address = Address::at(base, offset);
                self.assembler.store_byte(address, gpr(temporary));
            }
            Instruction::LoadScalar { buffer, shift } => self.load_scalar((buffer, shift), found),
            Instruction::LoadScalars(load) => self.scalars(load, found),
            Instruction::LoadStrided(load) => self.strided(load, found),
            Instruction::LoadQuadruple(load) => self.quadruple(load, found),
            Instruction::Call(at) => self.call(at),
            Instruction::Barrier => self.barrier(),
            Instruction::EachLane(loops) => {
                let registers = std::array::from_fn(|at| gpr(found[at]));
                self.each_lane(loops, registers);
            }
            Instruction::Jump { is_back } => {
                let to = function.blocks[block].successors[0].index();
                if is_back {
                    self.assembler.sub_memory(in_frame(frame::BUDGET), 1);
                    self.assembler.jump_if(Condition::Below, self.stop);
                }
                self.jump(to, block);
            }
            Instruction::Branch => {
                match self.isa {
                    Isa::Avx512 => {
                        let mask = number(found[0]);
                        self.simple(&vector_op::MASK_TEST, mask, Rm::Register(mask));
                    }
                    Isa::Avx2 => {
                        self.signs(found[1], found[0]);
                        self.assembler.test(gpr(found[1]));
                    }
                }
                let [any, none] = [0, 1].map(|at| function.blocks[block].successors[at].index());
                self.assembler.jump_if(Condition::Zero, self.labels[none]);
                self.jump(any, block);
            }
            Instruction::Return => {
                if block + 1 < function.blocks.len() {
                    self.assembler.jump(self.advance);
                }
            }
        }
    }

    fn vector(
        &mut self,
        op: &'static VectorOp,
        (immediate, memory): (Option<u8>, Option<Memory>),
        roles: &[Role; 6],
        found: &[Allocation],
    ) {
        let (mut reg, mut vvvv, mut rm, mut mask) = (0, 0, Rm::Register(0), 0);
        let (mut index, mut immediate) = (None, immediate);
        let mut base = match memory {
            Some(memory) if memory.base == MemoryBase::Pool => Base::Pool,
            Some(memory) => Base::Gpr(self.frame_base(memory.offset)),
            None => Base::Gpr(Gpr::RBX),
        };
        for (role, &one) in roles.iter().zip(found) {
            match role {
                Role::Reg => reg = number(one),
                Role::Vvvv => vvvv = number(one),
                Role::Rm => {
                    let spilled = self.spill_slot(one);
                    rm = spilled.map_or(Rm::Register(number(one)), Rm::Memory);
                }
                Role::Base => base = Base::Gpr(gpr(one)),
                Role::Index => index = Some(number(one)),
                Role::Mask => mask = number(one),
                Role::Fourth => immediate = Some(number(one) << 4),
                Role::Silent => {}
            }
        }
        if let Some(memory) = memory {
            rm = Rm::Memory(Address {
                base,
                index,
                displacement: memory.offset,
                is_broadcast: memory.is_broadcast,
            });
        }
        self.assembler.vector(&VectorInstruction {
            op,
            is_evex: self.isa == Isa::Avx512 && op.evex_w.is_some(),
            length: self.length(),
            reg,
            vvvv,
            rm,
            mask,
            immediate,
        });
    }

    pub(super) fn zero(&mut self, register: u8) {
        // The upper part of the register becomes 0, too.
        self.assembler.vector(&VectorInstruction {
            op: &vector_op::XOR,
            is_evex: register >= 16,
            length: if register >= 16 {
                Length::L512
            } else {
                Length::L128
            },
            reg: register,
            vvvv: register,
            rm: Rm::Register(register),
            mask: 0,
            immediate: None,
        });
    }

    /// The signs of a vector as bits.
    fn signs(&mut self, to: Allocation, from: Allocation) {
        self.simple(&vector_op::SIGNS, number(to), Rm::Register(number(from)));
    }

    /// All ones if a bit is set, else zeros.
    fn spread(&mut self, register: Gpr) {
        self.assembler.neg(register);
        self.assembler.sbb(register, register);
    }

    fn quads(&mut self, needs_all: bool, found: &[Allocation]) {
        let [bits, shifted] = [gpr(found[2]), gpr(found[3])];
        self.simple(
            &vector_op::GPR_FROM_MASK,
            bits.0,
            Rm::Register(number(found[1])),
        );
        for by in [1, 2] {
            self.assembler.mov(Width::Dword, shifted, bits);
            self.assembler.shr(shifted, by);
            if needs_all {
                self.assembler.arithmetic(Arithmetic::And, bits, shifted);
            } else {
                self.assembler.arithmetic(Arithmetic::Or, bits, shifted);
            }
        }
        // The lowest bit of each quad, then four copies of it.
        self.assembler.and_immediate(bits, 0x1111);
        self.assembler.imul(bits, bits, 0b1111);
        self.simple(
            &vector_op::MASK_FROM_GPR,
            number(found[0]),
            Rm::Register(bits.0),
        );
    }

    fn load_scalar(&mut self, of: (u32, u8), found: &[Allocation]) {
        let [index, address, outside] = [2, 3, 4].map(|at| gpr(found[at]));
        self.simple_lowest(index, found[1]);
        self.scalar(of, [index, address, outside], found[0]);
    }

    fn simple_lowest(&mut self, to: Gpr, from: Allocation) {
        // vmovd r32, xmm: the vector stands in ModRM.reg.
        self.simple(&vector_op::STORE_LOWEST, number(from), Rm::Register(to.0));
    }

    fn jump(&mut self, to: usize, from: usize) {
        if to != from + 1 {
            self.assembler.jump(self.labels[to]);
        }
    }
}
