//! Operands in registers and in memory, and the forms of instructions.

use super::{Place, Selector};
use crate::Isa;
use crate::encoder::{VectorOp, vector_op};
use crate::frame::displacement;
use crate::machine::{GPR, Instruction, Memory, MemoryBase, Role, VECTOR};
use estampe_ir::Value;
use regalloc2::{Operand, RegClass, VReg};

/// An operand that an instruction may read from memory.
#[derive(Debug, Clone, Copy)]
pub(super) enum Source {
    Register(VReg),
    /// With the register of its base, if it has one.
    Memory(Memory, Option<VReg>),
}

/// A list of operands with their roles, at most six.
#[derive(Debug)]
pub(super) struct Operands {
    roles: [Role; 6],
    list: Vec<Operand>,
}

impl Operands {
    pub(super) fn new() -> Self {
        Self {
            roles: [Role::Silent; 6],
            list: Vec::with_capacity(6),
        }
    }

    pub(super) fn with(mut self, role: Role, operand: Operand) -> Self {
        self.roles[self.list.len()] = role;
        self.list.push(operand);
        self
    }
}

impl Selector<'_> {
    /// Adds an instruction of the encoder's table.
    pub(super) fn push(
        &mut self,
        op: &'static VectorOp,
        (immediate, memory): (Option<u8>, Option<Memory>),
        operands: &Operands,
    ) {
        let instruction = Instruction::Vector {
            op,
            immediate,
            memory,
            roles: operands.roles,
        };
        self.function.push(instruction, &operands.list);
    }

    /// An operation with a result in ModRM.reg, a first operand if it has one, and a source.
    pub(super) fn emit(
        &mut self,
        (op, class): (&'static VectorOp, RegClass),
        first: Option<VReg>,
        source: Source,
        immediate: Option<u8>,
    ) -> VReg {
        let result = self.function.register(class);
        let mut operands = Operands::new().with(Role::Reg, Operand::reg_def(result));
        if let Some(first) = first {
            operands = operands.with(Role::Vvvv, Operand::reg_use(first));
        }
        let memory = match source {
            Source::Register(register) => {
                operands = operands.with(Role::Rm, Operand::any_use(register));
                None
            }
            Source::Memory(memory, base) => {
                if let Some(base) = base {
                    operands = operands.with(Role::Base, Operand::reg_use(base));
                }
                Some(memory)
            }
        };
        self.push(op, (immediate, memory), &operands);
        result
    }

    /// An operation of one source.
    pub(super) fn one(&mut self, op: &'static VectorOp, source: Source) -> VReg {
        self.emit((op, VECTOR), None, source, None)
    }

    /// An operation of two operands.
    pub(super) fn two(&mut self, op: &'static VectorOp, first: VReg, source: Source) -> VReg {
        self.emit((op, VECTOR), Some(first), source, None)
    }

    /// A shift by the same number of bits in all lanes.
    pub(super) fn shift_by(&mut self, op: &'static VectorOp, from: VReg, bits: u8) -> VReg {
        let result = self.function.register(VECTOR);
        let operands = Operands::new()
            .with(Role::Vvvv, Operand::reg_def(result))
            .with(Role::Rm, Operand::reg_use(from));
        self.push(op, (Some(bits), None), &operands);
        result
    }

    /// A word that is the same in all lanes.
    pub(super) fn constant(&mut self, word: u32) -> Source {
        let known = self.shared_constants.as_deref().unwrap_or_default();
        if let Some((_, known)) = known.iter().find(|(known, _)| *known == word) {
            return Source::Register(*known);
        }
        // Without embedded broadcasts the pool has whole vectors.
        let (copies, is_broadcast) = match self.isa {
            Isa::Avx2 => (8, false),
            Isa::Avx512 => (1, true),
        };
        let offset = displacement(self.assembler.pool_splat(word, copies));
        let memory = Memory {
            base: MemoryBase::Pool,
            offset,
            is_broadcast,
        };
        let source = Source::Memory(memory, None);
        if self.shared_constants.is_none() {
            return source;
        }
        let register = self.in_register(source);
        if let Some(shared) = &mut self.shared_constants {
            shared.push((word, register));
        }
        Source::Register(register)
    }

    /// Constant words, one for each lane of a register.
    pub(super) fn constant_lanes(&mut self, words: &[u32]) -> Source {
        let memory = Memory {
            base: MemoryBase::Pool,
            offset: displacement(self.assembler.pool_lanes(words)),
            is_broadcast: false,
        };
        Source::Memory(memory, None)
    }

    /// A source in a register.
    pub(super) fn in_register(&mut self, source: Source) -> VReg {
        match source {
            Source::Register(register) => register,
            Source::Memory(memory, base) => {
                let op = if memory.is_broadcast {
                    &vector_op::BROADCAST
                } else {
                    &vector_op::LOAD
                };
                let memory = Memory {
                    is_broadcast: false,
                    ..memory
                };
                self.one(op, Source::Memory(memory, base))
            }
        }
    }

    /// One word in memory, for all lanes.
    fn splat(&mut self, memory: Memory, base: Option<VReg>) -> Source {
        let source = Source::Memory(memory, base);
        match self.isa {
            Isa::Avx2 => Source::Register(self.in_register(source)),
            Isa::Avx512 => source,
        }
    }

    /// The word of a value, as an operand.
    pub(super) fn word(&mut self, value: Value, half: usize) -> Source {
        match self.places[value.index()] {
            Place::Registers(registers) => Source::Register(registers[half]),
            Place::Table(slot) => {
                let memory = Memory {
                    base: MemoryBase::Frame,
                    offset: displacement(self.frame.slot(slot)),
                    is_broadcast: self.isa == Isa::Avx512,
                };
                Source::Memory(memory, None)
            }
            Place::Constant(word) => self.constant(word),
            Place::Buffer { buffer, offset } => {
                let base = self.buffer_pointer(buffer);
                let memory = Memory {
                    base: MemoryBase::Operand,
                    offset: displacement(offset),
                    is_broadcast: true,
                };
                self.splat(memory, Some(base))
            }
            Place::Frame(offset) => {
                let memory = Memory {
                    base: MemoryBase::Frame,
                    offset: displacement(offset),
                    is_broadcast: true,
                };
                self.splat(memory, None)
            }
            Place::Nowhere | Place::MaskConstant(_) => {
                debug_assert!(false, "a word is used before it is computed");
                self.constant(0)
            }
        }
    }

    /// The word of a value in a register.
    pub(super) fn word_register(&mut self, value: Value, half: usize) -> VReg {
        let source = self.word(value, half);
        self.in_register(source)
    }

    /// A value in a register of its class.
    pub(super) fn any_register(&mut self, value: Value, half: usize) -> VReg {
        if self.class_of(value) == VECTOR
            && !matches!(self.places[value.index()], Place::MaskConstant(_))
        {
            return self.word_register(value, half);
        }
        self.mask(value, half)
    }

    /// The address of a buffer.
    pub(super) fn buffer_pointer(&mut self, buffer: u32) -> VReg {
        let at = buffer as usize;
        if let Some(Some(known)) = self.buffer_pointers.get(at) {
            return *known;
        }
        let pointer = self.pointer(self.frame.buffer(buffer));
        if let Some(place) = self.buffer_pointers.get_mut(at) {
            *place = Some(pointer);
        }
        pointer
    }

    /// A pointer that stands in the frame.
    pub(super) fn pointer(&mut self, offset: u32) -> VReg {
        let pointer = self.function.register(GPR);
        self.function.push(
            Instruction::LoadPointer(displacement(offset)),
            &[Operand::reg_def(pointer)],
        );
        pointer
    }

    /// A vector of zeros.
    pub(super) fn zero(&mut self) -> VReg {
        let zero = self.function.register(VECTOR);
        self.function
            .push(Instruction::Zero, &[Operand::reg_def(zero)]);
        zero
    }

    /// A register for a sequence of instructions.
    pub(super) fn temporary(&mut self, class: RegClass) -> Operand {
        Operand::reg_temp(self.function.register(class))
    }

    /// Keeps a hoisted value in the table.
    pub(super) fn keep(&mut self, value: Value, slot: u32) {
        let register = self.any_register(value, 0);
        let memory = Memory {
            base: MemoryBase::Frame,
            offset: displacement(self.frame.slot(slot)),
            is_broadcast: false,
        };
        let op = match self.isa {
            Isa::Avx2 => &vector_op::STORE,
            Isa::Avx512 if register.class() == VECTOR => &vector_op::STORE_LOWEST,
            Isa::Avx512 => &vector_op::MASK_STORE,
        };
        let operands = Operands::new().with(Role::Reg, Operand::reg_use(register));
        self.push(op, (None, Some(memory)), &operands);
        self.places[value.index()] = Place::Table(slot);
    }
}
