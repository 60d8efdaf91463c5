//! Inputs, outputs, buffers and arrays.

use super::Selector;
use super::operands::{Operands, Source};
use super::strides::Stride;
use crate::Isa;
use crate::encoder::vector_op;
use crate::frame::{BUFFER_WORDS, PACKET, displacement};
use crate::machine::strided::Strided;
use crate::machine::{GPR, Instruction, MASK, Memory, MemoryBase, Role, VECTOR};
use estampe_ir::{Type, Value};
use regalloc2::{Operand, VReg};

impl Selector<'_> {
    /// The displacement of a half in a packet of words.
    pub(super) fn half_words(&self, half: usize) -> i32 {
        if self.is_upper(half) {
            displacement(PACKET / 2)
        } else {
            0
        }
    }

    /// The displacement of a half in the 16 bits of a mask.
    fn half_mask(&self, half: usize) -> i32 {
        i32::from(self.is_upper(half))
    }

    /// True if a half has the upper lanes of a packet alone.
    fn is_upper(&self, half: usize) -> bool {
        half % self.isa.registers_of_packet() == 1
    }

    /// The packet of the pass to which a half belongs.
    fn packet_of(&self, half: usize) -> u32 {
        u32::from(half >= self.isa.registers_of_packet())
    }

    /// An input that is not the same in all lanes.
    pub(super) fn input(&mut self, at: u32, half: usize) -> VReg {
        let kinds = &self.kernel.interface.inputs;
        let kind = kinds.get(at as usize).map(|input| input.kind());
        let base = self.pointer(self.frame.input(at, self.packet_of(half)));
        match kind {
            Some(Type::Mask) => self.load_mask(MemoryBase::Operand, (0, half), Some(base)),
            _ => {
                let offset = self.half_words(half);
                let memory = Memory {
                    base: MemoryBase::Operand,
                    offset,
                    is_broadcast: false,
                };
                self.one(&vector_op::LOAD, Source::Memory(memory, Some(base)))
            }
        }
    }

    /// A mask whose bits are in memory.
    pub(super) fn load_mask(
        &mut self,
        base: MemoryBase,
        (offset, half): (i32, usize),
        pointer: Option<VReg>,
    ) -> VReg {
        let memory = Memory {
            base,
            offset: offset + self.half_mask(half),
            is_broadcast: false,
        };
        let source = Source::Memory(memory, pointer);
        match self.isa {
            Isa::Avx2 => {
                let bytes = self.one(&vector_op::BROADCAST_BYTE, source);
                let bits: Vec<u32> = (0..8).map(|lane| 1 << lane).collect();
                let bits = self.constant_lanes(&bits);
                let bits = self.in_register(bits);
                let own = self.two(&vector_op::AND, bytes, Source::Register(bits));
                self.two(&vector_op::EQUAL, own, Source::Register(bits))
            }
            Isa::Avx512 => self.emit((&vector_op::MASK_LOAD, MASK), None, source, None),
        }
    }

    /// Stores words of a register to memory.
    pub(super) fn store_words(
        &mut self,
        (base, offset): (MemoryBase, i32),
        pointer: Option<VReg>,
        words: VReg,
    ) {
        let memory = Memory {
            base,
            offset,
            is_broadcast: false,
        };
        let mut operands = Operands::new().with(Role::Reg, Operand::reg_use(words));
        if let Some(pointer) = pointer {
            operands = operands.with(Role::Base, Operand::reg_use(pointer));
        }
        self.push(&vector_op::STORE, (None, Some(memory)), &operands);
    }

    /// Stores the bits of a mask to memory: 16 bits, or with AVX2 those of a half.
    pub(super) fn store_mask(
        &mut self,
        (offset, half): (i32, usize),
        pointer: Option<VReg>,
        mask: VReg,
    ) {
        let mut operands = Operands::new().with(Role::Reg, Operand::reg_use(mask));
        match self.isa {
            Isa::Avx2 => {
                let temporary = self.temporary(GPR);
                let mut operands = vec![Operand::reg_use(mask)];
                operands.extend(pointer.map(Operand::reg_use));
                operands.push(temporary);
                let instruction = Instruction::StoreSigns {
                    offset: offset + self.half_mask(half),
                    has_pointer: pointer.is_some(),
                };
                self.function.push(instruction, &operands);
            }
            Isa::Avx512 => {
                let base = if pointer.is_some() {
                    MemoryBase::Operand
                } else {
                    MemoryBase::Frame
                };
                if let Some(pointer) = pointer {
                    operands = operands.with(Role::Base, Operand::reg_use(pointer));
                }
                let memory = Memory {
                    base,
                    offset,
                    is_broadcast: false,
                };
                self.push(&vector_op::MASK_STORE, (None, Some(memory)), &operands);
            }
        }
    }

    /// Writes the outputs.
    pub(super) fn outputs(&mut self, values: &[Value]) {
        let outputs = &self.kernel.interface.outputs;
        for (at, (output, &value)) in (0..).zip(outputs.iter().zip(values)) {
            for half in 0..self.halves {
                let pointer = self.pointer(self.frame.output(at, self.packet_of(half)));
                match output.kind() {
                    Type::Word => {
                        let words = self.word_register(value, half);
                        let offset = self.half_words(half);
                        let place = (MemoryBase::Operand, offset);
                        self.store_words(place, Some(pointer), words);
                    }
                    Type::Mask => {
                        let mask = self.mask(value, half);
                        self.store_mask((0, half), Some(pointer), mask);
                    }
                }
            }
        }
    }

    /// Words at indices of four-byte elements, in the lanes of a mask; 0 in others.
    pub(super) fn gather(&mut self, base: VReg, index: VReg, mask: VReg) -> VReg {
        let result = self.function.register(VECTOR);
        let zero = self.zero();
        // The instruction clears the mask, and no two of its registers may be the same.
        let class = self.mask_class();
        let cleared = self.function.register(class);
        let role = match self.isa {
            Isa::Avx2 => Role::Vvvv,
            Isa::Avx512 => Role::Mask,
        };
        let operands = Operands::new()
            .with(Role::Reg, Operand::reg_reuse_def(result, 2))
            .with(role, Operand::reg_reuse_def(cleared, 3))
            .with(Role::Silent, Operand::reg_use(zero))
            .with(Role::Silent, Operand::reg_use(mask))
            .with(Role::Index, Operand::reg_use_at_end(index))
            .with(Role::Base, Operand::reg_use(base));
        let memory = Memory {
            base: MemoryBase::Operand,
            offset: 0,
            is_broadcast: false,
        };
        self.push(&vector_op::GATHER, (None, Some(memory)), &operands);
        result
    }

    /// A word of a buffer.
    pub(super) fn load_buffer(&mut self, buffer: u32, offset: Value, half: usize) -> VReg {
        let stride = self.strides.of(offset);
        if stride.is_some_and(Stride::is_none) {
            return self.load_scalar((buffer, 2), offset, half);
        }
        // Offsets of words that are a multiple of four bytes apart.
        let stride = stride.filter(|stride| stride.words.is_multiple_of(4));
        let stride = stride.map(|stride| Stride {
            words: stride.words / 4,
            ..stride
        });
        let index = self.number_of_word(offset, half);
        self.load_words(buffer, index, stride)
    }

    /// The numbers of words at byte offsets.
    pub(super) fn number_of_word(&mut self, offset: Value, half: usize) -> VReg {
        let offset = self.word_register(offset, half);
        self.shift_by(&vector_op::SHR_U_BY, offset, 2)
    }

    /// A word of the memory of the work-group.
    pub(super) fn load_workgroup(&mut self, index: Value, half: usize) -> VReg {
        let memory = self.frame.workgroup;
        let stride = self.strides.of(index);
        if stride.is_some_and(Stride::is_none) {
            return self.load_scalar((memory, 0), index, half);
        }
        let index = self.workgroup_index(index, half);
        self.load_words(memory, index, stride)
    }

    /// The words with these numbers, which have a stride.
    fn load_strided(&mut self, (buffer, of): (u32, Stride), index: VReg) -> VReg {
        let stride = of.words;
        let steps = (!of.is_certain).then(|| {
            let steps = (0..16).map(|lane| lane * stride).collect::<Vec<_>>();
            self.assembler.pool_lanes(&steps)
        });
        let orders = (1..stride).map(|at| Strided::order(stride, at));
        let orders = orders.collect::<Vec<_>>().concat();
        let orders = self.assembler.pool_lanes(&orders);
        let base = self.buffer_pointer(buffer);
        let result = self.function.register(VECTOR);
        let mut operands = vec![
            Operand::reg_def_at_start(result),
            Operand::reg_use_at_end(index),
            Operand::reg_use_at_end(base),
            self.temporary(GPR),
            self.temporary(GPR),
            self.temporary(self.mask_class()),
        ];
        if stride > 1 || steps.is_some() {
            operands.push(self.temporary(VECTOR));
        }
        let load = Strided {
            buffer,
            stride,
            orders,
            steps,
        };
        self.function
            .push(Instruction::LoadStrided(load), &operands);
        result
    }

    /// The numbers of words of the memory of the work-group, less than 2³⁰.
    pub(super) fn workgroup_index(&mut self, index: Value, half: usize) -> VReg {
        let index = self.word_register(index, half);
        match self.isa {
            // Larger ones are outside as well.
            Isa::Avx2 => {
                let largest = self.constant((1 << 30) - 1);
                self.two(&vector_op::MIN_U, index, largest)
            }
            Isa::Avx512 => index,
        }
    }

    /// The word at a place that is the same in all lanes: its number, times a power of two.
    fn load_scalar(&mut self, (buffer, shift): (u32, u8), offset: Value, half: usize) -> VReg {
        let offset = self.word_register(offset, half);
        let result = self.function.register(VECTOR);
        let operands = [
            Operand::reg_def(result),
            Operand::reg_use(offset),
            self.temporary(GPR),
            self.temporary(GPR),
            self.temporary(GPR),
        ];
        let instruction = Instruction::LoadScalar { buffer, shift };
        self.function.push(instruction, &operands);
        result
    }

    /// The words with these numbers, which may have a stride; 0 outside.
    fn load_words(&mut self, buffer: u32, index: VReg, stride: Option<Stride>) -> VReg {
        if let Some(stride) = stride
            && (1..=Strided::most(self.isa)).contains(&stride.words)
        {
            return self.load_strided((buffer, stride), index);
        }
        let is_inside = self.is_inside(index, self.frame.buffer(buffer) + BUFFER_WORDS);
        let base = self.buffer_pointer(buffer);
        self.gather(base, index, is_inside)
    }

    /// The lanes in which a word's number is less than one in the frame.
    pub(super) fn is_inside(&mut self, index: VReg, words: u32) -> VReg {
        let words = Memory {
            base: MemoryBase::Frame,
            offset: displacement(words),
            is_broadcast: self.isa == Isa::Avx512,
        };
        // With AVX2 both are less than 2³⁰, so the comparison may be one of signed integers.
        match self.isa {
            Isa::Avx2 => {
                let words = Source::Memory(words, None);
                let words = self.one(&vector_op::BROADCAST, words);
                self.two(&vector_op::GREATER_S, words, Source::Register(index))
            }
            Isa::Avx512 => {
                let words = Source::Memory(words, None);
                self.emit((&vector_op::COMPARE_U, MASK), Some(index), words, Some(1))
            }
        }
    }

    /// Stores words by their numbers in the lanes of a mask, with AVX-512: to a place in memory, at
    /// these indices.
    pub(super) fn scatter_words(&mut self, [base, index]: [VReg; 2], value: VReg, mask: VReg) {
        let cleared = self.function.register(MASK);
        let operands = Operands::new()
            .with(Role::Mask, Operand::reg_reuse_def(cleared, 1))
            .with(Role::Silent, Operand::reg_use(mask))
            .with(Role::Reg, Operand::reg_use(value))
            .with(Role::Index, Operand::reg_use(index))
            .with(Role::Base, Operand::reg_use(base));
        let memory = Memory {
            base: MemoryBase::Operand,
            offset: 0,
            is_broadcast: false,
        };
        self.push(&vector_op::SCATTER, (None, Some(memory)), &operands);
    }
}
