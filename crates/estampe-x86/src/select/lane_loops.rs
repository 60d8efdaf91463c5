//! Stores and atomic operations as loops over the lanes of a packet.

use super::Selector;
use super::operands::Source;
use crate::Isa;
use crate::encoder::vector_op;
use crate::frame::{BUFFER_STORED_WORDS, MASK_ARGUMENT, PACKET, displacement};
use crate::machine::lane_loop::LaneLoop;
use crate::machine::{GPR, Instruction, Memory, MemoryBase};
use estampe_ir::op::{Atomic, Memory as Shared};
use estampe_ir::{Op, Value};
use regalloc2::{Operand, VReg};

/// An operation on memory, lane after lane.
#[derive(Debug, Clone, Copy)]
struct OnMemory {
    kind: Atomic,
    memory: Shared,
    /// The place in the memory.
    at: Value,
    value: Value,
    mask: Value,
    gives: bool,
}

impl Selector<'_> {
    /// A store or an atomic operation, if there is code for it; returns false if not.
    pub(super) fn effect_on_memory(&mut self, op: &Op, first: Value) -> bool {
        let Some(mut of) = OnMemory::new(op) else {
            return false;
        };
        // A store has no result: there may be no value of this number.
        of.gives = of.gives && self.plan.is_value_needed(first);
        if of.kind == Atomic::Load {
            self.atomic_load(of, first);
            return true;
        }
        let loops = LaneLoop {
            kind: of.kind,
            // The packets of a work-group run on one thread.
            is_shared: matches!(of.memory, Shared::Buffer(_)),
            gives: of.gives,
        };
        if of.kind == Atomic::Store && self.isa == Isa::Avx512 {
            self.scatter(of);
        } else if loops.is_compiled() {
            self.each_lane(of, loops, first);
        } else {
            return false;
        }
        true
    }

    fn buffer_of(&self, memory: Shared) -> u32 {
        match memory {
            Shared::Buffer(buffer) => buffer,
            Shared::Workgroup => self.frame.workgroup,
        }
    }

    /// The numbers of the words, and the lanes that act: those of the mask whose words are there.
    fn words_and_lanes(&mut self, of: OnMemory, half: usize) -> [VReg; 2] {
        let index = match of.memory {
            Shared::Buffer(_) => self.number_of_word(of.at, half),
            Shared::Workgroup => self.workgroup_index(of.at, half),
        };
        let words = self.frame.buffer(self.buffer_of(of.memory)) + BUFFER_STORED_WORDS;
        let is_inside = self.is_inside(index, words);
        let mask = self.mask(of.mask, half);
        [index, self.mask_and(mask, is_inside)]
    }

    /// Stores with AVX-512. The instruction stores from the lowest lane to the highest one, so the
    /// last one counts where several have the same number.
    fn scatter(&mut self, of: OnMemory) {
        for half in 0..self.halves {
            let [index, lanes] = self.words_and_lanes(of, half);
            let value = self.word_register(of.value, half);
            let base = self.buffer_pointer(self.buffer_of(of.memory));
            self.scatter_words([base, index], value, lanes);
        }
    }

    fn atomic_load(&mut self, of: OnMemory, first: Value) {
        for half in 0..self.halves {
            let [index, lanes] = self.words_and_lanes(of, half);
            let base = self.buffer_pointer(self.buffer_of(of.memory));
            let loaded = self.gather(base, index, lanes);
            self.define(first, half, loaded);
        }
    }

    fn each_lane(&mut self, of: OnMemory, loops: LaneLoop, first: Value) {
        let packet = |number: u32| displacement(self.frame.arguments + number * PACKET);
        let [indices, values, results] = [packet(0), packet(1), packet(2)];
        for halves in self.packets_of_pass() {
            for half in halves.clone() {
                let offset = self.half_words(half);
                let [index, lanes] = self.words_and_lanes(of, half);
                self.store_words((MemoryBase::Frame, indices + offset), None, index);
                let value = self.word_register(of.value, half);
                self.store_words((MemoryBase::Frame, values + offset), None, value);
                self.store_mask((MASK_ARGUMENT, half), None, lanes);
                if of.gives {
                    let zero = self.zero();
                    self.store_words((MemoryBase::Frame, results + offset), None, zero);
                }
            }
            let base = self.buffer_pointer(self.buffer_of(of.memory));
            let mut operands = vec![Operand::reg_use_at_end(base)];
            operands.extend((0..5).map(|_| self.temporary(GPR)));
            let instruction = Instruction::EachLane(loops);
            self.function.push(instruction, &operands);
            for half in halves.filter(|_| of.gives) {
                let memory = Memory {
                    base: MemoryBase::Frame,
                    offset: results + self.half_words(half),
                    is_broadcast: false,
                };
                let result = self.one(&vector_op::LOAD, Source::Memory(memory, None));
                self.define(first, half, result);
            }
        }
    }
}

impl OnMemory {
    fn new(op: &Op) -> Option<Self> {
        let (kind, memory, gives) = match *op {
            Op::StoreBuffer { buffer, .. } => (Atomic::Store, Shared::Buffer(buffer), false),
            Op::StoreWorkgroup { .. } => (Atomic::Store, Shared::Workgroup, false),
            Op::Atomic { kind, memory, .. } => (kind, memory, kind != Atomic::Store),
            _ => return None,
        };
        let (at, value, mask) = match *op {
            Op::StoreBuffer {
                offset: at,
                value,
                mask,
                ..
            }
            | Op::StoreWorkgroup {
                index: at,
                value,
                mask,
            }
            | Op::Atomic {
                offset: at,
                value,
                mask,
                ..
            } => (at, value, mask),
            _ => return None,
        };
        Some(Self {
            kind,
            memory,
            at,
            value,
            mask,
            gives,
        })
    }
}
