//! Arrays of the lanes: sixteen lanes of a word lie side by side in the frame, those of a table,
//! to which nothing is stored, behind the code.

use super::operands::Source;
use super::{Place, Selector};
use crate::Isa;
use crate::encoder::vector_op;
use crate::frame::{MASK_ARGUMENT, PACKET, displacement};
use crate::machine::lane_loop::LaneLoop;
use crate::machine::{GPR, Instruction, MASK, Memory, MemoryBase};
use estampe_ir::Value;
use estampe_ir::op::Atomic;
use regalloc2::{Operand, VReg};

impl Selector<'_> {
    /// Stores a word of an array in the lanes of a mask.
    pub(super) fn store_local(&mut self, array: u32, [index, value, mask]: [Value; 3]) {
        let of_kernel = self.kernel.interface.locals.get(array as usize);
        let words = of_kernel.map_or(0, |array| array.words);
        let start = self.frame.locals[array as usize];
        match self.plan.constant(index) {
            Some(index) if index < words => {
                self.store_packet(start + index * PACKET, [value, mask]);
            }
            // Nothing is there.
            Some(_) => {}
            None => self.store_indexed((start, words), [index, value, mask]),
        }
    }

    /// Stores a word of all lanes to a packet in the frame, in the lanes of a mask.
    fn store_packet(&mut self, packet: u32, [value, mask]: [Value; 2]) {
        let is_whole = matches!(self.places[mask.index()], Place::MaskConstant(true));
        for half in 0..self.halves {
            let offset = displacement(packet) + self.half_words(half);
            let value = self.word_register(value, half);
            let stored = if is_whole {
                value
            } else {
                let memory = Memory {
                    base: MemoryBase::Frame,
                    offset,
                    is_broadcast: false,
                };
                let before = self.one(&vector_op::LOAD, Source::Memory(memory, None));
                let mask = self.mask(mask, half);
                self.blend(mask, Source::Register(value), before)
            };
            self.store_words((MemoryBase::Frame, offset), None, stored);
        }
    }

    /// Stores words whose numbers are computed: by one instruction with AVX-512, lane by lane with
    /// AVX2.
    fn store_indexed(&mut self, (start, words): (u32, u32), [index, value, mask]: [Value; 3]) {
        let arguments = displacement(self.frame.arguments);
        let base = self.frame_pointer(start);
        for half in 0..self.halves {
            let index = self.word_register(index, half);
            let lanes = self.lanes_below(index, words);
            let mask = self.mask(mask, half);
            let lanes = self.mask_and(mask, lanes);
            let place = self.place_of_lanes(index, half);
            let value = self.word_register(value, half);
            if self.isa == Isa::Avx512 {
                self.scatter_words([base, place], value, lanes);
                continue;
            }
            let offset = arguments + self.half_words(half);
            let next = displacement(PACKET);
            self.store_words((MemoryBase::Frame, offset), None, place);
            self.store_words((MemoryBase::Frame, offset + next), None, value);
            self.store_mask((MASK_ARGUMENT, half), None, lanes);
        }
        if self.isa == Isa::Avx2 {
            let loops = LaneLoop {
                kind: Atomic::Store,
                is_shared: false,
                gives: false,
            };
            let mut operands = vec![Operand::reg_use_at_end(base)];
            operands.extend((0..5).map(|_| self.temporary(GPR)));
            self.function.push(Instruction::EachLane(loops), &operands);
        }
    }

    /// The lanes in which a number is less than another one.
    fn lanes_below(&mut self, index: VReg, words: u32) -> VReg {
        match self.isa {
            Isa::Avx2 => {
                let last = self.constant(words.saturating_sub(1));
                let held = self.two(&vector_op::MIN_U, index, last);
                self.two(&vector_op::EQUAL, held, Source::Register(index))
            }
            Isa::Avx512 => {
                let words = self.constant(words);
                self.emit((&vector_op::COMPARE_U, MASK), Some(index), words, Some(1))
            }
        }
    }

    /// A place in the frame.
    fn frame_pointer(&mut self, at: u32) -> VReg {
        let base = self.function.register(GPR);
        let pointer = Instruction::FramePointer(displacement(at));
        self.function.push(pointer, &[Operand::reg_def(base)]);
        base
    }

    /// The numbers of the lanes' words among those of all lanes.
    fn place_of_lanes(&mut self, index: VReg, half: usize) -> VReg {
        let index = self.shift_by(&vector_op::SHL_BY, index, 4);
        let first = u32::try_from(half * self.isa.lanes()).unwrap_or(0);
        let lanes: Vec<u32> = (first..).take(self.isa.lanes()).collect();
        let lanes = self.constant_lanes(&lanes);
        self.two(&vector_op::ADD, index, lanes)
    }

    /// A word of an array of the lane.
    pub(super) fn load_local(&mut self, array: u32, index: Value, half: usize) -> VReg {
        let at = array as usize;
        let kernel = self.kernel;
        let of_kernel = kernel.interface.locals.get(at);
        // An array without words has none to read.
        let Some((of_kernel, last)) =
            of_kernel.zip(of_kernel.and_then(|of| of.words.checked_sub(1)))
        else {
            return self.zero();
        };
        let start = self.frame.locals[at];
        let is_table = !self.plan.is_array_stored(array);
        if let (Some(index), false) = (self.plan.constant(index), is_table) {
            let offset = displacement(start + index.min(last) * PACKET);
            let memory = Memory {
                base: MemoryBase::Frame,
                offset: offset + self.half_words(half),
                is_broadcast: false,
            };
            return self.one(&vector_op::LOAD, Source::Memory(memory, None));
        }
        let index = self.word_register(index, half);
        let last = self.constant(last);
        let index = self.two(&vector_op::MIN_U, index, last);
        let mask = self.mask_constant(true);
        if is_table {
            let offset = self.tables[at].unwrap_or_else(|| {
                let mut words = of_kernel.init.clone();
                words.resize(of_kernel.words as usize, 0);
                self.assembler.pool_words(&words)
            });
            self.tables[at] = Some(offset);
            let base = self.function.register(GPR);
            let pointer = Instruction::PoolPointer(offset);
            self.function.push(pointer, &[Operand::reg_def(base)]);
            return self.gather(base, index, mask);
        }
        let base = self.frame_pointer(start);
        let place = self.place_of_lanes(index, half);
        self.gather(base, place, mask)
    }
}
